// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/Transition.h"

#include "Base/Bytes.h"
#include "Merging/SeamFairing.h"
#include "Merging/SmoothStep.h"
#include "Mesh/BoundaryLoops.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// How far around each vertex of a loop is, in parts of its length.
Eigen::VectorXd TurnsAlong(const Points& points, const std::vector<int>& loop)
{
  const auto size = static_cast<Eigen::Index>(loop.size());
  Eigen::VectorXd turns(size);
  double length = 0.0;
  for (Eigen::Index i = 0; i < size; ++i)
  {
    turns[i] = length;
    length += (points.row(loop[(i + 1) % size]) - points.row(loop[i])).norm();
  }
  return turns / length;
}

/// Between the angles of a segment's ends.
double AngleAt(const Eigen::VectorXd& angles, const CurvePlace& place)
{
  const double from = angles[place.Segment];
  return from + place.Fraction * TurnBetween(angles[(place.Segment + 1) % angles.size()], from);
}

/// Where a closed curve has this angle.
CurvePlace PlaceOfAngle(const Eigen::VectorXd& angles, double angle)
{
  CurvePlace best;
  double bestDistance = 1.0;
  for (Eigen::Index i = 0; i < angles.size(); ++i)
  {
    const double from = TurnBetween(angle, angles[i]);
    const double segment = TurnBetween(angles[(i + 1) % angles.size()], angles[i]);
    // A segment that is passed forwards; if rounding finds none, the closest vertex.
    const bool isInside = segment > 0.0 && from >= 0.0 && from < segment;
    const double distance = isInside ? -1.0 : std::abs(from);
    if (distance < bestDistance)
    {
      bestDistance = distance;
      best = { static_cast<int>(i), isInside ? from / segment : 0.0 };
    }
  }
  return best;
}

std::vector<std::vector<int>> LoopsOf(
  const std::vector<LoopPair>& pairs, std::vector<int> LoopPair::*side)
{
  std::vector<std::vector<int>> loops;
  loops.reserve(pairs.size());
  for (const LoopPair& pair : pairs)
  {
    loops.push_back(pair.*side);
  }
  return loops;
}

/// The loop, on the whole surface, whose band an isoline bounds: its vertices, or the ends of
/// their edges, are in the band or beside it.
int BandOfIsoline(const TriangleMesh& whole, const CutSurface& cut, const std::vector<int>& isoline,
  const std::vector<int>& loopOf)
{
  for (const int v : isoline)
  {
    for (const int corner : cut.Places[v].Corners)
    {
      for (int d = whole.RingBegin(corner); d < whole.RingEnd(corner); ++d)
      {
        if (loopOf[whole.Neighbor(d)] >= 0)
        {
          return loopOf[whole.Neighbor(d)];
        }
      }
    }
  }
  throw Error(
    ErrorCode::BadInput, "The end of a transition touches no transition. Lower TransitionWidth.");
}

void RequireFree(const TransitionBands& bands, const std::vector<SourceHold>& holds)
{
  IdSample held;
  for (std::size_t v = 0; v < holds.size(); ++v)
  {
    if (holds[v] != SourceHold::Free && bands.LoopOf[v] >= 0)
    {
      held.Add(static_cast<long long>(v));
    }
  }
  if (!held.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      held.Describe("point", "points") +
        " of the source are held and lie in its transition: unmark them, or raise BendWidth "
        "where that holds them.");
  }
}
}

void NameWholeFaces(const CutSurface& cut, JoinedSurface& joined)
{
  for (std::size_t f = 0; f < joined.OriginalFaces.size(); ++f)
  {
    if (!joined.IsSourceFace[f])
    {
      joined.OriginalFaces[f] = cut.OriginalFaces[joined.OriginalFaces[f]];
    }
  }
}

