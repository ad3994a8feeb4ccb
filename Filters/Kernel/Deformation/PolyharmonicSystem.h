// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Deformation/HandleLaplacian.h"
#include "Deformation/SurfaceDeformer.h"

namespace cartan
{
/// The system K = L (M^-1 L)^(k-1) of order k on the free vertices that moving
/// handles reach, the held ones eliminated: the discrete Laplacian of smoothness
/// k (Botsch and Kobbelt, An Intuitive Framework for Real-time Freeform Modeling,
/// 2004). For k = 2 it is also the matrix of
///
///   sum over all vertices of m_i |(M^-1 L x)_i - d_i|^2,
///
/// the least-squares fit to differential coordinates d, whose right-hand side is
/// L d. L and M are those of LaplaceOperator.
///
/// K's entries grow like the k-th power of L's, and rounding of K with them. So the
/// factor is tried on a solution that is known, the rest positions, when it is
/// made: what the solve misses there is the measure of its rounding, which decides
/// how often each solve is refined with residuals of L applied k times.
///
/// Its *local* numbering has the unknown vertices first, then the held vertices
/// one edge away from them, then those two edges away, up to k, which are all
/// that the system sees. Other vertices are not in it and cost nothing.
class PolyharmonicSystem
{
public:
  /// What a solve may miss of the known solution, in parts of its size, without
  /// being refined, and without a warning.
  static constexpr double RefinedError = 1e-7;
  static constexpr double WarnedError = 1e-6;

  /// `order` is 1, 2 or 3. Symmetric weights from HandleProblem::Weights.
  PolyharmonicSystem(const HandleProblem& problem, int order, SolverBackend backend,
    const ExecutionContext& context);

  /// How many locals are within so many edges of an unknown: 0 to the order.
  int NumberWithin(int edges) const { return this->RingEnds[edges]; }
  int NumberOfUnknowns() const { return this->NumberWithin(0); }
  int NumberOfLocals() const { return static_cast<int>(this->Vertices.size()); }

  /// The mesh's vertex of each local one.
  const std::vector<int>& GetVertices() const { return this->Vertices; }

  /// L between the locals. The rows of those nearer than k edges are complete.
  const SparseMatrix& GetLaplacian() const { return this->Laplacian; }

  /// 1 / m: #locals.
  const Eigen::VectorXd& GetInverseMass() const { return this->InverseMass; }

  /// What holds the locals: the unknowns softly with w^2 / 2, all others hard.
  const Anchors& GetAnchors() const { return this->Held; }

  /// The rows of the locals: #locals x 3 from #V x 3.
  Points Gather(const Points& ofVertices) const;

  /// Solves K x = b: `rightHandSide` is b (#locals x 3, read at unknowns); `values`
  /// (#V x 3) has those of held vertices and the targets of softly held ones, and
  /// gets the unknowns'. Zeros give zeros exactly, so that displacements from the
  /// rest are better unknowns than positions.
  void Solve(const Points& rightHandSide, Points& values) const;

  /// Solves K x = 0 for many functions at once: `locals` (#locals x n) has the values of
  /// held vertices and the targets of softly held ones, and gets the unknowns'.
  void Interpolate(Field& locals) const;

  /// L (M^-1 L)^(k-1) x of the locals, right at the unknowns.
  Points Apply(const Points& locals) const;

  /// M^-1 L x of the locals, right at those nearer than k edges.
  Points Differential(const Points& locals) const;

  /// What the refined solve misses of the known solution, in parts of its size.
  double GetMeasuredError() const { return this->MeasuredError; }
  int GetNumberOfRefinements() const { return this->Refinements; }

  /// Names the vertices where rounding is above WarnedError; empty if none is.
  const std::string& GetWarning() const { return this->Warning; }

  int GetNumberOfFactorizations() const { return this->System.GetNumberOfFactorizations(); }

  std::size_t GetBytes() const
  {
    return this->System.GetBytes() +
      TotalBytes(this->Vertices, this->RingEnds, this->Laplacian, this->InverseMass,
        this->Held.IsHard, this->Held.Stiffness, this->Held.Vertices);
  }

private:
  void NumberLocals(const TriangleMesh& mesh, const std::vector<char>& isUnknown, int order);
  void Refine(const Points& rightHandSide, const Points& targets, Points& values) const;
  void MeasureError(const Points& rest);
  void Warn(const Eigen::VectorXd& errors);

  int Order;
  int Refinements = 0;
  double MeasuredError = 0.0;
  std::string Warning;
  std::vector<int> Vertices;
  std::vector<int> RingEnds;
  SparseMatrix Laplacian;
  Eigen::VectorXd InverseMass;
  Anchors Held;
  AnchoredSystem System;
};

/// The problem again, or Error(BadInput) for methods that know handles by their
/// positions only where these are not held.
HandleProblem RequirePositions(HandleProblem problem, const std::string& method);
}
