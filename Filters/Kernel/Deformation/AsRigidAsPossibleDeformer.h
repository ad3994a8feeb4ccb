// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/InitialGuess.h"
#include "Deformation/RigidCells.h"

#include <memory>
#include <vector>

namespace cartan
{
enum class RigidityEnergy
{
  Spokes,           ///< Sorkine and Alexa 2007
  SpokesAndRims,    ///< Chao et al. 2010
  SmoothedRotations ///< Levi and Gotsman 2015
};

/// Deformation that leaves the neighborhood of each vertex as rigid as the
/// handles let it. With rest positions p, the positions x and a rotation R_i
/// per vertex are to minimize one of
///
///   Spokes:  E = sum_i sum_j w_ij |x_i - x_j - R_i (p_i - p_j)|^2
///
/// over the neighbors j of i (Sorkine and Alexa, As-Rigid-As-Possible Surface
/// Modeling, 2007, Eq. 7);
///
///   SpokesAndRims:  E = 2/3 sum_i sum_(j,k) c_jk |x_j - x_k - R_i (p_j - p_k)|^2
///
/// over the three edges of each triangle at i, c_jk the triangle's part of w_jk
/// (Chao, Pinkall, Sanan, Schroeder, A Simple Geometric Model for Elastic
/// Deformations, 2010, section 4; the factor makes it agree with Spokes in
/// homogeneous strain);
///
///   SmoothedRotations:  Spokes + alpha d^2 sum_i sum_j w_ij |R_i - R_j|^2
///
/// with the RegionThickness d of the free vertices and the Frobenius norm (Levi and
/// Gotsman, Smooth Rotation Enhanced As-Rigid-As-Possible Mesh Animation, 2015,
/// Eq. 6, which has the area in place of d^2), which resists bending as a shell does
/// whose thickness is a part of the body's: long bodies no more than short ones, and
/// sheets hardly. Vertices that are held softly with weight w at t add w^2 |x_i - t|^2.
///
/// Weights are HandleProblem::PositionWeights, symmetrized. A cell of Spokes
/// with negative weights can gain energy by turning at rest: there and in
/// SmoothedRotations they count as zero, as HandleProblem::ClampWeights has it.
/// SpokesAndRims keeps their sign, as the energy of a whole triangle is never
/// negative.
///
/// For given x the best R_i are closest rotations; for given R_i all three
/// energies ask for x with the same matrix,
///
///   L x = b,  Spokes: b_i = sum_j w_ij (R_i + R_j) (p_i - p_j) / 2,
///
/// which is that of the linear methods: the system is the initial guess's,
/// factorized once. Taking turns never raises the energy. Between the turns the
/// steps are extrapolated (Anderson acceleration, after Peng et al., Anderson
/// Acceleration for Geometry Optimization and Physics Simulation, 2018) where
/// that lowers the energy by more than the tolerance, so it still never rises.
///
/// Taking turns hands coupled rotations on from neighbor to neighbor, far too slowly:
/// from where the root of alpha d^2 is longer than edges on, SmoothedRotations descends by
/// turns of all rotations at once, with the positions at their best for them. L-BFGS gives
/// the turns, and the matrix L of the positions serves there too: 8 alpha d^2 L is what
/// couples rotations. A step is two solves.
///
/// Held vertices whose neighbors are all held get the rotation that fits their
/// ring, and keep it. With ConstrainPositions off, moving handles are held in
/// rotation instead of in position.
class AsRigidAsPossibleDeformer : public SurfaceDeformer
{
public:
  /// Factorizes once (twice with ConstrainPositions off); see HandleLaplacian
  /// for what it throws. PositionWeights serve as Weights too.
  AsRigidAsPossibleDeformer(HandleProblem problem, RigidityEnergy energy = RigidityEnergy::Spokes,
    InitialGuess guess = InitialGuess::ShapePreserving,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});
  ~AsRigidAsPossibleDeformer() override;

  /// alpha >= 0 of SmoothedRotations, without unit. Default: 0.03.
  void SetBending(double alpha) { this->Bending = alpha; }

  /// How many steps at most, >= 0 (none: the initial guess), and below which
  /// decrease of the energy in a step, relative to the energy, to stop.
  /// Default: 10, 1e-4.
  void SetIteration(int maximum, double tolerance)
  {
    this->MaximumIterations = maximum;
    this->Tolerance = tolerance;
  }

  /// Of the last motion: E of the initial guess and after each step, in squared
  /// length units for weights without unit; the last is that of the result.
  const std::vector<double>& GetEnergies() const { return this->Energies; }
  int GetNumberOfIterations() const { return static_cast<int>(this->Energies.size()) - 1; }

