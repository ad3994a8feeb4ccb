// SPDX-License-Identifier: BSD-3-Clause
//
// As-rigid-as-possible deformation next to CGAL's with the tag ORIGINAL_ARAP,
// in one run: what an iteration costs, both in one thread, in turns so that
// both see the same load; and the energy both come to. The energy is computed
// from the positions alone, the same way for both, with nonnegative cotangents
// as both have them. Ends with a table of what was asked and what was measured.
#include "OffReader.h"
#include "PeerDeformation.h"

#include "Kernel/AsRigidAsPossibleDeformer.h"
#include "Kernel/Rotation.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <map>
#include <stdexcept>

using cartan::AsRigidAsPossibleDeformer;
using cartan::InitialGuess;
using cartan::RigidityEnergy;

namespace
{
struct Mesh
{
  cartan::Points Points;
  cartan::Triangles Triangles;
};

/// A scanned mesh, centred on the origin.
Mesh Read(const char* name)
{
  const offreader::Mesh file = offreader::Read(offreader::MeshPath(name));
  Mesh mesh;
  mesh.Points = Eigen::Map<const cartan::Points>(
    file.Points.data(), static_cast<Eigen::Index>(file.Points.size() / 3), 3);
  mesh.Triangles = Eigen::Map<const cartan::Triangles>(
    file.Triangles.data(), static_cast<Eigen::Index>(file.Triangles.size() / 3), 3);
  const Eigen::RowVector3d center =
    0.5 * (mesh.Points.colwise().minCoeff() + mesh.Points.colwise().maxCoeff());
  mesh.Points.rowwise() -= center;
  return mesh;
}

/// Each triangle into four, by the edges' midpoints.
Mesh Subdivide(const Mesh& mesh)
{
  std::map<std::pair<int, int>, int> midpoints;
  std::vector<Eigen::RowVector3d> points;
  for (Eigen::Index v = 0; v < mesh.Points.rows(); ++v)
  {
    points.push_back(mesh.Points.row(v));
  }
  Mesh result;
  result.Triangles.resize(4 * mesh.Triangles.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.Triangles.rows(); ++t)
  {
    const Eigen::RowVector3i corners = mesh.Triangles.row(t);
    std::array<int, 3> middle;
    for (int c = 0; c < 3; ++c)
    {
      const std::pair<int, int> edge = std::minmax({ corners[c], corners[(c + 1) % 3] });
      const auto [found, isNew] = midpoints.emplace(edge, static_cast<int>(points.size()));
      if (isNew)
      {
        points.push_back(0.5 * (points[edge.first] + points[edge.second]));
      }
      middle[c] = found->second;
    }
    for (int c = 0; c < 3; ++c)
    {
      result.Triangles.row(4 * t + c) << corners[c], middle[c], middle[(c + 2) % 3];
    }
    result.Triangles.row(4 * t + 3) << middle[0], middle[1], middle[2];
  }
  result.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    result.Points.row(static_cast<Eigen::Index>(v)) = points[v];
  }
  return result;
}

/// Handle 1, static, below 5 % of the height; handle 2 above 95 %.
cartan::HandleProblem Problem(const Mesh& mesh)
{
  cartan::HandleProblem problem;
  problem.Mesh = std::make_shared<const cartan::TriangleMesh>(
    static_cast<int>(mesh.Points.rows()), mesh.Triangles);
  problem.Rest = std::make_shared<const cartan::Points>(mesh.Points);
  const double low = mesh.Points.col(1).minCoeff();
  const double height = mesh.Points.col(1).maxCoeff() - low;
  for (Eigen::Index v = 0; v < mesh.Points.rows(); ++v)
  {
    const double y = (mesh.Points(v, 1) - low) / height;
    problem.Handle.push_back(y <= 0.05 ? 1 : y >= 0.95 ? 2 : 0);
  }
  problem.Moving = { 2 };
  return problem;
}

cartan::HandleTargets Turn(double degrees)
{
  cartan::HandleTargets targets;
  cartan::HandleMotion motion;
  motion.RotationVector = Eigen::Vector3d(degrees * EIGEN_PI / 180.0, 0.0, 0.0);
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  targets.Motions = { motion };
  return targets;
}

/// sum_i min_R sum_j w_ij |x_i - x_j - R (p_i - p_j)|^2, w_ij >= 0.
double Energy(const cartan::HandleProblem& problem, const cartan::Points& positions)
{
  const cartan::TriangleMesh& mesh = *problem.Mesh;
  const Eigen::VectorXd weights =
    cartan::EdgeWeights(mesh, *problem.Rest, cartan::LaplacianWeights::Cotangent).cwiseMax(0.0);
  double energy = 0.0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const bool isFitted : { false, true })
    {
      const Eigen::Matrix3d rotation =
        isFitted ? cartan::ProjectOnRotations(covariance) : covariance;
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        const Eigen::Vector3d rest =
          (problem.Rest->row(v) - problem.Rest->row(mesh.Neighbor(d))).transpose();
        const Eigen::Vector3d edge =
          (positions.row(v) - positions.row(mesh.Neighbor(d))).transpose();
        if (isFitted)
        {
          energy += weights[d] * (edge - rotation * rest).squaredNorm();
        }
        else
        {
          covariance += weights[d] * edge * rest.transpose();
        }
      }
    }
  }
  return energy;
}

