// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "HandleShapes.h"
#include "PrepareShapes.h"

#include "Kernel/Deformation/JoinedVertices.h"
#include "Kernel/Measure/VolumeModel.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

/// Surfaces some of whose vertices are copies of others, to be held together.
namespace shapes
{
struct Joint
{
  std::string Name;
  Shape Surface;
  Eigen::VectorXd Ids;         ///< #V, as JoinedPoints; -1 for those alone
  std::vector<int> JoinedWith; ///< #V
  bool IsPoint = true;         ///< one vertex holds the limb, not an edge
  int AtJoint = -1;            ///< a vertex of the body that has copies
  int FarEnd = -1;             ///< the vertex of the limb farthest from it
  std::vector<int> Limb;       ///< all of the limb's vertices, a copy first
};

/// Gives every vertex a copy that takes the second half of its fan, but for those on the
/// border or next to it, and those that would have two such neighbors.
inline Joint Split(const Shape& whole)
{
  const int numberOfVertices = whole.NumberOfVertices();
  const cartan::TriangleMesh mesh(numberOfVertices, whole.Faces);
  Joint split;
  split.Surface = whole;
  split.JoinedWith.resize(numberOfVertices);
  std::iota(split.JoinedWith.begin(), split.JoinedWith.end(), 0);
  std::vector<char> isNearSplit(numberOfVertices, 0);
  std::vector<int> vertices;
  for (int v = 0; v < numberOfVertices; ++v)
  {
    bool isFree = !isNearSplit[v] && mesh.IsUsed(v) && !mesh.IsBoundary(v);
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      isFree = isFree && !isNearSplit[mesh.Neighbor(d)] && !mesh.IsBoundary(mesh.Neighbor(d));
    }
    if (!isFree)
    {
      continue;
    }
    const int copy = numberOfVertices + static_cast<int>(vertices.size());
    vertices.push_back(v);
    split.JoinedWith.push_back(v);
    isNearSplit[v] = 1;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      isNearSplit[mesh.Neighbor(d)] = 1;
      if (mesh.LeftTriangle(d) >= 0 && d >= mesh.RingBegin(v) + mesh.Valence(v) / 2)
      {
        auto corners = split.Surface.Faces.row(mesh.LeftTriangle(d));
        std::replace(corners.begin(), corners.end(), v, copy);
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(split.JoinedWith.size());
  split.Surface.Positions.conservativeResize(size, 3);
  split.Ids.resize(size);
  for (Eigen::Index v = 0; v < size; ++v)
  {
    split.Ids[v] = split.JoinedWith[v];
    split.Surface.Positions.row(v) = whole.Positions.row(split.JoinedWith[v]);
  }
  return split;
}

/// What the two ends of the body of Joints() are.
inline int EndsOfBody(const Eigen::Vector3d& x)
{
  return x[2] < -1.5 ? 1 : x[2] > 1.5 ? 2 : 0;
}

/// A surface that meets itself, cut where it does.
inline Joint JointOf(const std::string& name, const Shape& body, const Shape& limb)
{
  const Shape both = Union(body, limb);
  cartan::RepairOptions options = MergingAll();
  options.MergeTolerance = 1e-9;
  options.DropsDoubled = false;
  const cartan::RepairedSurface repaired =
    cartan::RepairSurface(both.Positions, both.Faces, options);
  Joint joint;
  joint.Name = name;
  joint.Surface = { repaired.Positions, repaired.Faces };
  joint.JoinedWith = repaired.CopyOf;
  joint.Ids = Eigen::VectorXd::Constant(repaired.Positions.rows(), -1.0);
  int count = 0;
  for (int v = 0; v < joint.Surface.NumberOfVertices(); ++v)
  {
    const int first = repaired.CopyOf[v];
    if (first != v)
    {
      joint.Ids[v] = joint.Ids[first] = first;
      joint.AtJoint = first;
      joint.Limb.insert(joint.Limb.begin(), v);
      ++count;
    }
    else if (repaired.OriginalPoints[v] >= body.NumberOfVertices())
    {
      joint.Limb.push_back(v);
    }
  }
  joint.IsPoint = count == 1;
  joint.FarEnd = *std::max_element(joint.Limb.begin(), joint.Limb.end(),
    [&](int v, int w)
    {
      const auto from = joint.Surface.Positions.row(joint.AtJoint);
      return (joint.Surface.Positions.row(v) - from).norm() <
        (joint.Surface.Positions.row(w) - from).norm();
    });
  return joint;
}

/// The limb with its vertex 0, the lowest corner of a bar, at a point of the bar of
/// Joints(), leaning away from it so that nothing else than its z axis touches.
inline Shape Hanging(Shape limb, double lean)
{
  const Eigen::RowVector3d at(0.5, 1.0 / 6.0, 0.0);
  limb.Positions.rowwise() += at - limb.Positions.row(0);
  for (Eigen::Index v = 0; v < limb.Positions.rows(); ++v)
  {
    const Eigen::RowVector3d from = limb.Positions.row(v) - at;
    limb.Positions(v, 0) += 0.3 * from[1] + lean * from[2];
  }
  return limb;
}

/// A bar along z from -2 to 2 with limbs that hang on the middle of one side, by a point
/// or by edges, closed ones and sheets. A block on a point comes first.
inline std::vector<Joint> Joints()
{
  const Shape body = Moved(Bar(3, 3, 12, { 1.0, 1.0, 4.0 }, true), { 0.0, 0.0, -2.0 });
  // Edges of a third, as the body's.
  const Shape block = Bar(2, 2, 3, { 0.5, 0.4, 1.0 }, true);
  PatchOptions options;
  options.CountU = 4;
  options.CountV = 3;
  const Shape sheet =
    Patch(options, [](double u, double v) { return Eigen::Vector3d(u, 0.2 * u * u, v); });
  return { JointOf("block on a point", body, Hanging(block, 0.4)),
    JointOf("sheet on a point", body, Hanging(sheet, 0.4)),
    JointOf("block on edges", body, Hanging(block, 0.0)),
    JointOf("sheet on edges", body, Hanging(sheet, 0.0)) };
}

/// The same with a cap in a triangle at the joint.
inline Joint WithCapAtJoint(Joint joint)
{
  Shape& surface = joint.Surface;
  Eigen::Index t = 0;
  while ((surface.Faces.row(t).array() != joint.AtJoint).all())
  {
    ++t;
  }
  const Eigen::RowVector3i corners = surface.Faces.row(t);
  const int low = surface.NumberOfVertices();
  Eigen::RowVector3d place = 1e-6 * surface.Positions.row(joint.AtJoint);
  for (int c = 0; c < 3; ++c)
  {
    if (corners[c] != joint.AtJoint)
    {
      place += 0.5 * (1.0 - 1e-6) * surface.Positions.row(corners[c]);
    }
  }
  surface.Positions.conservativeResize(low + 1, 3);
  surface.Positions.row(low) = place;
  surface.Faces.conservativeResize(surface.Faces.rows() + 2, 3);
  surface.Faces.row(t) << corners[0], corners[1], low;
  surface.Faces.bottomRows(2) << corners[1], corners[2], low, corners[2], corners[0], low;
  joint.Ids.conservativeResize(low + 1);
  joint.Ids[low] = -1.0;
  joint.JoinedWith.push_back(low);
  return joint;
}

/// The problem with all vertices apart.
inline cartan::HandleProblem PartedProblem(
  const Joint& joint, const HandleOf& handleOf, const std::vector<int>& moving = { 2 })
{
  return ProblemOf(joint.Surface, handleOf, moving);
}

inline cartan::HandleProblem JoinedProblem(
  const Joint& joint, const HandleOf& handleOf, const std::vector<int>& moving = { 2 })
{
  cartan::HandleProblem problem = PartedProblem(joint, handleOf, moving);
  cartan::HoldTogether(joint.Ids, problem);
  return cartan::WithJoinedVertices(std::move(problem));
}

inline cartan::VolumeModel VolumeModelOf(
  const cartan::TriangleMesh& mesh, const cartan::Points& points)
{
  const cartan::RayTree tree(mesh.GetTriangles(), points);
  return cartan::MeasureVolumeModel(mesh, points,
    [&tree](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
    { return tree.FirstHit(from, direction); });
}

/// sum of (x' - mean') (x - mean)^T.
inline Eigen::Matrix3d Covariance(
  const cartan::Points& rest, const cartan::Points& now, const std::vector<int>& vertices)
{
  Eigen::RowVector3d restMean = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  for (const int v : vertices)
  {
    restMean += rest.row(v) / static_cast<double>(vertices.size());
    mean += now.row(v) / static_cast<double>(vertices.size());
  }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const int v : vertices)
  {
    sum += (now.row(v) - mean).transpose() * (rest.row(v) - restMean);
  }
  return sum;
}
}
