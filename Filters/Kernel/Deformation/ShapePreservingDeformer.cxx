// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/ShapePreservingDeformer.h"

#include "Algebra/Rotation.h"
#include "Base/Constants.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace cartan
{
namespace
{
/// eta = 2 tan(angle / 4) axis of a rotation vector.
Eigen::Vector3d ConformalCoordinates(const Eigen::Vector3d& rotation)
{
  const double angle = rotation.norm();
  return (angle > 0.0 ? 2.0 * std::tan(angle / 4.0) / angle : 0.0) * rotation;
}

/// W_T, the sum over the corners of 1 / (4 + |eta|^2)^2.
double ConformalWeight(const HandleLaplacian::Triangle& triangle, const Field& eta)
{
  double weight = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    const double denominator = 4.0 + eta.row(triangle.Corners[c]).squaredNorm();
    weight += 1.0 / (denominator * denominator);
  }
  return weight;
}

/// sum over the edges of w |eta_a - eta_b|^2.
double DirichletEnergy(const HandleLaplacian::Triangle& triangle, const Field& eta)
{
  double energy = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    const int a = triangle.Corners[(c + 1) % 3];
    const int b = triangle.Corners[(c + 2) % 3];
    energy += triangle.Weights[c] * (eta.row(a) - eta.row(b)).squaredNorm();
  }
  return energy;
}
}

ShapePreservingDeformer::ShapePreservingDeformer(
  HandleProblem problem, SolverBackend backend, const ExecutionContext& context)
  : FrameDeformer(std::move(problem), backend, context.Part(0.0, 0.9))
  , Harmonic(this->Problem, this->FrameSystem)
  , IterationSystem(backend, LaplacianLimits())
{
  context.Report(1.0);
}

Eigen::Vector3d ShapePreservingDeformer::RotationVector(
  const HandleTargets& targets, const HandleVertex& held) const
{
  return targets.RotationVectors.rows()
    ? Eigen::Vector3d(targets.RotationVectors.row(targets.Row(held.Vertex)))
    : targets.Motions[held.Handle].RotationVector;
}

/// S of A = R S, with the rotation R of a handle's vertex and its linear map A.
Eigen::Matrix3d ShapePreservingDeformer::Stretch(
  const HandleTargets& targets, const HandleVertex& held) const
{
  return RotationFromVector(this->RotationVector(targets, held)).transpose() *
    HandleTransform(targets, held.Vertex, held.Handle);
}

Field ShapePreservingDeformer::Spread(const HandleTargets& targets, int components,
  const std::function<void(const HandleVertex&, double*)>& coordinates,
  const ExecutionContext& context) const
{
  const HandleLaplacian& frames = *this->FrameSystem;
  if (targets.RotationVectors.rows() == 0 && targets.Transforms.rows() == 0)
  {
    Field ofHandles(static_cast<Eigen::Index>(targets.Motions.size()), components);
    for (std::size_t k = 0; k < targets.Motions.size(); ++k)
    {
      coordinates({ -1, static_cast<int>(k) }, ofHandles.row(k).data());
    }
    return this->Harmonic.Blend(ofHandles, context);
  }
  return frames.Spread(
    components,
    [&](int local, double* values) {
      coordinates({ frames.Vertex(local), frames.MovingHandle(local) }, values);
    },
    context);
}

void ShapePreservingDeformer::ForgetIterations()
{
  this->Iterations = 0;
  this->Residual = 0.0;
  this->Converged = true;
}

bool ShapePreservingDeformer::FindTurns(
  const HandleTargets& targets, Eigen::Vector3d& axis, Eigen::VectorXd& angles)
{
  if (targets.IsPerVertex() || targets.RotationVectors.rows() || !this->Harmonic.IsStored())
  {
    return false;
  }
  std::vector<Eigen::Vector3d> rotationVectors;
  for (std::size_t k = 0; k < targets.Motions.size(); ++k)
  {
    if (!this->Stretch(targets, { -1, static_cast<int>(k) }).isIdentity(1e-9))
    {
      return false;
    }
    rotationVectors.push_back(targets.Motions[k].RotationVector);
  }
  if (!FindSharedAxis(rotationVectors, axis))
  {
    return false;
  }
  angles.resize(static_cast<Eigen::Index>(rotationVectors.size()));
  for (std::size_t k = 0; k < rotationVectors.size(); ++k)
  {
    angles[static_cast<Eigen::Index>(k)] = rotationVectors[k].dot(axis);
  }
  this->ForgetIterations();
  this->SharedAxis = true;
  return true;
}

/// Eq. 6.
TurnParts ShapePreservingDeformer::TurnOf(
  int local, const Eigen::VectorXd& ratios, double angle) const
{
  double turn = 0.0;
  for (Eigen::Index k = 0; k < ratios.size(); ++k)
  {
    turn += this->Harmonic.GetWeights()(local, k) * ratios[k] * angle;
  }
  return { std::sin(turn), 1.0 - std::cos(turn) };
}

