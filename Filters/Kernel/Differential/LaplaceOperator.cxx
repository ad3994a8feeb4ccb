// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/LaplaceOperator.h"

#include "Algebra/SparseProduct.h"
#include "Mesh/Geometry.h"
#include "Mesh/UsedVertices.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// The edges of a triangle opposite to its corners, each longer by what the
/// smallest slack lacks.
Eigen::Vector3d MollifiedLengths(const Eigen::Vector3d& lengths)
{
  const double longest = lengths.maxCoeff();
  const double slack = lengths.sum() - 2.0 * longest;
  return lengths.array() + std::max(0.0, LaplaceOperator::SmallestSlack * longest - slack);
}

/// A triangle with these edges opposite to its corners, in the plane.
Eigen::Matrix3d TriangleOfLengths(const Eigen::Vector3d& lengths)
{
  const double a = lengths[0];
  const double b = lengths[1];
  const double c = lengths[2];
  // Corner 0 on the origin, corner 1 on the x axis, and Heron's formula.
  const double along = (b * b + c * c - a * a) / (2.0 * c);
  const double product = (a + b + c) * (b + c - a) * (c + a - b) * (a + b - c);
  Eigen::Matrix3d corners;
  corners << 0.0, 0.0, 0.0, c, 0.0, 0.0, along, std::sqrt(product) / (2.0 * c), 0.0;
  return corners;
}

/// CornerWeights with mollified edges in triangles of too little slack.
Points BoundedCornerWeights(const TriangleMesh& mesh, const Points& points,
  LaplacianWeights weights, const ExecutionContext& context)
{
  Points cornerWeights = CornerWeights(mesh, points, weights, context);
  std::vector<int> slim;
  std::vector<Eigen::Matrix3d> shapes;
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto& corners = mesh.GetTriangles().row(t);
    Eigen::Vector3d lengths;
    for (int k = 0; k < 3; ++k)
    {
      lengths[k] = (points.row(corners[(k + 1) % 3]) - points.row(corners[(k + 2) % 3])).norm();
    }
    const Eigen::Vector3d mollified = MollifiedLengths(lengths);
    // A triangle that is one point stays equilateral, as CornerWeights has it.
    if (mollified[0] > lengths[0] && lengths.maxCoeff() > 0.0)
    {
      slim.push_back(t);
      shapes.push_back(TriangleOfLengths(mollified));
    }
  }
  const auto numberOfSlim = static_cast<int>(slim.size());
  Points separate(3 * numberOfSlim, 3);
  Triangles triangles(numberOfSlim, 3);
  for (int i = 0; i < numberOfSlim; ++i)
  {
    separate.middleRows<3>(3 * i) = shapes[i];
    triangles.row(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  }
  const Points bounded =
    CornerWeights(TriangleMesh(3 * numberOfSlim, triangles), separate, weights, context);
  for (int i = 0; i < numberOfSlim; ++i)
  {
    cornerWeights.row(slim[i]) = bounded.row(i);
  }
  return cornerWeights;
}

/// What the triangle on the left of an edge adds to its weight.
double LeftWeight(const TriangleMesh& mesh, const Points& cornerWeights, int d)
{
  const int t = mesh.LeftTriangle(d);
  if (t < 0)
  {
    return 0.0;
  }
  const auto& corners = mesh.GetTriangles().row(t);
  const int apex = mesh.Opposite(d);
  return cornerWeights(t, corners[0] == apex ? 0 : (corners[1] == apex ? 1 : 2));
}

/// m_i >= r m_j for all neighbors, r < 1: raises what is less. A mass reaches few
/// rings, because it falls by r from each to the next.
void BoundRatios(const TriangleMesh& mesh, Eigen::VectorXd& mass)
{
  for (bool isChanged = true; isChanged;)
  {
    isChanged = false;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        const double least = LaplaceOperator::SmallestMassRatio * mass[mesh.Neighbor(d)];
        if (mass[v] < least)
        {
          mass[v] = least;
          isChanged = true;
        }
      }
    }
  }
}
}

LaplaceOperator::LaplaceOperator(const TriangleMesh& mesh, const Points& points,
  LaplacianWeights weights, const ExecutionContext& context, ObtuseAngles obtuse)
  : Weights(Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges()))
  , Mass(Eigen::VectorXd::Ones(mesh.NumberOfVertices()))
{
  if (weights == LaplacianWeights::Uniform)
  {
    return;
  }
  Points cornerWeights = BoundedCornerWeights(mesh, points, weights, context);
  if (obtuse == ObtuseAngles::AsZero)
  {
    cornerWeights = cornerWeights.cwiseMax(0.0);
  }
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    this->Weights[d] =
      LeftWeight(mesh, cornerWeights, d) + LeftWeight(mesh, cornerWeights, mesh.Twin(d));
  }
  Eigen::VectorXd areas = MixedVoronoiAreas(mesh, points, context);
  const double mean = areas.sum() / static_cast<double>(UsedVertices(mesh).size());
  BoundRatios(mesh, areas);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    this->Mass[v] = areas[v] > 0.0 ? areas[v] / mean : 1.0;
  }
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

Points ApplyLaplacian(const SparseMatrix& laplacian, const Points& values)
{
  Points result = Points::Zero(values.rows(), 3);
  for (Eigen::Index i = 0; i < laplacian.cols(); ++i)
  {
    for (SparseMatrix::InnerIterator entry(laplacian, i); entry; ++entry)
    {
      result.row(i) += entry.value() * (values.row(entry.index()) - values.row(i));
    }
  }
  return result;
}
}
