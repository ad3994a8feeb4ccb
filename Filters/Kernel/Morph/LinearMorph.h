// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Interpolates coordinates, for comparison: shrinks all parts that turn. Each
/// component keeps its own position.
class LinearMorph : public SurfaceMorph
{
public:
  explicit LinearMorph(const KeyFrames& keys);
  Points Evaluate(const MorphPlace& place, const ExecutionContext& context) override;
  std::size_t GetBytes() const override { return this->Coordinates.GetBytes(); }

private:
  KeyInterpolation Coordinates; // 3 #V rows
};
}
