// SPDX-License-Identifier: BSD-3-Clause
//
// As-rigid-as-possible deformation next to CGAL's with the tag ORIGINAL_ARAP,
// in one run: what an iteration costs, in one thread and in all that the machine
// has, in turns so that both see the same load (CGAL has one thread); and the energy
// both come to. The energy is computed from the positions alone, the same way for
// both, with nonnegative cotangents as both have them. Ends with a table of what
// was asked and what was measured.
#include "BenchmarkTools.h"
#include "PeerDeformation.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

using namespace benchmarks;
using cartan::AsRigidAsPossibleDeformer;
using cartan::InitialGuess;
using cartan::RigidityEnergy;

namespace
{
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

/// What an iteration costs, the difference between many and few so that the
/// guess and the set-up do not count.
void CompareIterations()
{
  const Mesh mesh = Subdivide(ReadMesh("armadillo"));
  const cartan::HandleProblem problem = MakeProblem(mesh, 0.05, 0.95);
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
    for (const bool isThreaded : { false, true })
    {
      // Others' load does not count in one thread; several are waited for.
      const auto now = isThreaded ? WallTime : ProcessorTime;
      const cartan::ExecutionContext context = Threads(isThreaded);
      std::vector<double> ours;
      std::vector<double> theirs;
      for (int turn = 0; turn < 7; ++turn)
      {
        const cartan::HandleTargets targets = Turn(20.0 + 5.0 * turn);
        double seconds[2];
        for (const int part : { 0, 1 })
        {
          deformer.SetIteration(part ? Many : Few, 0.0);
          const double start = now();
          deformer.Deform(targets, false, result, context);
          seconds[part] = now() - start;
        }
        ours.push_back((seconds[1] - seconds[0]) / (Many - Few));
        peer.MoveHandle(targets.Motions[0].Linear, targets.Motions[0].Translation);
        const double start = now();
        peer.Iterate();
        theirs.push_back(now() - start);
      }
      std::printf("%s, armadillo, %d free vertices, %s\n", name, deformer.GetNumberOfFreeVertices(),
        isThreaded ? "all threads (CGAL has one)" : "one thread");
      PrintRow("an iteration", "", 1e3 * Median(ours), "ms");
      PrintRow("an iteration of CGAL's ORIGINAL_ARAP", "", 1e3 * Median(theirs), "ms");
      const double ratio = Median(theirs) / Median(ours);
      PrintRow("times faster",
        energy != RigidityEnergy::Spokes ? ""
          : isThreaded                   ? ">= 4"
                                         : ">= 3",
        ratio, "", ratio >= (isThreaded ? 4.0 : 3.0));
    }
  }
}

void CompareEnergies(const char* name, double degrees)
{
  const Mesh mesh = ReadMesh(name);
  const cartan::HandleProblem problem = MakeProblem(mesh, 0.05, 0.95);
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
  PrintRow("energy", "", ours, "");
  PrintRow("energy as the deformer reports it", "", deformer.GetEnergies().back(), "");
  PrintRow("energy of CGAL's", "", theirs, "");
  PrintRow("difference", "<= 1 %", 100.0 * (ours / theirs - 1.0), "%",
    std::abs(ours / theirs - 1.0) <= 0.01);
  PrintRow("iterations", "", deformer.GetNumberOfIterations(), "");
  PrintRow("CGAL's iterations", "", iterations, "");
  PrintRow("seconds", "", ourTime, "s");
  PrintRow("CGAL's seconds", "", theirTime, "s");
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
