// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/InitialGuess.h"

#include <memory>
#include <vector>

namespace cartan
{
/// Deformation that keeps the pyramid coordinates of one-rings (Sheffer and Kraevoy,
/// Pyramid Coordinates for Morphing and Deformation, 2004; Sorkine, Differential
/// Representations for Mesh Processing, 2006, section 4.3): with PyramidCoordinates p at
/// rest, positions x minimize
///
///   E = sum_i min over R_i of sum_j w_ij |x_j - x_i - R_i p_ij|^2,
///
/// over the neighbors j of i, where R_i takes the third axis to the normal n_i(x), the mean
/// by area of the normals around i, and is free to turn about it. So edges are compared in
/// the plane of their ring and in their height over it, and the plane is made from the
/// positions, as in the paper. (With R_i free altogether, the sum for coordinates that do not
/// change is AsRigidAsPossibleDeformer's of spokes.) The paper places each vertex over the
/// plane of its neighbors by mean value coordinates, which leave lengths open where the
/// surface is flat; here the whole ring is compared.
///
/// Vertices that are held softly with weight w at t add w^2 |x_i - t|^2. Weights are
/// HandleProblem::PositionWeights, symmetrized, negative ones as zero. A ring without a
/// normal has a free R_i.
///
/// For given R_i the sum asks for x with the matrix of the linear methods, whose 4 L are
/// the second derivatives then. L-BFGS adds how the planes tilt: each step is one solve with
/// the factors of the initial guess, shortened until it lowers E.
///
/// Rotations follow from positions, so handles are held in position only.
class PyramidDeformer : public SurfaceDeformer
{
public:
  /// Factorizes once; see HandleLaplacian for what it throws, and Error(BadInput) where
  /// handles are not held in position. PositionWeights serve as Weights too.
  PyramidDeformer(HandleProblem problem, InitialGuess guess = InitialGuess::ShapePreserving,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  /// How many steps at most, >= 0 (none: the initial guess), and below which decrease of E
  /// in a step, relative to E, to stop. Default: 200, 1e-4.
  void SetIteration(int maximum, double tolerance)
  {
    this->MaximumIterations = maximum;
    this->Tolerance = tolerance;
  }

  /// Of the last motion: E of the initial guess and after each step, in squared length units
  /// for weights without unit; the last is that of the result.
  const std::vector<double>& GetEnergies() const { return this->Energies; }
  int GetNumberOfIterations() const { return static_cast<int>(this->Energies.size()) - 1; }

  /// The terms of E at each vertex for the result; 0 where nothing moves: #V.
  Eigen::VectorXd GetVertexEnergies() const;

  /// Whether the last step's decrease fell below the tolerance.
  bool HasConverged() const { return this->Converged; }

  int GetNumberOfFactorizations() const override
  {
    return this->Guess->GetNumberOfFactorizations();
  }
  int GetNumberOfFreeVertices() const override { return this->System->NumberOfUnknowns(); }
  /// Of the initial guess; also where the largest number of steps ended the descent.
  std::string GetWarning() const override { return this->Warning; }
  std::size_t GetBytes() const override;

protected:
  /// Throws what the initial guess throws: ShapePreservingDeformer refuses rotations of 360
  /// degrees or more about different axes.
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

private:
  void Start(
    const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context);
  double FitCells(const ExecutionContext& context);
  Eigen::Vector3d SlopeAt(int unknown) const;
  void FindSlope(Eigen::VectorXd& slope, Eigen::VectorXd& solved, const ExecutionContext& context);
  double Move(double t, const Eigen::VectorXd& direction, const Points& from,
    const ExecutionContext& context);
  double SearchAlong(
    Eigen::VectorXd& direction, double promised, double before, const ExecutionContext& context);
  void Descend(const ExecutionContext& context);
  void WriteTransforms(const HandleTargets& targets, Matrices& transforms) const;

  InitialGuess GuessKind;
  std::unique_ptr<FrameDeformer> Guess;
  std::shared_ptr<const HandleLaplacian> System;
  std::shared_ptr<const Eigen::VectorXd> Weights; // #D
  std::vector<int> MovingHandles;                 // #V, index in Moving or -1
  std::vector<char> HasNormal;                    // #V, at rest
  Matrices RestFrames;                            // #V x 9
  Points Rings;                                   // #D x 3
  int MaximumIterations = 200;
  double Tolerance = 1e-4;

  Points Current;               // #V x 3
  Points SoftTargets;           // #unknowns x 3, of those held softly
  Matrices Frames;              // R, #V x 9
  Points SlopesOfAreas;         // #V x 3; 0 where R is free or no cell
  Eigen::VectorXd CellEnergies; // #locals
  bool HasPrevious = false;
  std::vector<double> Energies;
  bool Converged = false;
  std::string Warning;
};
}
