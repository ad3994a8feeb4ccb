// SPDX-License-Identifier: BSD-3-Clause
//
// Sewing a surface of 100,000 points onto another of that size: the first time, with a moved
// key, a moved handle, and with a transition, next to the set-up of one deformation by implicit
// similarities of that size in the same run. Then two smaller pairs by this and by CGAL's
// corefinement. Processor time, so that other programs do not count.
#include "BenchmarkTools.h"
#include "MergeShapes.h"
#include "PeerMerge.h"

#include "Kernel/Algebra/SimilarityFit.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Merging/LoopPairing.h"
#include "Kernel/Merging/SeamFairing.h"
#include "Kernel/Merging/Transition.h"
#include "Kernel/Mesh/GrowByRings.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>

using namespace cartan;
using benchmarks::PrintRow;
using benchmarks::ProcessorTime;

namespace
{
constexpr int Around = 400;
constexpr int Along = 250;

/// A tube with waves around it from z = `from` to `from` + 4: 100,000 points.
MergeInput Tube(double from, int waves)
{
  Points points(Around * Along, 3);
  Triangles faces(2 * Around * (Along - 1), 3);
  for (int j = 0; j < Along; ++j)
  {
    for (int i = 0; i < Around; ++i)
    {
      const double angle = 2.0 * Pi * i / Around;
      const double radius = 1.0 + 0.02 * std::cos(waves * angle);
      points.row(Around * j + i) << radius * std::cos(angle), radius * std::sin(angle),
        from + 4.0 * j / (Along - 1);
    }
  }
  for (int j = 0; j + 1 < Along; ++j)
  {
    for (int i = 0; i < Around; ++i)
    {
      const int a = Around * j + i;
      const int b = Around * j + (i + 1) % Around;
      faces.row(2 * a) << a, b, b + Around;
      faces.row(2 * a + 1) << a, b + Around, a + Around;
    }
  }
  return { std::make_shared<TriangleMesh>(static_cast<int>(points.rows()), faces),
    std::make_shared<Points>(points) };
}

double Seconds(const std::function<void()>& work)
{
  const double start = ProcessorTime();
  work();
  return ProcessorTime() - start;
}

/// One deformation of the source: both ends are handles.
double SimilaritySetUp(const MergeInput& source)
{
  HandleProblem problem;
  problem.Mesh = source.Mesh;
  problem.Rest = source.Positions;
  problem.Handle.assign(source.Mesh->NumberOfVertices(), 0);
  std::fill_n(problem.Handle.begin(), Around, 1);
  std::fill_n(problem.Handle.rbegin(), Around, 2);
  problem.Moving = { 2 };
  return Seconds(
    [&]
    {
      SimilarityDeformer deformer(problem, {});
      deformer.SetReconstruction(SimilarityReconstruction::LeastSquares);
      deformer.Prepare();
    });
}

/// Loops with one key.
PairedLoops Pair(const MergeInput& target, const MergeInput& source, int keyOfTarget)
{
  MergeBoundary targetSide{ target, "target", std::vector<int>(Around * Along, 0) };
  MergeBoundary sourceSide{ source, "source", std::vector<int>(Around * Along, 0) };
  targetSide.Keys[Around * (Along - 1) + keyOfTarget] = 1;
  sourceSide.Keys[0] = 1;
  return PairLoops(targetSide, sourceSide, LoopAlignment::BySimilarity);
}

/// All that a moved key costs.
void Sew(const MeshMerge& merge, const MergeInput& target, const MergeInput& source, int key,
  double& fit, double& join, double& transition)
{
  PairedLoops paired;
  FittedSource fitted;
  fit += Seconds(
    [&]
    {
      paired = Pair(target, source, key);
      fitted = merge.Fit(target, paired.Pairs, paired.Keys);
    });
  join += Seconds(
    [&]
    {
      const JoinedSurface joined = JoinSurfaces(*target.Mesh, *source.Mesh, fitted.Loops);
      Points positions = JoinedPositions(joined, *target.Positions, fitted.Positions);
      const TriangleMesh mesh(joined.NumberOfVertices(), joined.Faces);
      FairRegion(mesh, GrowByRings(mesh, SeamVertices(joined), 2), positions);
      MeasureSeam(joined, mesh, positions);
    });
  transition += Seconds(
    [&]
    {
      const Transition bands(target, paired.Pairs, { 0.5, 0.5 });
      const CutSurface& cut = bands.GetCut();
      fitted =
        merge.Fit({ cut.Mesh, cut.Positions }, bands.GetPairs(), bands.MoveKeys(paired.Keys));
      const JoinedSurface joined = JoinSurfaces(*cut.Mesh, *source.Mesh, fitted.Loops);
      Points positions = JoinedPositions(joined, *cut.Positions, fitted.Positions);
      const TriangleMesh mesh(joined.NumberOfVertices(), joined.Faces);
      bands.Fade(*source.Mesh, fitted, {}, joined, mesh, positions);
    });
}

void PrintSeam(const std::string& what, double mean, double maximum, double fairedMean,
  double fairedMaximum, double seconds)
{
  std::printf("  %-44s%6.1f%7.1f%10.1f%7.1f%9.2f s\n", what.c_str(), mean, maximum, fairedMean,
    fairedMaximum, seconds);
}

/// The source as it came, where the similarity closest to the fit takes it, and sunk into
/// the target by a mean edge of its loop: bodies have to overlap for a union.
Points PlacedForPeer(const shapes::MergeCase& pair, const shapes::Merged& merged)
{
  const std::vector<int>& loop = merged.Fit.Loops[0].Target;
  const Points curve = pair.Target.Positions(loop, Eigen::all);
  const LoopMeasures measures = MeasureLoop(curve);
  const double edge = measures.Length / static_cast<double>(loop.size());
  // The loop runs against the target's boundary, so the vector points into the target.
  const Eigen::Vector3d sink = -edge * measures.AreaVector.normalized();
  return Moved(pair.Source.Positions, FitSimilarity(pair.Source.Positions, merged.Fit.Positions))
           .rowwise() +
    sink.transpose();
}

/// Seams of both, before and after fairing of two rings, and the time for all of it.
void CompareWithPeer(const std::string& name, const shapes::MergeCase& pair)
{
  constexpr double Degrees = 180.0 / Pi;
  shapes::Merged merged;
  Points faired;
  const double seconds = Seconds(
    [&]
    {
      merged = shapes::Merge(pair.Target, pair.Source, pair.Pairs);
      faired = merged.Faired(2);
    });
  std::printf("%s of %d and %d points\n", name.c_str(), pair.Source.NumberOfVertices(),
    pair.Target.NumberOfVertices());
  const SeamAngles before = merged.Angles();
  const SeamAngles after = merged.Angles(faired);
  PrintSeam("sewn", before.Mean * Degrees, before.Maximum * Degrees, after.Mean * Degrees,
    after.Maximum * Degrees, seconds);
  const Points placed = PlacedForPeer(pair, merged);
  PeerSeam peer;
  const double peerSeconds = Seconds(
    [&] {
      peer = MergeByPeer(pair.Target.Positions, pair.Target.Faces, placed, pair.Source.Faces, 2);
    });
  PrintSeam("CGAL's union, " + std::to_string(peer.NumberOfEdges) + " edges", peer.Mean,
    peer.Maximum, peer.FairedMean, peer.FairedMaximum, peerSeconds);
}
}

