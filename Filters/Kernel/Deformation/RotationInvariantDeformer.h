// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/FrameDeformer.h"
#include "Deformation/HarmonicBlend.h"

namespace cartan
{
enum class FrameProjection
{
  Automatic, ///< on rotations when every motion is rigid
  None,      ///< frames as the linear system gives them: for scale and shear
  Rotation   ///< always on rotations
};

/// Editing with linear rotation-invariant coordinates (Lipman et al., Linear
/// Rotation-invariant Coordinates for Meshes, 2005, section 4).
///
/// The paper solves a 3 #V x 3 #V system for the frames. On forms that come from
/// a surface it is a scalar system. Let F_i be the frames of the surface and
/// C_ij = F_i^T F_j their transitions, and write the unknown frames as R_i F_i
/// with any 3 x 3 matrix R_i. The residual of the discrete surface equations
/// (1) on the edge i -> j is
///
///   R_j F_j - R_i F_i C_ij = R_j F_j - R_i F_i F_i^T F_j = (R_j - R_i) F_j,
///
/// of norm |R_j - R_i|, as F_j is orthogonal. The sum over both directions of
/// all edges is therefore 2 sum over the nine entries r of R of r^T L r, with
/// the graph Laplacian L: its minimizer under R = A_k on handle k is
///
///   R = sum_k h_k A_k,
///
/// h_k harmonic, 1 on handle k and 0 on the others. The positions (see
/// FrameDeformer) have the same matrix, so one factorization serves both, and
/// they are linear in each handle's motion x -> A_k x + t_k:
///
///   x = phi_0 + sum_k [A_k phi_k + h_k t_k],  phi_0 + sum_k phi_k = p,
///
/// with phi_k = L^-1 b(h_k I). A motion without projection is this sum, unless there are many
/// handles (HarmonicBlend). The weights w generalize the graph Laplacian (w = 1) of the paper.
class RotationInvariantDeformer : public FrameDeformer
{
public:
  RotationInvariantDeformer(HandleProblem problem, SolverBackend backend = SolverBackend::Automatic,
    const ExecutionContext& context = {});

  std::size_t GetBytes() const override
  {
    return FrameDeformer::GetBytes() + this->Harmonic.GetBytes() + TotalBytes(this->DragFields);
  }

  void SetFrameProjection(FrameProjection projection) { this->Projection = projection; }

protected:
  bool ServesPieces() const override { return this->VolumeServesPieces(); }
  void ComputeTransforms(const HandleTargets& targets, const ExecutionContext& context) override;
  PositionRows DirectSums(const HandleTargets& targets, const ExecutionContext& context) override;
  bool HasDirectSums(const HandleTargets& targets) const override
  {
    return this->DragFields.cols() > 0 && this->ServesDirectSums(targets);
  }
  bool FindTurns(
    const HandleTargets& targets, Eigen::Vector3d& axis, Eigen::VectorXd& angles) override;
  TurnParts TurnOf(int local, const Eigen::VectorXd& ratios, double angle) const override;

private:
  bool UsesRotations(const HandleTargets& targets) const;
  bool ServesDirectSums(const HandleTargets& targets) const;
  void BlendMotions(const HandleTargets& targets, bool project, const ExecutionContext& context);
  void AddIdentity(const Field& differences, bool project, const ExecutionContext& context);
  void ComputeDragFields(const ExecutionContext& context);

  FrameProjection Projection = FrameProjection::Automatic;
  HarmonicBlend Harmonic;
  Field DragFields; ///< #unknowns x 3 + 4 #Moving: phi_0, then phi_k, h_k
};
}
