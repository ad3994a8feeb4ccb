// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RealMeshes.h"

#include "Kernel/Merging/LoopPairing.h"
#include "Kernel/Merging/SeamFairing.h"
#include "Kernel/Mesh/GrowByRings.h"

#include <algorithm>
#include <map>
#include <utility>

/// What tests of merging share.
namespace shapes
{
/// A mesh in Data/Merging.
inline Shape MergeMesh(const std::string& name)
{
  return ReadShape(CARTAN_DATA_DIR "/Merging/" + name + ".off");
}

inline cartan::MergeInput MakeInput(const Shape& shape)
{
  return { std::make_shared<cartan::TriangleMesh>(MakeMesh(shape)),
    std::make_shared<cartan::Points>(shape.Positions) };
}

/// The shape without the points that no triangle uses.
inline Shape Compact(const cartan::Points& points, const std::vector<Eigen::Vector3i>& faces)
{
  std::vector<int> numbers(points.rows(), -1);
  std::vector<Eigen::Vector3d> kept;
  std::vector<Eigen::Vector3i> renumbered = faces;
  for (Eigen::Vector3i& face : renumbered)
  {
    for (int& v : face)
    {
      if (numbers[v] < 0)
      {
        numbers[v] = static_cast<int>(kept.size());
        kept.push_back(points.row(v).transpose());
      }
      v = numbers[v];
    }
  }
  Shape shape;
  shape.Positions = ToPoints(kept);
  shape.Faces = ToTriangles(renumbered);
  return shape;
}

/// What lies where normal . (x - origin) >= 0. Triangles across the plane are split, after
/// points nearer to it than .2 mean edges were moved onto it.
inline Shape CutByPlane(
  const Shape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& normal)
{
  const cartan::TriangleMesh mesh = MakeMesh(shape);
  double edges = 0.0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    edges += (shape.Positions.row(mesh.Origin(d)) - shape.Positions.row(mesh.Neighbor(d))).norm();
  }
  const double near = 0.2 * edges / mesh.NumberOfDirectedEdges();
  const Eigen::Vector3d n = normal.normalized();
  cartan::Points points = shape.Positions;
  std::vector<double> heights(points.rows());
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    heights[v] = n.dot(points.row(v).transpose() - origin);
    if (std::abs(heights[v]) < near)
    {
      points.row(v) -= heights[v] * n.transpose();
      heights[v] = 0.0;
    }
  }
  std::map<std::pair<int, int>, int> crossings;
  const auto crossing = [&](int a, int b)
  {
    const auto [entry, isNew] =
      crossings.try_emplace(std::minmax(a, b), static_cast<int>(points.rows()));
    if (isNew)
    {
      const double part = heights[a] / (heights[a] - heights[b]);
      points.conservativeResize(points.rows() + 1, 3);
      points.bottomRows<1>() = points.row(a) + part * (points.row(b) - points.row(a));
    }
    return entry->second;
  };
  std::vector<Eigen::Vector3i> faces;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    std::vector<int> corners;
    bool hasInside = false;
    for (int c = 0; c < 3; ++c)
    {
      const int a = shape.Faces(t, c);
      const int b = shape.Faces(t, (c + 1) % 3);
      hasInside = hasInside || heights[a] > 0.0;
      if (heights[a] >= 0.0)
      {
        corners.push_back(a);
      }
      if (heights[a] * heights[b] < 0.0)
      {
        corners.push_back(crossing(a, b));
      }
    }
    for (std::size_t i = 2; hasInside && i < corners.size(); ++i)
    {
      faces.emplace_back(corners[0], corners[i - 1], corners[i]);
    }
  }
  return Compact(points, faces);
}

/// The point of the boundary that is closest to a place.
inline int BoundaryPointAt(const Shape& shape, const Eigen::Vector3d& place)
{
  const cartan::TriangleMesh mesh = MakeMesh(shape);
  int best = -1;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    if (mesh.IsBoundary(v) &&
      (best < 0 ||
        (shape.Positions.row(v) - place.transpose()).norm() <
          (shape.Positions.row(best) - place.transpose()).norm()))
    {
      best = v;
    }
  }
  return best;
}

/// Two surfaces sewn together, and what is measured there.
struct Merged
{
  cartan::FittedSource Fit;
  cartan::JoinedSurface Joined;
  cartan::TriangleMesh Mesh;
  cartan::Points Positions;

  cartan::SeamAngles Angles() const { return this->Angles(this->Positions); }

  cartan::SeamAngles Angles(const cartan::Points& points) const
  {
    return cartan::MeasureSeam(this->Joined, this->Mesh, points);
  }

  /// The points after the seam and `rings` rings were made smooth.
  cartan::Points Faired(int rings) const
  {
    const std::vector<int> region =
      cartan::GrowByRings(this->Mesh, cartan::SeamVertices(this->Joined), rings);
    cartan::Points points = this->Positions;
    cartan::FairRegion(this->Mesh, region, points);
    return points;
  }

