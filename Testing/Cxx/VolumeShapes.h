// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/TetrahedronGraph.h"

#include <algorithm>
#include <array>
#include <map>

/// Bodies with an inside, and handles at their ends.
namespace shapes
{
/// The bar of 1 x 1 x 6 with 6 x 6 x 36 quads: handle 2 below z = 1, handle 1 above
/// z = 5.
inline HandleOf EndsOfBar()
{
  return [](const Eigen::Vector3d& x) {
    return x[2] <= 1.0 + 1e-9 ? 2 : x[2] >= 5.0 - 1e-9 ? 1 : 0;
  };
}

/// What moves its upper end so that the center line between the ends becomes an arc of
/// the same length.
inline cartan::HandleMotion BendOfBar(double degrees)
{
  const double angle = degrees * Pi / 180.0;
  const double radius = 4.0 / angle;
  cartan::HandleMotion motion;
  motion.RotationVector = { -angle, 0.0, 0.0 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  const Eigen::Vector3d to(0.0, radius * (1.0 - std::cos(angle)), 1.0 + radius * std::sin(angle));
  motion.Translation = to - motion.Linear * Eigen::Vector3d(0.0, 0.0, 5.0);
  return motion;
}

inline cartan::HandleMotion TwistOfBar(double degrees)
{
  cartan::HandleMotion motion;
  motion.RotationVector = { 0.0, 0.0, degrees * Pi / 180.0 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  return motion;
}

/// The tetrahedra of a bar's lattice of unit quads, six to a cube around its diagonal: a
/// Delaunay triangulation of the lattice. The nodes start with those of the surface.
struct SolidBar
{
  SolidBar(int nx, int ny, int nz, const Eigen::Vector3d& size)
    : Surface(Bar(nx, ny, nz, size))
  {
    std::vector<Eigen::Vector3d> inner;
    std::map<std::array<int, 3>, int> nodes;
    const auto place = [&](const std::array<int, 3>& at)
    {
      return Eigen::Vector3d(size[0] * (static_cast<double>(at[0]) / nx - 0.5),
        size[1] * (static_cast<double>(at[1]) / ny - 0.5),
        size[2] * at[2] / static_cast<double>(nz));
    };
    const auto node = [&](const std::array<int, 3>& at)
    {
      const auto known = nodes.find(at);
      if (known != nodes.end())
      {
        return known->second;
      }
      int id = -1;
      for (int v = 0; v < this->Surface.NumberOfVertices() && id < 0; ++v)
      {
        id = (this->Surface.Positions.row(v).transpose() - place(at)).norm() < 1e-9 ? v : -1;
      }
      if (id < 0)
      {
        id = this->Surface.NumberOfVertices() + static_cast<int>(inner.size());
        inner.push_back(place(at));
      }
      return nodes[at] = id;
    };
    std::vector<std::array<int, 4>> tetrahedra;
    const auto addCube = [&](int x, int y, int z)
    {
      std::array<int, 3> order = { 0, 1, 2 };
      do
      {
        std::array<int, 3> at = { x, y, z };
        std::array<int, 4> corners = { node(at), 0, 0, 0 };
        for (int step = 0; step < 3; ++step)
        {
          ++at[order[step]];
          corners[step + 1] = node(at);
        }
        // Odd orders run the other way around.
        const bool isOdd =
          order[(std::find(order.begin(), order.end(), 0) - order.begin() + 1) % 3] != 1;
        if (isOdd)
        {
          std::swap(corners[1], corners[2]);
        }
        tetrahedra.push_back(corners);
      } while (std::next_permutation(order.begin(), order.end()));
    };
    for (int z = 0; z < nz; ++z)
    {
      for (int y = 0; y < ny; ++y)
      {
        for (int x = 0; x < nx; ++x)
        {
          addCube(x, y, z);
        }
      }
    }
    this->Nodes.resize(
      this->Surface.NumberOfVertices() + static_cast<Eigen::Index>(inner.size()), 3);
    this->Nodes.topRows(this->Surface.NumberOfVertices()) = this->Surface.Positions;
    this->Nodes.bottomRows(static_cast<Eigen::Index>(inner.size())) = ToPoints(inner);
    this->Cells.resize(static_cast<Eigen::Index>(tetrahedra.size()), 4);
    for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    {
      for (int c = 0; c < 4; ++c)
      {
        this->Cells(static_cast<Eigen::Index>(t), c) = tetrahedra[t][c];
      }
    }
  }

  Shape Surface;
  cartan::Points Nodes;
  cartan::Tetrahedra Cells;
};
}