int main()
{
  try
  {
    const MergeInput target = Tube(0.0, 8);
    const MergeInput source = Tube(5.0, 5);
    const double similarity = SimilaritySetUp(source);
    std::unique_ptr<MeshMerge> merge;
    double setUp = Seconds(
      [&]
      {
        merge = std::make_unique<MeshMerge>(source,
          std::vector<std::vector<int>>{ Pair(target, source, 0).Pairs[0].Source },
          std::vector<SourceHold>{});
      });
    double fit = 0.0;
    double join = 0.0;
    double transition = 0.0;
    Sew(*merge, target, source, 0, fit, join, transition);
    setUp += fit + join;
    fit = join = transition = 0.0;
    Sew(*merge, target, source, 20, fit, join, transition);
    std::printf("Tubes of %d points\n", Around * Along);
    PrintRow("set-up of one similarity deformation", "", similarity, "s");
    PrintRow("sewn the first time", "", setUp, "s");
    PrintRow("  ratio to it", "<= 3", setUp / similarity, "", setUp <= 3.0 * similarity);
    PrintRow("a moved key", "<= 1 s", fit + join, "s", fit + join <= 1.0);
    PrintRow("  pairs and fit", "", fit, "s");
    PrintRow("  sewing, fairing of 2 rings, angles", "", join, "s");
    PrintRow("with a transition of 31 rings", "", transition, "s");
    std::printf("\n%-46s%s\n", "Seams in degrees", "mean, max    faired mean, max     time");
    CompareWithPeer("Tubes", shapes::TubesCase());
    CompareWithPeer("A head and a dinosaur", shapes::HeadCase());
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
