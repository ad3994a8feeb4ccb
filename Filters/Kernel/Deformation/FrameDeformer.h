// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleLaplacian.h"
#include "Deformation/SurfaceDeformer.h"
#include "Measure/VolumeModel.h"

namespace cartan
{
enum class VolumeCorrection
{
  None,
  /// Lipman et al. 2007, section 4: frames scaled by sqrt(h / h~), the surface
  /// reconstructed twice.
  FrameScaling,
  /// Edges that bend about the middle of the body instead of about its skin:
  /// linear in the frames, no curvature needed.
  NeutralOffset
};

/// What all methods share that first find how each vertex's frame changes and
/// then reconstruct the surface from the changed frames: the position system,
/// the handles' places, and the preservation of volume. With rest positions p
/// and frame changes R the positions x minimize
///
///   sum over directed edges of w_ij |x_j - x_i - R_i (p_j - p_i)|^2
///
/// (Lipman et al., Linear Rotation-invariant Coordinates for Meshes, 2005,
/// Eq. 5), that is L x = b with b_i = sum_j w_ij (R_i + R_j) (p_i - p_j) / 2. Where
/// a method knows the change of each triangle t it is sum_t c_t,ij R_t (p_i - p_j)
/// instead, c_t,ij what t adds to w_ij.
class FrameDeformer : public SurfaceDeformer
{
public:
  /// Factorizes; see HandleLaplacian for what it throws.
  FrameDeformer(HandleProblem problem, SolverBackend backend, const ExecutionContext& context);

  void SetVolumeCorrection(VolumeCorrection correction) { this->Correction = correction; }
  void SetCloseVolume(bool close) { this->Close = close; }

  /// Of HandleProblem::GetParted(), without slivers. Needed for any volume correction and
  /// for closing; empty where there is none. Has no effect on components that enclose
  /// no volume.
  void SetVolumeModel(std::shared_ptr<const VolumeModel> model)
  {
    this->RestHeights.resize(model == this->Model ? this->RestHeights.size() : 0);
    this->Model = std::move(model);
  }
  const std::shared_ptr<const VolumeModel>& GetVolumeModel() const { return this->Model; }

  int GetNumberOfFactorizations() const override;
  int GetNumberOfFreeVertices() const override { return this->FrameSystem->NumberOfUnknowns(); }
  std::string GetWarning() const override { return this->Warning; }

  std::size_t GetBytes() const override;

  /// For what refines the result: the system of the positions, and the symmetric
  /// weights of the edges in it (#D).
  std::shared_ptr<const HandleLaplacian> GetPositionSystem() const { return this->PositionSystem; }
  std::shared_ptr<const Eigen::VectorXd> GetPositionWeights() const { return this->EdgeWeights; }

protected:
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

  /// Volume is preserved by moving regions that no handle deforms, too.
  bool FollowsRigidHandles() const override { return !this->PreservesVolume(); }

  struct HandleVertex
  {
    int Vertex;
    int Handle; ///< index in HandleProblem::Moving
  };

  /// Writes into Transforms the linear map of each unknown of FrameSystem and of
  /// each vertex of HandleVertices, and into TriangleTransforms those of
  /// triangles where the method has them.
  virtual void ComputeTransforms(const HandleTargets& targets, const ExecutionContext& context) = 0;

  /// A shortcut for methods whose positions need no solve: whether it served.
  virtual bool DeformDirectly(const HandleTargets&, Points&, const ExecutionContext&)
  {
    return false;
  }

  bool PreservesVolume() const
  {
    return this->Model && !this->Model->IsEmpty() &&
      (this->Correction != VolumeCorrection::None || this->Close);
  }

  std::shared_ptr<const Eigen::VectorXd> EdgeWeights;
  /// The system of the frames, and of the positions where it is the same.
  std::shared_ptr<HandleLaplacian> FrameSystem;
  /// The same object, or one with other weights or moving handles unknown.
  std::shared_ptr<HandleLaplacian> PositionSystem;
  /// The vertices of moving handles.
  std::vector<HandleVertex> HandleVertices;
  /// #V x 9, the identity where nothing moves; empty until first needed.
  Matrices Transforms;
  /// Empty, or the maps of the triangles that take the place of R_i in the sum,
  /// which is over the edges of each triangle then: #T x 9.
  Matrices TriangleTransforms;
  std::string Warning;

private:
  void SolvePositions(const HandleTargets& targets, const Matrices& transforms,
    DeformedSurface& result, const ExecutionContext& context);
  Eigen::Vector3d RightHandSide(int unknown, const HandleTargets& targets,
    const Matrices& transforms, const DeformedSurface& result) const;
  Eigen::Vector3d TriangleSum(int vertex, const Eigen::VectorXd& frameScale) const;
  void ScaleFrames(
    const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context);
  void CloseVolumes(Points& positions);

  VolumeCorrection Correction = VolumeCorrection::None;
  bool Close = false;
  std::shared_ptr<const VolumeModel> Model;
  Eigen::VectorXd RestHeights; ///< ColumnHeights at rest, empty until first needed
  Points TriangleWeights;      ///< CornerWeights, empty until first needed
};
}
