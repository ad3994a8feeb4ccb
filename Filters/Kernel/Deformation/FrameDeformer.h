// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleLaplacian.h"
#include "Deformation/SurfaceDeformer.h"
#include "Deformation/TurnTable.h"
#include "Measure/VolumeModel.h"

#include <optional>

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
  /// no volume. On one of several pieces the rows of the whole's model that are here, at least
  /// one of them; nothing but the neutral offset serves there.
  void SetVolumeModel(std::shared_ptr<const VolumeModel> model);
  const std::shared_ptr<const VolumeModel>& GetVolumeModel() const { return this->Model; }

  /// With a range above 0, motions that turn the handles about one axis in a fixed ratio are
  /// read from a table that the first of them makes; angles beyond the range, other motions,
  /// and volume corrections that are not linear in the frames are solved for as ever. A table
  /// for another ratio is made when two motions in a row have it.
  void SetTurnTable(const TurnTable::Options& options) { this->TableOptions = options; }

  /// The table that the last motion was read from; nothing where it was solved for.
  const TurnTable* GetUsedTable() const { return this->UsesTable ? this->Table.get() : nullptr; }

  int GetNumberOfFactorizations() const override;
  int GetNumberOfFreeVertices() const override { return this->FreeVertices; }
  std::string GetWarning() const override { return this->Warning; }

  std::size_t GetBytes() const override;

  /// For what refines the result: the system of the positions, and the symmetric
  /// weights of the edges in it (#D).
  std::shared_ptr<const HandleLaplacian> GetPositionSystem() const { return this->PositionSystem; }
  std::shared_ptr<const Eigen::VectorXd> GetPositionWeights() const { return this->EdgeWeights; }

protected:
  PositionRows RowsRelative(const HandleTargets& targets, const ExecutionContext& context) override;
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

  /// Where it is a sum over fields or tables that are there.
  bool IsLocalRelative(const HandleTargets& targets) override;

  /// Volume is preserved by moving regions that no handle deforms, too.
  bool FollowsRigidHandles() const override { return !this->PreservesVolume(); }

  struct HandleVertex
  {
    int Vertex;
    int Handle; ///< index in HandleProblem::Moving
  };

  /// Writes into Transforms the linear map of each unknown of FrameSystem and of
  /// each vertex of HandleVertices, unless NeedsVertices is false; and into
  /// TriangleTransforms those of triangles where the method has them.
  virtual void ComputeTransforms(const HandleTargets& targets, const ExecutionContext& context) = 0;

  /// A shortcut for methods whose positions need no solve: those of ranges of PositionSystem's
  /// unknowns; nothing where it does not serve.
  virtual PositionRows DirectSums(const HandleTargets&, const ExecutionContext&) { return {}; }

  /// Whether DirectSums() serves, and without computing anything first.
  virtual bool HasDirectSums(const HandleTargets&) const { return false; }

  /// For methods that a TurnTable serves: whether all handles turn rigidly about one axis, that
  /// axis, and the angle of each moving handle. Then results about the rotations are set, too.
  virtual bool FindTurns(const HandleTargets&, Eigen::Vector3d&, Eigen::VectorXd&) { return false; }

  /// The turn of a local vertex of FrameSystem when each moving handle turns by its ratio times
  /// `angle`.
  virtual TurnParts TurnOf(int, const Eigen::VectorXd& /*ratios*/, double /*angle*/) const
  {
    return {};
  }

  /// Depths and volumes are those of the whole.
  bool KeepsNoVolume() const
  {
    return !this->Model || (this->Correction == VolumeCorrection::None && !this->Close);
  }

  /// Without, or with what each vertex needs to know of them for itself.
  bool VolumeServesPieces() const
  {
    return this->KeepsNoVolume() ||
      (this->Correction == VolumeCorrection::NeutralOffset && !this->Close);
  }

  bool PreservesVolume() const { return !this->KeepsNoVolume() && !this->Model->IsEmpty(); }

  std::shared_ptr<const Eigen::VectorXd> EdgeWeights;
  /// The system of the frames, and of the positions where it is the same.
  std::shared_ptr<HandleLaplacian> FrameSystem;
  /// The same object, or one with other weights or moving handles unknown.
  std::shared_ptr<HandleLaplacian> PositionSystem;
  /// The vertices of moving handles.
  std::vector<HandleVertex> HandleVertices;
  /// #V x 9, the identity where nothing moves; empty until first needed.
  Matrices Transforms;
  /// Empty, or the triangles around unknown positions, whose maps take the place of
  /// R_i in the sum, which is over the edges of each triangle then.
  std::vector<int> TriangleIds;
  Matrices TriangleTransforms; ///< #TriangleIds x 9
  /// Whether Transforms are asked for or enter the positions.
  bool NeedsVertices = true;
  std::string Warning;

private:
  /// A motion that a table may serve.
  struct Turn
  {
    Eigen::Vector3d Axis;
    double Angle;           ///< of the handle that turns most
    Eigen::VectorXd Ratios; ///< of the angles of all handles to that one
  };

  void CountFreeVertices();
  std::optional<Turn> FindTurn(const HandleTargets& targets);
  bool IsTableCurrent() const;
  PositionRows TableSums(const HandleTargets& targets, const ExecutionContext& context);
  void WriteRows(
    const HandleTargets& targets, const PositionRows& sums, int begin, int end, double* rows) const;
  bool HasTable(const Eigen::VectorXd& ratios, const ExecutionContext& context);
  TurnsOfAngle TurnsWith(const Eigen::VectorXd& ratios) const;
  const Points* NeutralOffsets() const;
  void SolvePositions(const HandleTargets& targets, const Matrices& transforms,
    DeformedSurface& result, const ExecutionContext& context);
  Eigen::Vector3d RightHandSide(int unknown, const HandleTargets& targets,
    const Matrices& transforms, const DeformedSurface& result) const;
  template <bool IsByVertex, bool HasOffsets>
  Eigen::Vector3d EdgeSum(int unknown, const Matrices& transforms) const;
  Points TriangleSums(const Eigen::VectorXd& frameScale, const ExecutionContext& context) const;
  void ScaleFrames(
    const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context);
  void CloseVolumes(Points& positions);

  int FreeVertices = 0;
  VolumeCorrection Correction = VolumeCorrection::None;
  bool Close = false;
  std::shared_ptr<const VolumeModel> Model;
  Points JoinedOffsets;        ///< its Offsets, at joined vertices their means; empty without those
  Eigen::VectorXd RestHeights; ///< ColumnHeights at rest, empty until first needed
  Points TriangleWeights;      ///< CornerWeights, empty until first needed

  PositionRows Rows; ///< of the current motion, where it needs no solve
  TurnTable::Options TableOptions;
  std::unique_ptr<TurnTable> Table;
  bool UsesTable = false;
  /// What Table was made for.
  TurnTable::Options MadeWith;
  const Points* MadeWithOffsets = nullptr;
  Eigen::VectorXd MadeForRatios;
  Eigen::VectorXd LastRatios;
};
}
