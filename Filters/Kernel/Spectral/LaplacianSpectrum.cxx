// SPDX-License-Identifier: BSD-3-Clause
#include "Spectral/LaplacianSpectrum.h"

#include "Algebra/ConstrainedSolver.h"
#include "Base/Bytes.h"
#include "Differential/Laplacian.h"
#include "Mesh/Geometry.h"
#include "Mesh/UsedVertices.h"

#include <Eigen/Eigenvalues>
#include <Spectra/SymEigsShiftSolver.h>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// So few vertices are decomposed densely, in less time than it takes to factorize.
constexpr int FewVertices = 300;

/// The shift in parts of the mean of L_ii / M_ii, which bounds the largest eigenvalue by
/// half: small against the eigenvalues that are asked for, large against rounding.
constexpr double Shift = 1e-8;

/// The used vertices and the symmetric matrix S = M^-1/2 L M^-1/2 on them, whose
/// eigenvectors y are M^1/2 phi.
struct StandardProblem
{
  std::vector<int> Vertices;
  Eigen::VectorXd RootMass; ///< of Vertices
  SparseMatrix Matrix;
};

StandardProblem MakeProblem(const TriangleMesh& mesh, const Points& points, SpectrumOperator kind,
  const ExecutionContext& context)
{
  StandardProblem problem;
  problem.Vertices = UsedVertices(mesh);
  const bool isGraph = kind == SpectrumOperator::Graph;
  const LaplacianWeights weights =
    isGraph ? LaplacianWeights::Uniform : LaplacianWeights::Cotangent;
  problem.Matrix = Laplacian(mesh, EdgeWeights(mesh, points, weights, context), problem.Vertices);
  const auto count = static_cast<Eigen::Index>(problem.Vertices.size());
  problem.RootMass = Eigen::VectorXd::Ones(count);
  if (!isGraph)
  {
    const Eigen::VectorXd areas = MixedVoronoiAreas(mesh, points, context);
    // A vertex without area has next to no mass, not none: it would have no eigenvalue.
    const double least = 1e-12 * areas.sum() / static_cast<double>(count);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      problem.RootMass[i] = std::sqrt(std::max(areas[problem.Vertices[i]], least));
    }
    const Eigen::VectorXd inverse = problem.RootMass.cwiseInverse();
    problem.Matrix = (inverse.asDiagonal() * problem.Matrix * inverse.asDiagonal()).eval();
  }
  return problem;
}

/// (S - sigma I)^-1 as Spectra asks for it, by the factorization of the Laplacian.
class ShiftedInverse
{
public:
  using Scalar = double;

  ShiftedInverse(const SparseMatrix& matrix, SolverBackend backend, const ExecutionContext& context)
    : Matrix(matrix)
    , Solver(backend)
    , Context(context)
  {
  }

  Eigen::Index rows() const { return this->Matrix.rows(); }
  Eigen::Index cols() const { return this->Matrix.cols(); }

  void set_shift(double sigma)
  {
    const std::vector<char> isFixed(this->rows(), 0);
    this->Solver.Factorize(this->Matrix, isFixed, Eigen::VectorXd::Constant(this->rows(), -sigma),
      {}, this->Context.Part(0.0, 0.2));
  }

  void perform_op(const double* in, double* out) const
  {
    const Eigen::Map<const Eigen::MatrixXd> x(in, this->rows(), 1);
    Eigen::Map<Eigen::MatrixXd>(out, this->rows(), 1) = this->Solver.SolveFree(x);
    // How many there will be is not known: the rest halves with every hundred.
    ++this->Operations;
    this->Context.Report(1.0 - 0.8 * std::exp2(-this->Operations / 100.0));
  }

private:
  const SparseMatrix& Matrix;
  ConstrainedSolver Solver;
  const ExecutionContext& Context;
  mutable int Operations = 0;
};

/// How many Lanczos vectors are kept for `count` modes: more mean fewer solves.
Eigen::Index NumberOfLanczosVectors(int count, Eigen::Index size)
{
  return std::min<Eigen::Index>(size, 2 * count + 20);
}

/// Refuses what does not fit: the modes, twice for sorting, and Lanczos' vectors.
void RequireMemory(int count, Eigen::Index size, std::uint64_t maximumBytes)
{
  const auto bytesOf = [size](std::uint64_t modes)
  { return 8 * static_cast<std::uint64_t>(size) * (4 * modes + 20); };
  if (bytesOf(static_cast<std::uint64_t>(count)) <= maximumBytes)
  {
    return;
  }
  const std::uint64_t columns = maximumBytes / (8 * static_cast<std::uint64_t>(size));
  const std::uint64_t fits = columns > 24 ? (columns - 20) / 4 : 0;
  throw Error(ErrorCode::OutOfMemory,
    std::to_string(count) + " modes of " + std::to_string(size) + " points take " +
      std::to_string(bytesOf(static_cast<std::uint64_t>(count)) / 1000000) +
      " megabytes, more than the limit of " + std::to_string(maximumBytes / 1000000) +
      (fits > 0 ? ": ask for at most " + std::to_string(fits) + ", or raise the memory limit."
                : ": raise the memory limit."));
}

