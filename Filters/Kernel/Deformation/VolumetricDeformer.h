// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Deformation/SurfaceDeformer.h"
#include "Deformation/VolumeGraph.h"

namespace cartan
{
/// Deformation of a surface together with its inside (Zhou et al., Large Mesh Deformation
/// Using the Volumetric Graph Laplacian, ACM SIGGRAPH 2005). The maps of the handles
/// spread over the graph by harmonic functions h_k (see MotionBlend), and the nodes
/// minimize
///
///   sum over edges of w_ij |x_i - x_j - T_ij (p_i - p_j)|^2,
///
/// T_ij the map at the mean of the blends of i and j: one symmetric Laplacian of the
/// graph for both, which is factorized once. In place of the paper's rotated Laplacian
/// coordinates, whose right-hand side does not see that rotations change inside, these
/// are rotated edges, as in FrameDeformer.
///
/// A bend or twist makes such a body thinner: the rotated edges of the outer side do not
/// fit together, and the best fit lies inside. So rounds follow that multiply T_i by
/// (det T_i / det F_i)^(1/3), F_i the gradient of the last positions at i: each is one
/// more back-substitution, and takes two thirds of the loss that the round before left.
///
/// All unknowns are displacements, so that rounding is in parts of the motion.
class VolumetricDeformer : public SurfaceDeformer
{
public:
  VolumetricDeformer(HandleProblem problem, VolumeGraph graph,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  /// How often volume is restored, >= 0.
  void SetVolumeRounds(int rounds) { this->VolumeRounds = rounds; }

  /// Throws Error(BadInput) for targets that are not one motion per handle.
  static void RequireMotions(const HandleTargets& targets);

  const VolumeGraph& GetGraph() const { return this->Graph; }

  /// Where the nodes are after Deform(), #N x 3, with the surface's vertices where
  /// `result` has them.
  Points NodesAfter(const DeformedSurface& result) const;

  int GetNumberOfFactorizations() const override
  {
    return this->System.GetNumberOfFactorizations();
  }
  int GetNumberOfFreeVertices() const override;
  std::size_t GetBytes() const override
  {
    return this->GetBaseBytes() + this->Graph.GetBytes() + this->System.GetBytes() +
      TotalBytes(this->IsFree, this->IsReached, this->MovingHandles, this->Displacements);
  }

protected:
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;
  bool FollowsRigidHandles() const override { return false; }

private:
  void FindUnknowns();
  Anchors MakeAnchors() const;
  Field SpreadBlends(const Field& ofHandles) const;
  void SolvePositions(const Field& blends, const Eigen::VectorXd& scales, const Points& targets,
    const ExecutionContext& context);
  void RestoreVolume(
    const Field& blends, Eigen::VectorXd& scales, const ExecutionContext& context) const;

  void CarryInside(DeformedSurface& result) const;

  VolumeGraph Graph;
  std::vector<char> IsFree;       ///< #N, solved for: also nodes held softly
  std::vector<char> IsReached;    ///< #N, free, or of a moving handle
  std::vector<int> MovingHandles; ///< #V
  AnchoredSystem System;
  Points Displacements; ///< #N x 3, of the last motion, relative to what all handles do
  int VolumeRounds = 3;
};
}
