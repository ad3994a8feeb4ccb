// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/RotationInvariantDeformer.h"

#include "Algebra/Rotation.h"

#include <cmath>

namespace cartan
{
namespace
{
bool IsRotation(const Eigen::Matrix3d& matrix)
{
  // 1e-9 is far above rounding and far below what anyone sees.
  return (matrix.transpose() * matrix).isApprox(Eigen::Matrix3d::Identity(), 1e-9) &&
    matrix.determinant() > 0.0;
}

}

RotationInvariantDeformer::RotationInvariantDeformer(
  HandleProblem problem, SolverBackend backend, const ExecutionContext& context)
  : FrameDeformer(std::move(problem), backend, context.Part(0.0, 0.8))
  , Harmonic(this->Problem, this->FrameSystem)
{
  context.Report(1.0);
}

bool RotationInvariantDeformer::UsesRotations(const HandleTargets& targets) const
{
  if (this->Projection != FrameProjection::Automatic)
  {
    return this->Projection == FrameProjection::Rotation;
  }
  bool areAllIdentities = true;
  bool areAllRotations = true;
  const auto check = [&](const Eigen::Matrix3d& linear)
  {
    // The identity needs no projection: its blends are the identity.
    areAllIdentities = areAllIdentities && linear.isIdentity(1e-15);
    areAllRotations = areAllRotations && IsRotation(linear);
  };
  if (targets.Transforms.rows())
  {
    for (const HandleVertex& held : this->HandleVertices)
    {
      check(HandleTransform(targets, held.Vertex, held.Handle));
    }
  }
  else
  {
    for (const HandleMotion& motion : targets.Motions)
    {
      check(motion.Linear);
    }
  }
  return areAllRotations && !areAllIdentities;
}

void RotationInvariantDeformer::ComputeTransforms(
  const HandleTargets& targets, const ExecutionContext& context)
{
  const bool project = this->UsesRotations(targets);
  const auto projected = [project](const Eigen::Matrix3d& matrix)
  { return project ? ProjectOnRotations(matrix) : matrix; };

  for (const HandleVertex& held : this->HandleVertices)
  {
    MatrixAt(this->Transforms, held.Vertex) =
      projected(HandleTransform(targets, held.Vertex, held.Handle));
  }

  const HandleLaplacian& frames = *this->FrameSystem;
  if (targets.Transforms.rows() == 0)
  {
    this->BlendMotions(targets, project, context);
    return;
  }

  // R - I is harmonic with the values that the held vertices give, and near those
  // that softly held ones give, projected alike.
  const Field differences = frames.Spread(
    9,
    [&](int local, double* values)
    {
      Eigen::Map<Eigen::Matrix3d>(values, 3, 3) =
        MatrixAt(this->Transforms, frames.Vertex(local)) - Eigen::Matrix3d::Identity();
    },
    context);
  this->AddIdentity(differences, project, context);
}

void RotationInvariantDeformer::AddIdentity(
  const Field& differences, bool project, const ExecutionContext& context)
{
  const HandleLaplacian& frames = *this->FrameSystem;
  context.For(frames.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const Eigen::Matrix3d blend = Eigen::Matrix3d::Identity() +
          Eigen::Map<const Eigen::Matrix3d>(differences.row(i).data());
        MatrixAt(this->Transforms, frames.Vertex(i)) = project ? ProjectOnRotations(blend) : blend;
      }
    });
}

void RotationInvariantDeformer::BlendMotions(
  const HandleTargets& targets, bool project, const ExecutionContext& context)
{
  const HandleLaplacian& frames = *this->FrameSystem;
  const std::vector<HandleMotion>& motions = targets.Motions;
  const int numberOfMoving = static_cast<int>(motions.size());
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();

  std::vector<Eigen::Vector3d> rotationVectors;
  bool areAllRotations = true;
  for (const HandleMotion& motion : motions)
  {
    rotationVectors.push_back(VectorFromRotation(ProjectOnRotations(motion.Linear)));
    areAllRotations = areAllRotations && IsRotation(motion.Linear);
  }
  Eigen::Vector3d axis;
  if (project && areAllRotations && FindSharedAxis(rotationVectors, axis))
  {
    // A blend of rotations about one axis n is n n^T + c (I - n n^T) + s [n]x
    // with the blended cosine and sine, and its projection has them normalized.
    const Eigen::Matrix3d along = axis * axis.transpose();
    const Eigen::Matrix3d across = identity - along;
    Eigen::Matrix3d turn;
    turn << 0.0, -axis[2], axis[1], axis[2], 0.0, -axis[0], -axis[1], axis[0], 0.0;
    Field ofHandles(numberOfMoving, 2);
    for (int k = 0; k < numberOfMoving; ++k)
    {
      const double angle = rotationVectors[k].dot(axis);
      ofHandles.row(k) << std::cos(angle) - 1.0, std::sin(angle);
    }
    const Field blends = this->Harmonic.Blend(ofHandles, context);
    context.For(frames.NumberOfUnknowns(),
      [&](int begin, int end)
      {
        for (int i = begin; i < end; ++i)
        {
          const double cosine = 1.0 + blends(i, 0);
          const double sine = blends(i, 1);
          const double length = std::hypot(cosine, sine);
          MatrixAt(this->Transforms, frames.Vertex(i)) = length > 0.0
            ? Eigen::Matrix3d(along + cosine / length * across + sine / length * turn)
            : identity;
        }
      });
    return;
  }
  Field ofHandles(numberOfMoving, 9);
  for (int k = 0; k < numberOfMoving; ++k)
  {
    Eigen::Map<Eigen::Matrix3d>(ofHandles.row(k).data()) = motions[k].Linear - identity;
  }
  this->AddIdentity(this->Harmonic.Blend(ofHandles, context), project, context);
}