  /// The points after details were blended there.
  cartan::Points Blended(int rings) const
  {
    cartan::Points points = this->Positions;
    cartan::BlendSeam(this->Mesh, cartan::SeamVertices(this->Joined), rings, points);
    return points;
  }

  int EulerNumber() const
  {
    int used = 0;
    for (int v = 0; v < this->Mesh.NumberOfVertices(); ++v)
    {
      used += this->Mesh.IsUsed(v);
    }
    return used - this->Mesh.NumberOfEdges() + this->Mesh.NumberOfTriangles();
  }
};

/// Pairs of points with equal keys, source first.
using Keys = std::vector<std::pair<int, int>>;

/// Two surfaces that are to be sewn together.
struct MergeCase
{
  Shape Target;
  Shape Source;
  Keys Pairs;
};

/// A bumpy tube of 1640 points (a loop of 40) and one of 806 (31).
inline MergeCase TubesCase()
{
  return { MergeMesh("tubes-target"), MergeMesh("tubes-source"),
    { { 0, 25 }, { 410, 233 }, { 820, 415 }, { 1230, 623 } } };
}

/// A head of 12,556 points (a loop of 111) and a dinosaur of 2,915 without its own (32).
inline MergeCase HeadCase()
{
  MergeCase merge;
  merge.Source = CutByPlane(RealMesh("mannequin-devil"), { 0, 0, -15 }, Eigen::Vector3d::UnitZ());
  merge.Target = CutByPlane(RealMesh("dino"), { 0, -0.9, 0.9 }, { 0, 0.45, -1.0 });
  const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> places = {
    { { 0.7024, -4.0345, -15 }, { -0.0057, -0.3284, 1.1572 } },
    { { 8.7036, 6.0022, -15 }, { 0.1425, -0.1198, 1.2511 } },
    { { -0.8888, 14.6942, -15 }, { -0.0046, -0.0464, 1.2841 } },
    { { -9.1506, 7.1219, -15 }, { -0.1465, -0.12, 1.251 } }
  };
  for (const auto& [from, to] : places)
  {
    merge.Pairs.emplace_back(
      BoundaryPointAt(merge.Source, from), BoundaryPointAt(merge.Target, to));
  }
  return merge;
}

/// Both surfaces with their keys.
struct Sides
{
  Sides(const Shape& target, const Shape& source, const Keys& keys)
    : Target{ MakeInput(target), "target", std::vector<int>(target.NumberOfVertices(), 0) }
    , Source{ MakeInput(source), "source", std::vector<int>(source.NumberOfVertices(), 0) }
  {
    for (std::size_t k = 0; k < keys.size(); ++k)
    {
      this->Source.Keys[keys[k].first] = static_cast<int>(k) + 1;
      this->Target.Keys[keys[k].second] = static_cast<int>(k) + 1;
    }
  }

  cartan::MergeBoundary Target;
  cartan::MergeBoundary Source;
};

/// Loops without keys are paired by where they lie.
inline Merged Merge(const Shape& target, const Shape& source, const Keys& keys,
  const std::vector<cartan::SourceHold>& holds = {})
{
  const Sides sides(target, source, keys);
  const cartan::PairedLoops paired = cartan::PairLoops(sides.Target, sides.Source,
    holds.empty() ? cartan::LoopAlignment::BySimilarity : cartan::LoopAlignment::AsTheyLie);
  std::vector<std::vector<int>> loops;
  for (const cartan::LoopPair& pair : paired.Pairs)
  {
    loops.push_back(pair.Source);
  }
  const cartan::MeshMerge merge(sides.Source.Surface, loops, holds);
  Merged merged;
  merged.Fit = merge.Fit(sides.Target.Surface, paired.Pairs, paired.Keys);
  merged.Joined =
    cartan::JoinSurfaces(*sides.Target.Surface.Mesh, *sides.Source.Surface.Mesh, merged.Fit.Loops);
  merged.Positions = cartan::JoinedPositions(merged.Joined, target.Positions, merged.Fit.Positions);
  merged.Mesh = cartan::TriangleMesh(merged.Joined.NumberOfVertices(), merged.Joined.Faces);
  return merged;
}

/// The root mean square relative change of edges beside that of all on average.
inline double EdgeChange(const Shape& before, const cartan::Points& after)
{
  const cartan::TriangleMesh mesh = MakeMesh(before);
  Eigen::VectorXd ratios(mesh.NumberOfDirectedEdges());
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int a = mesh.Origin(d);
    const int b = mesh.Neighbor(d);
    ratios[d] = (after.row(b) - after.row(a)).norm() /
      (before.Positions.row(b) - before.Positions.row(a)).norm();
  }
  const double mean = ratios.mean();
  return std::sqrt((ratios.array() / mean - 1.0).square().mean());
}

/// x -> s R x + t.
inline cartan::Points Transformed(
  const cartan::Points& points, double scale, const RigidMotion& motion)
{
  return (
    (scale * points * motion.Rotation.transpose()).rowwise() + motion.Translation.transpose());
}
}
