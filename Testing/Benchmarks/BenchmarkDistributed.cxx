// SPDX-License-Identifier: BSD-3-Clause
//
// Rotation-invariant editing of a surface in pieces: steps of conjugate gradients, seconds
// of the set-up and of motions, first on one rank and then on all, and what the others are
// worth. See Documentation/Scale.md.
//
//   mpiexec -n <ranks> CartanBenchmarkDistributed <surface>...
//
// A surface is generated with so many points, like that of BenchmarkSolver, of which each rank
// makes its own slice; or armadillo<k>, the scan subdivided k times, which each rank reads and
// cuts.
#include "BenchmarkTools.h"

#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Distributed/DistributedMesh.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>
#include <vector>

using namespace benchmarks;

namespace
{
/// A number in [-.5, .5) that depends on the point and not on who asks.
double Noise(int i, int j, int which)
{
  auto state = static_cast<unsigned>(i) * 2654435761U ^ static_cast<unsigned>(j) * 2246822519U ^
    static_cast<unsigned>(which) * 3266489917U;
  state ^= state >> 15;
  state *= 2246822519U;
  state ^= state >> 13;
  return (state >> 8) / 16777216.0 - 0.5;
}

/// The rows of a square with hills and the noise of a scanner that a rank has, and a row of
/// ghosts on either side.
cartan::SurfacePiece Slice(int side, const std::shared_ptr<const cartan::Ranks>& group)
{
  const auto firstOf = [&](int rank)
  { return static_cast<int>(static_cast<long long>(side) * rank / group->GetSize()); };
  const int first = firstOf(group->GetRank());
  const int last = firstOf(group->GetRank() + 1);
  const int begin = std::max(first - 1, 0);
  const int end = std::min(last + 1, side);
  cartan::SurfacePiece piece;
  piece.Group = group;
  piece.Positions.resize(static_cast<Eigen::Index>(end - begin) * side, 3);
  piece.Corners.resize(2 * static_cast<Eigen::Index>(end - begin - 1) * (side - 1), 3);
  const double step = 1.0 / (side - 1);
  Eigen::Index triangle = 0;
  for (int i = begin; i < end; ++i)
  {
    for (int j = 0; j < side; ++j)
    {
      const double x = (j + 0.6 * Noise(i, j, 0)) * step;
      const double y = (i + 0.6 * Noise(i, j, 1)) * step;
      const int v = (i - begin) * side + j;
      piece.Positions.row(v) << x - 0.5, y - 0.5,
        0.1 * std::sin(9.0 * x) * std::cos(7.0 * y) + 0.2 * step * Noise(i, j, 2);
      piece.GlobalIds.push_back(static_cast<std::int64_t>(i) * side + j);
      piece.Owners.push_back(group->GetRank() + (i < first ? -1 : 0) + (i >= last ? 1 : 0));
      if (i + 1 < end && j + 1 < side)
      {
        piece.Corners.row(triangle++) << v, v + 1, v + side;
        piece.Corners.row(triangle++) << v + 1, v + side + 1, v + side;
      }
    }
  }
  return piece;
}

/// The slice of a rank along y of a whole that all have.
cartan::SurfacePiece CutOut(const Mesh& mesh, const std::shared_ptr<const cartan::Ranks>& group)
{
  const double low = mesh.Points.col(1).minCoeff();
  const double extent = mesh.Points.col(1).maxCoeff() - low;
  const auto ownerOf = [&](int v)
  {
    const double part = (mesh.Points(v, 1) - low) / extent;
    return std::min(static_cast<int>(part * group->GetSize()), group->GetSize() - 1);
  };
  std::vector<int> local(static_cast<std::size_t>(mesh.Points.rows()), -1);
  std::vector<int> vertices;
  std::vector<Eigen::Vector3i> faces;
  for (Eigen::Index t = 0; t < mesh.Triangles.rows(); ++t)
  {
    Eigen::Vector3i face = mesh.Triangles.row(t);
    if (ownerOf(face[0]) != group->GetRank() && ownerOf(face[1]) != group->GetRank() &&
      ownerOf(face[2]) != group->GetRank())
    {
      continue;
    }
    for (int& v : face)
    {
      if (local[v] < 0)
      {
        local[v] = static_cast<int>(vertices.size());
        vertices.push_back(v);
      }
      v = local[v];
    }
    faces.push_back(face);
  }
  cartan::SurfacePiece piece;
  piece.Group = group;
  piece.Positions.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  piece.Corners.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    piece.Positions.row(static_cast<Eigen::Index>(i)) = mesh.Points.row(vertices[i]);
    piece.GlobalIds.push_back(vertices[i]);
    piece.Owners.push_back(ownerOf(vertices[i]));
  }
  for (std::size_t t = 0; t < faces.size(); ++t)
  {
    piece.Corners.row(static_cast<Eigen::Index>(t)) = faces[t].transpose();
  }
  return piece;
}

