// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/Types.h"

#include <cmath>
#include <map>

namespace cartan
{
/// The frames of a morph at its key frames and at the last parameter: starting
/// points for the frames at another parameter.
class FrameMemory
{
public:
  void AddKey(double parameter, Matrices frames) { this->Keys[parameter] = std::move(frames); }
  void SetLast(double parameter, Matrices frames)
  {
    this->LastParameter = parameter;
    this->Last = std::move(frames);
  }

  /// The parameter nearest to t whose frames are known, and these.
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
    return this->Last.size() && std::abs(this->LastParameter - t) < std::abs(nearest->first - t)
      ? Known{ this->LastParameter, this->Last }
      : Known{ nearest->first, nearest->second };
  }

  std::size_t GetBytes() const
  {
    std::size_t bytes = BytesOf(this->Last);
    for (const auto& key : this->Keys)
    {
      bytes += BytesOf(key.second);
    }
    return bytes;
  }

private:
  std::map<double, Matrices> Keys;
  double LastParameter = 0.0;
  Matrices Last;
};
}
