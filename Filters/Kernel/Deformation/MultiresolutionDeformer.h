// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/PolyharmonicSystem.h"

namespace cartan
{
/// Two-band multiresolution editing (Kobbelt et al., Interactive Multi-Resolution
/// Modeling on Arbitrary Meshes, 1998; Sorkine, Differential Representations for
/// Mesh Processing, 2006, section 4.2): a smooth base that solves L^k x = 0
/// between the handles, and the detail as offsets in the base's local frames.
/// The base follows the handles; its frames take the detail along. The base is
/// solved for by its displacements from the rest. They are linear in the handles'
/// motions x -> A_k (x - c_k) + c_k + t_k about the middle c_k of each handle,
///
///   d = sum_k [(A_k - I) phi_k + h_k t_k],
///
/// with four numbers per vertex and moving handle, so that a drag solves nothing for the
/// base. (Targets that differ from vertex to vertex are solved for, and motions of many
/// handles, see HandleProblem::StoredHandles.)
///
/// A base need not be like the surface: that of a limb without handles is nearly a
/// point. Where the details are long against the base's one-rings, frames of these
/// rings say nothing, and the frames are spread harmonically from around instead.
class MultiresolutionDeformer : public SurfaceDeformer
{
public:
  /// The longest detail, in parts of the radius of its one-ring in the base, that a
  /// frame of this ring takes along.
  static constexpr double LongestDetail = 10.0;

  /// The radius of a one-ring in the base, in parts of that in the surface, below
  /// which the base counts as collapsed.
  static constexpr double SmallestRing = 0.1;

  /// `order` is the smoothness k of the base: 1 membrane, 2 thin plate, 3.
  MultiresolutionDeformer(HandleProblem problem, int order,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  std::string GetWarning() const override { return this->Warning; }

  /// The vertices whose frames are spread from around.
  int GetNumberOfSpreadFrames() const { return this->NumberOfSpread; }

  int GetNumberOfFactorizations() const override
  {
    return this->System.GetNumberOfFactorizations() + this->Spreading.GetNumberOfFactorizations();
  }
  int GetNumberOfFreeVertices() const override { return this->System.NumberOfUnknowns(); }
  std::size_t GetBytes() const override
  {
    return this->GetBaseBytes() + this->System.GetBytes() + this->Spreading.GetBytes() +
      TotalBytes(this->MovingHandles, this->Zero, this->RestBase, this->RestNormals, this->Changes,
        this->HandleCenters, this->BaseFields);
  }

protected:
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

private:
  void PrepareSpreading(const ExecutionContext& context);
  void ComputeBaseFields();
  void MoveBase(
    const HandleTargets& targets, Points& displacements, const ExecutionContext& context);
  void FitFrames(const Points& displacements, const ExecutionContext& context);

  PolyharmonicSystem System;
  AnchoredSystem Spreading; ///< of frames; not factorized where none is spread
  int NumberOfSpread = 0;
  std::string Warning;
  std::vector<int> MovingHandles; ///< #V, index in HandleProblem::Moving or -1
  Points Zero;                    ///< #locals x 3, the right-hand side
  bool StoresFields;              ///< whether motions are sums of these:
  Points HandleCenters;           ///< #Moving x 3, c_k
  /// #unknowns x 4 #Moving, phi_k and h_k; empty until first needed.
  Field BaseFields;
  Points RestBase;    ///< #V x 3
  Points RestNormals; ///< of the base's vertices that have a frame: #frames x 3
  /// The frames' rotations minus the identity, of the unknowns and the locals next
  /// to them: #x 9.
  Matrices Changes;
};
}