void ShapePreservingDeformer::ComputeTransforms(
  const HandleTargets& targets, const ExecutionContext& context)
{
  this->ForgetIterations();
  std::vector<Eigen::Vector3d> rotationVectors;
  for (const HandleVertex& held : this->HandleVertices)
  {
    MatrixAt(this->Transforms, held.Vertex) = HandleTransform(targets, held.Vertex, held.Handle);
    if (targets.RotationVectors.rows())
    {
      rotationVectors.push_back(this->RotationVector(targets, held));
    }
  }
  // A piece may have vertices of some handles only.
  for (std::size_t k = 0; k < targets.Motions.size() && !targets.RotationVectors.rows(); ++k)
  {
    rotationVectors.push_back(targets.Motions[k].RotationVector);
  }
  Eigen::Vector3d axis;
  this->SharedAxis = FindSharedAxis(rotationVectors, axis);
  if (this->SharedAxis)
  {
    this->BlendAngles(targets, axis, context);
  }
  else
  {
    this->BlendRotations(targets, context);
  }
  this->BlendStretches(targets, context);
}

/// Eq. 6.
void ShapePreservingDeformer::BlendAngles(
  const HandleTargets& targets, const Eigen::Vector3d& axis, const ExecutionContext& context)
{
  const HandleLaplacian& frames = *this->FrameSystem;
  const Field angle = this->Spread(
    targets, 1,
    [&](const HandleVertex& held, double* value)
    { *value = this->RotationVector(targets, held).dot(axis); },
    context);
  context.For(frames.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        MatrixAt(this->Transforms, frames.Vertex(i)) =
          Eigen::AngleAxisd(angle(i, 0), axis).toRotationMatrix();
      }
    });
}

/// Eq. 8.
void ShapePreservingDeformer::BlendRotations(
  const HandleTargets& targets, const ExecutionContext& context)
{
  this->RequireLessThanTurns(targets);
  const HandleLaplacian& frames = *this->FrameSystem;
  Field eta = this->Spread(
    targets, 3,
    [&](const HandleVertex& held, double* value)
    {
      Eigen::Map<Eigen::Vector3d>(value, 3) =
        ConformalCoordinates(this->RotationVector(targets, held));
    },
    context);
  this->Iterations = 1;
  if (this->MaximumIterations > 1 && this->Problem.Pieces)
  {
    throw Error(ErrorCode::BadInput,
      "Rotations about different axes are refined on one process only: set MaximumIterations to "
      "1, or gather the surface.");
  }
  if (this->MaximumIterations > 1 && eta.rows() > 0)
  {
    eta = this->Iterate(std::move(eta), targets, context);
  }
  context.For(frames.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const Eigen::Vector3d direction = eta.row(i);
        const double length = direction.norm();
        MatrixAt(this->Transforms, frames.Vertex(i)) = RotationFromVector(length > 0.0
            ? Eigen::Vector3d(4.0 * std::atan(length / 2.0) / length * direction)
            : direction);
      }
    });
}

void ShapePreservingDeformer::RequireLessThanTurns(const HandleTargets& targets) const
{
  IdSample tooLarge;
  for (const HandleVertex& held : this->HandleVertices)
  {
    if (this->RotationVector(targets, held).norm() >= FullTurn * (1.0 - 1e-9))
    {
      tooLarge.Add(held.Vertex);
    }
  }
  if (!tooLarge.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The rotations have different axes, and " +
        tooLarge.Describe("handle point turns", "handle points turn") +
        " by 360 degrees or more, which only rotations about one axis can do: give all handles "
        "the same axis, or turn in several steps.");
  }
}

void ShapePreservingDeformer::BlendStretches(
  const HandleTargets& targets, const ExecutionContext& context)
{
  const auto isRigid = [&](const HandleVertex& held)
  { return this->Stretch(targets, held).isIdentity(1e-9); };
  bool areAllRigid = true;
  if (targets.Transforms.rows())
  {
    areAllRigid = std::all_of(this->HandleVertices.begin(), this->HandleVertices.end(), isRigid);
  }
  for (std::size_t k = 0; k < targets.Motions.size() && targets.Transforms.rows() == 0; ++k)
  {
    areAllRigid = areAllRigid && isRigid({ -1, static_cast<int>(k) });
  }
  if (areAllRigid)
  {
    return;
  }
  const HandleLaplacian& frames = *this->FrameSystem;
  const Field blends = this->Spread(
    targets, 9,
    [&](const HandleVertex& held, double* value)
    {
      Eigen::Map<Eigen::Matrix3d>(value, 3, 3) =
        this->Stretch(targets, held) - Eigen::Matrix3d::Identity();
    },
    context);
  for (int i = 0; i < frames.NumberOfUnknowns(); ++i)
  {
    auto transform = MatrixAt(this->Transforms, frames.Vertex(i));
    transform += (transform * Eigen::Map<const Eigen::Matrix3d>(blends.row(i).data())).eval();
  }
}

