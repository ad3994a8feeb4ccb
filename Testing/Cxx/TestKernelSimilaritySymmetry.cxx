// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/SimilarityDeformer.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::Points;
using cartan::RotationFromVector;
using cartan::SimilarityDeformer;
using cartan::SimilarityReconstruction;
using cartan::TriangleMesh;
using Eigen::Vector3d;
using shapes::Shape;

namespace
{
constexpr SimilarityReconstruction AllReconstructions[] = { SimilarityReconstruction::Affine,
  SimilarityReconstruction::LeastSquares, SimilarityReconstruction::EdgeForm };

/// Handles 1 and 2 where coordinate `axis` is in the lowest and highest tenth; 2
/// moves. `turn` puts the surface elsewhere.
HandleProblem EndsHeld(const Shape& shape, int axis, const Eigen::Matrix3d& turn)
{
  HandleProblem problem;
  problem.Mesh = std::make_shared<const TriangleMesh>(shapes::MakeMesh(shape));
  problem.Rest = std::make_shared<const Points>(shape.Positions * turn.transpose());
  const auto along = shape.Positions.col(axis);
  const double low = along.minCoeff();
  const double size = along.maxCoeff() - low;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const double part = (along[v] - low) / size;
    problem.Handle.push_back(part < 0.1 + 1e-9 ? 1 : part > 0.9 - 1e-9 ? 2 : 0);
  }
  problem.Moving = { 2 };
  return problem;
}

Points Deform(const HandleProblem& problem, SimilarityReconstruction reconstruction,
  const Eigen::Matrix3d& linear, const Vector3d& translation)
{
  SimilarityDeformer deformer(problem, {});
  deformer.SetReconstruction(reconstruction);
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].Linear = linear;
  targets.Motions[0].Translation = translation;
  cartan::DeformedSurface result;
  deformer.Deform(targets, false, result, {});
  return result.Positions;
}

/// A plate without thickness: a plane and its other side, joined at the border.
/// `twins` has the pairs of points that are in one place.
Shape Plate(int count, std::vector<std::pair<int, int>>& twins)
{
  const Shape front = shapes::Plane(count);
  const int size = front.NumberOfVertices();
  const Eigen::RowVector3d low = front.Positions.colwise().minCoeff();
  const Eigen::RowVector3d high = front.Positions.colwise().maxCoeff();
  std::vector<int> back(size);
  int next = size;
  for (int v = 0; v < size; ++v)
  {
    const Eigen::RowVector3d point = front.Positions.row(v);
    const bool isBorder =
      (point - low).head<2>().minCoeff() < 1e-9 || (high - point).head<2>().minCoeff() < 1e-9;
    back[v] = isBorder ? v : next++;
  }
  Shape plate;
  plate.Positions.resize(next, 3);
  plate.Positions.topRows(size) = front.Positions;
  for (int v = 0; v < size; ++v)
  {
    if (back[v] >= size)
    {
      plate.Positions.row(back[v]) = front.Positions.row(v);
      twins.emplace_back(v, back[v]);
    }
  }
  // Corners whose points are all on the border would have the same triangle on
  // both sides: they are cut off.
  plate.Faces.resize(2 * front.Faces.rows(), 3);
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < front.Faces.rows(); ++t)
  {
    const auto corners = front.Faces.row(t);
    if (back[corners[0]] == corners[0] && back[corners[1]] == corners[1] &&
      back[corners[2]] == corners[2])
    {
      continue;
    }
    plate.Faces.row(kept++) = corners;
    plate.Faces.row(kept++) << back[corners[0]], back[corners[2]], back[corners[1]];
  }
  plate.Faces.conservativeResize(kept, 3);
  return plate;
}

/// Splits the first edge a - b in the middle of the tube's length by a point at
/// `part` of it, which comes last.
Shape WithNeedle(const Shape& shape, double part)
{
  const double middle =
    0.5 * (shape.Positions.col(2).minCoeff() + shape.Positions.col(2).maxCoeff());
  int a = 0;
  (shape.Positions.col(2).array() - middle).abs().minCoeff(&a);
  int b = -1;
  Shape split = shape;
  const int added = shape.NumberOfVertices();
  split.Positions.conservativeResize(added + 1, 3);
  std::vector<Eigen::RowVector3i> triangles;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    const Eigen::RowVector3i corners = shape.Faces.row(t);
    bool isSplit = false;
    for (int c = 0; c < 3 && !isSplit; ++c)
    {
      const int from = corners[c];
      const int to = corners[(c + 1) % 3];
      if (b < 0 && from == a)
      {
        b = to;
      }
      if ((from == a && to == b) || (from == b && to == a))
      {
        const int third = corners[(c + 2) % 3];
        triangles.emplace_back(from, added, third);
        triangles.emplace_back(added, to, third);
        isSplit = true;
      }
    }
    if (!isSplit)
    {
      triangles.push_back(corners);
    }
  }
  split.Positions.row(added) =
    (1.0 - part) * shape.Positions.row(a) + part * shape.Positions.row(b);
  split.Faces.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    split.Faces.row(static_cast<Eigen::Index>(t)) = triangles[t];
  }
  return split;
}
}

