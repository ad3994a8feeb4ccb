// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/TriangleFeatures.h"

#include "Algebra/Rotation.h"
#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>
#include <vector>

namespace cartan
{
namespace
{
/// Two edges and the unit normal; zero for a triangle without area.
Eigen::Matrix3d Basis(const Eigen::Ref<const Eigen::Matrix3d>& corners)
{
  Eigen::Matrix3d basis;
  basis.col(0) = corners.col(1) - corners.col(0);
  basis.col(1) = corners.col(2) - corners.col(0);
  const Eigen::Vector3d twiceArea = basis.col(0).cross(basis.col(1));
  if (!HasArea(
        twiceArea.norm(), LongestEdgeSquared(corners.col(0), corners.col(1), corners.col(2))))
  {
    return Eigen::Matrix3d::Zero();
  }
  basis.col(2) = twiceArea.normalized();
  return basis;
}

/// The rotation of the map that takes each triangle of `from` to that of `to`,
/// both #T x 9, after `to` has been turned so that their mean is the identity;
/// zero where one triangle has no area. Throws Error(BadInput) for components
/// without any.
Matrices TriangleRotations(
  const TriangleMesh& mesh, const Matrices& from, MeanRotation mean, Matrices& to)
{
  Matrices rotations(mesh.NumberOfTriangles(), 9);
  std::vector<Eigen::Matrix3d> means(mesh.NumberOfComponents(), Eigen::Matrix3d::Zero());
  std::vector<char> hasTriangle(mesh.NumberOfComponents(), 0);
  const auto componentOf = [&mesh](int t) { return mesh.Component(mesh.GetTriangles()(t, 0)); };
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::Matrix3d source = Basis(MatrixAt(from, t));
    const Eigen::Matrix3d target = Basis(MatrixAt(to, t));
    rotations.row(t).setZero();
    if (!source.isZero(0.0) && !target.isZero(0.0))
    {
      MatrixAt(rotations, t) = ProjectOnRotations(target * source.inverse());
      means[componentOf(t)] += MatrixAt(rotations, t);
      hasTriangle[componentOf(t)] = 1;
    }
  }
  IdSample flat;
  for (std::size_t c = 0; c < means.size(); ++c)
  {
    if (!hasTriangle[c])
    {
      flat.Add(static_cast<long long>(c));
    }
  }
  if (mean == MeanRotation::OfSurface)
  {
    const Eigen::Matrix3d sum =
      std::accumulate(means.begin(), means.end(), Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
    std::fill(means.begin(), means.end(), sum);
  }
  if (!flat.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The surface has " + flat.Describe("component", "components") +
        " in which no triangle has an area in both of two key frames: remove such components, or "
        "choose another method.");
  }
  for (Eigen::Matrix3d& rotation : means)
  {
    rotation = ProjectOnRotations(rotation);
  }
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::Matrix3d back = means[componentOf(t)].transpose();
    MatrixAt(rotations, t) = (back * MatrixAt(rotations, t)).eval();
    MatrixAt(to, t) = (back * MatrixAt(to, t)).eval();
  }
  return rotations;
}

/// The triangles across the edges of one; -1 at the boundary.
Eigen::Vector3i NeighborTriangles(const TriangleMesh& mesh, int t)
{
  Eigen::Vector3i neighbors;
  for (int corner = 0; corner < 3; ++corner)
  {
    int d = mesh.RingBegin(mesh.GetTriangles()(t, corner));
    while (mesh.LeftTriangle(d) != t)
    {
      ++d;
    }
    neighbors[corner] = mesh.LeftTriangle(mesh.Twin(d));
  }
  return neighbors;
}

/// The triangle of each component that has the shortest of `vectors`, among those
/// with a rotation: #components.
std::vector<int> LeastTurned(
  const TriangleMesh& mesh, const Matrices& rotations, const Points& vectors)
{
  std::vector<int> least(mesh.NumberOfComponents(), -1);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    int& ofComponent = least[mesh.Component(mesh.GetTriangles()(t, 0))];
    if (!rotations.row(t).isZero(0.0) &&
      (ofComponent < 0 || vectors.row(t).norm() < vectors.row(ofComponent).norm()))
    {
      ofComponent = t;
    }
  }
  return least;
}

