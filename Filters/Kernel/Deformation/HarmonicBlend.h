// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleLaplacian.h"

namespace cartan
{
/// Blends what is known of each moving handle over the surface with weights h_k,
/// harmonic, 1 on handle k and 0 on the others (HandleLaplacian::HarmonicFields).
/// The weights are kept, or, with many handles, each blend is solved for: the
/// same up to rounding.
class HarmonicBlend
{
public:
  HarmonicBlend(const HandleProblem& problem, std::shared_ptr<const HandleLaplacian> system);

  /// Whether h_k are kept (see StoresHandleFields), and those: #locals x #Moving.
  bool IsStored() const { return this->Stores; }
  const Field& GetWeights() const { return this->Weights; }

  /// sum_k h_k c_k for the rows c_k of `ofHandles` (#Moving x n): #locals x n.
  Field Blend(const Field& ofHandles, const ExecutionContext& context) const;

  std::size_t GetBytes() const { return TotalBytes(this->Weights); }

private:
  std::shared_ptr<const HandleLaplacian> System;
  bool Stores;
  Field Weights;
};
}
