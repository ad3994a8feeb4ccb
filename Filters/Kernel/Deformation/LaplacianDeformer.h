// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/PolyharmonicSystem.h"

#include <memory>

namespace cartan
{
enum class LaplacianRotations
{
  None,      ///< differential coordinates keep their direction
  Estimated, ///< rotated as the result of the previous round turned (Lipman et al. 2004)
  Implicit   ///< similarities linear in the unknown positions (Sorkine et al. 2004)
};

/// Laplacian editing (Sorkine, Differential Representations for Mesh Processing,
/// 2006, sections 2 and 4.3): positions whose differential coordinates M^-1 L x
/// fit the rotated rest ones, T_i d_i, best over all vertices.
///
/// Estimated: T_i is the rotation that fits the two-ring of i in the last result
/// best; each round is one back-substitution (Lipman et al., Differential
/// Coordinates for Interactive Mesh Editing, 2004).
///
/// Implicit: T_i = s I + [h]x fits the one-ring of i best, linear in the unknown
/// positions, so that one system over 3 #V unknowns finds both (Sorkine et al.,
/// Laplacian Surface Editing, 2004, Eq. 7 of the survey). Its linearized
/// rotations change the size; a second solve takes the rotation of each T_i and
/// leaves its scale.
class LaplacianDeformer : public SurfaceDeformer
{
public:
  LaplacianDeformer(HandleProblem problem, LaplacianRotations rotations,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  /// The rounds of estimation, >= 1; 5 is past any visible change.
  void SetRounds(int rounds) { this->Rounds = rounds; }

  void Deform(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

  int GetNumberOfFactorizations() const override
  {
    return this->System.GetNumberOfFactorizations() +
      this->ImplicitSolver.GetNumberOfFactorizations();
  }
  int GetNumberOfFreeVertices() const override
  {
    return static_cast<int>(this->System.GetUnknowns().size());
  }
  std::size_t GetBytes() const override
  {
    return this->Problem.GetBytes() + this->System.GetBytes() + this->ImplicitSolver.GetBytes() +
      TotalBytes(this->Differential, this->Rows, this->TwoRings, this->Transforms, this->Fits);
  }

private:
  void FindRows();
  void PrepareImplicit(const ExecutionContext& context);
  void EstimateRotations(const Points& current, const ExecutionContext& context);
  void SolveImplicitly(Points& positions);
  void SolveRotated(const HandleTargets& targets, Points& positions) const;

  LaplacianRotations Rotations;
  PolyharmonicSystem System;
  int Rounds = 5;
  Points Differential; ///< #V x 3, of the rest
  /// The vertices whose differential coordinates the unknowns change: these and
  /// their neighbors.
  std::vector<int> Rows;
  std::vector<std::vector<int>> TwoRings; ///< of Rows, the vertex included
  Matrices Transforms;                    ///< #V x 9
  /// Implicit: (s, h) of each of Rows as a linear function of the positions of
  /// its one-ring, 4 x 3 k, and the equations' matrix over 3 #V unknowns.
  std::vector<Eigen::MatrixXd> Fits;
  ConstrainedSolver ImplicitSolver;
};
}
