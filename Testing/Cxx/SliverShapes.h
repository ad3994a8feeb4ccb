// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "AllDeformers.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/SliverRemoval.h"
#include "TestShapes.h"

#include <cmath>

/// Tubes with caps and needles, whose ends are handles.
namespace slivers
{
using cartan::DeformedSurface;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::Points;
using shapes::Shape;

constexpr int Around = 14;
constexpr int Along = 16;

/// Along z from -1 to 1, open.
inline Shape Tube()
{
  Shape tube = shapes::OpenCylinder(Around, Along, 0.4, 2.0);
  tube.Positions.rowwise() -= tube.Positions.colwise().mean().eval();
  return tube;
}

inline HandleProblem ProblemOf(const Shape& shape)
{
  HandleProblem problem;
  problem.Mesh =
    std::make_shared<const cartan::TriangleMesh>(shape.NumberOfVertices(), shape.Faces);
  problem.Rest = std::make_shared<const Points>(shape.Positions);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const double z = shape.Positions(v, 2);
    problem.Handle.push_back(z < -0.8 ? 1 : z > 0.8 ? 2 : 0);
  }
  problem.Moving = { 2 };
  return problem;
}

inline HandleTargets Bend(double angle = 0.9)
{
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].RotationVector = { angle, 0.0, 0.3 * angle };
  targets.Motions[0].Linear = cartan::RotationFromVector(targets.Motions[0].RotationVector);
  return targets;
}

/// Splits triangle t by a point at the barycentric coordinates, given last.
inline int SplitTriangle(Shape& shape, int t, const Eigen::Vector3d& weights)
{
  const Eigen::RowVector3i corners = shape.Faces.row(t);
  const int added = shape.NumberOfVertices();
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) = weights[0] * shape.Positions.row(corners[0]) +
    weights[1] * shape.Positions.row(corners[1]) + weights[2] * shape.Positions.row(corners[2]);
  const Eigen::Index count = shape.Faces.rows();
  shape.Faces.conservativeResize(count + 2, 3);
  shape.Faces.row(t) << corners[0], corners[1], added;
  shape.Faces.row(count) << corners[1], corners[2], added;
  shape.Faces.row(count + 1) << corners[2], corners[0], added;
  return added;
}

/// A point at `part` of the edge from a to b splits its triangles.
inline void SplitEdge(Shape& shape, int a, int b, double part)
{
  const int added = shape.NumberOfVertices();
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) =
    (1.0 - part) * shape.Positions.row(a) + part * shape.Positions.row(b);
  const Eigen::Index count = shape.Faces.rows();
  for (Eigen::Index f = 0; f < count; ++f)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int from = shape.Faces(f, i);
      const int to = shape.Faces(f, (i + 1) % 3);
      const int apex = shape.Faces(f, (i + 2) % 3);
      if ((from == a && to == b) || (from == b && to == a))
      {
        shape.Faces.row(f) << from, added, apex;
        shape.Faces.conservativeResize(shape.Faces.rows() + 1, 3);
        shape.Faces.row(shape.Faces.rows() - 1) << added, to, apex;
        break;
      }
    }
  }
}

/// A triangle about the middle of the tube.
inline int MiddleTriangle(const Shape& shape)
{
  int best = 0;
  double least = 1e9;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    double height = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      height += shape.Positions(shape.Faces(t, i), 2) / 3.0;
    }
    if (std::abs(height) < least)
    {
      least = std::abs(height);
      best = static_cast<int>(t);
    }
  }
  return best;
}

inline Points Deform(const deformers::MakeDeformer& make, const HandleProblem& problem)
{
  DeformedSurface result;
  make(problem, {})->Deform(Bend(), false, result, {});
  return result.Positions;
}
}
