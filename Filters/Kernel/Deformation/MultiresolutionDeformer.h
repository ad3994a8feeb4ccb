// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/PolyharmonicSystem.h"

namespace cartan
{
/// Two-band multiresolution editing (Kobbelt et al., Interactive Multi-Resolution
/// Modeling on Arbitrary Meshes, 1998; Sorkine, Differential Representations for
/// Mesh Processing, 2006, section 4.2): a smooth base that solves L^k x = 0
/// between the handles, and the detail as offsets in the base's local frames.
/// The base follows the handles; its frames take the detail along.
class MultiresolutionDeformer : public SurfaceDeformer
{
public:
  /// `order` is the smoothness k of the base: 1 membrane, 2 thin plate, 3.
  MultiresolutionDeformer(HandleProblem problem, int order,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  void Deform(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

  int GetNumberOfFactorizations() const override
  {
    return this->System.GetNumberOfFactorizations();
  }
  int GetNumberOfFreeVertices() const override { return this->System.NumberOfUnknowns(); }
  std::size_t GetBytes() const override
  {
    return this->Problem.GetBytes() + this->System.GetBytes() +
      TotalBytes(this->MovingHandles, this->Zero, this->RestBase, this->Rotations);
  }

private:
  PolyharmonicSystem System;
  std::vector<int> MovingHandles; ///< #V, index in HandleProblem::Moving or -1
  Points Zero;                    ///< #locals x 3, the right-hand side
  Points RestBase;                ///< #V x 3
  Matrices Rotations;             ///< #unknowns x 9, of the base's local frames
};
}
