// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Merging/SurfacePlace.h"
#include "Mesh/TriangleMesh.h"

#include <string>
#include <vector>

namespace cartan
{
/// The surroundings of boundary loops within a width, each an annulus: a band along its
/// loop that reaches no other boundary, no other band, and does not close up.
struct TransitionBands
{
  Eigen::VectorXd Distances; ///< #V: from the nearest loop, over the surface
  std::vector<int> LoopOf;   ///< #V: the loop whose band it is in, or -1
};

/// `width` > 0. Distances are known one ring beyond the width. Throws Error(BadInput)
/// with `role` ("target") where a band would be no annulus.
TransitionBands FindBands(const TriangleMesh& mesh, const Points& points,
  const std::vector<std::vector<int>>& loops, double width, const std::string& role,
  const ExecutionContext& context = {});

/// Cylinder coordinates of a band: the distance from its loop and the angle around. The
/// angle is that of a harmonic map into the plane (cos, sin), given at the loop and free
/// at the other end, so that the band need not be cut open.
struct BandCoordinates
{
  std::vector<int> Vertices; ///< the band and one ring around it, in increasing order
  Triangles Faces;           ///< those with a corner in the band, vertices of the surface
  Eigen::VectorXd Angles;    ///< #V of the surface: in turns, modulo 1; 0 outside
};

/// `loopAngles`, one for each of `loop`, in turns.
BandCoordinates FindCoordinates(const TriangleMesh& mesh, const Points& points,
  const TransitionBands& bands, int loopNumber, const std::vector<int>& loop,
  const Eigen::VectorXd& loopAngles, const ExecutionContext& context = {});

/// a - b without whole turns: in [-1/2, 1/2].
double TurnBetween(double a, double b);

/// Where a band has these angles and distances (one of each per place). Beyond its ends,
/// the closest place in the triangle that misses it least.
std::vector<SurfacePlace> PlacesInBand(const BandCoordinates& band,
  const Eigen::VectorXd& bandDistances, const Eigen::VectorXd& angles,
  const Eigen::VectorXd& distances);
}
