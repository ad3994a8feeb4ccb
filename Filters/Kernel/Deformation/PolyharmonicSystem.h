// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleLaplacian.h"
#include "Deformation/SurfaceDeformer.h"

namespace cartan
{
/// The system K = L (M^-1 L)^(k-1) of order k on the free vertices that moving
/// handles reach, over all vertices of the mesh, the held ones eliminated: the
/// discrete Laplacian of smoothness k (Botsch and Kobbelt, An Intuitive Framework
/// for Real-time Freeform Modeling, 2004). For k = 2 it is also the matrix of
///
///   sum over all vertices of m_i |(M^-1 L x)_i - d_i|^2,
///
/// the least-squares fit to differential coordinates d, whose right-hand side is
/// L d. M are the mixed Voronoi areas over their mean, so that K has no unit;
/// the identity with uniform weights.
class PolyharmonicSystem
{
public:
  /// `order` is 1, 2 or 3. Symmetric weights from HandleProblem::Weights.
  PolyharmonicSystem(const HandleProblem& problem, int order, SolverBackend backend,
    const ExecutionContext& context);

  const std::vector<int>& GetUnknowns() const { return this->Solver.GetFree(); }
  const SparseMatrix& GetLaplacian() const { return this->Laplacian; }

  /// 1 / m, and the stiffness w^2 / 2 that holds softly: #V each.
  const Eigen::VectorXd& GetInverseMass() const { return this->InverseMass; }
  const Eigen::VectorXd& GetStiffness() const { return this->Stiffness; }

  /// M^-1 L x: #V x 3.
  Points DifferentialCoordinates(const Points& points) const;

  /// Where handles are to go: the rest with the targets of all moving handles'
  /// vertices: #V x 3.
  Points Targets(const HandleTargets& targets) const;

  /// Solves K x = b on the unknowns: `rightHandSide` is b, #V x 3; `values` has
  /// the held vertices' positions, and the soft targets, and gets the unknowns'.
  void Solve(const Points& rightHandSide, Points& values) const;

  int GetNumberOfFactorizations() const { return this->Solver.GetNumberOfFactorizations(); }

  std::size_t GetBytes() const
  {
    return this->Solver.GetBytes() + this->Problem.GetBytes() +
      TotalBytes(this->MovingHandles, this->Laplacian, this->InverseMass, this->Stiffness);
  }

private:
  HandleProblem Problem;
  std::vector<int> MovingHandles;
  SparseMatrix Laplacian;
  Eigen::VectorXd InverseMass;
  Eigen::VectorXd Stiffness;
  ConstrainedSolver Solver;
};

/// Throws Error(BadInput) for methods that know handles by their positions only.
void RequirePositions(const HandleProblem& problem, const std::string& method);
}
