// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <algorithm>
#include <array>

namespace cartan
{
/// The points a surface is fitted to around one vertex. Reused from vertex to
/// vertex, so that nothing is allocated in the loop.
class FitNeighborhood
{
public:
  FitNeighborhood(const TriangleMesh& mesh, const Points& points)
    : Mesh(mesh)
    , Positions(points)
  {
  }

  /// The two-ring of v, more rings where these are too few points (at borders),
  /// and what is connected with v inside the ball through its farthest
  /// neighbor. The ball makes up for long thin triangles, whose two-ring is
  /// just as long and thin and says little about bending the other way.
  void Collect(int v)
  {
    this->Count = 0;
    this->Add(v);
    int begin = 0;
    for (int ring = 0; ring < 2 || (ring < MaximumRings && this->Count <= MinimumPoints); ++ring)
    {
      const int end = this->Count;
      for (; begin < end; ++begin)
      {
        this->ForFan(this->Ids[begin], [this](int w) { this->Add(w); });
      }
    }

    const Eigen::RowVector3d center = this->Positions.row(v);
    double radius = 0.0;
    this->ForFan(v,
      [&](int w) { radius = std::max(radius, (this->Positions.row(w) - center).squaredNorm()); });
    // Equal distances, as in a regular grid, must not be told apart by rounding.
    radius *= 1.0001;
    for (int i = 1; i < this->Count; ++i)
    {
      if ((this->Positions.row(this->Ids[i]) - center).squaredNorm() <= radius)
      {
        this->ForFan(this->Ids[i],
          [&](int w)
          {
            if ((this->Positions.row(w) - center).squaredNorm() <= radius)
            {
              this->Add(w);
            }
          });
      }
    }
  }

  /// Without the vertex itself.
  int Size() const { return this->Count - 1; }
  int operator[](int i) const { return this->Ids[i + 1]; }

private:
  template <typename Visitor>
  void ForFan(int v, Visitor visit) const
  {
    const int step = (this->Mesh.Valence(v) + MaximumFan - 1) / MaximumFan;
    for (int d = this->Mesh.RingBegin(v); d < this->Mesh.RingEnd(v); d += step)
    {
      visit(this->Mesh.Neighbor(d));
    }
  }

  void Add(int v)
  {
    const auto end = this->Ids.begin() + this->Count;
    if (this->Count < static_cast<int>(this->Ids.size()) &&
      std::find(this->Ids.begin(), end, v) == end)
    {
      this->Ids[this->Count++] = v;
    }
  }

  /// A cubic has nine coefficients without its constant one; a few points more
  /// than that let the fit average.
  static constexpr int MinimumPoints = 12;

  /// Bounds the work at vertices with many neighbors and on very anisotropic
  /// triangles. Twice as many have not made any error of our tests smaller.
  static constexpr int MaximumPoints = 64;

  /// Of a vertex with more neighbors than this, such as the pole of a sphere,
  /// only evenly spaced ones are taken: all of them would turn every
  /// neighborhood next to it into that one fan.
  static constexpr int MaximumFan = 32;

  /// Neighborhoods of fewer points than MinimumPoints grow at most this far.
  static constexpr int MaximumRings = 5;

  const TriangleMesh& Mesh;
  const Points& Positions;
  std::array<int, MaximumPoints + 1> Ids;
  int Count = 0;
};
}
