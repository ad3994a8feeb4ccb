// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces between two poses of a scan of 39K points: what each method takes to
// prepare, and for one in-between as it is played, in one thread, next to an
// iteration of CGAL's as-rigid-as-possible deformation on the same surface in
// the same run. Ends with a table of what was asked and what was measured.
#include "BenchmarkTools.h"
#include "PeerDeformation.h"

#include "Kernel/Deformation/ShapePreservingDeformer.h"
#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/TriangleGradientMorph.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>

using namespace benchmarks;
using cartan::DiscreteFormsMorph;
using cartan::KeyFrames;
using cartan::SurfaceMorph;

namespace
{
constexpr int Steps = 20;
using Solver = DiscreteFormsMorph::FrameSolver;

struct Times
{
  double SetUp;
  std::vector<double> Evaluations;
  std::vector<double> Iterations;
};

Times Play(
  const KeyFrames& keys, const std::function<std::unique_ptr<SurfaceMorph>(const KeyFrames&)>& make)
{
  Times times;
  double start = WallTime();
  const auto morph = make(keys);
  times.SetUp = WallTime() - start;
  for (int step = 1; step < Steps; ++step)
  {
    start = WallTime();
    morph->Evaluate(static_cast<double>(step) / Steps, {});
    times.Evaluations.push_back(WallTime() - start);
    times.Iterations.push_back(morph->GetNumberOfIterations());
  }
  return times;
}

/// The camel bent over its height, its upper fifth turned by so many degrees.
KeyFrames Poses(const Mesh& mesh, double degrees)
{
  cartan::HandleProblem problem = MakeProblem(mesh, 0.3, 0.8);
  problem.ConstrainPositions = false;
  cartan::ShapePreservingDeformer deformer(problem);
  cartan::DeformedSurface pose;
  deformer.Deform(Turn(degrees), false, pose, {});
  return { problem.Mesh, { *problem.Rest, pose.Positions }, { 0.0, 1.0 } };
}

void Measure(const Mesh& mesh, double degrees)
{
  const KeyFrames keys = Poses(mesh, degrees);
  std::printf(
    "Camel, %d points, turned by %.0f degrees\n", static_cast<int>(mesh.Points.rows()), degrees);
  const cartan::HandleProblem problem = MakeProblem(mesh, 0.3, 0.8);
  PeerDeformation peer(mesh.Points, mesh.Triangles, problem.Handle);
  const cartan::HandleTargets targets = Turn(20.0);
  peer.MoveHandle(targets.Motions[0].Linear, targets.Motions[0].Translation);
  std::vector<double> iterations;
  for (int i = 0; i < 7; ++i)
  {
    const double start = WallTime();
    peer.Iterate();
    iterations.push_back(WallTime() - start);
  }
  const double iteration = Median(iterations);
  PrintRow("one iteration of CGAL ORIGINAL_ARAP", "", 1e3 * iteration, "ms");

  const auto forms = [](Solver solver)
  {
    return [solver](const KeyFrames& of) -> std::unique_ptr<SurfaceMorph>
    {
      return std::make_unique<DiscreteFormsMorph>(
        of, DiscreteFormsMorph::Transitions::Rotations, solver);
    };
  };
  struct Method
  {
    const char* Name;
    std::function<std::unique_ptr<SurfaceMorph>(const KeyFrames&)> Make;
    double Limit; // seconds for an in-between; 0 where nothing is asked
  };
  for (const Method& method :
    { Method{ "DiscreteForms, rotation averaging", forms(Solver::RotationAveraging), 0.5 },
      Method{ "DiscreteForms, conjugate gradients", forms(Solver::ConjugateGradients), 0.0 },
      Method{ "DiscreteForms, direct", forms(Solver::Direct), 0.0 },
      Method{ "Isometric",
        [](const KeyFrames& of) -> std::unique_ptr<SurfaceMorph>
        { return std::make_unique<cartan::IsometricMorph>(of); },
        0.0 },
      Method{ "DeformationGradient",
        [](const KeyFrames& of) -> std::unique_ptr<SurfaceMorph>
        { return std::make_unique<cartan::TriangleGradientMorph>(of); },
        0.0 } })
  {
    const Times times = Play(keys, method.Make);
    const double worst = *std::max_element(times.Evaluations.begin(), times.Evaluations.end());
    std::printf("%s\n", method.Name);
    PrintRow("  set-up", "", times.SetUp, "s");
    PrintRow("  in-between, median", "", Median(times.Evaluations), "s");
    PrintRow("  in-between, worst of 19", method.Limit > 0.0 ? "< 0.5 s" : "", worst, "s",
      method.Limit == 0.0 || worst < method.Limit);
    PrintRow("  iterations, median", "", Median(times.Iterations), "");
    PrintRow("  iterations, most", "",
      *std::max_element(times.Iterations.begin(), times.Iterations.end()), "");
    PrintRow(
      "  ratio of the median to CGAL's iteration", "", Median(times.Evaluations) / iteration, "");
  }
}
}

int main()
{
  try
  {
    const Mesh mesh = Subdivide(ReadMesh("camel"));
    for (const double degrees : { 60.0, 120.0 })
    {
      Measure(mesh, degrees);
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
