// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/FrameDeformer.h"
#include "Deformation/HarmonicBlend.h"

namespace cartan
{
/// Deformation by the rotation field of least Dirichlet energy (Lipman et al.,
/// Volume and Shape Preservation via Moving Frame Manipulation, 2007, section
/// 3): of all isometries the one that changes the second fundamental form
/// least.
///
/// If all rotations share an axis, the angle is harmonic (Eq. 6), of any size.
/// Else the field is found in conformal coordinates eta = 2 tan(angle / 4) axis
/// of SO(3), where the energy is (Eqs. 5 and 7, with w = (4 + |eta|^2)^-2)
///
///   E(eta) = sum over triangles of W_T Q_T,
///   W_T = sum of w over the corners,  Q_T = sum of cot |difference of eta|^2,
///
/// stationary where (Eq. 8, its denominator corrected)
///
///   sum_r (cot a W_left + cot b W_right) (eta_j - eta_r)
///     = 2 eta_j / (4 + |eta_j|^2)^3 sum of Q_T around j.
///
/// The first iterate, from eta = 0 on the right, is the harmonic eta; it needs
/// no factorization and is close. Further ones lag W and the right-hand side
/// and factorize each time, with the symbolic factors kept.
///
/// Scale and shear of a handle are blended linearly beneath the rotations.
class ShapePreservingDeformer : public FrameDeformer
{
public:
  ShapePreservingDeformer(HandleProblem problem, SolverBackend backend = SolverBackend::Automatic,
    const ExecutionContext& context = {});

  /// How many iterates of Eq. 8, >= 1, and below which change of eta, relative
  /// to its largest value, to stop.
  void SetIteration(int maximum, double tolerance)
  {
    this->MaximumIterations = maximum;
    this->Tolerance = tolerance;
  }

  /// Of the last motion: whether all rotations shared an axis; the iterates of
  /// Eq. 8 that were computed (0 with a shared axis); the last relative change,
  /// and whether it fell below the tolerance. The residual of one iterate is
  /// not known and 0.
  bool HasSharedAxis() const { return this->SharedAxis; }
  int GetNumberOfIterations() const { return this->Iterations; }
  double GetResidual() const { return this->Residual; }
  bool HasConverged() const { return this->Converged; }

  int GetNumberOfFactorizations() const override
  {
    return FrameDeformer::GetNumberOfFactorizations() +
      this->IterationSystem.GetNumberOfFactorizations();
  }
  std::size_t GetBytes() const override
  {
    return FrameDeformer::GetBytes() + this->IterationSystem.GetBytes() +
      this->Harmonic.GetBytes() + TotalBytes(this->Triangles);
  }

protected:
  bool ServesPieces() const override { return this->VolumeServesPieces(); }
  void ComputeTransforms(const HandleTargets& targets, const ExecutionContext& context) override;
  bool FindTurns(
    const HandleTargets& targets, Eigen::Vector3d& axis, Eigen::VectorXd& angles) override;
  TurnParts TurnOf(int local, const Eigen::VectorXd& ratios, double angle) const override;

private:
  void ForgetIterations();
  Eigen::Vector3d RotationVector(const HandleTargets& targets, const HandleVertex& held) const;
  Eigen::Matrix3d Stretch(const HandleTargets& targets, const HandleVertex& held) const;
  Field Spread(const HandleTargets& targets, int components,
    const std::function<void(const HandleVertex&, double*)>& coordinates,
    const ExecutionContext& context) const;
  void BlendAngles(
    const HandleTargets& targets, const Eigen::Vector3d& axis, const ExecutionContext& context);
  void BlendRotations(const HandleTargets& targets, const ExecutionContext& context);
  void BlendStretches(const HandleTargets& targets, const ExecutionContext& context);
  void RequireLessThanTurns(const HandleTargets& targets) const;
  Field Iterate(Field eta, const HandleTargets& targets, const ExecutionContext& context);
  bool Step(const Field& eta, const Anchors& anchors, Field& next);
  SparseMatrix Linearize(const Field& eta, Field& rightHandSide) const;
  double Energy(const Field& eta, const Eigen::VectorXd& stiffness, const Field& targets) const;
  void WarnUnlessConverged();

  int MaximumIterations = 1;
  double Tolerance = 1e-6;
  bool SharedAxis = true;
  int Iterations = 0;
  double Residual = 0.0;
  bool Converged = true;

  HarmonicBlend Harmonic;

  /// Empty until an iteration needs them.
  std::vector<HandleLaplacian::Triangle> Triangles;
  AnchoredSystem IterationSystem;
};
}
