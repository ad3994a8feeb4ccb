// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/LoopPairing.h"

#include "Algebra/SimilarityFit.h"
#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace cartan
{
namespace
{
std::vector<BoundaryLoop> RequireLoops(const MergeBoundary& boundary)
{
  std::vector<BoundaryLoop> loops = FindBoundaryLoops(*boundary.Surface.Mesh);
  if (loops.empty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + boundary.Role +
        " has no boundary to sew on: it is closed. Cut it open where it is to be merged, for "
        "example with Clip.");
  }
  return loops;
}

/// The vertex of each key. Throws where a key is not on the boundary or twice there.
std::map<int, int> KeyVertices(const MergeBoundary& boundary)
{
  std::map<int, int> vertices;
  IdSample inside;
  IdSample repeated;
  for (std::size_t v = 0; v < boundary.Keys.size(); ++v)
  {
    const int key = boundary.Keys[v];
    if (key == 0)
    {
      continue;
    }
    if (!boundary.Surface.Mesh->IsBoundary(static_cast<int>(v)))
    {
      inside.Add(static_cast<long long>(v));
    }
    else if (!vertices.emplace(key, static_cast<int>(v)).second)
    {
      repeated.Add(static_cast<long long>(v));
    }
  }
  if (!inside.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The boundary keys at " + inside.Describe("point", "points") + " of the " + boundary.Role +
        " are not on its boundary: move them to boundary points, or set them to 0.");
  }
  if (!repeated.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The boundary keys at " + repeated.Describe("point", "points") + " of the " + boundary.Role +
        " are there already at other points: give each point a number of its own.");
  }
  return vertices;
}

std::string Describe(const BoundaryLoop& loop)
{
  return "that of point " + std::to_string(loop.Vertices.front()) + " (" +
    std::to_string(loop.Vertices.size()) + " points)";
}

/// The loop that each boundary vertex is on.
std::map<int, int> LoopOfVertices(const std::vector<BoundaryLoop>& loops)
{
  std::map<int, int> loopOf;
  for (std::size_t i = 0; i < loops.size(); ++i)
  {
    for (const int v : loops[i].Vertices)
    {
      loopOf[v] = static_cast<int>(i);
    }
  }
  return loopOf;
}

/// The keys that only one of both sides has.
void RequireSameKeys(const std::map<int, int>& target, const std::map<int, int>& source)
{
  IdSample single;
  for (const auto* sides : { &target, &source })
  {
    const auto& other = sides == &target ? source : target;
    for (const auto& [key, vertex] : *sides)
    {
      if (!other.count(key))
      {
        single.Add(key);
      }
    }
  }
  if (!single.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The boundary " + single.Describe("key", "keys") +
        " are on one of the two surfaces only: give the point where it belongs on the other the "
        "same number, or set them to 0.");
  }
}

int IndexOf(const std::vector<int>& loop, int vertex)
{
  return static_cast<int>(std::find(loop.begin(), loop.end(), vertex) - loop.begin());
}

LoopPair MakePair(const BoundaryLoop& target, const BoundaryLoop& source)
{
  return { source.Vertices, { target.Vertices.rbegin(), target.Vertices.rend() } };
}

PairedLoops PairByKeys(const std::vector<BoundaryLoop>& targets,
  const std::vector<BoundaryLoop>& sources, const std::map<int, int>& targetKeys,
  const std::map<int, int>& sourceKeys)
{
  const std::map<int, int> loopOfTarget = LoopOfVertices(targets);
  const std::map<int, int> loopOfSource = LoopOfVertices(sources);
  std::map<int, int> partners;     // of the source's loops
  std::map<int, int> backPartners; // of the target's
  std::map<int, std::vector<int>> keysOfLoop;
  for (const auto& [key, vertex] : sourceKeys)
  {
    const int source = loopOfSource.at(vertex);
    const int target = loopOfTarget.at(targetKeys.at(key));
    if (partners.emplace(source, target).first->second != target ||
      backPartners.emplace(target, source).first->second != source)
    {
      throw Error(ErrorCode::BadInput,
        "The boundary key " + std::to_string(key) + " joins the source's loop, " +
          Describe(sources[source]) + ", to the target's, " + Describe(targets[target]) +
          ", but another key joins one of them to a third loop: keys of one loop go to one loop.");
    }
    keysOfLoop[source].push_back(key);
  }
  PairedLoops paired;
  for (const auto& [source, target] : partners)
  {
    paired.Pairs.push_back(MakePair(targets[target], sources[source]));
    const LoopPair& pair = paired.Pairs.back();
    std::vector<LoopKey> keys;
    for (const int key : keysOfLoop[source])
    {
      keys.push_back({ IndexOf(pair.Source, sourceKeys.at(key)),
        { IndexOf(pair.Target, targetKeys.at(key)), 0.0 } });
    }
    paired.GivenKeys.push_back(static_cast<int>(keys.size()));
    paired.Keys.push_back(std::move(keys));
  }
  return paired;
}