/// Rotation vectors that mean `rotations` (#T x 9) and are near to those of
/// neighbors: #T x 3. Spreads from the least turned triangle of each component
/// over the most alike neighbors first. Triangles without a rotation take their
/// neighbor's.
Points ConsistentVectors(const TriangleMesh& mesh, const Matrices& rotations)
{
  const int numberOfTriangles = mesh.NumberOfTriangles();
  Points vectors = Points::Zero(numberOfTriangles, 3);
  for (int t = 0; t < numberOfTriangles; ++t)
  {
    if (!rotations.row(t).isZero(0.0))
    {
      vectors.row(t) = VectorFromRotation(MatrixAt(rotations, t)).transpose();
    }
  }
  // How far apart, the triangle, the neighbor it takes its branch from.
  using Step = std::tuple<double, int, int>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
  std::vector<char> isDone(numberOfTriangles, 0);
  const auto nearTo = [&](int t, const Eigen::Vector3d& guess)
  {
    return rotations.row(t).isZero(0.0) ? guess : VectorFromRotation(MatrixAt(rotations, t), guess);
  };
  const auto settle = [&](int t)
  {
    isDone[t] = 1;
    const Eigen::Vector3d vector = vectors.row(t);
    for (const int neighbor : NeighborTriangles(mesh, t))
    {
      if (neighbor >= 0 && !isDone[neighbor])
      {
        queue.emplace((nearTo(neighbor, vector) - vector).norm(), neighbor, t);
      }
    }
  };
  for (const int seed : LeastTurned(mesh, rotations, vectors))
  {
    settle(seed);
    while (!queue.empty())
    {
      const auto [distance, t, from] = queue.top();
      queue.pop();
      if (!isDone[t])
      {
        vectors.row(t) = nearTo(t, vectors.row(from).transpose()).transpose();
        settle(t);
      }
    }
  }
  return vectors;
}
}

Matrices TriangleCorners(const TriangleMesh& mesh, const Points& positions)
{
  Matrices corners(mesh.NumberOfTriangles(), 9);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    auto triangle = MatrixAt(corners, t);
    for (int corner = 0; corner < 3; ++corner)
    {
      triangle.col(corner) = positions.row(mesh.GetTriangles()(t, corner)).transpose();
    }
    const Eigen::Vector3d center = triangle.rowwise().mean();
    triangle.colwise() -= center;
  }
  return corners;
}

Matrices TriangleFrames(const TriangleMesh& mesh, const Matrices& corners)
{
  Matrices frames(mesh.NumberOfTriangles(), 9);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::Matrix3d basis = Basis(MatrixAt(corners, t));
    auto frame = MatrixAt(frames, t);
    frame.setIdentity();
    if (!basis.isZero(0.0))
    {
      frame.col(0) = basis.col(0).normalized();
      frame.col(2) = basis.col(2);
      frame.col(1) = basis.col(2).cross(frame.col(0));
    }
  }
  return frames;
}

Matrices InFrames(const Matrices& frames, const Matrices& corners)
{
  Matrices local(corners.rows(), 9);
  for (Eigen::Index t = 0; t < corners.rows(); ++t)
  {
    MatrixAt(local, t) = MatrixAt(frames, t).transpose() * MatrixAt(corners, t);
  }
  return local;
}

TriangleFeatures FeaturesOf(const TriangleMesh& mesh, const Matrices& rest, const Matrices& frames,
  const Points& positions, MeanRotation mean)
{
  TriangleFeatures features;
  features.Corners = TriangleCorners(mesh, positions);
  const Matrices rotations = TriangleRotations(mesh, rest, mean, features.Corners);
  features.Vectors = ConsistentVectors(mesh, rotations);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::Vector3d vector = features.Vectors.row(t);
    MatrixAt(features.Corners, t) =
      (RotationFromVector(-vector) * MatrixAt(features.Corners, t)).eval();
    features.Vectors.row(t) = (MatrixAt(frames, t).transpose() * vector).transpose();
  }
  // In the triangles' own frames, so that turning the poses changes no number.
  features.Corners = InFrames(frames, features.Corners);
  return features;
}
}
