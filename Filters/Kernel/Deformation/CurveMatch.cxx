// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/CurveMatch.h"

#include "Algebra/Rotation.h"
#include "Base/Error.h"

#include <Eigen/SVD>

#include <algorithm>
#include <limits>
#include <numeric>

namespace cartan
{
namespace
{
/// Segments nearer than this part of the length touch.
constexpr double TouchingPart = 1e-9;

/// A curve is straight when its second extent is below this part of the first: the turn
/// about it would follow the zigzag of its edges.
constexpr double StraightPart = 1e-2;

double Clamp(double t)
{
  return std::min(std::max(t, 0.0), 1.0);
}

/// The distance between two segments (Ericson, Real-Time Collision Detection, 2005,
/// section 5.1.9).
double SegmentDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
  const Eigen::Vector3d& d)
{
  const Eigen::Vector3d u = b - a;
  const Eigen::Vector3d v = d - c;
  const Eigen::Vector3d w = a - c;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 0.0 ? Clamp((uv * v.dot(w) - vv * u.dot(w)) / determinant) : 0.0;
  const double t = vv > 0.0 ? Clamp((v.dot(w) + s * uv) / vv) : 0.0;
  s = uu > 0.0 ? Clamp((t * uv - u.dot(w)) / uu) : 0.0;
  return (w + s * u - t * v).norm();
}

/// Central differences, one-sided at the ends; zero where points coincide.
Eigen::Vector3d Tangent(const Points& curve, Eigen::Index i, bool isClosed)
{
  const Eigen::Index last = curve.rows() - 1;
  const Eigen::Index next = i < last ? i + 1 : isClosed ? 0 : last;
  const Eigen::Index before = i > 0 ? i - 1 : isClosed ? last : 0;
  return (curve.row(next) - curve.row(before)).transpose();
}

Eigen::Matrix3d LeastRotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  if (from.isZero(0.0) || to.isZero(0.0))
  {
    return Eigen::Matrix3d::Identity();
  }
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

/// The first point again at the end.
Points Closed(const Points& curve)
{
  Points closed(curve.rows() + 1, 3);
  closed << curve, curve.row(0);
  return closed;
}

/// The ring from one of its points on.
Points StartedAt(const Points& ring, int first)
{
  const Eigen::Index tail = ring.rows() - first;
  Points started(ring.rows(), 3);
  started << ring.bottomRows(tail), ring.topRows(first);
  return started;
}

Points Backward(const Points& ring)
{
  Points backward = ring.colwise().reverse();
  return backward;
}

/// The ring from its place nearest to x on, which becomes a point of it.
Points StartedNear(const Points& ring, const Eigen::RowVector3d& x)
{
  Eigen::Index segment = 0;
  Eigen::RowVector3d place = ring.row(0);
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < ring.rows(); ++i)
  {
    const Eigen::RowVector3d start = ring.row(i);
    const Eigen::RowVector3d edge = ring.row((i + 1) % ring.rows()) - start;
    const double t = edge.isZero(0.0) ? 0.0 : Clamp((x - start).dot(edge) / edge.squaredNorm());
    const Eigen::RowVector3d there = start + t * edge;
    if ((there - x).norm() < nearest)
    {
      nearest = (there - x).norm();
      segment = i;
      place = there;
    }
  }
  const auto next = static_cast<int>((segment + 1) % ring.rows());
  if (place == ring.row(segment) || place == ring.row(next))
  {
    return StartedAt(ring, place == ring.row(next) ? next : static_cast<int>(segment));
  }
  Points started(ring.rows() + 1, 3);
  started << place, StartedAt(ring, next);
  return started;
}

/// Of all points (Kabsch, A Solution for the Best Rotation to Relate Two Sets of Vectors,
/// 1976).
Eigen::Matrix3d BestRotation(const Points& source, const Points& moved)
{
  const Points from = source.rowwise() - source.colwise().mean();
  const Points to = moved.rowwise() - moved.colwise().mean();
  const Eigen::Matrix3d covariance = to.transpose() * from;
  const Eigen::Vector3d extents = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  if (extents[1] > StraightPart * extents[0])
  {
    return ProjectOnRotations(covariance);
  }
  const Eigen::Index last = source.rows() - 1;
  return LeastRotation(
    (source.row(last) - source.row(0)).transpose(), (moved.row(last) - moved.row(0)).transpose());
}
}

Eigen::VectorXd ArcLengths(const Points& curve)
{
  Eigen::VectorXd lengths = Eigen::VectorXd::Zero(curve.rows());
  for (Eigen::Index i = 1; i < curve.rows(); ++i)
  {
    lengths[i] = lengths[i - 1] + (curve.row(i) - curve.row(i - 1)).norm();
  }
  return lengths;
}

