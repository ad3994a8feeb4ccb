// SPDX-License-Identifier: BSD-3-Clause
#include "Spectral/LaplacianSpectrum.h"

#include "Algebra/LowestEigenpairs.h"
#include "Base/Bytes.h"
#include "Differential/Laplacian.h"
#include "Mesh/Geometry.h"
#include "Mesh/UsedVertices.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
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

/// Refuses what does not fit.
void RequireMemory(int count, Eigen::Index size, std::uint64_t maximumBytes)
{
  const auto bytesOf = [size](int modes)
  { return 8 * static_cast<std::uint64_t>(size) * VectorsOfEigenpairs(modes, size); };
  int fits = count;
  while (fits > 0 && bytesOf(fits) > maximumBytes)
  {
    --fits;
  }
  if (fits < count)
  {
    throw Error(ErrorCode::OutOfMemory,
      std::to_string(count) + " modes of " + std::to_string(size) + " points take " +
        std::to_string(bytesOf(count) / 1000000) + " megabytes, more than the limit of " +
        std::to_string(maximumBytes / 1000000) +
        (fits > 0 ? ": ask for at most " + std::to_string(fits) + ", or raise the memory limit."
                  : ": raise the memory limit."));
  }
}

/// The null space, which is known: a mode for each component that is constant on it in
/// units of the root of the mass and zero on others; the first `most` of them.
Eigen::MatrixXd NullSpace(const TriangleMesh& mesh, const StandardProblem& problem, int most)
{
  const int count = std::min(mesh.NumberOfComponents(), most);
  Eigen::MatrixXd vectors = Eigen::MatrixXd::Zero(problem.Matrix.rows(), count);
  for (Eigen::Index i = 0; i < vectors.rows(); ++i)
  {
    const int component = mesh.Component(problem.Vertices[i]);
    if (component < count)
    {
      vectors(i, component) = problem.RootMass[i];
    }
  }
  vectors.colwise().normalize();
  return vectors;
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
  RequireMemory(count, size, maximumBytes);
  Eigenpairs pairs = LowestEigenpairs(
    problem.Matrix, NullSpace(mesh, problem, count), count, backend, context.Part(0.05, 0.95));

  LaplacianSpectrum spectrum;
  spectrum.Eigenvalues = std::move(pairs.Values);
  spectrum.Mass = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  spectrum.Modes = Eigen::MatrixXd::Zero(mesh.NumberOfVertices(), count);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const int v = problem.Vertices[i];
    spectrum.Mass[v] = problem.RootMass[i] * problem.RootMass[i];
    spectrum.Modes.row(v) = pairs.Vectors.row(i) / problem.RootMass[i];
  }
  for (int k = 0; k < count; ++k)
  {
    Eigen::Index largest = 0;
    spectrum.Modes.col(k).cwiseAbs().maxCoeff(&largest);
    spectrum.Modes.col(k) *= spectrum.Modes(largest, k) < 0.0 ? -1.0 : 1.0;
  }
  context.Report(1.0);
  return spectrum;
}
}
