// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/Laplacian.h"

#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cartan
{
namespace
{
/// What the triangle on the left of an edge from p to q, with apex r, adds to
/// the weight of p -> q (`forward`) and of q -> p (`backward`).
struct Contribution
{
  double Forward;
  double Backward;
};

Contribution TriangleContribution(LaplacianWeights weights, const Eigen::Vector3d& p,
  const Eigen::Vector3d& q, const Eigen::Vector3d& r)
{
  if (weights == LaplacianWeights::Uniform)
  {
    return { 1.0, 1.0 };
  }
  const double longestSquared = LongestEdgeSquared(p, q, r);
  const double twiceArea = (q - p).cross(r - p).norm();
  if (weights == LaplacianWeights::Cotangent)
  {
    const double half = 0.5 * Cotangent((p - r).dot(q - r), twiceArea, longestSquared);
    return { half, half };
  }
  if (!HasArea(twiceArea, longestSquared))
  {
    const double equilateral = longestSquared > 0.0 ? 1.0 / std::sqrt(3.0 * longestSquared) : 0.0;
    return { equilateral, equilateral };
  }
  // tan(a/2) = sin a / (1 + cos a), written so that nothing cancels.
  const double length = (q - p).norm();
  const auto halfTangent = [twiceArea](const Eigen::Vector3d& u, const Eigen::Vector3d& v)
  {
    const double lengths = u.norm() * v.norm();
    const double dot = u.dot(v);
    return dot > 0.0 ? twiceArea / (lengths + dot) : (lengths - dot) / twiceArea;
  };
  return { halfTangent(q - p, r - p) / length, halfTangent(p - q, r - q) / length };
}
}

Eigen::VectorXd EdgeWeights(const TriangleMesh& mesh, const Points& points,
  LaplacianWeights weights, const ExecutionContext& context)
{
  Eigen::VectorXd edgeWeights = Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges());
  if (weights == LaplacianWeights::Uniform)
  {
    return edgeWeights;
  }
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const Eigen::Vector3d p = points.row(v);
          const Eigen::Vector3d q = points.row(mesh.Neighbor(d));
          double weight = 0.0;
          const int left = mesh.NextAround(v, d);
          if (left >= 0)
          {
            const Eigen::Vector3d apex = points.row(mesh.Neighbor(left));
            weight += TriangleContribution(weights, p, q, apex).Forward;
          }
          const int right = mesh.Opposite(mesh.Twin(d));
          if (right >= 0)
          {
            const Eigen::Vector3d apex = points.row(right);
            weight += TriangleContribution(weights, q, p, apex).Backward;
          }
          edgeWeights[d] = weight;
        }
      }
    });
  return edgeWeights;
}

Points CornerWeights(const TriangleMesh& mesh, const Points& points, LaplacianWeights weights,
  const ExecutionContext& context)
{
  const Triangles& triangles = mesh.GetTriangles();
  Points cornerWeights(triangles.rows(), 3);
  context.For(mesh.NumberOfTriangles(),
    [&](int begin, int end)
    {
      for (int t = begin; t < end; ++t)
      {
        for (int corner = 0; corner < 3; ++corner)
        {
          const Eigen::Vector3d apex = points.row(triangles(t, corner));
          const Eigen::Vector3d p = points.row(triangles(t, (corner + 1) % 3));
          const Eigen::Vector3d q = points.row(triangles(t, (corner + 2) % 3));
          const Contribution contribution = TriangleContribution(weights, p, q, apex);
          cornerWeights(t, corner) = 0.5 * (contribution.Forward + contribution.Backward);
        }
      }
    });
  if (weights == LaplacianWeights::Uniform)
  {
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      const int t = mesh.LeftTriangle(d);
      if (t >= 0 && mesh.LeftTriangle(mesh.Twin(d)) >= 0)
      {
        const int apex = mesh.Opposite(d);
        const int corner = triangles(t, 0) == apex ? 0 : (triangles(t, 1) == apex ? 1 : 2);
        cornerWeights(t, corner) = 0.5;
      }
    }
  }
  return cornerWeights;
}

Eigen::VectorXd SymmetricPart(const TriangleMesh& mesh, const Eigen::VectorXd& edgeWeights)
{
  Eigen::VectorXd symmetric(edgeWeights.size());
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    symmetric[d] = 0.5 * (edgeWeights[d] + edgeWeights[mesh.Twin(d)]);
  }
  return symmetric;
}

SparseMatrix Laplacian(const TriangleMesh& mesh, const Eigen::VectorXd& edgeWeights)
{
  std::vector<int> all(mesh.NumberOfVertices());
  std::iota(all.begin(), all.end(), 0);
  return Laplacian(mesh, edgeWeights, all);
}

SparseMatrix Laplacian(
  const TriangleMesh& mesh, const Eigen::VectorXd& edgeWeights, const std::vector<int>& vertices)
{
  std::vector<int> local(mesh.NumberOfVertices(), -1);
  const auto size = static_cast<Eigen::Index>(vertices.size());
  Eigen::Index entries = size;
  for (Eigen::Index i = 0; i < size; ++i)
  {
    local[vertices[i]] = static_cast<int>(i);
    entries += mesh.Valence(vertices[i]);
  }
  SparseMatrix laplacian(size, size);
  laplacian.reserve(entries);
  std::vector<std::pair<int, double>> column;
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const int v = vertices[i];
    column.clear();
    double sum = 0.0;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      sum += edgeWeights[d];
      if (local[mesh.Neighbor(d)] >= 0)
      {
        column.emplace_back(local[mesh.Neighbor(d)], -edgeWeights[mesh.Twin(d)]);
      }
    }
    if (mesh.IsUsed(v))
    {
      column.emplace_back(static_cast<int>(i), sum);
    }
    std::sort(column.begin(), column.end());
    laplacian.startVec(i);
    for (std::size_t k = 0; k < column.size(); ++k)
    {
      // Several edges may lead to one vertex where vertices are joined.
      if (k + 1 < column.size() && column[k].first == column[k + 1].first)
      {
        column[k + 1].second += column[k].second;
        continue;
      }
      laplacian.insertBack(column[k].first, i) = column[k].second;
    }
  }
  laplacian.finalize();
  return laplacian;
}

SparseMatrix GraphLaplacian(int numberOfNodes,
  const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& edges,
  const Eigen::VectorXd& weights)
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(4 * static_cast<std::size_t>(edges.rows()));
  for (Eigen::Index e = 0; e < edges.rows(); ++e)
  {
    const int i = edges(e, 0);
    const int j = edges(e, 1);
    entries.emplace_back(i, i, weights[e]);
    entries.emplace_back(j, j, weights[e]);
    entries.emplace_back(i, j, -weights[e]);
    entries.emplace_back(j, i, -weights[e]);
  }
  SparseMatrix laplacian(numberOfNodes, numberOfNodes);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}
}
