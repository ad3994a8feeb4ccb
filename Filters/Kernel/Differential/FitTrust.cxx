// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/FitTrust.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// Surfaces that turn by less count as if they turned by so much, in radians: the
/// noise of a plane is no error.
constexpr double SmallTurn = 0.05;

/// The largest standard error relative to the curvature, where nothing is hidden.
constexpr double LargestRelativeError = 0.015;

/// The same at borders, where points on one side only hide more of it.
constexpr double LargestRelativeErrorAtBorder = 0.01;

/// How much of the error is hidden per radian of turn and square root of the relative
/// mismatch of normals: derivatives of even order look like a quadric all around, the more
/// so the less even the points lie.
constexpr double HiddenInside = 6.8;

/// Turns count up to here: farther along or around a tube nothing more is hidden.
constexpr double LargestTurn = 2.0;

/// What is hidden at borders, over the square root of mismatch by turn: the error
/// goes down with the edge length only, what shows of it faster.
constexpr double HiddenAtBorder = 3.6;

/// The sine of 33 degrees: half the largest turn along an edge. Edges of tubes with
/// six sides turn by 60, of the icosahedron by 63, of a bar's cross section by 90.
constexpr double LargestHalfTurnSine = 0.545;

/// The cosine of as much. A neighbor whose normal has turned farther is on the other side
/// of a sharp edge or of a fold, where triangles lie upside down.
constexpr double SmallestCosine = 0.4;

/// The sine of the angle between planes that count as one. Coordinates in single
/// precision turn the small triangles of fine surfaces by 1e-4.
constexpr double SamePlane = 1e-3;

/// Points in the middle of split edges have six neighbors, of split quads up to eight. At
/// points of far more the triangles need not be looked at, neighbor by neighbor.
constexpr int LargestValence = 12;

/// How often a ring of triangles in two planes bends.
constexpr int MostBends = 2;

/// How far the normals n_w of the neighbors change otherwise than the form says: the
/// least error of n_w - n = A (w - v) over the edges w - v, root mean square per length,
/// in the tangent plane.
double NormalMismatch(const Neighborhood& neighborhood, const SecondForm& form)
{
  double squaredMismatch = 0.0;
  double squaredLength = 0.0;
  for (int i = 0; i < neighborhood.OneRingSize(); ++i)
  {
    const Eigen::Vector3d& edge = neighborhood.Offset(i);
    const Eigen::Vector3d change = neighborhood.Normal(i) - form.Normal;
    const double u = edge.dot(form.U);
    const double v = edge.dot(form.V);
    squaredMismatch += std::pow(change.dot(form.U) - form.Uu * u - form.Uv * v, 2) +
      std::pow(change.dot(form.V) - form.Uv * u - form.Vv * v, 2);
    squaredLength += u * u + v * v;
  }
  return squaredLength > 0.0 ? std::sqrt(squaredMismatch / squaredLength) : 0.0;
}

/// By how much more than shows an error may be where the normal turns by `turn` over the
/// points. `curvature`, 1 / length, is the largest of the surface there.
double HiddenFactor(const Neighborhood& neighborhood, const SecondForm& form, double curvature,
  double turn, bool isAtBorder)
{
  const double mismatch = std::sqrt(NormalMismatch(neighborhood, form) / curvature);
  const double hidden = isAtBorder ? HiddenAtBorder * mismatch / std::sqrt(turn)
                                   : HiddenInside * mismatch * std::min(turn, LargestTurn);
  return std::max(1.0, hidden);
}

/// Whether two planes are the same, by their normals of any length.
inline bool AreInOnePlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return a.cross(b).squaredNorm() <= SamePlane * SamePlane * a.squaredNorm() * b.squaredNorm();
}

/// Whether the triangles at v lie in one plane or in two that meet in a line through v.
bool HasStraightEdge(const TriangleMesh& mesh, const Points& points, int v)
{
  if (mesh.Valence(v) > LargestValence)
  {
    return false;
  }
  const auto edge = [&](int d) -> Eigen::Vector3d
  { return (points.row(mesh.Neighbor(d)) - points.row(v)).transpose(); };
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  int bends = 0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v) && bends <= MostBends; ++d)
  {
    const int next = mesh.NextAround(v, d);
    if (next < 0)
    {
      continue;
    }
    const Eigen::Vector3d a = edge(d);
    const Eigen::Vector3d b = edge(next);
    const double squared = a.squaredNorm() + b.squaredNorm();
    const Eigen::Vector3d normal = a.cross(b) / (squared > 0.0 ? squared : 1.0);
    if (first.isZero(0.0))
    {
      first = normal;
    }
    else
    {
      bends += AreInOnePlane(normal, last) ? 0 : 1;
    }
    last = normal;
  }
  if (!mesh.IsBoundary(v))
  {
    // Around a point, two planes meet in two edges, which lie in one line.
    return bends + (AreInOnePlane(last, first) ? 0 : 1) <= MostBends;
  }
  const Eigen::Vector3d begin = edge(mesh.RingBegin(v)).normalized();
  const Eigen::Vector3d end = edge(mesh.RingEnd(v) - 1).normalized();
  return bends == 0 && begin.cross(end).norm() < SamePlane && begin.dot(end) < 0.0;
}
}

bool MayBeWrong(const Neighborhood& neighborhood, const SecondForm& form, bool isAtBorder)
{
  double radius = 0.0;
  bool isSharp = false;
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    radius = std::max(radius, neighborhood.Offset(i).norm());
    if (i < neighborhood.OneRingSize())
    {
      isSharp = isSharp || form.HalfTurnSine(neighborhood.Offset(i)) > LargestHalfTurnSine ||
        form.Normal.dot(neighborhood.Normal(i)) < SmallestCosine;
    }
  }
  const double curvature =
    std::abs(0.5 * (form.Uu + form.Vv)) + std::hypot(0.5 * (form.Uu - form.Vv), form.Uv);
  if (radius * curvature < FlatTurn)
  {
    return false;
  }
  // Where the curvature changes its sign, half of its change over the points, if they turn by
  // a radian at most.
  const double around = std::max(curvature, std::min(0.5 * radius * form.Change, 1.0 / radius));
  const double relativeError = form.StandardError / std::max(around, SmallTurn / radius);
  const double largest = isAtBorder ? LargestRelativeErrorAtBorder : LargestRelativeError;
  return isSharp || relativeError > largest ||
    relativeError * HiddenFactor(neighborhood, form, around, radius * around, isAtBorder) > largest;
}

bool IsSplitFlat(const TriangleMesh& mesh, const Points& points, int v)
{
  if (HasStraightEdge(mesh, points, v))
  {
    return true;
  }
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    if (!HasStraightEdge(mesh, points, mesh.Neighbor(d)))
    {
      return false;
    }
  }
  return true;
}
}
