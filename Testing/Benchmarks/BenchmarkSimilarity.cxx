// SPDX-License-Identifier: BSD-3-Clause
//
// Editing by implicit similarities on 31K free vertices: set-up, motions, and
// their ratio to an iteration of CGAL's as-rigid-as-possible deformation on the
// same surface with the same handles in the same run. Ends with a table of what
// was asked and what was measured.
#include "BenchmarkTools.h"
#include "PeerDeformation.h"

#include "Kernel/Deformation/SimilarityDeformer.h"

#include <cstdio>
#include <exception>

using namespace benchmarks;
using cartan::SimilarityDeformer;
using cartan::SimilarityReconstruction;

namespace
{
constexpr int Turns = 7;

/// The medians of several set-ups, until the handles can move, and of motions.
void Measure(const Mesh& mesh, SimilarityReconstruction reconstruction, const char* name)
{
  const cartan::HandleProblem problem = MakeProblem(mesh, 0.2, 0.8);
  PeerDeformation peer(mesh.Points, mesh.Triangles, problem.Handle);
  const cartan::ExecutionContext context = Threads();
  std::vector<double> setUps;
  std::vector<double> motions;
  std::vector<double> refits;
  std::vector<double> iterations;
  int free = 0;
  for (int turn = 0; turn < Turns; ++turn)
  {
    double start = WallTime();
    SimilarityDeformer deformer(problem, {}, cartan::SolverBackend::Automatic, context);
    deformer.SetReconstruction(reconstruction);
    deformer.Prepare(context);
    setUps.push_back(WallTime() - start);
    free = deformer.GetNumberOfFreeVertices();

    cartan::DeformedSurface result;
    deformer.Deform(Turn(10.0), false, result, context);
    for (int motion = 0; motion < Turns; ++motion)
    {
      const cartan::HandleTargets targets = Turn(20.0 + 5.0 * motion);
      deformer.SetRefits(0);
      start = WallTime();
      deformer.Deform(targets, false, result, context);
      motions.push_back(WallTime() - start);
      deformer.SetRefits(3);
      start = WallTime();
      deformer.Deform(targets, false, result, context);
      refits.push_back((WallTime() - start - motions.back()) / 3.0);
      peer.MoveHandle(targets.Motions[0].Linear, targets.Motions[0].Translation);
      start = WallTime();
      peer.Iterate();
      iterations.push_back(WallTime() - start);
    }
  }
  std::printf("%s, refined elephant, %d free vertices\n", name, free);
  const double setUp = Median(setUps);
  const double motion = Median(motions);
  PrintRow("set-up", "<= 1.5 s", setUp, "s", setUp <= 1.5);
  PrintRow("motion", "<= 60 ms", 1e3 * motion, "ms", motion <= 0.06);
  PrintRow("a re-fit", "", 1e3 * Median(refits), "ms");
  PrintRow("one iteration of CGAL ORIGINAL_ARAP", "", 1e3 * Median(iterations), "ms");
  PrintRow("  ratio of a motion to it", "", motion / Median(iterations), "");
}
}

int main()
{
  try
  {
    const Mesh mesh = ReadMesh("refined_elephant");
    Measure(mesh, SimilarityReconstruction::EdgeForm, "Edge form");
    Measure(mesh, SimilarityReconstruction::LeastSquares, "Least squares");
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