/// Two points for each loop that say where it is, how it lies and how large it is: the
/// center and, on both sides of its plane, the root of its area away.
Points LoopMarks(const std::vector<BoundaryLoop>& loops, const Points& points, double direction)
{
  Points marks(2 * static_cast<Eigen::Index>(loops.size()), 3);
  for (std::size_t i = 0; i < loops.size(); ++i)
  {
    const LoopMeasures measures = MeasureLoop(points(loops[i].Vertices, Eigen::all));
    const double area = measures.AreaVector.norm();
    const Eigen::Vector3d offset = area > 0.0
      ? Eigen::Vector3d(direction / std::sqrt(area) * measures.AreaVector)
      : Eigen::Vector3d(Eigen::Vector3d::Zero());
    const auto row = 2 * static_cast<Eigen::Index>(i);
    marks.row(row) = (measures.Center + offset).transpose();
    marks.row(row + 1) = (measures.Center - offset).transpose();
  }
  return marks;
}

/// The target's loop for each of the source's, so that their marks are closest.
std::vector<int> ClosestPairing(const Points& target, const Points& source, LoopAlignment alignment)
{
  std::vector<int> order(target.rows() / 2);
  std::iota(order.begin(), order.end(), 0);
  std::vector<int> best = order;
  double bestDistance = std::numeric_limits<double>::infinity();
  do
  {
    Points there(target.rows(), 3);
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      const auto row = 2 * static_cast<Eigen::Index>(i);
      there.middleRows<2>(row) = target.middleRows<2>(2 * order[i]);
    }
    const Points moved = alignment == LoopAlignment::BySimilarity
      ? Moved(source, FitSimilarity(source, there))
      : source;
    const double distance = (moved - there).squaredNorm();
    // Beyond rounding, so that the first of equally good ways is taken.
    if (distance < bestDistance * (1.0 - 1e-9))
    {
      bestDistance = distance;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

void RequirePairable(
  const std::vector<BoundaryLoop>& targets, const std::vector<BoundaryLoop>& sources)
{
  const auto count = [](std::size_t n)
  { return std::to_string(n) + (n == 1 ? " boundary loop" : " boundary loops"); };
  if (targets.size() != sources.size())
  {
    throw Error(ErrorCode::BadInput,
      "The target has " + count(targets.size()) + " and the source " + count(sources.size()) +
        ": which belong together? Give a point of each loop that is to be sewn, and the point "
        "where it belongs on the other surface, equal numbers from 1 in the boundary key array.");
  }
  if (sources.size() > MostLoopsWithoutKeys)
  {
    throw Error(ErrorCode::BadInput,
      "Both surfaces have " + count(sources.size()) + ", more than are paired without keys (" +
        std::to_string(MostLoopsWithoutKeys) +
        "). Give a point of each loop, and the point where it belongs on the other surface, equal "
        "numbers from 1 in the boundary key array.");
  }
}
}

PairedLoops PairLoops(
  const MergeBoundary& target, const MergeBoundary& source, LoopAlignment alignment)
{
  const std::vector<BoundaryLoop> targets = RequireLoops(target);
  const std::vector<BoundaryLoop> sources = RequireLoops(source);
  const std::map<int, int> targetKeys = KeyVertices(target);
  const std::map<int, int> sourceKeys = KeyVertices(source);
  RequireSameKeys(targetKeys, sourceKeys);
  if (!sourceKeys.empty())
  {
    return PairByKeys(targets, sources, targetKeys, sourceKeys);
  }
  RequirePairable(targets, sources);
  const Points& targetPoints = *target.Surface.Positions;
  const Points& sourcePoints = *source.Surface.Positions;
  const std::vector<int> partners = ClosestPairing(
    LoopMarks(targets, targetPoints, -1.0), LoopMarks(sources, sourcePoints, 1.0), alignment);
  PairedLoops paired;
  for (std::size_t s = 0; s < sources.size(); ++s)
  {
    const BoundaryLoop& partner = targets[partners[s]];
    LoopPair pair = MakePair(partner, sources[s]);
    paired.Keys.push_back({ FindFirstKey(
      sourcePoints(pair.Source, Eigen::all), targetPoints(pair.Target, Eigen::all), alignment) });
    paired.Pairs.push_back(std::move(pair));
    paired.GivenKeys.push_back(0);
    if (sources.size() > 1)
    {
      paired.Warning += (s ? "; " : "Loops without keys are paired by where they lie: ") +
        ("the source's, " + Describe(sources[s]) + ", with the target's, " + Describe(partner));
    }
  }
  if (!paired.Warning.empty())
  {
    paired.Warning += ". Give them boundary keys to pair them otherwise.";
  }
  return paired;
}
}