/// Frames that are not projected need no table: DirectSums() are faster.
bool RotationInvariantDeformer::FindTurns(
  const HandleTargets& targets, Eigen::Vector3d& axis, Eigen::VectorXd& angles)
{
  if (targets.IsPerVertex() || !this->Harmonic.IsStored() || !this->UsesRotations(targets))
  {
    return false;
  }
  std::vector<Eigen::Vector3d> rotationVectors;
  for (const HandleMotion& motion : targets.Motions)
  {
    if (!IsRotation(motion.Linear))
    {
      return false;
    }
    rotationVectors.push_back(VectorFromRotation(ProjectOnRotations(motion.Linear)));
  }
  angles.resize(static_cast<Eigen::Index>(rotationVectors.size()));
  if (!FindSharedAxis(rotationVectors, axis))
  {
    return false;
  }
  for (std::size_t k = 0; k < rotationVectors.size(); ++k)
  {
    angles[static_cast<Eigen::Index>(k)] = rotationVectors[k].dot(axis);
  }
  return true;
}

/// The projection of BlendMotions.
TurnParts RotationInvariantDeformer::TurnOf(
  int local, const Eigen::VectorXd& ratios, double angle) const
{
  double cosine = 1.0;
  double sine = 0.0;
  for (Eigen::Index k = 0; k < ratios.size(); ++k)
  {
    const double weight = this->Harmonic.GetWeights()(local, k);
    cosine += weight * (std::cos(ratios[k] * angle) - 1.0);
    sine += weight * std::sin(ratios[k] * angle);
  }
  const double length = std::hypot(cosine, sine);
  return length > 0.0 ? TurnParts{ sine / length, 1.0 - cosine / length } : TurnParts{};
}

void RotationInvariantDeformer::ComputeDragFields(const ExecutionContext& context)
{
  const HandleLaplacian& system = *this->PositionSystem;
  const Field& harmonic = this->Harmonic.GetWeights();
  const Points& rest = *this->Problem.Rest;
  const int numberOfUnknowns = system.NumberOfUnknowns();
  const int numberOfMoving = static_cast<int>(this->Problem.Moving.size());
  // b(h_k I) with the handle k in its rest place and all others at the origin.
  Eigen::MatrixXd rightHandSide(numberOfUnknowns, 3 * numberOfMoving);
  context.For(numberOfUnknowns,
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        for (int k = 0; k < numberOfMoving; ++k)
        {
          Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
          for (const auto* edge = system.EdgesBegin(i); edge != system.EdgesEnd(i); ++edge)
          {
            const int j = edge->Neighbor;
            const auto neighbor = rest.row(system.Vertex(j));
            sum += 0.5 * edge->Weight * (harmonic(i, k) + harmonic(j, k)) *
              (rest.row(system.Vertex(i)) - neighbor);
            if (j >= numberOfUnknowns && system.MovingHandle(j) == k)
            {
              sum += edge->Weight * neighbor;
            }
          }
          if (system.MovingHandle(i) == k)
          {
            sum += 0.5 * system.SquaredSoftWeight(i) * rest.row(system.Vertex(i));
          }
          rightHandSide.block<1, 3>(i, 3 * k) = sum;
        }
      }
    });
  const Eigen::Map<const Eigen::MatrixXd> phi = system.Solve(rightHandSide, context);
  this->DragFields.resize(numberOfUnknowns, 3 + 4 * numberOfMoving);
  for (int i = 0; i < numberOfUnknowns; ++i)
  {
    Eigen::RowVector3d still = rest.row(system.Vertex(i));
    for (int k = 0; k < numberOfMoving; ++k)
    {
      still -= phi.block<1, 3>(i, 3 * k);
      this->DragFields.block<1, 3>(i, 3 + 4 * k) = phi.block<1, 3>(i, 3 * k);
      this->DragFields(i, 6 + 4 * k) = harmonic(i, k);
    }
    this->DragFields.block<1, 3>(i, 0) = still;
  }
}

bool RotationInvariantDeformer::ServesDirectSums(const HandleTargets& targets) const
{
  return this->PositionSystem == this->FrameSystem && this->Harmonic.IsStored() &&
    !targets.IsPerVertex() && !this->UsesRotations(targets);
}

PositionRows RotationInvariantDeformer::DirectSums(
  const HandleTargets& targets, const ExecutionContext& context)
{
  if (!this->ServesDirectSums(targets))
  {
    return {};
  }
  // A piece may have no rows.
  if (this->DragFields.cols() == 0)
  {
    this->ComputeDragFields(context);
  }
  return [this, motions = targets.Motions](int begin, int end, double* rows)
  {
    const auto numberOfFields = static_cast<std::size_t>(this->DragFields.cols());
    const double* fields =
      this->DragFields.data() + static_cast<std::size_t>(begin) * numberOfFields;
    for (int i = begin; i < end; ++i, fields += numberOfFields, rows += 3)
    {
      Eigen::Vector3d position(fields[0], fields[1], fields[2]);
      const double* phi = fields + 3;
      for (const HandleMotion& motion : motions)
      {
        position +=
          motion.Linear * Eigen::Map<const Eigen::Vector3d>(phi) + phi[3] * motion.Translation;
        phi += 4;
      }
      Eigen::Map<Eigen::Vector3d>(rows, 3) = position;
    }
  };
}
}