Transition::Transition(const MergeInput& target, const std::vector<LoopPair>& pairs,
  const TransitionWidths& widths, const ExecutionContext& context)
  : Target(target)
  , OldPairs(pairs)
  , Pairs(pairs)
  , Widths(widths)
  , Bands(FindBands(*target.Mesh, *target.Positions, LoopsOf(pairs, &LoopPair::Target),
      widths.Target, "target", context.Part(0.0, 0.4)))
  , Cut(CutBelow(*target.Mesh, *target.Positions, this->Bands.Distances, widths.Target))
{
  for (std::size_t p = 0; p < pairs.size(); ++p)
  {
    const std::vector<int>& loop = pairs[p].Target;
    this->Coordinates.push_back(FindCoordinates(*target.Mesh, *target.Positions, this->Bands,
      static_cast<int>(p), loop, TurnsAlong(*target.Positions, loop), context.Part(0.5, 1.0)));
    this->Pairs[p].Target.clear();
  }
  for (const BoundaryLoop& loop : FindBoundaryLoops(*this->Cut.Mesh))
  {
    if (this->Cut.IsOnIsoline[loop.Vertices.front()])
    {
      const int p = BandOfIsoline(*target.Mesh, this->Cut, loop.Vertices, this->Bands.LoopOf);
      this->Pairs[p].Target.assign(loop.Vertices.rbegin(), loop.Vertices.rend());
    }
  }
}

Eigen::VectorXd Transition::IsolineAngles(std::size_t pair) const
{
  const std::vector<int>& isoline = this->Pairs[pair].Target;
  const Eigen::VectorXd& angles = this->Coordinates[pair].Angles;
  Eigen::VectorXd there(static_cast<Eigen::Index>(isoline.size()));
  for (std::size_t i = 0; i < isoline.size(); ++i)
  {
    const SurfacePlace& place = this->Cut.Places[isoline[i]];
    const double from = angles[place.Corners[0]];
    there[static_cast<Eigen::Index>(i)] =
      from + place.Weights[1] * TurnBetween(angles[place.Corners[1]], from);
  }
  return there;
}

Eigen::VectorXd Transition::LoopAngles(std::size_t pair, const SeamLoop& loop) const
{
  const Eigen::VectorXd isoline = this->IsolineAngles(pair);
  const std::vector<int> snapped = SnappedVertices(loop);
  Eigen::VectorXd angles(static_cast<Eigen::Index>(snapped.size()));
  for (std::size_t i = 0; i < snapped.size(); ++i)
  {
    angles[static_cast<Eigen::Index>(i)] =
      snapped[i] >= 0 ? isoline[snapped[i]] : AngleAt(isoline, loop.Places[i]);
  }
  return angles;
}

std::vector<std::vector<LoopKey>> Transition::MoveKeys(
  const std::vector<std::vector<LoopKey>>& keys) const
{
  std::vector<std::vector<LoopKey>> moved = keys;
  for (std::size_t p = 0; p < keys.size(); ++p)
  {
    const Eigen::VectorXd before = TurnsAlong(*this->Target.Positions, this->OldPairs[p].Target);
    const Eigen::VectorXd after = this->IsolineAngles(p);
    for (LoopKey& key : moved[p])
    {
      key.Target = PlaceOfAngle(after, AngleAt(before, key.Target));
    }
  }
  return moved;
}

std::vector<SurfacePlace> Transition::TargetPlaces(
  std::size_t pair, const BandCoordinates& band, const Eigen::VectorXd& distances) const
{
  Eigen::VectorXd angles(static_cast<Eigen::Index>(band.Vertices.size()));
  Eigen::VectorXd fromLoop = angles;
  for (std::size_t i = 0; i < band.Vertices.size(); ++i)
  {
    const int v = band.Vertices[i];
    angles[static_cast<Eigen::Index>(i)] = band.Angles[v];
    // The source's loop is at the end of the target's band, and its band's end at the loop.
    fromLoop[static_cast<Eigen::Index>(i)] =
      this->Widths.Target * std::max(0.0, 1.0 - distances[v] / this->Widths.Source);
  }
  return PlacesInBand(this->Coordinates[pair], this->Bands.Distances, angles, fromLoop);
}

