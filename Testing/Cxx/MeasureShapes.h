// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RealMeshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

/// Surfaces that are deformed in a known way, for the tests of measures.
namespace shapes
{
/// A sheet of height 1 along z rolled about the z axis: isometric, up to the
/// chords, to the flat one.
inline Shape Rolled(const Shape& flat, double radius)
{
  Shape rolled = flat;
  for (int v = 0; v < flat.NumberOfVertices(); ++v)
  {
    const double angle = flat.Positions(v, 0) / radius;
    rolled.Positions.row(v) << radius * std::sin(angle), flat.Positions(v, 1),
      radius * (1.0 - std::cos(angle));
  }
  return rolled;
}

/// Bends the middle of a bar along z about the y axis by `angle`, rigid below
/// z = from and above z = to, and thins the middle to (1 - thinning).
inline cartan::Points BentBar(
  const cartan::Points& bar, double from, double to, double angle, double thinning = 0.0)
{
  cartan::Points bent = bar;
  const double radius = (to - from) / angle;
  for (Eigen::Index v = 0; v < bar.rows(); ++v)
  {
    const double z = bar(v, 2);
    const double along = std::min(std::max(z - from, 0.0), to - from);
    const double scale = 1.0 - thinning * std::sin(Pi * along / (to - from));
    const double x = scale * bar(v, 0);
    const double turn = along / radius;
    const double beyond = z - from - along;
    bent.row(v) << radius * (1.0 - std::cos(turn)) + x * std::cos(turn) + beyond * std::sin(turn),
      scale * bar(v, 1),
      from + radius * std::sin(turn) - x * std::sin(turn) + beyond * std::cos(turn);
  }
  return bent;
}

/// The surface where `field` is zero, inside where it is negative, by marching
/// tetrahedra on a grid of count^3 cubes over [-size, size]^3: edges of all lengths
/// down to next to none, and slivers, as isosurface filters make them.
class MarchingTetrahedra
{
public:
  template <typename Field>
  MarchingTetrahedra(int count, double size, const Field& field)
    : Count(count)
    , Size(size)
  {
    for (int corner = 0; corner < (count + 1) * (count + 1) * (count + 1); ++corner)
    {
      this->Values.push_back(field(this->Position(corner)));
    }
    // The six ways from a cube's corner to the opposite one along its edges.
    int way[3] = { 0, 1, 2 };
    do
    {
      for (int cube = 0; cube < count * count * count; ++cube)
      {
        int place[3] = { cube % count, cube / count % count, cube / (count * count) };
        int corners[4] = { this->Corner(place) };
        for (int i = 0; i < 3; ++i)
        {
          ++place[way[i]];
          corners[i + 1] = this->Corner(place);
        }
        this->March(corners);
      }
    } while (std::next_permutation(way, way + 3));
  }

  Shape Get() const { return { ToPoints(this->Vertices), ToTriangles(this->Faces) }; }

private:
  int Corner(const int* place) const
  {
    return (place[2] * (this->Count + 1) + place[1]) * (this->Count + 1) + place[0];
  }
  /// Moved a little, so that no corner is on a surface with symmetries.
  Eigen::Vector3d Position(int corner) const
  {
    const int n = this->Count + 1;
    const Eigen::Vector3d place(corner % n, corner / n % n, corner / (n * n));
    return this->Size * (2.0 / this->Count * place.array() - 1.0).matrix() +
      this->Size * Eigen::Vector3d(0.0123, -0.0071, 0.0031);
  }
  int Cut(int inside, int outside)
  {
    const auto [place, isNew] =
      this->Cuts.emplace(std::make_pair(inside, outside), static_cast<int>(this->Vertices.size()));
    if (isNew)
    {
      const double part = this->Values[inside] / (this->Values[inside] - this->Values[outside]);
      this->Vertices.push_back(
        (1.0 - part) * this->Position(inside) + part * this->Position(outside));
    }
    return place->second;
  }
  void Add(int a, int b, int c, const Eigen::Vector3d& inside)
  {
    const Eigen::Vector3d normal =
      (this->Vertices[b] - this->Vertices[a]).cross(this->Vertices[c] - this->Vertices[a]);
    const bool isOutward = normal.dot(this->Vertices[a] - inside) > 0.0;
    this->Faces.emplace_back(a, isOutward ? b : c, isOutward ? c : b);
  }
  void March(const int* corners)
  {
    std::vector<int> in;
    std::vector<int> out;
    Eigen::Vector3d inside = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4; ++i)
    {
      (this->Values[corners[i]] < 0.0 ? in : out).push_back(corners[i]);
    }
    for (const int corner : in)
    {
      inside += this->Position(corner) / static_cast<double>(in.size());
    }
    if (in.size() == 1)
    {
      this->Add(
        this->Cut(in[0], out[0]), this->Cut(in[0], out[1]), this->Cut(in[0], out[2]), inside);
    }
    else if (in.size() == 3)
    {
      this->Add(
        this->Cut(in[0], out[0]), this->Cut(in[1], out[0]), this->Cut(in[2], out[0]), inside);
    }
    else if (in.size() == 2)
    {
      const int a = this->Cut(in[0], out[0]);
      const int c = this->Cut(in[1], out[1]);
      this->Add(a, this->Cut(in[0], out[1]), c, inside);
      this->Add(a, c, this->Cut(in[1], out[0]), inside);
    }
  }

  int Count;
  double Size;
  std::vector<double> Values;
  std::map<std::pair<int, int>, int> Cuts;
  std::vector<Eigen::Vector3d> Vertices;
  std::vector<Eigen::Vector3i> Faces;
};
}
