// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/FrameReconstruction.h"

#include "Algebra/ConjugateGradients.h"
#include "Algebra/Rotation.h"
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

/// X_i = F_i^T, one below the other.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

Columns TransposedFrames(const Matrices& frames)
{
  Columns transposed(3 * frames.rows(), 3);
  for (Eigen::Index v = 0; v < frames.rows(); ++v)
  {
    transposed.middleRows<3>(3 * v) = MatrixAt(frames, v).transpose();
  }
  return transposed;
}

void ClearGiven(const std::vector<char>& isGiven, Columns& columns)
{
  for (std::size_t v = 0; v < isGiven.size(); ++v)
  {
    if (isGiven[v])
    {
      columns.middleRows<3>(3 * static_cast<Eigen::Index>(v)).setZero();
    }
  }
}

/// Next to the inverse of the frames' matrix: the unknown X_i is S_i^T Y_i in the
/// gauge of the start's frames S_i, where the matrix is close to 2 L on each of the
/// nine entries of Y.
class FramePreconditioner
{
public:
  FramePreconditioner(
    const Matrices& start, const AnchoredSystem& laplacian, const std::vector<char>& isGiven)
    : Start(start)
    , Laplacian(laplacian)
    , IsGiven(isGiven)
    , Turned(start.rows(), 9)
    , Solved(Field::Zero(start.rows(), 9))
  {
  }

  Columns operator()(const Columns& residual)
  {
    for (Eigen::Index v = 0; v < this->Start.rows(); ++v)
    {
      MatrixAt(this->Turned, v) = MatrixAt(this->Start, v) * residual.middleRows<3>(3 * v);
    }
    this->Laplacian.Solve(this->Turned, this->Solved);
    Columns result(residual.rows(), 3);
    for (Eigen::Index v = 0; v < this->Start.rows(); ++v)
    {
      result.middleRows<3>(3 * v) =
        0.5 * MatrixAt(this->Start, v).transpose() * MatrixAt(this->Solved, v);
    }
    ClearGiven(this->IsGiven, result);
    return result;
  }

private:
  const Matrices& Start;
  const AnchoredSystem& Laplacian;
  const std::vector<char>& IsGiven;
  Matrices Turned;
  Matrices Solved; ///< zero where frames are given
};

/// Sets frames from those of `isFixed` on, vertex by vertex: F_j = F_i C_ij. Returns the
/// largest |F_i C_ij - F_j|; infinity where a used vertex is reached over zeros only.
double CarryFrames(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices& frames)
{
  std::vector<char> isKnown = FixUnused(mesh, isFixed);
  std::vector<int> order;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isFixed[v])
    {
      order.push_back(v);
    }
  }
  double misfit = 0.0;
  for (std::size_t next = 0; next < order.size(); ++next)
  {
    const int i = order[next];
    for (int d = mesh.RingBegin(i); d < mesh.RingEnd(i); ++d)
    {
      const int j = mesh.Neighbor(d);
      if (MatrixAt(transitions, d).isZero(0.0))
      {
        continue;
      }
      const Eigen::Matrix3d carried = MatrixAt(frames, i) * MatrixAt(transitions, d);
      if (!isKnown[j])
      {
        MatrixAt(frames, j) = ProjectOnRotations(carried);
        isKnown[j] = 1;
        order.push_back(j);
      }
      misfit = std::max(misfit, (carried - MatrixAt(frames, j)).norm());
    }
  }
  const bool isWhole =
    std::all_of(isKnown.begin(), isKnown.end(), [](char known) { return known != 0; });
  return isWhole ? misfit : std::numeric_limits<double>::infinity();
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

FactorLimits FrameLimits()
{
  FactorLimits limits;
  limits.Use = FactorUse::OneSolve;
  limits.GroupSize = 3;
  return limits;
}