TEST(SimilaritySymmetry, MotionsInAPlaneStayInIt)
{
  for (const Eigen::Matrix3d& frame :
    { Eigen::Matrix3d(Eigen::Matrix3d::Identity()), RotationFromVector({ 0.4, 1.1, -0.7 }) })
  {
    const HandleProblem problem = EndsHeld(shapes::Plane(24), 0, frame);
    const Vector3d normal = frame.col(2);
    const Eigen::Matrix3d turn = RotationFromVector(0.7 * normal);
    for (const SimilarityReconstruction reconstruction : AllReconstructions)
    {
      const Points result = Deform(problem, reconstruction, turn, frame * Vector3d(0.3, 0.2, 0.0));
      EXPECT_LT((result * normal).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}

TEST(SimilaritySymmetry, BothSidesOfAPlateStayTogether)
{
  std::vector<std::pair<int, int>> twins;
  const HandleProblem problem =
    EndsHeld(Plate(16, twins), 1, Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  ASSERT_GT(twins.size(), 150U);
  for (const SimilarityReconstruction reconstruction : AllReconstructions)
  {
    const Points result = Deform(
      problem, reconstruction, RotationFromVector({ 0.9, 0.0, 0.0 }), Vector3d(0.0, 0.1, 0.2));
    double apart = 0.0;
    for (const auto& [front, back] : twins)
    {
      apart = std::max(apart, (result.row(front) - result.row(back)).norm());
    }
    EXPECT_LT(apart, 1e-10);
    // It leaves its plane.
    EXPECT_GT(result.col(2).maxCoeff() - result.col(2).minCoeff(), 0.1);
  }
}

TEST(SimilaritySymmetry, MirroredMotionsGiveMirroredSurfaces)
{
  // A sheet whose diagonals are symmetric to y = 0 is bent: the result is too.
  const int count = 12;
  Shape sheet;
  sheet.Positions.resize((count + 1) * (2 * count + 1), 3);
  std::vector<Eigen::RowVector3i> triangles;
  const auto at = [&](int i, int j) { return i * (2 * count + 1) + j + count; };
  for (int i = 0; i <= count; ++i)
  {
    for (int j = -count; j <= count; ++j)
    {
      sheet.Positions.row(at(i, j)) << static_cast<double>(i) / count,
        static_cast<double>(j) / count, 0.0;
      if (i < count && j < count)
      {
        const int a = at(i, j);
        const int b = at(i + 1, j);
        const int c = at(i + 1, j + 1);
        const int d = at(i, j + 1);
        triangles.emplace_back(a, b, j < 0 ? d : c);
        triangles.emplace_back(j < 0 ? b : a, c, d);
      }
    }
  }
  sheet.Faces.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    sheet.Faces.row(static_cast<Eigen::Index>(t)) = triangles[t];
  }
  const HandleProblem problem = EndsHeld(sheet, 0, Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  for (const SimilarityReconstruction reconstruction : AllReconstructions)
  {
    const Points result = Deform(
      problem, reconstruction, RotationFromVector({ 0.0, -1.0, 0.0 }), Vector3d(-0.2, 0.0, 0.1));
    double asymmetry = 0.0;
    for (int i = 0; i <= count; ++i)
    {
      for (int j = 0; j <= count; ++j)
      {
        const Eigen::RowVector3d mirrored =
          result.row(at(i, -j)).cwiseProduct(Eigen::RowVector3d(1.0, -1.0, 1.0));
        asymmetry = std::max(asymmetry, (result.row(at(i, j)) - mirrored).norm());
      }
    }
    EXPECT_LT(asymmetry, 1e-10);
  }
}

// A point next to another one counts with the area around it.
TEST(SimilarityMasses, NeedlesDoNotMoveOthers)
{
  const Shape tube = shapes::OpenCylinder(32, 48, 0.5, 5.0);
  const Eigen::Matrix3d bend = RotationFromVector({ 1.2, 0.0, 0.0 });
  const Vector3d shift(0.0, 1.5, -0.3);
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  for (const SimilarityReconstruction reconstruction : AllReconstructions)
  {
    const Points clean = Deform(EndsHeld(tube, 2, upright), reconstruction, bend, shift);
    for (const double part : { 0.1, 0.01, 0.001 })
    {
      const Points result =
        Deform(EndsHeld(WithNeedle(tube, part), 2, upright), reconstruction, bend, shift);
      const double moved = (result.topRows(clean.rows()) - clean).rowwise().norm().maxCoeff();
      shapes::ShowFigure("moved by a needle of " + std::to_string(part), moved);
      EXPECT_LT(moved, 0.01);
    }
  }
}

TEST(SimilaritySymmetry, NoMotionMovesNothing)
{
  const HandleProblem problem =
    EndsHeld(shapes::Bar(4, 4, 12, { 1.0, 1.0, 4.0 }), 2, RotationFromVector({ 0.4, 1.1, -0.7 }));
  for (int stored : { 0, 64 })
  {
    HandleProblem same = problem;
    same.StoredHandles = stored;
    const Points result =
      Deform(same, SimilarityReconstruction::Affine, Eigen::Matrix3d::Identity(), Vector3d::Zero());
    EXPECT_TRUE(result == *problem.Rest);
  }
}
