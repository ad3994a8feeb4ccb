// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/FrameDeformer.h"
#include "Deformation/HarmonicBlend.h"

#include <optional>

namespace cartan
{
enum class Propagation
{
  Harmonic, ///< weights harmonic between the handles (Zayer et al. 2005)
  Geodesic  ///< weights by geodesic distance (Yu et al. 2004)
};

/// Poisson editing (Yu et al., Mesh Editing with Poisson-Based Gradient Field
/// Manipulation, 2004; Zayer et al., Harmonic Guidance for Surface Deformation,
/// 2005; Sorkine, Differential Representations for Mesh Processing, 2006,
/// section 4.3): the handles' linear maps are blended with the identity, each
/// gradient of the coordinates is transformed, and the positions fit the
/// transformed gradients best. With cotangent weights this is the position system
/// of FrameDeformer with a map per triangle, that of the mean of the weights at
/// its corners.
///
/// Geodesic weights fall with the distances d_k from the moving handles and d_0
/// from the pinned ones: w_k = d_k^-1 / (d_0^-1 + sum_j d_j^-1).
class PoissonDeformer : public FrameDeformer
{
public:
  PoissonDeformer(HandleProblem problem, Propagation propagation,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});
  std::size_t GetBytes() const override
  {
    return FrameDeformer::GetBytes() + (this->Harmonic ? this->Harmonic->GetBytes() : 0) +
      TotalBytes(this->Geodesic);
  }

  /// Throws Error(BadInput) for targets that are not one motion per handle.
  static void RequireMotions(const HandleTargets& targets);

protected:
  bool ServesPieces() const override
  {
    return this->VolumeServesPieces() && this->Harmonic.has_value();
  }
  void ComputeTransforms(const HandleTargets& targets, const ExecutionContext& context) override;

private:
  std::optional<HarmonicBlend> Harmonic;
  Field Geodesic; ///< #locals x #Moving, their weights; empty with harmonic ones
};
}