void RequireSimpleCurve(const Points& ofCurve, const std::string& role, bool isClosed)
{
  const Points curve = isClosed ? Closed(ofCurve) : ofCurve;
  const auto count = static_cast<int>(curve.rows()) - 1;
  const double length = count > 0 ? ArcLengths(curve)[count] : 0.0;
  if (!(length > 0.0))
  {
    throw Error(
      ErrorCode::BadInput, "The " + role + " has no length: give it two different points or more.");
  }
  const auto low = [&](int i) { return std::min(curve(i, 0), curve(i + 1, 0)); };
  const auto high = [&](int i) { return std::max(curve(i, 0), curve(i + 1, 0)); };
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int i, int j) { return std::make_pair(low(i), i) < std::make_pair(low(j), j); });
  const double touching = TouchingPart * length;
  IdSample crossings;
  for (int a = 0; a < count; ++a)
  {
    const int i = order[a];
    for (int b = a + 1; b < count && low(order[b]) <= high(i) + touching; ++b)
    {
      const int j = order[b];
      const bool areNeighbors = std::abs(i - j) <= 1 || (isClosed && std::abs(i - j) == count - 1);
      if (!areNeighbors &&
        SegmentDistance(curve.row(i), curve.row(i + 1), curve.row(j), curve.row(j + 1)) <= touching)
      {
        crossings.Add(std::min(i, j));
      }
    }
  }
  if (!crossings.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " crosses or touches itself at " + crossings.Describe("segment", "segments") +
        ", so that places on it are not in one order: move its points apart, or leave a gap "
        "between its ends.");
  }
}

Points MatchCurves(const Points& source, const Points& target, std::vector<CurveKey> keys)
{
  keys.push_back({ 0, 0 });
  keys.push_back({ static_cast<int>(source.rows()) - 1, static_cast<int>(target.rows()) - 1 });
  std::sort(keys.begin(), keys.end(),
    [](const CurveKey& a, const CurveKey& b)
    { return std::make_pair(a.Source, a.Target) < std::make_pair(b.Source, b.Target); });
  const Eigen::VectorXd from = ArcLengths(source);
  const Eigen::VectorXd to = ArcLengths(target);
  Points matched(source.rows(), 3);
  for (std::size_t k = 0; k + 1 < keys.size(); ++k)
  {
    const CurveKey& begin = keys[k];
    const CurveKey& end = keys[k + 1];
    if (begin.Source >= end.Source || begin.Target >= end.Target)
    {
      throw Error(ErrorCode::BadInput,
        "The keys run in different orders along source and target curve, or a point has two, or "
        "an end has one: reverse the target, or remove keys.");
    }
    int segment = begin.Target;
    for (int i = begin.Source; i <= end.Source; ++i)
    {
      const double part = (from[i] - from[begin.Source]) / (from[end.Source] - from[begin.Source]);
      const double length = to[begin.Target] + part * (to[end.Target] - to[begin.Target]);
      while (segment + 2 <= end.Target && to[segment + 1] < length)
      {
        ++segment;
      }
      const double extent = to[segment + 1] - to[segment];
      const double t = extent > 0.0 ? Clamp((length - to[segment]) / extent) : 0.0;
      matched.row(i) = target.row(segment) + t * (target.row(segment + 1) - target.row(segment));
    }
    matched.row(end.Source) = target.row(end.Target);
  }
  return matched;
}

Points MatchClosedCurves(
  const Points& source, const Points& target, const std::vector<CurveKey>& keys, bool isReversed)
{
  const auto sourceSize = static_cast<int>(source.rows());
  const auto targetSize = static_cast<int>(target.rows());
  // From the first key or place on, with the other keys in between.
  const int start = keys.empty() ? 0 : keys[0].Source;
  const Points from = Closed(StartedAt(source, start));
  const double scale = ArcLengths(Closed(target))[targetSize] / ArcLengths(from)[sourceSize];
  const auto match = [&](bool isBackward)
  {
    const Points way = isBackward ? Backward(target) : target;
    const auto place = [&](int i) { return isBackward ? targetSize - 1 - i : i; };
    std::vector<CurveKey> between;
    Points to;
    if (keys.empty())
    {
      to = StartedNear(
        way, target.colwise().mean() + scale * (source.row(0) - source.colwise().mean()));
    }
    else
    {
      const int first = place(keys[0].Target);
      to = StartedAt(way, first);
      for (std::size_t k = 1; k < keys.size(); ++k)
      {
        between.push_back({ (keys[k].Source - start + sourceSize) % sourceSize,
          (place(keys[k].Target) - first + targetSize) % targetSize });
      }
    }
    const Points matched = MatchCurves(from, Closed(to), between).topRows(sourceSize);
    return StartedAt(matched, (sourceSize - start) % sourceSize);
  };
  if (keys.size() > 2)
  {
    return match(isReversed);
  }
  const Points forward = match(false);
  const Points backward = match(true);
  const bool isForward = (forward - source).squaredNorm() <= (backward - source).squaredNorm();
  return isForward != isReversed ? forward : backward;
}

Points CurveRotations(const Points& source, const Points& moved, bool isClosed)
{
  const Eigen::Matrix3d best = BestRotation(source, moved);
  Points vectors(source.rows(), 3);
  Eigen::Vector3d guess = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < source.rows(); ++i)
  {
    const Eigen::Vector3d turned = best * Tangent(source, i, isClosed);
    guess = VectorFromRotation(LeastRotation(turned, Tangent(moved, i, isClosed)) * best, guess);
    vectors.row(i) = guess.transpose();
  }
  return vectors;
}

HandleTargets CurveTargets(const std::vector<int>& path, const Points& goals, const Points& vectors)
{
  const auto count = static_cast<Eigen::Index>(path.size());
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Vertices = path;
  std::sort(targets.Vertices.begin(), targets.Vertices.end());
  targets.Positions.resize(count, 3);
  targets.RotationVectors.resize(count, 3);
  targets.Transforms.resize(count, 9);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const Eigen::Index row = targets.Row(path[i]);
    targets.Positions.row(row) = goals.row(i);
    targets.RotationVectors.row(row) = vectors.row(i);
    MatrixAt(targets.Transforms, row) = RotationFromVector(vectors.row(i).transpose());
  }
  return targets;
}
}
