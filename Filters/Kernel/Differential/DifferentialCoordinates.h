// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Differential/Laplacian.h"

#include <optional>

namespace cartan
{
/// What the sum over the one-ring is divided by, the n_i of DifferentialOperator.
enum class DeltaNormalization
{
  Row,        ///< by the sum of the weights: a length, the vertex minus the mean of its ring
  Integrated, ///< by nothing: for uniform weights the paper's L_s
  Area        ///< by the mixed Voronoi area: with cotangent weights twice the mean curvature
              ///< normal, in 1 / length units
};

/// The operator that makes differential coordinates of positions (Sorkine, Differential
/// Representations for Mesh Processing, Computer Graphics Forum 25(4), 2006, section 2):
///
///   delta_i = 1 / n_i sum_j w_ij (v_i - v_j).
///
/// They point outwards where the surface is convex. Rows of boundary vertices see a
/// half ring and mean nothing by themselves, though a reconstruction uses them. A
/// vertex without area around it has the mean area of all.
class DifferentialOperator
{
public:
  DifferentialOperator(const TriangleMesh& mesh, const Points& points, LaplacianWeights weights,
    DeltaNormalization normalization, const ExecutionContext& context = {});

  /// delta of `values` (#V x 3) at each vertex, as a sum of differences; zero for
  /// vertices in no triangle.
  Points Apply(
    const TriangleMesh& mesh, const Points& values, const ExecutionContext& context = {}) const;

  /// The w_ij (#D) and n_i (#V).
  const Eigen::VectorXd& GetWeights() const { return this->Weights; }
  const Eigen::VectorXd& GetDivisors() const { return this->Divisors; }

private:
  Eigen::VectorXd Weights;
  Eigen::VectorXd Divisors;
};

/// Positions from differential coordinates and anchors (section 2.2): a least-squares
/// fit of all n_i delta_i = sum_j w_ij (v_i - v_j), each with the weight 1 / m_i, where m
/// is the sum of the row's weights with DeltaNormalization::Row, else the mass of
/// LaplaceOperator. An anchor c of weight omega adds omega^2 |v_c - p_c|^2.
///
/// One factorization serves all deltas and anchor positions. What is solved for is
/// the displacement from given positions, and refined until it does not improve any
/// more: from the right deltas it reproduces these positions to rounding, and others as
/// exactly as the numbers allow.
class DifferentialReconstruction
{
public:
  struct Settings
  {
    LaplacianWeights Weights = LaplacianWeights::Cotangent;
    DeltaNormalization Normalization = DeltaNormalization::Area;
    AnchorMode Mode = AnchorMode::Hard;
    SolverBackend Backend = SolverBackend::Automatic;
    /// How far the coordinates of `points` may be from what they stand for, a length.
    double Rounding = 0.0;
  };

  /// `anchors` are vertices in increasing order, `anchorWeights` their omega > 0 (any with
  /// modes other than Soft). Throws Error(SingularSystem) naming components without one.
  DifferentialReconstruction(std::shared_ptr<const TriangleMesh> mesh,
    std::shared_ptr<const Points> points, std::vector<int> anchors,
    const Eigen::VectorXd& anchorWeights, const Settings& settings,
    const ExecutionContext& context = {});

  /// `deltas` is #V x 3, `anchorPositions` #anchors x 3. Vertices in no triangle keep
  /// their points. `uncertainty` is set to what rounding leaves open, #V x 3: the change that
  /// the last step of refinement would still make, or, where weights are so large that they
  /// hang on the last digits of `points`, that weights of other last digits would make.
  Points Reconstruct(const Points& deltas, const Points& anchorPositions,
    const ExecutionContext& context = {}, Points* uncertainty = nullptr) const;

  const DifferentialOperator& GetOperator() const { return this->Operator; }
  int GetNumberOfFactorizations() const { return this->System.GetNumberOfFactorizations(); }
  std::size_t GetBytes() const;

private:
  Points Residual(const Points& deltas, const Points& positions) const;
  double Exaggeration(const Points& deltas) const;
  Points ChangeOfOtherDigits(const Points& deltas, const Points& positions) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Points> Rest;
  std::vector<int> AnchorVertices;
  Eigen::VectorXd Masses; // of the fit
  DifferentialOperator Operator;
  std::optional<DifferentialOperator> OfOtherDigits; // where there are large weights
  AnchoredSystem System;
};
}
