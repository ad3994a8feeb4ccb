// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/LaplaceOperator.h"

#include "Algebra/SparseProduct.h"
#include "Mesh/Geometry.h"

#include <algorithm>

namespace cartan
{
LaplaceOperator::LaplaceOperator(const TriangleMesh& mesh, const Points& points,
  LaplacianWeights weights, const ExecutionContext& context)
  : Weights(SymmetricPart(mesh, EdgeWeights(mesh, points, weights, context)))
  , Mass(Eigen::VectorXd::Ones(mesh.NumberOfVertices()))
{
  if (weights == LaplacianWeights::Uniform)
  {
    return;
  }
  const Eigen::VectorXd areas = MixedVoronoiAreas(mesh, points, context);
  int numberOfUsed = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    numberOfUsed += mesh.IsUsed(v) ? 1 : 0;
  }
  const double mean = areas.sum() / numberOfUsed;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    // A vertex whose triangles have no area counts as an average one.
    this->Mass[v] = areas[v] > 1e-12 * mean ? areas[v] / mean : 1.0;
  }
}

SparseMatrix LaplaceOperator::Restricted(
  const TriangleMesh& mesh, const std::vector<int>& vertices) const
{
  std::vector<int> local(mesh.NumberOfVertices(), -1);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    local[vertices[i]] = static_cast<int>(i);
  }
  const auto size = static_cast<Eigen::Index>(vertices.size());
  SparseMatrix matrix(size, size);
  // Rounds of 6 neighbors are the mean.
  matrix.reserve(7 * size);
  std::vector<std::pair<int, double>> column;
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const int v = vertices[i];
    column.clear();
    double sum = 0.0;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      sum += this->Weights[d];
      if (local[mesh.Neighbor(d)] >= 0)
      {
        column.emplace_back(local[mesh.Neighbor(d)], -this->Weights[d]);
      }
    }
    column.emplace_back(static_cast<int>(i), sum);
    std::sort(column.begin(), column.end());
    matrix.startVec(i);
    for (const auto& [row, value] : column)
    {
      matrix.insertBack(row, i) = value;
    }
  }
  matrix.finalize();
  return matrix;
}

SparseMatrix PolyharmonicMatrix(
  const SparseMatrix& laplacian, const Eigen::VectorXd& inverseMass, int order)
{
  SparseMatrix matrix = laplacian;
  for (int k = 1; k < order; ++k)
  {
    matrix = CheckedProduct(SparseMatrix(matrix * inverseMass.asDiagonal()), laplacian,
      "The system of order " + std::to_string(order));
  }
  return matrix;
}
}
