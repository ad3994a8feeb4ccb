// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/RoundingCheck.h"

#include "Algebra/Rotation.h"
#include "Deformation/JoinedVertices.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace cartan
{
namespace
{
/// The same numbers on every machine, in [-1, 1).
double SignedUnit(std::mt19937& random)
{
  return std::ldexp(static_cast<double>(random()), -31) - 1.0;
}

Eigen::Vector3d SignedUnits(std::mt19937& random)
{
  const double x = SignedUnit(random);
  const double y = SignedUnit(random);
  return { x, y, SignedUnit(random) };
}

/// (I + [e]) A for a small random vector e; the identity stays.
Eigen::Matrix3d TurnedSlightly(const Eigen::Matrix3d& transform, std::mt19937& random)
{
  const Eigen::Vector3d by = RoundingOfTurns * SignedUnits(random);
  return transform.isIdentity(0.0) ? transform
                                   : Eigen::Matrix3d(transform - transform.colwise().cross(by));
}

/// By a part of its length; zero stays.
Eigen::Vector3d MovedSlightly(const Eigen::Vector3d& vector, std::mt19937& random)
{
  return vector + RoundingOfTurns * vector.norm() * SignedUnits(random);
}
}

HandleProblem WithMovedPoints(HandleProblem problem)
{
  Points moved = *problem.Rest;
  const double by = RoundingOfInput * BoundingDiagonal(moved, problem.GetWhole()->GetTriangles());
  std::mt19937 random(1);
  for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
  {
    for (int c = 0; c < 3; ++c)
    {
      moved(v, c) += by * SignedUnit(random);
    }
  }
  FollowJoined(problem.JoinedWith, moved);
  problem.Rest = std::make_shared<const Points>(std::move(moved));
  return problem;
}

HandleTargets WithMovedTargets(HandleTargets targets)
{
  std::mt19937 random(2);
  for (HandleMotion& motion : targets.Motions)
  {
    motion.Linear = TurnedSlightly(motion.Linear, random);
    motion.RotationVector = MovedSlightly(motion.RotationVector, random);
  }
  for (Eigen::Index row = 0; row < targets.Transforms.rows(); ++row)
  {
    MatrixAt(targets.Transforms, row) = TurnedSlightly(MatrixAt(targets.Transforms, row), random);
  }
  for (Eigen::Index row = 0; row < targets.RotationVectors.rows(); ++row)
  {
    targets.RotationVectors.row(row) =
      MovedSlightly(targets.RotationVectors.row(row).transpose(), random).transpose();
  }
  return targets;
}

double ShortMotion(const HandleProblem& problem)
{
  const Triangles& triangles = problem.GetWhole()->GetTriangles();
  const double edge = triangles.rows() > 0
    ? (problem.Rest->row(triangles(0, 0)) - problem.Rest->row(triangles(0, 1))).norm()
    : 0.0;
  return FarthestMotion * edge / std::sqrt(3.0);
}

std::string DescribeLostDigits(const HandleProblem& problem, const DeformedSurface& result)
{
  // At each motion, in a single pass. A piece may be empty.
  if (result.Positions.rows() == 0 ||
    (result.Positions - *problem.Rest).cwiseAbs().maxCoeff() <= ShortMotion(problem))
  {
    return {};
  }
  const Triangles& triangles = problem.GetWhole()->GetTriangles();
  const double size = BoundingDiagonal(*problem.Rest, triangles);
  const double farthest = (result.Positions - *problem.Rest).rowwise().norm().maxCoeff();
  if (!(farthest > FarthestMotion * size))
  {
    return {};
  }
  std::ostringstream text;
  text.precision(2);
  text << "Points move by up to " << farthest / size
       << " times the size of the surface: their coordinates have no digits for its shape. Use "
          "smaller motions.";
  return text.str();
}

RoundingDifference CompareResults(const HandleProblem& problem, const DeformedSurface& result,
  const DeformedSurface& other, const ComparedFields& fields)
{
  const TriangleMesh& mesh = *problem.GetWhole();
  Points normals;
  Points otherNormals;
  if (fields.Normals)
  {
    normals = VertexNormals(mesh, result.Positions);
    otherNormals = VertexNormals(mesh, other.Positions);
  }
  const double size = std::max(BoundingDiagonal(result.Positions, mesh.GetTriangles()),
    BoundingDiagonal(*problem.Rest, mesh.GetTriangles()));
  RoundingDifference difference;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!mesh.IsUsed(v))
    {
      continue;
    }
    const double moved = (result.Positions.row(v) - other.Positions.row(v)).norm() / size;
    double rest = std::abs(result.FrameScale[v] - other.FrameScale[v]);
    if (fields.Transforms)
    {
      const auto transform = MatrixAt(result.Transforms, v);
      rest = (transform - MatrixAt(other.Transforms, v)).norm() / (1.0 + transform.norm());
    }
    if (fields.Rotations)
    {
      rest = std::max(rest,
        (ProjectOnRotations(MatrixAt(result.Transforms, v)) -
          ProjectOnRotations(MatrixAt(other.Transforms, v)))
          .norm());
    }
    if (fields.Normals)
    {
      rest = std::max(rest, (normals.row(v) - otherNormals.row(v)).norm());
    }
    // Also where one of them is not finite.
    if (!(std::max(moved, rest) <= RoundingOfResult))
    {
      difference.Vertices.Add(v);
      difference.Largest = std::max(difference.Largest, moved);
    }
  }
  return difference;
}

std::string RoundingDifference::Describe() const
{
  if (this->Vertices.IsEmpty())
  {
    return {};
  }
  std::ostringstream text;
  text << "Rounding decides about " << this->Vertices.Describe("point", "points")
       << ": when the points of the surface move by " << RoundingOfInput
       << " of its size, and motions turn by less, ";
  if (this->Largest > RoundingOfResult)
  {
    text.precision(2);
    text << "the result moves by up to " << this->Largest << " of it. ";
  }
  else
  {
    text << "the rotations or normals there change. ";
  }
  if (this->IsOfSlivers)
  {
    text << "It decides which thin triangles the surface is solved without: flip edges first "
            "(Prepare Surface, Flip Edges).";
    return text.str();
  }
  text << "The handles leave open what happens there, turn it by about half a turn against what is "
          "beside it, or crush it: hold more points, use smaller motions, or Rotation Invariant "
          "Deformation "
          "with uniform LaplacianWeights and FrameProjection off.";
  return text.str();
}
}