Fading Transition::FindFading(const TriangleMesh& source, const FittedSource& fitted,
  const TransitionBands& bands, const JoinedSurface& joined) const
{
  std::vector<int> joinedOfSource(source.NumberOfVertices(), -1);
  Fading fading;
  fading.SourceParts = Eigen::VectorXd::Zero(joined.NumberOfVertices());
  for (int v = 0; v < joined.NumberOfVertices(); ++v)
  {
    const int ofTarget = joined.TargetVertices[v];
    fading.TargetPlaces.push_back(ofTarget >= 0 ? this->Cut.Places[ofTarget] : SurfacePlace());
    if (ofTarget < 0)
    {
      const int ofSource = joined.SourceVertices[v];
      joinedOfSource[ofSource] = v;
      fading.SourceParts[v] = SmoothStep(bands.Distances[ofSource] / this->Widths.Source);
    }
  }
  for (std::size_t p = 0; p < this->Pairs.size(); ++p)
  {
    const SeamLoop& loop = fitted.Loops[p];
    const BandCoordinates band = FindCoordinates(
      source, fitted.Positions, bands, static_cast<int>(p), loop.Source, this->LoopAngles(p, loop));
    const std::vector<SurfacePlace> places = this->TargetPlaces(p, band, bands.Distances);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      if (joinedOfSource[band.Vertices[i]] >= 0)
      {
        fading.TargetPlaces[joinedOfSource[band.Vertices[i]]] = places[i];
      }
    }
  }
  return fading;
}

Fading Transition::Fade(const TriangleMesh& source, const FittedSource& fitted,
  const std::vector<SourceHold>& holds, const JoinedSurface& joined, const TriangleMesh& mesh,
  Points& positions, const ExecutionContext& context) const
{
  const TransitionBands bands = FindBands(source, fitted.Positions,
    LoopsOf(this->Pairs, &LoopPair::Source), this->Widths.Source, "source", context.Part(0.0, 0.3));
  RequireFree(bands, holds);
  Fading fading = this->FindFading(source, fitted, bands, joined);
  std::vector<int> region;
  for (int v = 0; v < joined.NumberOfVertices(); ++v)
  {
    if (joined.SourceVertices[v] >= 0 && !joined.IsSeam[v] && fading.SourceParts[v] < 1.0)
    {
      region.push_back(v);
    }
  }
  if (region.empty())
  {
    return fading;
  }
  const RegionFit fit(mesh, region, positions, context.Part(0.5, 1.0));
  const Points there = AtPlaces(*this->Target.Positions, fading.TargetPlaces);
  Points ofTarget = positions;
  for (int v = 0; v < joined.NumberOfVertices(); ++v)
  {
    if (!joined.IsSeam[v] && joined.TargetVertices[v] < 0)
    {
      ofTarget.row(v) = there.row(v);
    }
  }
  const Points fromTarget = fit.Laplacians(ofTarget);
  Points laplacians = fit.Laplacians(positions);
  for (Eigen::Index i = 0; i < laplacians.rows(); ++i)
  {
    const double t = fading.SourceParts[fit.GetVertices()[i]];
    laplacians.row(i) = (1.0 - t) * fromTarget.row(i) + t * laplacians.row(i);
  }
  fit.Solve(laplacians, positions);
  return fading;
}

std::size_t Transition::GetBytes() const
{
  std::size_t bytes = this->Cut.Mesh->GetBytes() +
    TotalBytes(this->Bands.Distances, this->Bands.LoopOf, *this->Cut.Positions, this->Cut.Places,
      this->Cut.OriginalFaces, this->Cut.IsOnIsoline);
  for (const BandCoordinates& band : this->Coordinates)
  {
    bytes += TotalBytes(band.Vertices, band.Faces, band.Angles);
  }
  for (const std::vector<LoopPair>* pairs : { &this->OldPairs, &this->Pairs })
  {
    for (const LoopPair& pair : *pairs)
    {
      bytes += TotalBytes(pair.Source, pair.Target);
    }
  }
  return bytes;
}
}
