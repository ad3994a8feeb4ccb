// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Merging/SurfacePlace.h"
#include "Mesh/TriangleMesh.h"

#include <map>
#include <vector>

namespace cartan
{
/// The surface without its details, those whose wave length is below `width` mean edge
/// lengths of their component: waves of this length keep three quarters of their height,
/// half as long ones a tenth, and twice as long ones all but .4 % (of second
/// order in time and space, after Desbrun et al., Implicit Fairing of Irregular Meshes
/// using Diffusion and Curvature Flow, 1999; with S = (M + tau^2 L M^-1 L)^-1 M, tau the
/// inverse of the squared wave number, the result is S (2 - S) p, so that large forms do
/// not shrink). width >= 0; 0 returns the points.
Points SmoothBase(const TriangleMesh& mesh, const Points& points, double width,
  const ExecutionContext& context = {});

/// The similarity (4 x 4) that takes the target's key points closest to the source's; keys
/// are vertices by number, those of one surface only do not count. Throws Error(BadInput) where
/// equal keys determine none.
Eigen::Matrix4d AlignKeys(const std::map<int, int>& targetKeys, const Points& target,
  const std::map<int, int>& sourceKeys, const Points& source);

/// How the neighborhood of each target vertex lies to that of its place on the source:
/// the rotation that takes the places of its one-ring, with their normal, closest to the
/// ring itself, and how much larger its component is than its places, by the root of the mean
/// squares of edges (1 where the places are all one): where a base has shrunk to a tip,
/// a ratio of single rings would throw details far away.
struct PlaceFrames
{
  Matrices Rotations;     ///< #V of the target x 9
  Eigen::VectorXd Scales; ///< #V of the target
};

/// `places` are those of the target's vertices on the source's base; rows of unused
/// vertices mean nothing.
PlaceFrames FramesAtPlaces(const TriangleMesh& target, const Points& targetPoints,
  const Points& basePoints, const std::vector<SurfacePlace>& places,
  const ExecutionContext& context = {});

/// The displacements that a coating, the difference between a detailed surface and its
/// smooth base, makes of the target (Sorkine et al., Laplacian Surface Editing, 2004,
/// section 4; Sorkine, Differential Representations for Mesh Processing, 2006, section
/// 4.4). There Laplacian coordinates are carried over; between surfaces of different
/// connectivity these hang on the triangles, so here displacements are, in the frames of
/// the base: turned by the rotation of each place, and scaled by its scale on request.
///
///   u_i = strength_i s_i R_i (v - b)(place of i): #V of the target x 3.
Points CoatingDisplacements(const Points& base, const Points& detailed,
  const std::vector<SurfacePlace>& places, const PlaceFrames& frames, bool scales,
  const Eigen::VectorXd& strengths);

/// The same by Laplacian coordinates, as the references have it, for a target with the
/// base's triangles: displacements u with
///
///   L u = strength_i s_i R_i L (v - b), L the base's,
///
/// which on closed surfaces and free boundaries determines them up to a shift of each component:
/// that with the mean of `guess`, which are those of CoatingDisplacements. Where the base was
/// moved rigidly, the coating comes out whole.
Points CoatingByLaplacians(const TriangleMesh& mesh, const Points& base, const Points& detailed,
  const PlaceFrames& frames, bool scales, const Eigen::VectorXd& strengths, const Points& guess,
  const ExecutionContext& context = {});
}
