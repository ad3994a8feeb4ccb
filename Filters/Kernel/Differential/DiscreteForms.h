// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

/// Discrete forms, frames and transitions of Lipman, Sorkine, Levin, Cohen-Or,
/// Linear Rotation-invariant Coordinates for Meshes, 2005, sections 2 and 3.
namespace cartan
{
/// The first and second discrete form, a value per directed edge i -> j, that
/// is, per one-ring entry of i. Together they fix every one-ring up to a rigid
/// motion.
struct DiscreteForms
{
  Eigen::VectorXd Length; ///< #D, length of the edge projected on the tangent plane of i
  /// #D, signed angle in radians, in (-pi, pi], from the projected edge to the
  /// next one counter-clockwise around i; NaN where there is no next triangle.
  Eigen::VectorXd Angle;
  Eigen::VectorXd Height; ///< #D, <x_j - x_i, N_i>
  /// #D, the sign of det(projected edge, next projected edge, N_i): +1, -1, or 0
  /// where an edge has no projection or there is no next one.
  std::vector<signed char> Orientation;
};

/// Right-handed orthonormal frames (b1, b2, N): #V x 9. N is the area-weighted
/// normal and b1 the direction of the first projected edge of the one-ring.
/// Unused vertices get the identity. Throws Error(BadInput) where a vertex has
/// no normal.
Matrices VertexFrames(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

/// The forms with respect to the normals in `frames`. An edge that is parallel
/// to the normal (its projection is below 1e-10 of the ring's longest edge) has
/// no direction of its own and takes that of the edge before it.
DiscreteForms ComputeDiscreteForms(const TriangleMesh& mesh, const Points& points,
  const Matrices& frames, const ExecutionContext& context = {});

/// Each directed edge in the frame of its origin, from the forms alone (Lemma
/// 2.1): #D x 3, (Length cos a, Length sin a, Height), with a the sum of the
/// angles from the ring's first edge.
Points RingCoordinates(const TriangleMesh& mesh, const DiscreteForms& forms);

/// Transition coefficients: for each directed edge i -> j the matrix C_ij, F_j =
/// F_i C_ij (Eq. 2). Zero where nothing determines it.
using Transitions = Matrices;

/// C_ij = F_i^T F_j of frames that are given.
Transitions TransitionsFromFrames(const TriangleMesh& mesh, const Matrices& frames);

enum class TransitionMethod
{
  /// The rotation that best maps i, j and the vertices opposite to their edge as
  /// seen from j on the same as seen from i. Needs no orientation bits and is
  /// far less sensitive to noise in the forms.
  Procrustes,
  /// The paper's Theorem 3.1: the normal from Eq. 3 and an orientation bit, the
  /// rest from Lemma 2.1.
  OrientationBits
};

/// C_ij from the forms alone (Theorem 3.1). Both methods give the same for the
/// forms of a surface. An edge between triangles without area has no
/// transition.
Transitions TransitionsFromForms(const TriangleMesh& mesh, const DiscreteForms& forms,
  TransitionMethod method = TransitionMethod::Procrustes, const ExecutionContext& context = {});

/// The same by Procrustes from the one-rings themselves (as RingCoordinates gives
/// them, #D x 3), whatever frames they are seen from.
Transitions TransitionsFromRings(
  const TriangleMesh& mesh, const Points& ring, const ExecutionContext& context = {});
}
