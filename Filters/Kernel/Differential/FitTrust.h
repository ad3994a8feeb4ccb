// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/SurfaceFit.h"

namespace cartan
{
/// A neighborhood is flat, whatever its points say or leave open, if its normal turns
/// by less than this from the vertex to the farthest point, in radians. Single
/// precision coordinates leave 1e-6 in a flat polygon.
constexpr double FlatTurn = 1e-4;

/// Whether a form of FitCubic() may be off by more than 5 % of the largest principal
/// curvature there is at the vertex or, where that is nearly zero, around it.
///
/// The standard error shows the part of the error that is no cubic's. How much more
/// is hidden grows with the turn of the normal over the points, and with what the
/// normals of the neighbors say otherwise than the form, which is what irregular
/// triangles do: FitTrust.cxx has the bounds. They are such that no error above 5 %
/// passes on spheres, cylinders, cones, tori, catenoids and saddles of 8 to 80 points
/// around, regular and jittered by up to .3 of an edge, borders included, and on
/// hulls of 20 to 300 random points of an ellipsoid. Three times as many
/// points are said to be doubtful there as are off by 5 %.
///
/// `neighborhood` is the one of the fit, with normals.
bool MayBeWrong(const Neighborhood& neighborhood, const SecondForm& form, bool isAtBorder);

/// Whether the surface looks around v as if larger triangles had been split into
/// coplanar ones: the triangles at v, or at each of its neighbors, lie in one plane
/// or in two that meet in a straight edge. No splitting of that kind determines a
/// curvature.
bool IsSplitFlat(const TriangleMesh& mesh, const Points& points, int v);
}
