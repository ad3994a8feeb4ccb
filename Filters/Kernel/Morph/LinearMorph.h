// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// The coordinates themselves interpolated, to compare with: shrinks whatever
/// turns. Leaves each component in its place.
class LinearMorph : public SurfaceMorph
{
public:
  explicit LinearMorph(const KeyFrames& keys);
  Points Evaluate(double t, const ExecutionContext& context) override;

private:
  KeyInterpolation Coordinates; // 3 #V rows
};
}
