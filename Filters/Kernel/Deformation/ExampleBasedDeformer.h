// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/ExampleSpan.h"
#include "Deformation/HandleLaplacian.h"
#include "Deformation/SurfaceDeformer.h"

#include <functional>
#include <memory>
#include <vector>

namespace cartan
{
/// Deformation that learns from examples how a surface moves (Sumner, Zwicker, Gotsman,
/// Popovic, Mesh-based Inverse Kinematics, 2005; Sorkine, Differential Representations for
/// Mesh Processing, 2006, Eq. 9): positions x, weights w of the examples and a rotation Q
/// of the whole minimize
///
///   E = sum over triangles t and their edges of c |x_b - x_a - Q e_t(w)|^2
///
/// with the handles in place, where e_t(w) are the edges of ExampleSpan and c is what t
/// adds to the weight of its edge. Vertices that are held softly with weight w at p add
/// w^2 |x - p|^2 / 2.
///
/// For given w, x = h + Q z with the harmonic h between the handles and the z that fits
/// e(w) best and is zero where they hold; as |e - G z| does not depend on Q, Q is the
/// rotation closest to sum h_i b_i^T for the right-hand side b of z. So E is a function of
/// the few w alone. BFGS steps descend it, from the Gauss-Newton matrix; each needs one
/// solve for three right-hand sides, that matrix one for each example.
///
/// Handles in one point or on a line leave a turn open: of the Q that fit alike the least is
/// taken. The search starts at that of the rest pose and the examples which fits best, of
/// those that fit alike at the first, or from the last motion's weights. Weights are not limited:
/// beyond 1 and below 0 they extrapolate.
class ExampleBasedDeformer : public SurfaceDeformer
{
public:
  /// `examples` are #V x 3 each, at least one. Factorizes; see HandleLaplacian for what it
  /// throws, and Error(BadInput) where handles are not held in position, or where a
  /// component has no triangle with area both at rest and in an example.
  ExampleBasedDeformer(HandleProblem problem, const std::vector<Points>& examples,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  /// How many steps at most, >= 0, and the largest change of a weight in the last one.
  /// Default: 30, 1e-6.
  void SetIteration(int maximum, double tolerance)
  {
    this->MaximumIterations = maximum;
    this->Tolerance = tolerance;
  }

  /// Whether to start from the last motion's weights. Default: off.
  void SetWarmStart(bool warm) { this->IsWarm = warm; }

  /// Makes another deformer for a problem.
  using MakeDeformer =
    std::function<std::unique_ptr<SurfaceDeformer>(const HandleProblem&, const ExecutionContext&)>;

  /// How rigid the result is, 0 to 1: the part of another method's result in the positions,
  /// the rest is that of the examples. `make` is called when it is first needed; that of
  /// ShapePreservingDeformer or PoissonDeformer fits edges by the same matrix, so these are
  /// blended in the edges that they fit. Default: 0.
  void SetRigidness(double part, MakeDeformer make)
  {
    this->Rigidness = part;
    this->MakeRigid = std::move(make);
  }

  /// Of the last motion: w, #examples; sqrt(E / E(x = 0)), how far the result is from the
  /// span; the number of steps; and whether they ended below the tolerance.
  const Eigen::VectorXd& GetWeights() const { return this->Weights; }
  double GetDistance() const { return this->Distance; }
  int GetNumberOfIterations() const { return this->Iterations; }
  bool HasConverged() const { return this->Converged; }

  int GetNumberOfFactorizations() const override
  {
    return this->System.GetNumberOfFactorizations() +
      (this->Rigid ? this->Rigid->GetNumberOfFactorizations() : 0);
  }
  int GetNumberOfFreeVertices() const override { return this->System.NumberOfUnknowns(); }
  std::string GetWarning() const override;
  std::size_t GetBytes() const override;

protected:
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

private:
  double Evaluate(const Eigen::VectorXd& weights, const ExecutionContext& context);
  void SpreadHandles(const HandleTargets& targets, const Points& positions);
  void FitTogether();
  double SumResiduals();
  Eigen::MatrixXd GaussNewton() const;
  double SizeOfEdges() const;
  Eigen::VectorXd BestStart(const ExecutionContext& context);
  void Descend(const ExecutionContext& context);
  bool StepDown(double& energy, Eigen::VectorXd& step, const ExecutionContext& context);
  void BlendWithRigid(
    const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context);
  void WriteTransforms(const HandleTargets& targets, Matrices& transforms) const;

  HandleLaplacian System;
  ExampleSpan Span;
  std::vector<int> MovingHandles; // #V, index in Moving or -1
  int MaximumIterations = 30;
  double Tolerance = 1e-6;
  bool IsWarm = false;
  double Rigidness = 0.0;
  MakeDeformer MakeRigid;
  std::unique_ptr<SurfaceDeformer> Rigid; // empty until first needed

  Points Harmonic;    // h, #locals x 3
  Points SoftTargets; // #unknowns x 3, of those held softly
  Points Fitted;      // z, #locals x 3
  Points Forces;      // b, #locals x 3
  Points Values;      // x, #locals x 3
  Eigen::Matrix3d Rotation = Eigen::Matrix3d::Identity();
  Eigen::VectorXd Slope;     // dE/dw
  Eigen::MatrixXd Curvature; // of E; empty until first needed
  Eigen::VectorXd Weights;
  double Distance = 0.0;
  int Iterations = 0;
  bool Converged = false;
};
}
