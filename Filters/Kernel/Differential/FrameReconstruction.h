// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Differential/DiscreteForms.h"

/// The two linear systems of Lipman et al., Linear Rotation-invariant
/// Coordinates for Meshes, 2005, sections 3 and 3.1, for transitions that need
/// not come from a surface.
namespace cartan
{
/// The normal matrix of the discrete surface equations (1): 3 #V x 3 #V. With
/// X_i = F_i^T, a 3 x 3 block of rows per vertex, the equations over the
/// directed edges i -> j are X_j - C_ij^T X_i = 0. Transitions that are zero
/// are left out. `weights` (#D, the same for both directions of an edge; here and
/// below: empty for 1) are those of the equations' squares.
SparseMatrix FrameMatrix(
  const TriangleMesh& mesh, const Transitions& transitions, const Eigen::VectorXd& weights = {});

/// What a system that serves SolveFrames is for: one solve for each matrix.
FactorLimits FrameLimits();

/// The frames that fit the transitions best in the least-squares sense, with
/// those given where `isFixed` is non-zero: #V x 9. Raw: rotations only if the
/// transitions are consistent. Throws Error(SingularSystem) for a component
/// without a fixed frame. Unused vertices keep what `frames` has. `system`, best made with
/// FrameLimits(), keeps the symbolic factors for other transitions on the same mesh.
Matrices SolveFrames(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices frames, AnchoredSystem& system,
  const ExecutionContext& context = {}, const Eigen::VectorXd& weights = {});

/// The same from the FrameMatrix, which is released before the factorization takes its memory.
Matrices SolveFrames(const TriangleMesh& mesh, SparseMatrix&& matrix,
  const std::vector<char>& isFixed, Matrices frames, AnchoredSystem& system,
  const ExecutionContext& context = {});

/// The same frames by conjugate gradients, without a factorization of the 3 #V
/// matrix. `start` must be rotations near the result: relative to them the
/// matrix is nearly three graph Laplacians, whose factors are the
/// preconditioner, and a few steps suffice; far from the result hundreds are
/// needed. `laplacian` is factorized with the vertices of `isFixed` and the
/// unused ones fixed; the frames there are kept. Stops when the preconditioned
/// residual is 1e-10 of that of the start. `steps`, if given, receives the
/// number of steps; throws Error(NotConverged) after `maximumSteps`.
Matrices SolveFramesFrom(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices start, const AnchoredSystem& laplacian,
  int* steps = nullptr, const ExecutionContext& context = {}, const Eigen::VectorXd& weights = {},
  int maximumSteps = 1000);

/// The frames of SolveFrames, where transitions nearly fit together in less than half of
/// its memory: by SolveFramesFrom, from frames that are carried along the edges from the
/// nearest one that is given. Else, where that would take more time, by SolveFrames.
/// `laplacian` is the ReconstructionSystem.
Matrices ReconstructFrames(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices frames, const AnchoredSystem& laplacian,
  const ExecutionContext& context = {});

/// The system of ReconstructFrames and SolvePositions: the graph Laplacian with the
/// vertices of `isFixed` and the unused ones fixed. Throws Error(SingularSystem) for a
/// component without a fixed vertex.
AnchoredSystem ReconstructionSystem(
  const TriangleMesh& mesh, const std::vector<char>& isFixed, const ExecutionContext& context = {});

/// b of the normal equations L x = b that SolvePositions solves, with the graph
/// Laplacian L: #V x 3.
Field PositionRightHandSide(const TriangleMesh& mesh, const Matrices& frames, const Points& ring,
  const ExecutionContext& context = {}, const Eigen::VectorXd& weights = {});

/// The positions that fit x_j - x_i = F_i c_ij (Eq. 5) best over all directed
/// edges, with those given where `isFixed` is non-zero: #V x 3. `ring` are the
/// edges in the frames of their origins (RingCoordinates), `system` the
/// ReconstructionSystem. Unused vertices keep what `positions` has.
Points SolvePositions(const TriangleMesh& mesh, const Matrices& frames, const Points& ring,
  const std::vector<char>& isFixed, Points positions, const AnchoredSystem& system,
  const ExecutionContext& context = {});
}
