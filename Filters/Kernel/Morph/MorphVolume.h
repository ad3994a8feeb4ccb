// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Gives surfaces between key frames the volumes between theirs.
class MorphVolume
{
public:
  /// Components take part that enclose volume in all key frames, everywhere of the
  /// same sign: the wall of a cavity, whose volume is negative, does too.
  explicit MorphVolume(const KeyFrames& keys, const ExecutionContext& context = {});

  /// Why some components do not take part, in a sentence; empty if all do.
  const std::string& GetWarning() const { return this->Warning; }

  /// Moves `positions` (#V x 3) along A^-1 grad V, with the graph Laplacian A:
  /// of all changes of the volume by the same amount the smoothest. Returns what
  /// could not be closed, in a sentence; empty if nothing.
  std::string Close(double t, Points& positions) const;

  std::size_t GetBytes() const
  {
    return this->Volumes.GetBytes() + this->Laplacian.GetBytes() + BytesOf(this->TakesPart);
  }

private:
  std::shared_ptr<const TriangleMesh> Mesh;
  KeyInterpolation Volumes; // #components rows
  std::vector<char> TakesPart;
  AnchoredSystem Laplacian;
  std::string Warning;
};
}
