// SPDX-License-Identifier: BSD-3-Clause
//
// Rotation-invariant editing of a large surface by one solver: seconds of the set-up and
// of motions, and memory. See Documentation/Scale.md.
//
//   CartanBenchmarkSolver <surface> <automatic|eigen|cholmod|cg> [file]
//
// The surface is generated with so many points, or armadillo<k>: the scan subdivided k
// times. Writes the moved points to the file, or compares with those in it when it is there.
#include "BenchmarkTools.h"

#include "Kernel/Algebra/SymmetricSolver.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Mesh/Geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

using namespace benchmarks;
using cartan::SolverBackend;

namespace
{
/// A square with hills and the noise of a scanner, sampled unevenly.
Mesh ScanLike(double points)
{
  const int side = static_cast<int>(std::lround(std::sqrt(points)));
  Mesh mesh;
  mesh.Points.resize(static_cast<Eigen::Index>(side) * side, 3);
  mesh.Triangles.resize(2 * static_cast<Eigen::Index>(side - 1) * (side - 1), 3);
  unsigned state = 1;
  const auto random = [&state]()
  {
    state = 1664525u * state + 1013904223u;
    return (state >> 8) / 16777216.0 - 0.5;
  };
  const double step = 1.0 / (side - 1);
  Eigen::Index triangle = 0;
  for (int i = 0; i < side; ++i)
  {
    for (int j = 0; j < side; ++j)
    {
      const double x = (j + 0.6 * random()) * step;
      const double y = (i + 0.6 * random()) * step;
      const double z = 0.1 * std::sin(9.0 * x) * std::cos(7.0 * y) + 0.2 * step * random();
      const int v = i * side + j;
      mesh.Points.row(v) << x - 0.5, y - 0.5, z;
      if (i + 1 < side && j + 1 < side)
      {
        mesh.Triangles.row(triangle++) << v, v + 1, v + side;
        mesh.Triangles.row(triangle++) << v + 1, v + side + 1, v + side;
      }
    }
  }
  return mesh;
}

Mesh SurfaceOf(const std::string& name)
{
  const std::string scan = "armadillo";
  if (name.rfind(scan, 0) != 0)
  {
    return ScanLike(std::atof(name.c_str()));
  }
  Mesh mesh = ReadMesh(scan);
  for (int k = std::atoi(name.c_str() + scan.size()); k > 0; --k)
  {
    mesh = Subdivide(mesh);
  }
  return mesh;
}

/// Reading and subdividing take more than what is measured.
void ForgetPeakMemory()
{
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// The most memory that this process has had, in bytes.
double PeakMemory()
{
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
  {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes)
    {
      return 1024.0 * kilobytes;
    }
  }
  return 0.0;
}

SolverBackend BackendOf(const char* name)
{
  return std::strcmp(name, "eigen") == 0 ? SolverBackend::Eigen
    : std::strcmp(name, "cholmod") == 0  ? SolverBackend::Cholmod
    : std::strcmp(name, "cg") == 0       ? SolverBackend::ConjugateGradients
                                         : SolverBackend::Automatic;
}

void PrintTime(const char* what, double wall, double processor)
{
  std::printf("  %-34s %9.2f s processor %9.2f s wall\n", what, ProcessorTime() - processor,
    WallTime() - wall);
}

/// The largest difference between points and those of a file, or writes them.
void Compare(const cartan::Points& points, double diagonal, const char* path)
{
  const auto bytes = static_cast<std::streamsize>(points.size() * sizeof(double));
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(points.data()), bytes);
    return;
  }
  cartan::Points others(points.rows(), 3);
  file.read(reinterpret_cast<char*>(others.data()), bytes);
  std::printf("  %-34s %9.2g of the diagonal\n", "difference",
    (points - others).rowwise().norm().maxCoeff() / diagonal);
}

void Measure(const std::string& surface, SolverBackend backend, const char* path)
{
  const cartan::ExecutionContext context = Threads();
  const cartan::HandleProblem problem = MakeProblem(SurfaceOf(surface), 0.1, 0.9);
  const double points = static_cast<double>(problem.Rest->rows());
  ForgetPeakMemory();
  const double before = PeakMemory();
  std::printf("%.0f points, %.0f bytes per point before\n", points, before / points);
  double wall = WallTime();
  double processor = ProcessorTime();
  cartan::RotationInvariantDeformer deformer(problem, backend, context);
  PrintTime("set-up", wall, processor);
  cartan::DeformedSurface result;
  for (const char* what : { "first raw motion", "next raw motion" })
  {
    deformer.SetFrameProjection(cartan::FrameProjection::None);
    wall = WallTime();
    processor = ProcessorTime();
    deformer.Deform(Turn(20.0), false, result, context);
    PrintTime(what, wall, processor);
  }
  deformer.SetFrameProjection(cartan::FrameProjection::Rotation);
  wall = WallTime();
  processor = ProcessorTime();
  deformer.Deform(Turn(30.0), false, result, context);
  PrintTime("projected motion", wall, processor);
  std::printf("  %-34s %9.0f, with %.0f of the deformer\n", "bytes per point at most",
    PeakMemory() / points, static_cast<double>(deformer.GetBytes()) / points);
  if (path)
  {
    Compare(result.Positions, cartan::BoundingDiagonal(*problem.Rest), path);
  }
}
}

int main(int argc, char* argv[])
{
  try
  {
    Measure(argc > 1 ? argv[1] : "100000", BackendOf(argc > 2 ? argv[2] : ""),
      argc > 3 ? argv[3] : nullptr);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
