// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace cartan
{
class AnchoredSystem;

/// Chooses the anchors of a LeastSquaresMesh.
enum class AnchorSelection
{
  FarthestPoint, ///< spread over the surface, see FarthestPoints
  Greedy         ///< one in each component, then always where the error around is largest
};

/// The smoothest surface of a connectivity that passes through a few anchors (Sorkine and
/// Cohen-Or, Least-squares Meshes, 2004; Sorkine, Cohen-Or, Irony, Toledo, Geometry-aware
/// Bases for Shape Approximation, 2005):
///
///   min sum_i |v_i - mean of its ring|^2  with  v_a = p_a at anchors a.
///
/// Positions of other vertices are not used, other than to choose anchors.
///
/// One factorization serves any number of anchors. With G the inverse of the system's
/// matrix under the anchors that there are, another anchor a changes the surface by
/// G_a (p_a - v_a) / G_aa with G_a the column of a, and G by the rank-one term
/// G_a G_a^T / G_aa: a Cholesky factorization of G, pivoted by where the error is, of which
/// only the columns that are chosen are ever computed, a solve for each.
class LeastSquaresMesh
{
public:
  struct Settings
  {
    AnchorSelection Selection = AnchorSelection::Greedy;
    int NumberOfAnchors = 100;
    std::uint64_t MaximumBytes = 4000000000;
    SolverBackend Backend = SolverBackend::Automatic;
  };

  /// Chooses the anchors. Throws Error(BadInput) for fewer anchors than components or
  /// more than vertices, and Error(OutOfMemory) naming how many anchors fit.
  LeastSquaresMesh(const TriangleMesh& mesh, const Points& points, const Settings& settings,
    const ExecutionContext& context = {});

  /// With given anchors, at least one per component, all at once. Throws
  /// Error(SingularSystem) naming components without one, and what the other one throws.
  LeastSquaresMesh(const TriangleMesh& mesh, const Points& points, std::vector<int> anchors,
    std::uint64_t maximumBytes, SolverBackend backend = SolverBackend::Automatic,
    const ExecutionContext& context = {});

  /// In the order in which they were chosen.
  const std::vector<int>& GetAnchors() const { return this->AnchorVertices; }

  /// The least number of anchors that there is a surface of: one per component, or
  /// all given ones.
  int NumberOfBaseAnchors() const { return static_cast<int>(this->Base.cols()); }

  /// The surface through the first `count` anchors, from NumberOfBaseAnchors() to all.
  /// Vertices in no triangle keep their place.
  Points Surface(int count) const;

  /// The distances of Surface(count) from the points: their root mean square and maximum,
  /// for each count from NumberOfBaseAnchors().
  const std::vector<double>& GetRootMeanSquares() const { return this->RootMeanSquares; }
  const std::vector<double>& GetMaxima() const { return this->Maxima; }

  /// A function for each of the first `count` anchors that is 1 there and 0 at the others
  /// of them; the surface is their sum, weighted by the anchors' positions: #V x count.
  Eigen::MatrixXd BasisFunctions(int count) const;

  std::size_t GetBytes() const;

private:
  void Prepare(const TriangleMesh& mesh, const Points& points, int numberOfBase,
    SolverBackend backend, const ExecutionContext& context);
  void RecordErrors(const Points& surface);

  std::vector<int> AnchorVertices;
  std::shared_ptr<const AnchoredSystem> System;
  Points Rest;
  std::vector<char> IsUsed;
  Points BaseSurface;      ///< through the base anchors
  Eigen::MatrixXd Base;    ///< #V x #base: their functions
  Eigen::MatrixXd Columns; ///< #V x #others: the Cholesky factor of G
  Eigen::MatrixXd Steps;   ///< #others x 3: what multiplies them
  std::vector<double> RootMeanSquares;
  std::vector<double> Maxima;
};
}
