// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleProblem.h"

#include <string>
#include <vector>

namespace cartan
{
/// A point of one polyline that belongs to a point of another.
struct CurveKey
{
  int Source;
  int Target;
};

/// The length of a polyline from its start to each of its points: #P.
Eigen::VectorXd ArcLengths(const Points& curve);

/// Throws Error(BadInput) for a polyline without length, or one that touches itself: two
/// segments without a common point nearer than 1e-9 of the length. `role` names it. A closed
/// one goes on from its last point to its first. O(#P log #P) for most curves.
void RequireSimpleCurve(const Points& curve, const std::string& role, bool isClosed = false);

/// Where the points of `source` (#P x 3) go on `target`: from start to end, with the same
/// part of the length between two keys. Keys are inner points; they are sorted here.
/// Throws Error(BadInput) where they run in different orders on the curves. #P x 3, on
/// the segments of the target.
Points MatchCurves(const Points& source, const Points& target, std::vector<CurveKey> keys);

/// The same for closed polylines. Keys, at least one, tell which points belong together, and
/// their order which way the target runs. Without keys the first point of the source goes to the
/// place of the target that is nearest once both have one center and one length; with less than
/// three the target runs the way on which points move less. `isReversed`: the other way.
Points MatchClosedCurves(
  const Points& source, const Points& target, const std::vector<CurveKey>& keys, bool isReversed);

/// The rotation vectors, in radians, that take the frames of one polyline to those of
/// another with as many points: the rotation that fits all points best, and after it the
/// least one that takes tangent to tangent. On straight curves, which leave the turn
/// about them open, the best fit is the least rotation of the chord. #P x 3; neighbors'
/// vectors do not jump by full turns, but from the last point to the first of closed ones.
Points CurveRotations(const Points& source, const Points& moved, bool isClosed = false);

/// The targets of the only moving handle, whose vertices are those of `path`: `goals`
/// (#path x 3), turned by rotation `vectors` (#path x 3).
HandleTargets CurveTargets(
  const std::vector<int>& path, const Points& goals, const Points& vectors);
}
