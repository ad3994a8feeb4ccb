// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/LoopMatching.h"

#include "Base/Error.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// How many samples of each curve are compared to find the best turn.
constexpr int NumberOfSamples = 256;

/// Turns whose agreement differs by less than this part are equally good.
constexpr double SameAgreement = 1e-9;

/// The length from the first vertex to each, and around: #C + 1.
Eigen::VectorXd LengthsAlong(const Points& curve)
{
  const Eigen::Index size = curve.rows();
  Eigen::VectorXd lengths(size + 1);
  lengths[0] = 0.0;
  for (Eigen::Index i = 0; i < size; ++i)
  {
    lengths[i + 1] = lengths[i] + (curve.row((i + 1) % size) - curve.row(i)).norm();
  }
  if (!(lengths[size] > 0.0))
  {
    throw Error(ErrorCode::BadInput,
      "A boundary loop has no length: all its points are in one place. Merge these "
      "points (Prepare Surface), which closes it, and sew another loop.");
  }
  return lengths;
}

double LengthAt(const Eigen::VectorXd& lengths, const CurvePlace& place)
{
  return lengths[place.Segment] +
    place.Fraction * (lengths[place.Segment + 1] - lengths[place.Segment]);
}

/// The place at a length in [0, 2 laps).
CurvePlace PlaceAt(const Eigen::VectorXd& lengths, double length)
{
  const Eigen::Index size = lengths.size() - 1;
  const double lap = lengths[size];
  length = std::max(0.0, length >= lap ? length - lap : length);
  const double* const begin = lengths.data();
  const auto next = std::upper_bound(begin, begin + size, length) - begin;
  CurvePlace place;
  place.Segment = static_cast<int>(std::max<std::ptrdiff_t>(next, 1) - 1);
  const double segment = lengths[place.Segment + 1] - lengths[place.Segment];
  place.Fraction = segment > 0.0 ? (length - lengths[place.Segment]) / segment : 0.0;
  if (place.Fraction >= 1.0)
  {
    place = { static_cast<int>((place.Segment + 1) % size), 0.0 };
  }
  return place;
}

/// From one length forward to another around a lap: in (0, lap].
double GapBetween(double from, double to, double lap)
{
  return to > from ? to - from : to - from + lap;
}

/// Throws where a further key comes before the one it follows.
void RequireCommonOrder(const std::vector<LoopKey>& keys, const Eigen::VectorXd& lengths)
{
  const double lap = lengths[lengths.size() - 1];
  double sum = 0.0;
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    sum += GapBetween(LengthAt(lengths, keys[k].Target),
      LengthAt(lengths, keys[(k + 1) % keys.size()].Target), lap);
  }
  // Each gap is more than 0 and at most a lap; they add up to whole laps.
  if (sum > 1.5 * lap)
  {
    throw Error(ErrorCode::BadInput,
      "The keys of a pair of loops cross: they follow each other in another order around the "
      "source than around the target, seen with both surfaces on their outsides. Exchange or "
      "remove keys until the orders agree.");
  }
}

Points SampleCurve(const Points& curve)
{
  const Eigen::VectorXd lengths = LengthsAlong(curve);
  const double lap = lengths[lengths.size() - 1];
  Points samples(NumberOfSamples, 3);
  for (int i = 0; i < NumberOfSamples; ++i)
  {
    samples.row(i) = PointAt(curve, PlaceAt(lengths, lap * i / NumberOfSamples));
  }
  return samples;
}

/// How well samples agree when target sample `shift` belongs to the first of the
/// source: minus the squared distance but for a constant, or, after a similarity, the
/// part of it that a turn decides, sum of the covariance's singular values (Umeyama,
/// Least-squares Estimation of Transformation Parameters Between Two Point Patterns, 1991).
double Agreement(const Points& source, const Points& target, int shift, LoopAlignment alignment)
{
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < NumberOfSamples; ++i)
  {
    covariance += source.row(i).transpose() * target.row((i + shift) % NumberOfSamples);
  }
  if (alignment == LoopAlignment::AsTheyLie)
  {
    return covariance.trace();
  }
  const Eigen::Vector3d singularValues =
    Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  return singularValues[0] + singularValues[1] +
    (covariance.determinant() < 0.0 ? -singularValues[2] : singularValues[2]);
}
}

Eigen::RowVector3d PointAt(const Points& curve, const CurvePlace& place)
{
  const Eigen::Index next = (place.Segment + 1) % curve.rows();
  return curve.row(place.Segment) + place.Fraction * (curve.row(next) - curve.row(place.Segment));
}

std::vector<CurvePlace> MatchLoops(
  const Points& source, const Points& target, std::vector<LoopKey> keys)
{
  const Eigen::VectorXd sourceLengths = LengthsAlong(source);
  const Eigen::VectorXd targetLengths = LengthsAlong(target);
  const double sourceLap = sourceLengths[source.rows()];
  const double targetLap = targetLengths[target.rows()];
  std::sort(keys.begin(), keys.end(),
    [](const LoopKey& a, const LoopKey& b) { return a.Source < b.Source; });
  RequireCommonOrder(keys, targetLengths);

  const auto size = static_cast<int>(source.rows());
  std::vector<CurvePlace> places(size);
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    const LoopKey& key = keys[k];
    const LoopKey& nextKey = keys[(k + 1) % keys.size()];
    const double from = sourceLengths[key.Source];
    const double sourceGap = GapBetween(from, sourceLengths[nextKey.Source], sourceLap);
    const double targetFrom = LengthAt(targetLengths, key.Target);
    const double targetGap =
      GapBetween(targetFrom, LengthAt(targetLengths, nextKey.Target), targetLap);
    places[key.Source] = key.Target;
    for (int i = (key.Source + 1) % size; i != nextKey.Source; i = (i + 1) % size)
    {
      const double part =
        i == key.Source ? 0.0 : GapBetween(from, sourceLengths[i], sourceLap) / sourceGap;
      // Points in one place have no part of the length between them.
      places[i] = PlaceAt(targetLengths, targetFrom + (part < 1.0 ? part : 0.0) * targetGap);
    }
  }
  return places;
}

LoopKey FindFirstKey(const Points& source, const Points& target, LoopAlignment alignment)
{
  Points from = SampleCurve(source);
  Points to = SampleCurve(target);
  from.rowwise() -= Eigen::RowVector3d(from.colwise().mean());
  to.rowwise() -= Eigen::RowVector3d(to.colwise().mean());
  const double scale = from.norm() * to.norm();
  int best = 0;
  double bestAgreement = Agreement(from, to, 0, alignment);
  for (int shift = 1; shift < NumberOfSamples; ++shift)
  {
    const double agreement = Agreement(from, to, shift, alignment);
    if (agreement > bestAgreement + SameAgreement * scale)
    {
      best = shift;
      bestAgreement = agreement;
    }
  }
  const Eigen::VectorXd lengths = LengthsAlong(target);
  return { 0, PlaceAt(lengths, lengths[target.rows()] * best / NumberOfSamples) };
}
}