Matrices SolveFrames(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices frames, AnchoredSystem& system,
  const ExecutionContext& context, const Eigen::VectorXd& weights)
{
  return SolveFrames(
    mesh, FrameMatrix(mesh, transitions, weights), isFixed, std::move(frames), system, context);
}

Matrices SolveFrames(const TriangleMesh& mesh, SparseMatrix&& matrix,
  const std::vector<char>& isFixed, Matrices frames, AnchoredSystem& system,
  const ExecutionContext& context)
{
  system.Factorize(std::move(matrix), Anchors::Hard(FixUnused(mesh, isFixed)).Repeated(3), context);
  Field solution = TransposedFrames(frames);
  system.Interpolate(solution);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    MatrixAt(frames, v) = solution.middleRows<3>(3 * v).transpose();
  }
  return frames;
}

Matrices SolveFramesFrom(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices start, const AnchoredSystem& laplacian, int* steps,
  const ExecutionContext& context, const Eigen::VectorXd& weights, int maximumSteps)
{
  const std::vector<char> isGiven = FixUnused(mesh, isFixed);
  const SparseMatrix matrix = FrameMatrix(mesh, transitions, weights);
  const auto apply = [&](const Columns& columns)
  {
    Columns image = matrix * columns;
    ClearGiven(isGiven, image);
    return image;
  };
  FramePreconditioner precondition(start, laplacian, isGiven);
  Columns solution = TransposedFrames(start);
  // Transitions that fit the start exactly leave rounding only.
  const double rounding = std::numeric_limits<double>::epsilon() * solution.norm();
  const ConjugateGradientsResult result = ConjugateGradients(solution, Columns(-apply(solution)),
    apply, precondition, { 1e-10, maximumSteps, rounding * rounding },
    [&](int step, double) { context.Report(static_cast<double>(step) / maximumSteps); });
  if (!result.HasConverged)
  {
    throw Error(ErrorCode::NotConverged,
      "The frames of the interpolated surface were not found after " +
        std::to_string(maximumSteps) +
        " steps of conjugate gradients: choose Direct or RotationAveraging as FrameSolver.");
  }
  if (steps)
  {
    *steps = result.Steps;
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!isGiven[v])
    {
      MatrixAt(start, v) = solution.middleRows<3>(3 * v).transpose();
    }
  }
  return start;
}

Matrices ReconstructFrames(const TriangleMesh& mesh, const Transitions& transitions,
  const std::vector<char>& isFixed, Matrices frames, const AnchoredSystem& laplacian,
  const ExecutionContext& context)
{
  // Forms of a surface take a step or two. With carried frames that miss each other by
  // more than this the steps take longer than a factorization, as 40 always do.
  constexpr double largestMisfit = 0.03;
  constexpr int maximumSteps = 40;
  Matrices start = frames;
  if (CarryFrames(mesh, transitions, isFixed, start) <= largestMisfit)
  {
    try
    {
      return SolveFramesFrom(mesh, transitions, isFixed, std::move(start), laplacian, nullptr,
        context.Part(0.0, 0.5), {}, maximumSteps);
    }
    catch (const Error& error)
    {
      if (error.GetCode() != ErrorCode::NotConverged)
      {
        throw;
      }
    }
  }
  AnchoredSystem system(SolverBackend::Automatic, FrameLimits());
  return SolveFrames(mesh, transitions, isFixed, std::move(frames), system, context.Part(0.5, 1.0));
}

AnchoredSystem ReconstructionSystem(
  const TriangleMesh& mesh, const std::vector<char>& isFixed, const ExecutionContext& context)
{
  AnchoredSystem system;
  system.Factorize(Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges())),
    Anchors::Hard(FixUnused(mesh, isFixed)), context);
  return system;
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
  const std::vector<char>& isFixed, Points positions, const AnchoredSystem& system,
  const ExecutionContext& context)
{
  const std::vector<char> isGiven = FixUnused(mesh, isFixed);
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
  system.Solve(PositionRightHandSide(mesh, frames, ring, context), solution);
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
