// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/ExampleBasedDeformer.h"

#include "Algebra/ClosestRotation.h"
#include "Algebra/Rotation.h"

#include <Eigen/Cholesky>

namespace cartan
{
namespace
{
/// The part of a sum of products that is made of rounding.
constexpr double RoundingOfSums = 1e-12;

/// What examples that differ in nothing add to the curvature of E, so that their weights
/// are determined.
constexpr double Damping = 1e-12;

std::shared_ptr<const Eigen::VectorXd> SymmetricWeights(const HandleProblem& problem)
{
  if (!problem.ConstrainPositions)
  {
    throw Error(ErrorCode::BadInput,
      "Examples are fitted to where handles are: turn ConstrainHandlePositions on.");
  }
  return std::make_shared<const Eigen::VectorXd>(SymmetricPart(
    *problem.Mesh, cartan::EdgeWeights(*problem.Mesh, *problem.Rest, problem.Weights)));
}

/// Of x, the edges of a triangle as columns.
Eigen::Matrix3d EdgesBetween(const Points& x, const Eigen::Vector3i& corners)
{
  Eigen::Matrix3d edges;
  for (int e = 0; e < 3; ++e)
  {
    edges.col(e) = (x.row(corners[(e + 2) % 3]) - x.row(corners[(e + 1) % 3])).transpose();
  }
  return edges;
}

/// Adds G^T of weighted edges: each pulls its end one way and its start the other.
template <typename Row>
void AddPulls(const HandleLaplacian::Triangle& triangle, const Eigen::Matrix3d& edges, Row row)
{
  for (int e = 0; e < 3; ++e)
  {
    const Eigen::RowVector3d pull = triangle.Weights[e] * edges.col(e).transpose();
    row(triangle.Corners[(e + 2) % 3]) += pull;
    row(triangle.Corners[(e + 1) % 3]) -= pull;
  }
}

/// Eliminates the turns from the matrix of weights and turns.
Eigen::MatrixXd WithoutTurns(
  const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& mixed, const Eigen::Matrix3d& turns)
{
  const Eigen::Matrix3d symmetric = 0.5 * (turns + turns.transpose());
  Eigen::MatrixXd reduced = matrix - mixed.transpose() * symmetric.ldlt().solve(mixed);
  const double largest = reduced.diagonal().cwiseAbs().maxCoeff();
  reduced.diagonal().array() += largest > 0.0 ? Damping * largest : 1.0;
  return reduced;
}
}

ExampleBasedDeformer::ExampleBasedDeformer(HandleProblem problem,
  const std::vector<Points>& examples, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
  , System(this->Problem, SymmetricWeights(this->Problem), Hold::AllHandles, backend,
      context.Part(0.0, 0.5))
  , Span(this->Problem, this->System.Triangles(this->Problem), examples)
  , MovingHandles(MovingHandleOfVertices(this->Problem))
  , Weights(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(examples.size())))
{
  context.Report(1.0);
}

std::size_t ExampleBasedDeformer::GetBytes() const
{
  return this->GetBaseBytes() + this->System.GetBytes() + this->Span.GetBytes() +
    (this->Rigid ? this->Rigid->GetBytes() : 0) +
    TotalBytes(this->MovingHandles, this->Harmonic, this->SoftTargets, this->Fitted, this->Forces,
      this->Values, this->Slope, this->Curvature, this->Weights);
}

std::string ExampleBasedDeformer::GetWarning() const
{
  if (!this->Converged && this->MaximumIterations > 0)
  {
    return "The weights of the examples have not settled after " +
      std::to_string(this->Iterations) +
      " iterations: raise MaximumIterations, or move the handles less far from the examples.";
  }
  return this->Rigidness > 0.0 && this->Rigid ? this->Rigid->GetWarning() : std::string();
}

/// L h = 0 on unknowns, with the handles at `positions` (#V x 3).
void ExampleBasedDeformer::SpreadHandles(const HandleTargets& targets, const Points& positions)
{
  const int unknowns = this->System.NumberOfUnknowns();
  this->Harmonic.setZero(this->System.NumberOfLocals(), 3);
  this->SoftTargets.setZero(unknowns, 3);
  for (int i = unknowns; i < this->System.NumberOfLocals(); ++i)
  {
    this->Harmonic.row(i) = positions.row(this->System.Vertex(i));
  }
  Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(unknowns, 3);
  for (int i = 0; i < unknowns; ++i)
  {
    const double squaredWeight = this->System.SquaredSoftWeight(i);
    if (squaredWeight > 0.0)
    {
      this->SoftTargets.row(i) =
        HandleTarget(this->Problem, targets, this->System.Vertex(i), this->System.MovingHandle(i))
          .transpose();
      pulls.row(i) += 0.5 * squaredWeight * this->SoftTargets.row(i);
    }
    for (const auto* edge = this->System.EdgesBegin(i); edge != this->System.EdgesEnd(i); ++edge)
    {
      if (edge->Neighbor >= unknowns)
      {
        pulls.row(i) += edge->Weight * this->Harmonic.row(edge->Neighbor);
      }
    }
  }
  this->Harmonic.topRows(unknowns) = this->System.Solve(pulls);
}

/// b = G^T e, L z = b, Q and x = h + Q z.
void ExampleBasedDeformer::FitTogether()
{
  const auto& triangles = this->Span.GetTriangles();
  const int unknowns = this->System.NumberOfUnknowns();
  this->Forces.setZero(this->System.NumberOfLocals(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    AddPulls(triangles[t], this->Span.Edges(static_cast<Eigen::Index>(t)),
      [this](int local) { return this->Forces.row(local); });
  }
  this->Fitted.setZero(this->System.NumberOfLocals(), 3);
  this->Fitted.topRows(unknowns) = this->System.Solve(this->Forces.topRows(unknowns));
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double size = 0.0;
  for (Eigen::Index i = 0; i < this->Forces.rows(); ++i)
  {
    covariance += this->Harmonic.row(i).transpose() * this->Forces.row(i);
    size += this->Harmonic.row(i).norm() * this->Forces.row(i).norm();
  }
  // What is held in one point, or in points on a line, leaves a turn open: the least one then.
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  this->Rotation =
    covariance.norm() > RoundingOfSums * size ? ClosestRotationNear(covariance, none) : none;
  this->Values.resize(this->Harmonic.rows(), 3);
  for (Eigen::Index i = 0; i < this->Values.rows(); ++i)
  {
    this->Values.row(i) =
      this->Harmonic.row(i) + (this->Rotation * this->Fitted.row(i).transpose()).transpose();
  }
}

/// E, and its slope -2 sum c r . Q de/dw with the residuals r, as x and Q are at their best.
double ExampleBasedDeformer::SumResiduals()
{
  const auto& triangles = this->Span.GetTriangles();
  this->Slope.setZero(this->Span.NumberOfExamples());
  double energy = 0.0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const auto row = static_cast<Eigen::Index>(t);
    Eigen::Matrix3d residual =
      EdgesBetween(this->Values, triangles[t].Corners) - this->Rotation * this->Span.Edges(row);
    energy += triangles[t].Weights.dot(residual.colwise().squaredNorm().transpose());
    residual = this->Rotation.transpose() * residual * triangles[t].Weights.asDiagonal();
    this->Span.AddProducts(row, residual, this->Slope);
  }
  this->Slope *= -2.0;
  for (int i = 0; i < this->System.NumberOfUnknowns(); ++i)
  {
    energy += 0.5 * this->System.SquaredSoftWeight(i) *
      (this->Values.row(i) - this->SoftTargets.row(i)).squaredNorm();
  }
  return energy;
}

double ExampleBasedDeformer::Evaluate(
  const Eigen::VectorXd& weights, const ExecutionContext& context)
{
  this->Span.Evaluate(weights, context);
  this->FitTogether();
  return this->SumResiduals();
}

/// 2 J^T J of the residuals as functions of w, with x and Q at their best (variable
/// projection). With d_k = de/dw_k, b_k = G^T d_k and y_k = L^-1 b_k, and turns of the
/// whole by u,
///
///   J^T J = sum c d_k . d_l - b_k . y_l             for w,
///           sum c e x d_k - sum z x b_k             between u and w,
///           sum c (e^2 I - e e^T) - sum (b . z) I - z b^T  for u, which is eliminated.
Eigen::MatrixXd ExampleBasedDeformer::GaussNewton() const
{
  const auto& triangles = this->Span.GetTriangles();
  const int count = this->Span.NumberOfExamples();
  const int unknowns = this->System.NumberOfUnknowns();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(3, count);
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  Field pulls = Field::Zero(this->System.NumberOfLocals(), 3 * count);
  std::vector<Eigen::Matrix3d> derivatives(count);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const auto row = static_cast<Eigen::Index>(t);
    const Eigen::Matrix3d edges = this->Span.Edges(row);
    const Eigen::Matrix3d weighted = edges * triangles[t].Weights.asDiagonal();
    turns += weighted.cwiseProduct(edges).sum() * Eigen::Matrix3d::Identity() -
      weighted * edges.transpose();
    for (int k = 0; k < count; ++k)
    {
      derivatives[k] = this->Span.Derivative(row, k);
      AddPulls(triangles[t], derivatives[k],
        [&pulls, k](int local) { return pulls.row(local).segment<3>(3 * k); });
      for (int e = 0; e < 3; ++e)
      {
        mixed.col(k) +=
          Eigen::Vector3d(weighted.col(e)).cross(Eigen::Vector3d(derivatives[k].col(e)));
      }
      const Eigen::Matrix3d scaled = derivatives[k] * triangles[t].Weights.asDiagonal();
      for (int l = 0; l <= k; ++l)
      {
        matrix(k, l) += scaled.cwiseProduct(derivatives[l]).sum();
      }
    }
  }
  const Eigen::MatrixXd right = pulls.topRows(unknowns);
  const Eigen::MatrixXd fitted = this->System.Solve(right);
  for (int i = 0; i < unknowns; ++i)
  {
    const Eigen::Vector3d z = this->Fitted.row(i);
    const Eigen::Vector3d b = this->Forces.row(i);
    turns -= b.dot(z) * Eigen::Matrix3d::Identity() - z * b.transpose();
    for (int k = 0; k < count; ++k)
    {
      mixed.col(k) -= z.cross(Eigen::Vector3d(pulls.row(i).segment<3>(3 * k)));
    }
  }
  for (int k = 0; k < count; ++k)
  {
    for (int l = 0; l <= k; ++l)
    {
      for (int c = 0; c < 3; ++c)
      {
        matrix(k, l) -= right.col(3 * k + c).dot(fitted.col(3 * l + c));
      }
      matrix(l, k) = matrix(k, l);
    }
  }
  return 2.0 * WithoutTurns(matrix, mixed, turns);
}

void ExampleBasedDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  result.Positions = HandlePositions(this->Problem, targets, this->MovingHandles);
  result.FrameScale.setOnes(this->Problem.Mesh->NumberOfVertices());
  if (this->System.NumberOfUnknowns() == 0)
  {
    this->Converged = true;
    this->WriteTransforms(targets, result.Transforms);
    return;
  }
  this->SpreadHandles(targets, result.Positions);
  if (!this->IsWarm || this->Curvature.size() == 0)
  {
    this->Curvature.resize(0, 0);
    this->Weights = this->BestStart(context.Part(0.0, 0.3));
  }
  this->Descend(context.Part(0.3, 0.9));
  for (int i = 0; i < this->System.NumberOfUnknowns(); ++i)
  {
    result.Positions.row(this->System.Vertex(i)) = this->Values.row(i);
  }
  if (wantTransforms)
  {
    this->WriteTransforms(targets, result.Transforms);
  }
  if (this->Rigidness > 0.0)
  {
    this->BlendWithRigid(targets, result, context.Part(0.9, 1.0));
  }
  context.Report(1.0);
}

void ExampleBasedDeformer::BlendWithRigid(
  const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context)
{
  if (!this->Rigid)
  {
    this->Rigid = this->MakeRigid(this->Problem, context.Part(0.0, 0.6));
  }
  DeformedSurface rigid;
  this->Rigid->Deform(targets, result.Transforms.rows() > 0, rigid, context.Part(0.6, 1.0));
  result.Positions += this->Rigidness * (rigid.Positions - result.Positions);
  for (Eigen::Index v = 0; v < result.Transforms.rows(); ++v)
  {
    // Handles have their own motion in both, which is no rotation where it mirrors.
    if (this->MovingHandles[v] < 0)
    {
      auto transform = MatrixAt(result.Transforms, v);
      transform = ClosestRotationNear(
        (1.0 - this->Rigidness) * transform + this->Rigidness * MatrixAt(rigid.Transforms, v),
        transform);
    }
  }
}

/// The mean of the triangles' rotations around each unknown.
void ExampleBasedDeformer::WriteTransforms(const HandleTargets& targets, Matrices& transforms) const
{
  const int numberOfVertices = this->Problem.Mesh->NumberOfVertices();
  transforms = Identities(numberOfVertices);
  const int unknowns = this->System.NumberOfUnknowns();
  Matrices sums = Matrices::Zero(unknowns, 9);
  const auto& triangles = this->Span.GetTriangles();
  for (std::size_t t = 0; t < triangles.size() && unknowns > 0; ++t)
  {
    const Eigen::Matrix3d rotation =
      this->Rotation * this->Span.Rotation(static_cast<Eigen::Index>(t));
    for (const int corner : triangles[t].Corners)
    {
      if (corner < unknowns)
      {
        MatrixAt(sums, corner) += rotation;
      }
    }
  }
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (this->MovingHandles[v] >= 0)
    {
      MatrixAt(transforms, v) = HandleTransform(targets, v, this->MovingHandles[v]);
    }
  }
  for (int i = 0; i < unknowns; ++i)
  {
    MatrixAt(transforms, this->System.Vertex(i)) =
      ClosestRotationNear(MatrixAt(sums, i), this->Rotation);
  }
}
}