  /// The terms of E at each vertex for the result; 0 where nothing moves: #V.
  Eigen::VectorXd GetVertexEnergies() const;

  /// Whether the last step's decrease fell below the tolerance.
  bool HasConverged() const { return this->Converged; }

  /// An estimate of the part of E that the last step and all after it could gain:
  /// g^T P^-1 g / 2 E, with the gradient g before that step and the part P of the second
  /// derivatives that is the system's matrix. Near the end it is right to a factor of
  /// ten. 0 without steps.
  double GetResidual() const { return this->Residual; }

  int GetNumberOfFactorizations() const override
  {
    return this->Guess->GetNumberOfFactorizations();
  }
  int GetNumberOfFreeVertices() const override { return this->System->NumberOfUnknowns(); }
  /// Of the initial guess; of SmoothedRotations also when the last step still
  /// moves vertices.
  std::string GetWarning() const override { return this->Warning; }
  std::size_t GetBytes() const override;

protected:
  /// Throws what the initial guess throws: ShapePreservingDeformer refuses
  /// rotations of 360 degrees or more about different axes.
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

private:
  Eigen::Matrix3d Covariance(int cell) const;
  Eigen::Matrix3d CoupledRotations(int cell) const;
  void FitRotations(const ExecutionContext& context);
  double SumEnergies(const HandleTargets& targets, const ExecutionContext& context);
  void EvaluateCell(int cell, double bending, const HandleTargets& targets);
  double RimEnergy(int spoke, const Eigen::Matrix3d& rotation) const;
  double TimesOfBending(int cell, int neighbor) const;
  Eigen::Vector3d ResidualOfSpoke(int spoke, const Eigen::Vector3d& edge,
    const Eigen::Vector3d& restEdge, const Eigen::Vector3d& turned) const;
  /// alpha d^2; 0 unless rotations are coupled.
  double BendingFactor() const
  {
    return this->AreCoupled ? this->Bending * this->Thickness * this->Thickness : 0.0;
  }
  void Start(
    const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context);
  void SolveCells(const Eigen::Ref<const Eigen::VectorXd>& values, Eigen::VectorXd& solution,
    const ExecutionContext& context);
  void SolveStep(Eigen::VectorXd& step, const ExecutionContext& context);
  bool HasSettled(double before, double after) const;
  void Alternate(
    const HandleTargets& targets, Eigen::VectorXd& step, const ExecutionContext& context);
  bool CouplesFar() const;
  void SlopeOfTurns(
    Eigen::VectorXd& slope, Eigen::VectorXd& solved, const ExecutionContext& context);
  double Turn(double t, const Eigen::VectorXd& direction, const HandleTargets& targets,
    Eigen::VectorXd& step, const ExecutionContext& context);
  double SearchAlong(Eigen::VectorXd& direction, double promised, double before,
    const HandleTargets& targets, Eigen::VectorXd& step, const ExecutionContext& context);
  void DescendByTurns(
    const HandleTargets& targets, Eigen::VectorXd& step, const ExecutionContext& context);
  void WarnIfUnsettled(const Eigen::VectorXd& step);
  void WriteResult(bool wantTransforms, DeformedSurface& result) const;

  InitialGuess GuessKind;
  std::unique_ptr<FrameDeformer> Guess;
  std::shared_ptr<const HandleLaplacian> System;
  double Bending = 0.03;
  int MaximumIterations = 10;
  double Tolerance = 1e-4;

  RigidCells Cells;
  std::vector<RigidCells::Rim> Rims; // as Cells.Spokes; empty without rims
  bool AreCoupled = false;           // the rotations of neighbors
  std::vector<char> HoldsRotation;   // #cells
  std::vector<int> MovingHandles;    // #V, index in Moving or -1
  double FreeArea = 0.0;             // with coupled rotations
  double Thickness = 0.0;            // the same
  double NegligibleEnergy = 0.0;     // rounding makes as much

  Points Rest;                  // #sites x 3
  Points Current;               // #sites x 3
  Matrices Rotations;           // #sites x 9
  Matrices Before;              // the same before the last fit, where coupled
  Matrices Covariances;         // #active cells x 9, where coupled
  Eigen::VectorXd CellEnergies; // #cells
  Points Forces;                // #unknowns x 3: b - L x
  bool HasPrevious = false;
  std::vector<double> Energies;
  double Residual = 0.0;
  bool Converged = false;
  std::string Warning;
};
}
