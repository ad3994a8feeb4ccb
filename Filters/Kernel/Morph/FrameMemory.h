// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/Types.h"

#include <cmath>
#include <map>

namespace cartan
{
/// The frames of a morph at its key frames: starting points for those in between.
/// What was found at other parameters is none, or the result would depend on what
/// was asked for before.
class FrameMemory
{
public:
  void AddKey(double parameter, Matrices frames) { this->Keys[parameter] = std::move(frames); }

  /// The key frame nearest to t, and its frames.
  struct Known
  {
    double Parameter;
    const Matrices& Frames;
  };
  Known Nearest(double t) const
  {
    auto nearest = this->Keys.begin();
    for (auto key = this->Keys.begin(); key != this->Keys.end(); ++key)
    {
      nearest = std::abs(key->first - t) < std::abs(nearest->first - t) ? key : nearest;
    }
    return { nearest->first, nearest->second };
  }

  std::size_t GetBytes() const
  {
    std::size_t bytes = 0;
    for (const auto& key : this->Keys)
    {
      bytes += BytesOf(key.second);
    }
    return bytes;
  }

private:
  std::map<double, Matrices> Keys;
};
}