/// Puts the null space, which is known, in place of the first modes: a mode that is
/// constant on one component and zero on others, for each.
int MakeNullSpaceExact(const TriangleMesh& mesh, const StandardProblem& problem,
  Eigen::VectorXd& eigenvalues, Eigen::MatrixXd& vectors)
{
  const int count = std::min(mesh.NumberOfComponents(), static_cast<int>(vectors.cols()));
  vectors.leftCols(count).setZero();
  eigenvalues.head(count).setZero();
  for (Eigen::Index i = 0; i < vectors.rows(); ++i)
  {
    const int component = mesh.Component(problem.Vertices[i]);
    if (component < count)
    {
      vectors(i, component) = problem.RootMass[i];
    }
  }
  vectors.leftCols(count).colwise().normalize();
  return count;
}

/// Orthonormalizes, which keeps the first `known` vectors, and does one step of the
/// Rayleigh-Ritz method with the others: eigenvectors of Lanczos' method are
/// orthonormal to less than all digits.
void Polish(
  const SparseMatrix& matrix, int known, Eigen::VectorXd& eigenvalues, Eigen::MatrixXd& vectors)
{
  for (int pass = 0; pass < 2; ++pass)
  {
    const Eigen::MatrixXd gram = vectors.transpose() * vectors;
    const Eigen::LLT<Eigen::MatrixXd> factor(gram);
    factor.matrixU().solveInPlace<Eigen::OnTheRight>(vectors);
  }
  const Eigen::Index others = vectors.cols() - known;
  if (others == 0)
  {
    return;
  }
  const Eigen::MatrixXd rest = vectors.rightCols(others);
  const Eigen::MatrixXd projected = rest.transpose() * (matrix * rest).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(projected);
  vectors.rightCols(others) = rest * ritz.eigenvectors();
  eigenvalues.tail(others) = ritz.eigenvalues();
}

void SolveDense(const SparseMatrix& matrix, int count, LaplacianSpectrum& spectrum)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver((Eigen::MatrixXd(matrix)));
  spectrum.Eigenvalues = solver.eigenvalues().head(count);
  spectrum.Modes = solver.eigenvectors().leftCols(count);
}

void SolveLanczos(const SparseMatrix& matrix, int count, SolverBackend backend,
  const ExecutionContext& context, LaplacianSpectrum& spectrum)
{
  const double scale = matrix.diagonal().mean();
  ShiftedInverse inverse(matrix, backend, context);
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(
    inverse, count, NumberOfLanczosVectors(count, matrix.rows()), -Shift * scale);
  solver.init();
  constexpr int MostRestarts = 1000;
  const Eigen::Index found = solver.compute(
    Spectra::SortRule::LargestMagn, MostRestarts, 1e-12, Spectra::SortRule::SmallestAlge);
  if (found < count)
  {
    throw Error(ErrorCode::NotConverged,
      "Only " + std::to_string(found) + " of " + std::to_string(count) +
        " modes have converged: ask for fewer.");
  }
  spectrum.Eigenvalues = solver.eigenvalues();
  spectrum.Modes = solver.eigenvectors();
}
}

Eigen::MatrixXd LaplacianSpectrum::Coefficients(const Field& values) const
{
  return this->Modes.transpose() * (this->Mass.asDiagonal() * values);
}

Field LaplacianSpectrum::Sum(const Eigen::MatrixXd& coefficients, int first, int last) const
{
  return this->Modes.middleCols(first, last - first) * coefficients.middleRows(first, last - first);
}

std::size_t LaplacianSpectrum::GetBytes() const
{
  return TotalBytes(this->Eigenvalues, this->Modes, this->Mass);
}

LaplacianSpectrum ComputeSpectrum(const TriangleMesh& mesh, const Points& points,
  SpectrumOperator kind, int count, std::uint64_t maximumBytes, SolverBackend backend,
  const ExecutionContext& context)
{
  const StandardProblem problem = MakeProblem(mesh, points, kind, context.Part(0.0, 0.05));
  const Eigen::Index size = problem.Matrix.rows();
  if (count < 1 || count > size)
  {
    throw Error(ErrorCode::BadInput,
      std::to_string(count) + " modes are asked for, and the surface has " + std::to_string(size) +
        ": as many as points. Ask for 1 to " + std::to_string(size) + ".");
  }
  const bool isDense = size <= FewVertices || 2 * count + 20 > size / 2;
  RequireMemory(isDense ? static_cast<int>(size) : count, size, maximumBytes);
  LaplacianSpectrum spectrum;
  if (isDense)
  {
    SolveDense(problem.Matrix, count, spectrum);
  }
  else
  {
    SolveLanczos(problem.Matrix, count, backend, context.Part(0.05, 0.95), spectrum);
  }

  const int known = MakeNullSpaceExact(mesh, problem, spectrum.Eigenvalues, spectrum.Modes);
  Polish(problem.Matrix, known, spectrum.Eigenvalues, spectrum.Modes);
  spectrum.Eigenvalues = spectrum.Eigenvalues.cwiseMax(0.0);
  spectrum.Mass = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(mesh.NumberOfVertices(), count);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const int v = problem.Vertices[i];
    spectrum.Mass[v] = problem.RootMass[i] * problem.RootMass[i];
    modes.row(v) = spectrum.Modes.row(i) / problem.RootMass[i];
  }
  for (int k = 0; k < count; ++k)
  {
    Eigen::Index largest = 0;
    modes.col(k).cwiseAbs().maxCoeff(&largest);
    modes.col(k) *= modes(largest, k) < 0.0 ? -1.0 : 1.0;
  }
  spectrum.Modes = std::move(modes);
  context.Report(1.0);
  return spectrum;
}
}
