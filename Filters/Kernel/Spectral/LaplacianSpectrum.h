// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <cstdint>

namespace cartan
{
enum class SpectrumOperator
{
  Graph,    ///< L phi = lambda phi of uniform weights: the connectivity alone
  Cotangent ///< L phi = lambda M phi with mixed Voronoi areas M: lambda in 1 / squared length
};

/// The modes of lowest frequency of a surface: the eigenvectors of the smallest
/// eigenvalues of its Laplacian (Karni and Gotsman, Spectral Compression of Mesh Geometry,
/// 2000, for the graph's; Sorkine, Differential Representations for Mesh Processing, 2006,
/// section 3.1). Each component has one eigenvalue zero, whose mode is constant on it and
/// zero on the others.
///
/// Modes of equal eigenvalues are any basis of the space that they span: single ones
/// mean nothing there. A mode's entry of largest size is positive.
struct LaplacianSpectrum
{
  Eigen::VectorXd Eigenvalues; ///< #modes, increasing, >= 0
  Eigen::MatrixXd Modes;       ///< #V x #modes; Modes^T M Modes = I; zero at unused vertices
  Eigen::VectorXd Mass;        ///< #V: M; ones for the graph, zero at unused vertices

  int NumberOfModes() const { return static_cast<int>(this->Eigenvalues.size()); }

  /// The coefficients of a field: Modes^T M values, #modes x k.
  Eigen::MatrixXd Coefficients(const Field& values) const;

  /// The sum of modes [first, last) with these coefficients: #V x k.
  Field Sum(const Eigen::MatrixXd& coefficients, int first, int last) const;

  std::size_t GetBytes() const;
};

/// Computes `count` modes, 1 <= count <= the number of used vertices. Throws Error(BadInput)
/// for another count, naming the largest; Error(OutOfMemory) naming how many modes fit into
/// `maximumBytes`, without the factorization; and what LowestEigenpairs throws.
LaplacianSpectrum ComputeSpectrum(const TriangleMesh& mesh, const Points& points,
  SpectrumOperator kind, int count, std::uint64_t maximumBytes,
  SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});
}