cartan::SurfacePiece PieceOf(
  const std::string& name, const std::shared_ptr<const cartan::Ranks>& group)
{
  const std::string scan = "armadillo";
  if (name.rfind(scan, 0) != 0)
  {
    return Slice(static_cast<int>(std::lround(std::sqrt(std::atof(name.c_str())))), group);
  }
  Mesh mesh = ReadMesh(scan);
  for (int k = std::atoi(name.c_str() + scan.size()); k > 0; --k)
  {
    mesh = Subdivide(mesh);
  }
  return CutOut(mesh, group);
}

/// Both ends along x are handles, so that all ranks have some of them.
cartan::HandleProblem ProblemOf(const std::shared_ptr<const cartan::DistributedMesh>& mesh)
{
  cartan::HandleProblem problem;
  problem.Mesh = mesh->GetMesh();
  problem.Rest = mesh->GetPositions();
  problem.Pieces = mesh;
  problem.Moving = { 2 };
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(1);
  if (mesh->NumberOfVertices() > 0)
  {
    largest[0] = problem.Rest->col(0).cwiseAbs().maxCoeff();
  }
  mesh->Max(largest);
  for (int v = 0; v < mesh->NumberOfVertices(); ++v)
  {
    const double part = (*problem.Rest)(v, 0) / largest[0];
    problem.Handle.push_back(part < -0.8 ? 1 : part > 0.8 ? 2 : 0);
  }
  return problem;
}

struct Times
{
  double Wall;
  double Processor;
};

/// Of the slowest rank, and of all ranks together.
Times Since(double wall, double processor, const cartan::Ranks& group)
{
  Eigen::VectorXd slowest = Eigen::VectorXd::Constant(1, WallTime() - wall);
  Eigen::VectorXd all = Eigen::VectorXd::Constant(1, ProcessorTime() - processor);
  group.Max(slowest);
  group.Sum(all);
  return { slowest[0], all[0] };
}

/// The time of the set-up with the first raw motion.
Times Measure(const std::string& surface, const std::shared_ptr<const cartan::Ranks>& group)
{
  const cartan::SurfacePiece piece = PieceOf(surface, group);
  group->Agree();
  double wall = WallTime();
  double processor = ProcessorTime();
  const auto mesh = std::make_shared<const cartan::DistributedMesh>(piece);
  cartan::RotationInvariantDeformer deformer(ProblemOf(mesh));
  const int ofProbe = deformer.GetPositionSystem()->GetNumberOfSteps();
  deformer.SetFrameProjection(cartan::FrameProjection::None);
  cartan::DeformedSurface result;
  deformer.Deform(Turn(20.0), false, result, {});
  const Times setUp = Since(wall, processor, *group);
  const int ofFields = deformer.GetPositionSystem()->GetNumberOfSteps();
  const std::int64_t before = group->GetNumberOfMessages();
  wall = WallTime();
  processor = ProcessorTime();
  deformer.Deform(Turn(25.0), false, result, {});
  const std::int64_t messages = group->GetNumberOfMessages() - before;
  const Times raw = Since(wall, processor, *group);
  deformer.SetFrameProjection(cartan::FrameProjection::Rotation);
  wall = WallTime();
  processor = ProcessorTime();
  deformer.Deform(Turn(30.0), false, result, {});
  const Times projected = Since(wall, processor, *group);
  if (group->GetRank() == 0)
  {
    std::printf("%9lld points, %3d ranks: steps %2d %2d %2d, set-up and first motion %7.2f s wall "
                "%7.2f s processor, raw motion %.3f s wall with %lld messages, projected %.2f s "
                "wall\n",
      static_cast<long long>(mesh->GetTotalNumberOfPoints()), group->GetSize(), ofProbe, ofFields,
      deformer.GetPositionSystem()->GetNumberOfSteps(), setUp.Wall, setUp.Processor, raw.Wall,
      static_cast<long long>(messages), projected.Wall);
    std::fflush(stdout);
  }
  return setUp;
}

/// Waits without taking the processor from the one that works.
void WaitForAll()
{
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  for (int isThere = 0; !isThere;)
  {
    MPI_Test(&request, &isThere, MPI_STATUS_IGNORE);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void MeasureAll(const std::string& surface)
{
  const auto all = std::make_shared<const cartan::Ranks>(MPI_COMM_WORLD);
  Times alone{ 0.0, 0.0 };
  if (all->GetRank() == 0)
  {
    alone = Measure(surface, std::make_shared<const cartan::Ranks>(MPI_COMM_SELF));
  }
  WaitForAll();
  if (all->GetSize() > 1)
  {
    const Times together = Measure(surface, all);
    if (all->GetRank() == 0)
    {
      std::printf("%s on %d ranks: efficiency %.2f by the wall clock, %.2f by the processors' "
                  "time\n",
        surface.c_str(), all->GetSize(), alone.Wall / (all->GetSize() * together.Wall),
        alone.Processor / together.Processor);
    }
  }
}
}

int main(int argc, char* argv[])
{
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  try
  {
    for (int i = 1; i < argc; ++i)
    {
      MeasureAll(argv[i]);
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
  return EXIT_SUCCESS;
}
