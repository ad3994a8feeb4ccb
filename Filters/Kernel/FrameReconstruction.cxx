// SPDX-License-Identifier: BSD-3-Clause
#include "FrameReconstruction.h"

#include "Laplacian.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// Unused vertices are in no equation: they count as fixed.
std::vector<char> FixUnused(const TriangleMesh& mesh, std::vector<char> isFixed)
{
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    isFixed[v] = isFixed[v] || !mesh.IsUsed(v);
  }
  return isFixed;
}
}

SparseMatrix FrameMatrix(const TriangleMesh& mesh, const Transitions& transitions)
{
  const int numberOfVertices = mesh.NumberOfVertices();
  SparseMatrix matrix(3 * numberOfVertices, 3 * numberOfVertices);
  matrix.reserve(9 * (mesh.NumberOfDirectedEdges() + numberOfVertices));
  std::vector<std::pair<int, Eigen::Matrix3d>> blocks; // of one block column
  for (int j = 0; j < numberOfVertices; ++j)
  {
    // |X_j - C_ij^T X_i|^2 adds I to block (j, j), C_ij C_ij^T to (i, i) and
    // -C_ij to (i, j); both directions of each edge are equations.
    blocks.clear();
    Eigen::Matrix3d diagonal = Eigen::Matrix3d::Zero();
    for (int d = mesh.RingBegin(j); d < mesh.RingEnd(j); ++d)
    {
      const Eigen::Matrix3d outgoing = MatrixAt(transitions, d);
      const Eigen::Matrix3d incoming = MatrixAt(transitions, mesh.Twin(d));
      diagonal += outgoing * outgoing.transpose();
      if (!incoming.isZero(0.0))
      {
        diagonal += Eigen::Matrix3d::Identity();
      }
      blocks.emplace_back(mesh.Neighbor(d), -(incoming + outgoing.transpose()));
    }
    blocks.emplace_back(j, diagonal);
    std::sort(blocks.begin(), blocks.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
    for (int column = 0; column < 3; ++column)
    {
      matrix.startVec(3 * j + column);
      for (const auto& [i, block] : blocks)
      {
        for (int row = 0; row < 3; ++row)
        {
          matrix.insertBack(3 * i + row, 3 * j + column) = block(row, column);
        }
      }
    }
  }
  matrix.finalize();
  return matrix;
}

Matrices SolveFrames(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices frames, ConstrainedSolver& solver,
  const ExecutionContext& context)
{
  const std::vector<char> isFixedVertex = FixUnused(mesh, isFixed);
  const int numberOfVertices = mesh.NumberOfVertices();
  std::vector<char> isFixedUnknown(3 * static_cast<std::size_t>(numberOfVertices));
  std::vector<int> vertices(isFixedUnknown.size());
  Field transposed(3 * numberOfVertices, 3);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    std::fill_n(isFixedUnknown.begin() + 3 * static_cast<std::size_t>(v), 3, isFixedVertex[v]);
    std::fill_n(vertices.begin() + 3 * static_cast<std::size_t>(v), 3, v);
    transposed.middleRows<3>(3 * v) = MatrixAt(frames, v).transpose();
  }
  solver.Factorize(FrameMatrix(mesh, transitions), isFixedUnknown, {}, vertices, context);
  solver.Solve(Field::Zero(3 * numberOfVertices, 3), transposed);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    MatrixAt(frames, v) = transposed.middleRows<3>(3 * v).transpose();
  }
  return frames;
}

Points SolvePositions(const TriangleMesh& mesh, const Matrices& frames, const Points& ring,
  const std::vector<char>& isFixed, Points positions, ConstrainedSolver& solver,
  const ExecutionContext& context)
{
  // The normal equations of Eq. 5 over both directions of each edge are
  // 2 L x = sum_j (F_j c_ji - F_i c_ij) with the graph Laplacian L.
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges());
  Field rightHandSide = Field::Zero(mesh.NumberOfVertices(), 3);
  for (int i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int d = mesh.RingBegin(i); d < mesh.RingEnd(i); ++d)
    {
      sum += MatrixAt(frames, mesh.Neighbor(d)) * ring.row(mesh.Twin(d)).transpose() -
        MatrixAt(frames, i) * ring.row(d).transpose();
    }
    rightHandSide.row(i) = 0.5 * sum;
  }
  const std::vector<char> isGiven = FixUnused(mesh, isFixed);
  solver.Factorize(Laplacian(mesh, ones), isGiven, {}, {}, context);

  // Relative to a fixed position of each component, so that a seed far from the
  // origin costs no digits.
  std::vector<int> references(mesh.NumberOfComponents(), -1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isFixed[v] && mesh.IsUsed(v) && references[mesh.Component(v)] < 0)
    {
      references[mesh.Component(v)] = v;
    }
  }
  Field solution = Field::Zero(mesh.NumberOfVertices(), 3);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isFixed[v] && mesh.IsUsed(v))
    {
      solution.row(v) = positions.row(v) - positions.row(references[mesh.Component(v)]);
    }
  }
  solver.Solve(rightHandSide, solution);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!isGiven[v])
    {
      positions.row(v) = positions.row(references[mesh.Component(v)]) + solution.row(v);
    }
  }
  return positions;
}
}