/// Seconds of this thread: others' load does not count.
double ProcessorTime()
{
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double Median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void PrintRow(const char* what, const char* asked, double value, const char* unit, bool isMet)
{
  std::printf("  %-52s %-8s %12.5g %-3s %s\n", what, asked, value, unit,
    *asked == '\0' ? ""
      : isMet      ? "met"
                   : "MISSED");
}

/// What an iteration costs, the difference between many and few so that the
/// guess and the set-up do not count.
void CompareIterations()
{
  const Mesh mesh = Subdivide(Read("armadillo"));
  const cartan::HandleProblem problem = Problem(mesh);
  PeerDeformation peer(mesh.Points, mesh.Triangles, problem.Handle);
  constexpr int Few = 3;
  constexpr int Many = 13;
  for (const auto& [energy, name] :
    { std::pair<RigidityEnergy, const char*>{ RigidityEnergy::Spokes, "Spokes" },
      { RigidityEnergy::SpokesAndRims, "SpokesAndRims" },
      { RigidityEnergy::SmoothedRotations, "SmoothedRotations" } })
  {
    AsRigidAsPossibleDeformer deformer(problem, energy);
    cartan::DeformedSurface result;
    std::vector<double> ours;
    std::vector<double> theirs;
    for (int turn = 0; turn < 5; ++turn)
    {
      const cartan::HandleTargets targets = Turn(20.0 + 5.0 * turn);
      double seconds[2];
      for (const int part : { 0, 1 })
      {
        deformer.SetIteration(part ? Many : Few, 0.0);
        const double start = ProcessorTime();
        deformer.Deform(targets, false, result, {});
        seconds[part] = ProcessorTime() - start;
      }
      ours.push_back((seconds[1] - seconds[0]) / (Many - Few));
      peer.MoveHandle(targets.Motions[0].Linear, targets.Motions[0].Translation);
      const double start = ProcessorTime();
      peer.Iterate();
      theirs.push_back(ProcessorTime() - start);
    }
    std::printf(
      "%s, armadillo, %d free vertices, one thread\n", name, deformer.GetNumberOfFreeVertices());
    PrintRow("an iteration", "", 1e3 * Median(ours), "ms", true);
    PrintRow("an iteration of CGAL's ORIGINAL_ARAP", "", 1e3 * Median(theirs), "ms", true);
    const double ratio = Median(theirs) / Median(ours);
    PrintRow(
      "times faster", energy == RigidityEnergy::Spokes ? ">= 3" : "", ratio, "", ratio >= 3.0);
  }
}

void CompareEnergies(const char* name, double degrees)
{
  const Mesh mesh = Read(name);
  const cartan::HandleProblem problem = Problem(mesh);
  const cartan::HandleTargets targets = Turn(degrees);
  std::printf("%s, %d vertices, turned by %g degrees, energy at convergence\n", name,
    problem.Mesh->NumberOfVertices(), degrees);

  AsRigidAsPossibleDeformer deformer(problem);
  deformer.SetIteration(5000, 1e-9);
  cartan::DeformedSurface result;
  double start = ProcessorTime();
  deformer.Deform(targets, false, result, {});
  const double ourTime = ProcessorTime() - start;
  const double ours = Energy(problem, result.Positions);

  PeerDeformation peer(mesh.Points, mesh.Triangles, problem.Handle);
  peer.MoveHandle(targets.Motions[0].Linear, targets.Motions[0].Translation);
  int iterations = 0;
  double theirs = 0.0;
  start = ProcessorTime();
  double before = 1e300;
  // A decrease of 1e-6 in ten iterations.
  for (theirs = 1e299; before - theirs > 1e-6 * theirs && iterations < 3000;)
  {
    before = theirs;
    for (int i = 0; i < 10; ++i, ++iterations)
    {
      peer.Iterate();
    }
    theirs = Energy(problem, peer.GetPositions());
  }
  const double theirTime = ProcessorTime() - start;
  PrintRow("energy", "", ours, "", true);
  PrintRow("energy as the deformer reports it", "", deformer.GetEnergies().back(), "", true);
  PrintRow("energy of CGAL's", "", theirs, "", true);
  PrintRow("difference", "<= 1 %", 100.0 * (ours / theirs - 1.0), "%",
    std::abs(ours / theirs - 1.0) <= 0.01);
  PrintRow("iterations", "", deformer.GetNumberOfIterations(), "", true);
  PrintRow("CGAL's iterations", "", iterations, "", true);
  PrintRow("seconds", "", ourTime, "s", true);
  PrintRow("CGAL's seconds", "", theirTime, "s", true);
}
}

int main()
{
  try
  {
    CompareIterations();
    CompareEnergies("elephant", 40.0);
    CompareEnergies("camel", 40.0);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
