// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Morph/SurfaceMorph.h"
#include "TestShapes.h"

#include <algorithm>
#include <cmath>

/// Key frames with known in-betweens, and what is measured on these.
namespace morphshapes
{
/// Key frames at even parameters from 0 to 1.
inline cartan::KeyFrames Keys(const shapes::Shape& shape, std::vector<cartan::Points> positions)
{
  cartan::KeyFrames keys;
  keys.Mesh = std::make_shared<cartan::TriangleMesh>(shape.NumberOfVertices(), shape.Faces);
  for (std::size_t k = 0; k < positions.size(); ++k)
  {
    keys.Parameters.push_back(static_cast<double>(k) / (static_cast<double>(positions.size()) - 1));
  }
  keys.Positions = std::move(positions);
  return keys;
}

/// What is along z, bent about the x axis at an even rate between two heights,
/// by this many degrees in all; rigid outside.
inline cartan::Points Bend(const shapes::Shape& shape, double degrees, double from, double to)
{
  const double angle = degrees * shapes::Pi / 180.0;
  const double radius = (to - from) / angle;
  cartan::Points bent(shape.Positions.rows(), 3);
  for (Eigen::Index v = 0; v < bent.rows(); ++v)
  {
    const Eigen::Vector3d x = shape.Positions.row(v);
    const double inside = std::clamp(x[2], from, to);
    const double a = angle * (inside - from) / (to - from);
    const double arm = radius - x[1];
    bent.row(v) << x[0], radius - arm * std::cos(a) + (x[2] - inside) * std::sin(a),
      from + arm * std::sin(a) + (x[2] - inside) * std::cos(a);
  }
  return bent;
}

/// The same about the z axis: a twist.
inline cartan::Points Twist(const shapes::Shape& shape, double degrees, double from, double to)
{
  cartan::Points twisted(shape.Positions.rows(), 3);
  for (Eigen::Index v = 0; v < twisted.rows(); ++v)
  {
    const Eigen::Vector3d x = shape.Positions.row(v);
    const double part = (std::clamp(x[2], from, to) - from) / (to - from);
    const Eigen::AngleAxisd turn(degrees * shapes::Pi / 180.0 * part, Eigen::Vector3d::UnitZ());
    twisted.row(v) = (turn * x).transpose();
  }
  return twisted;
}

/// Any shape, bent along one of its axes over its whole extent.
inline cartan::Points BendAlong(shapes::Shape shape, int axis, double degrees)
{
  cartan::Points turned(shape.Positions.rows(), 3);
  for (int c = 0; c < 3; ++c)
  {
    turned.col(c) = shape.Positions.col((axis + 1 + c) % 3);
  }
  turned.rowwise() -= turned.colwise().mean().eval();
  shape.Positions = turned;
  return Bend(shape, degrees, turned.col(2).minCoeff(), turned.col(2).maxCoeff());
}

/// Degrees by which the edge of a bar of square cross-section at one end is
/// turned about z against the other, full turns counted along the edge. For surfaces
/// that are twisted about the z axis but may lie anywhere.
inline double TotalTwist(const shapes::Shape& bar, const cartan::Points& positions)
{
  // Levels of the bar: the corner (low x, low y) and the opposite one.
  std::vector<std::pair<double, std::pair<int, int>>> levels;
  const double low = bar.Positions.col(0).minCoeff();
  const double high = bar.Positions.col(0).maxCoeff();
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    if (bar.Positions(v, 0) == low && bar.Positions(v, 1) == low)
    {
      for (int w = 0; w < bar.NumberOfVertices(); ++w)
      {
        if (bar.Positions(w, 0) == high && bar.Positions(w, 1) == high &&
          bar.Positions(w, 2) == bar.Positions(v, 2))
        {
          levels.push_back({ bar.Positions(v, 2), { v, w } });
        }
      }
    }
  }
  std::sort(levels.begin(), levels.end());
  const auto diagonal = [&](std::size_t level) -> Eigen::Vector3d
  {
    const auto [v, w] = levels[level].second;
    return (positions.row(w) - positions.row(v)).transpose().normalized();
  };
  const auto center = [&](std::size_t level) -> Eigen::Vector3d
  {
    const auto [v, w] = levels[level].second;
    return 0.5 * (positions.row(w) + positions.row(v)).transpose();
  };
  const Eigen::Vector3d axis = (center(levels.size() - 1) - center(0)).normalized();
  double total = 0.0;
  for (std::size_t level = 1; level < levels.size(); ++level)
  {
    const Eigen::Vector3d before = diagonal(level - 1);
    const Eigen::Vector3d after = diagonal(level);
    total += std::atan2(before.cross(after).dot(axis), before.dot(after));
  }
  return total * 180.0 / shapes::Pi;
}

struct MorphFigures
{
  double Volume = 0.0; ///< over that between the first and the last key frame
  /// Relative deviation of edges from the length between those of both.
  double EdgeRms = 0.0;
  double EdgeMax = 0.0;
};

inline MorphFigures MeasureMorph(
  const cartan::KeyFrames& keys, const cartan::Points& positions, double t)
{
  const cartan::TriangleMesh& mesh = *keys.Mesh;
  const auto volume = [&mesh](const cartan::Points& points)
  {
    double sum = 0.0;
    for (int f = 0; f < mesh.NumberOfTriangles(); ++f)
    {
      const Eigen::RowVector3i face = mesh.GetTriangles().row(f);
      const Eigen::RowVector3d a = points.row(face[0]) - points.row(0);
      const Eigen::RowVector3d b = points.row(face[1]) - points.row(0);
      const Eigen::RowVector3d c = points.row(face[2]) - points.row(0);
      sum += a.dot(b.cross(c)) / 6.0;
    }
    return sum;
  };
  const auto length = [&mesh](const cartan::Points& points, int d)
  { return (points.row(mesh.Origin(d)) - points.row(mesh.Neighbor(d))).norm(); };
  MorphFigures figures;
  figures.Volume = volume(positions) /
    ((1 - t) * volume(keys.Positions.front()) + t * volume(keys.Positions.back()));
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const double expected =
      (1 - t) * length(keys.Positions.front(), d) + t * length(keys.Positions.back(), d);
    const double error = std::abs(length(positions, d) / expected - 1.0);
    figures.EdgeRms += error * error / mesh.NumberOfDirectedEdges();
    figures.EdgeMax = std::max(figures.EdgeMax, error);
  }
  figures.EdgeRms = std::sqrt(figures.EdgeRms);
  return figures;
}
}
