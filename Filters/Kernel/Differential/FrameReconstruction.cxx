// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/FrameReconstruction.h"

#include "Algebra/SparseProduct.h"
#include "Differential/Laplacian.h"

#include <algorithm>
#include <limits>

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

/// That of a directed edge, 1 where none are given.
double WeightOf(const Eigen::VectorXd& weights, int d)
{
  return weights.size() ? weights[d] : 1.0;
}
}

SparseMatrix FrameMatrix(
  const TriangleMesh& mesh, const Transitions& transitions, const Eigen::VectorXd& weights)
{
  const int numberOfVertices = mesh.NumberOfVertices();
  const std::int64_t blocksInAll =
    static_cast<std::int64_t>(mesh.NumberOfDirectedEdges()) + numberOfVertices;
  RequireIndexable(9 * blocksInAll, "The system of the frames");
  SparseMatrix matrix(3 * numberOfVertices, 3 * numberOfVertices);
  matrix.reserve(9 * blocksInAll);
  std::vector<std::pair<int, Eigen::Matrix3d>> blocks; // of one block column
  for (int j = 0; j < numberOfVertices; ++j)
  {
    // w |X_j - C_ij^T X_i|^2 adds w I to block (j, j), w C_ij C_ij^T to (i, i) and
    // -w C_ij to (i, j); both directions of each edge are equations.
    blocks.clear();
    Eigen::Matrix3d diagonal = Eigen::Matrix3d::Zero();
    for (int d = mesh.RingBegin(j); d < mesh.RingEnd(j); ++d)
    {
      const Eigen::Matrix3d outgoing = MatrixAt(transitions, d);
      const Eigen::Matrix3d incoming = MatrixAt(transitions, mesh.Twin(d));
      const double weight = WeightOf(weights, d);
      diagonal += weight * outgoing * outgoing.transpose();
      if (!incoming.isZero(0.0))
      {
        diagonal += weight * Eigen::Matrix3d::Identity();
      }
      blocks.emplace_back(mesh.Neighbor(d), -weight * (incoming + outgoing.transpose()));
    }
    blocks.emplace_back(j, diagonal);
    std::sort(
      blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
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
  const ExecutionContext& context, const Eigen::VectorXd& weights)
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
  solver.Factorize(FrameMatrix(mesh, transitions, weights), isFixedUnknown, {}, vertices, context);
  solver.Solve(Field::Zero(3 * numberOfVertices, 3), transposed);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    MatrixAt(frames, v) = transposed.middleRows<3>(3 * v).transpose();
  }
  return frames;
}

Matrices SolveFramesFrom(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices start, const ConstrainedSolver& laplacian, int* steps,
  const ExecutionContext& context, const Eigen::VectorXd& weights)
{
  constexpr double tolerance = 1e-10;
  constexpr int maximumSteps = 1000;
  const std::vector<char> isGiven = FixUnused(mesh, isFixed);
  const int numberOfVertices = mesh.NumberOfVertices();
  const SparseMatrix matrix = FrameMatrix(mesh, transitions, weights);
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  const auto clearGiven = [&](Columns& columns)
  {
    for (int v = 0; v < numberOfVertices; ++v)
    {
      if (isGiven[v])
      {
        columns.middleRows<3>(3 * v).setZero();
      }
    }
  };
  // The unknown X_i = F_i^T is S_i^T Y_i in the gauge of the start's frames S_i,
  // where the matrix is close to 2 L on each of the nine entries of Y.
  Field turned(numberOfVertices, 9);
  Field solved = Field::Zero(numberOfVertices, 9);
  const auto precondition = [&](const Columns& residual)
  {
    for (int v = 0; v < numberOfVertices; ++v)
    {
      Eigen::Map<Eigen::Matrix3d>(turned.data() + 9 * static_cast<Eigen::Index>(v)) =
        MatrixAt(start, v) * residual.middleRows<3>(3 * v);
    }
    laplacian.Solve(turned, solved);
    Columns result(3 * numberOfVertices, 3);
    for (int v = 0; v < numberOfVertices; ++v)
    {
      result.middleRows<3>(3 * v) = 0.5 * MatrixAt(start, v).transpose() *
        Eigen::Map<const Eigen::Matrix3d>(solved.data() + 9 * static_cast<Eigen::Index>(v));
    }
    clearGiven(result);
    return result;
  };

  Columns solution(3 * numberOfVertices, 3);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    solution.middleRows<3>(3 * v) = MatrixAt(start, v).transpose();
  }
  Columns residual = -(matrix * solution);
  clearGiven(residual);
  Columns preconditioned = precondition(residual);
  Columns direction = preconditioned;
  double product = residual.cwiseProduct(preconditioned).sum();
  // Transitions that fit the start exactly leave rounding only.
  const double goal = std::max(tolerance * tolerance * product,
    std::numeric_limits<double>::epsilon() * std::numeric_limits<double>::epsilon() *
      solution.squaredNorm());
  int step = 0;
  while (product > goal)
  {
    if (++step > maximumSteps)
    {
      throw Error(ErrorCode::NotConverged,
        "The frames of the interpolated surface were not found after " +
          std::to_string(maximumSteps) +
          " steps of conjugate gradients: choose Direct or RotationAveraging as FrameSolver.");
    }
    Columns image = matrix * direction;
    clearGiven(image);
    const double length = product / direction.cwiseProduct(image).sum();
    solution += length * direction;
    residual -= length * image;
    preconditioned = precondition(residual);
    const double next = residual.cwiseProduct(preconditioned).sum();
    direction = preconditioned + next / product * direction;
    product = next;
    context.Report(static_cast<double>(step) / maximumSteps);
  }
  if (steps)
  {
    *steps = step;
  }
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (!isGiven[v])
    {
      MatrixAt(start, v) = solution.middleRows<3>(3 * v).transpose();
    }
  }
  return start;
}

Field PositionRightHandSide(const TriangleMesh& mesh, const Matrices& frames, const Points& ring,
  const ExecutionContext& context, const Eigen::VectorXd& weights)
{
  // The normal equations of Eq. 5 over both directions of each edge are
  // 2 L x = sum_j w_ij (F_j c_ji - F_i c_ij) with the graph Laplacian L.
  Field rightHandSide = Field::Zero(mesh.NumberOfVertices(), 3);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (int d = mesh.RingBegin(i); d < mesh.RingEnd(i); ++d)
        {
          sum += WeightOf(weights, d) *
            (MatrixAt(frames, mesh.Neighbor(d)) * ring.row(mesh.Twin(d)).transpose() -
              MatrixAt(frames, i) * ring.row(d).transpose());
        }
        rightHandSide.row(i) = 0.5 * sum;
      }
    });
  return rightHandSide;
}

Points SolvePositions(const TriangleMesh& mesh, const Matrices& frames, const Points& ring,
  const std::vector<char>& isFixed, Points positions, ConstrainedSolver& solver,
  const ExecutionContext& context)
{
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges());
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
  solver.Solve(PositionRightHandSide(mesh, frames, ring, context), solution);
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