/// E(eta) and what the soft anchors add to it: the system is its gradient.
double ShapePreservingDeformer::Energy(
  const Field& eta, const Eigen::VectorXd& stiffness, const Field& targets) const
{
  double energy = 0.0;
  for (const HandleLaplacian::Triangle& triangle : this->Triangles)
  {
    energy += ConformalWeight(triangle, eta) * DirichletEnergy(triangle, eta);
  }
  return stiffness.size() ? energy + stiffness.dot((eta - targets).rowwise().squaredNorm())
                          : energy;
}

/// Eq. 8 with the weights and the right-hand side at `eta`.
SparseMatrix ShapePreservingDeformer::Linearize(const Field& eta, Field& rightHandSide) const
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * this->Triangles.size());
  rightHandSide.setZero(eta.rows(), 3);
  for (const HandleLaplacian::Triangle& triangle : this->Triangles)
  {
    const double weight = ConformalWeight(triangle, eta);
    const double dirichlet = DirichletEnergy(triangle, eta);
    for (int c = 0; c < 3; ++c)
    {
      const int a = triangle.Corners[(c + 1) % 3];
      const int b = triangle.Corners[(c + 2) % 3];
      const double value = weight * triangle.Weights[c];
      entries.emplace_back(a, a, value);
      entries.emplace_back(b, b, value);
      entries.emplace_back(a, b, -value);
      entries.emplace_back(b, a, -value);
      // d W_T / d eta is -4 eta / (4 + |eta|^2)^3; moved to the right.
      const int corner = triangle.Corners[c];
      const double denominator = 4.0 + eta.row(corner).squaredNorm();
      rightHandSide.row(corner) +=
        2.0 * dirichlet / (denominator * denominator * denominator) * eta.row(corner);
    }
  }
  SparseMatrix matrix(eta.rows(), eta.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Solves Eq. 8 at `eta` for the next iterate, which has the anchors' values.
/// False where it cannot: far from a solution, negative cotangents may make the
/// system indefinite, and weights may vanish.
bool ShapePreservingDeformer::Step(const Field& eta, const Anchors& anchors, Field& next)
{
  Field rightHandSide;
  const SparseMatrix matrix = this->Linearize(eta, rightHandSide);
  try
  {
    this->IterationSystem.Factorize(matrix, anchors);
    this->IterationSystem.Solve(rightHandSide, next);
  }
  catch (const Error& error)
  {
    if (error.GetCode() != ErrorCode::NotPositiveDefinite &&
      error.GetCode() != ErrorCode::SingularSystem)
    {
      throw;
    }
    return false;
  }
  return true;
}

Field ShapePreservingDeformer::Iterate(
  Field eta, const HandleTargets& targets, const ExecutionContext& context)
{
  const HandleLaplacian& frames = *this->FrameSystem;
  if (this->Triangles.empty())
  {
    this->Triangles = frames.Triangles(this->Problem);
  }
  // Soft targets keep their strength relative to the energy near eta = 0,
  // where W_T is 3/16.
  Anchors anchors = frames.GetAnchors();
  anchors.Stiffness *= 3.0 / 16.0;
  Field goals = eta;
  for (int i = 0; anchors.Stiffness.size() && i < frames.NumberOfUnknowns(); ++i)
  {
    const HandleVertex held{ frames.Vertex(i), frames.MovingHandle(i) };
    goals.row(i).setZero();
    if (held.Handle >= 0)
    {
      goals.row(i) = ConformalCoordinates(this->RotationVector(targets, held)).transpose();
    }
  }
  Field best = eta;
  double bestEnergy = this->Energy(eta, anchors.Stiffness, goals);
  this->Converged = false;
  for (; this->Iterations < this->MaximumIterations && !this->Converged; ++this->Iterations)
  {
    context.Report(static_cast<double>(this->Iterations) / this->MaximumIterations);
    Field next = goals;
    if (!this->Step(eta, anchors, next))
    {
      break;
    }
    // Of vectors: their components depend on the axes.
    this->Residual = std::sqrt((next - eta).rowwise().squaredNorm().maxCoeff() /
      std::max(next.rowwise().squaredNorm().maxCoeff(), 1e-300));
    eta = std::move(next);
    const double energy = this->Energy(eta, anchors.Stiffness, goals);
    if (!(energy < 1e300))
    {
      break;
    }
    this->Converged = this->Residual <= this->Tolerance;
    // A fixed point need not be followed downhill all the way.
    if (energy < bestEnergy || this->Converged)
    {
      best = eta;
      bestEnergy = energy;
    }
  }
  this->WarnUnlessConverged();
  return best;
}

void ShapePreservingDeformer::WarnUnlessConverged()
{
  if (!this->Converged)
  {
    std::ostringstream warning;
    warning << "The rotation field has not converged: after " << this->Iterations
            << " iterations the last change was " << this->Residual
            << " of the largest value. The best field so far is used. Allow more iterations, or "
               "turn in several steps (rotations beyond about 270 degrees about different axes do "
               "not converge).";
    this->Warning = warning.str();
  }
}
}
