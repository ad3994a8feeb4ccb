// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/RingFrames.h"

#include "Algebra/Rotation.h"

namespace cartan
{
namespace
{
Eigen::Vector3d EdgeVector(const TriangleMesh& mesh, const Points& points, int d)
{
  return (points.row(mesh.Neighbor(d)) - points.row(mesh.Origin(d))).transpose();
}

/// to from^T of the unit vectors; zero where one has no length.
Eigen::Matrix3d DirectionProduct(const Eigen::Vector3d& to, const Eigen::Vector3d& from)
{
  return to.normalized() * from.normalized().transpose();
}

/// A frame of a one-ring given as vectors: its normal by area, and along the
/// surface the first edge that is not among the shortest ones. The identity for a
/// ring without a normal: any frame does, as long as all key frames share it.
Eigen::Matrix3d FrameOfRing(
  const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& ring, int v)
{
  const int first = mesh.RingBegin(v);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (int d = first; d < mesh.RingEnd(v); ++d)
  {
    const int next = mesh.NextAround(v, d);
    if (next >= 0)
    {
      const Eigen::Vector3d cross = ring[d - first].cross(ring[next - first]);
      normal += cross;
      area += cross.norm();
    }
  }
  if (!(normal.norm() > 1e-10 * area))
  {
    return Eigen::Matrix3d::Identity();
  }
  normal.normalize();
  double longest = 0.0;
  for (const Eigen::Vector3d& edge : ring)
  {
    longest = std::max(longest, (edge - edge.dot(normal) * normal).norm());
  }
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  for (const Eigen::Vector3d& edge : ring)
  {
    const Eigen::Vector3d tangent = edge - edge.dot(normal) * normal;
    if (tangent.norm() > 0.5 * longest)
    {
      frame << tangent.normalized(), normal.cross(tangent).normalized(), normal;
      break;
    }
  }
  return frame;
}
}

Matrices RingRotations(
  const TriangleMesh& mesh, const Points& from, const Points& to, const ExecutionContext& context)
{
  Matrices rotations = Identities(mesh.NumberOfVertices());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const Eigen::Vector3d a = EdgeVector(mesh, from, d);
          const Eigen::Vector3d b = EdgeVector(mesh, to, d);
          products += DirectionProduct(b, a);
          const int next = mesh.NextAround(v, d);
          if (next >= 0)
          {
            products += DirectionProduct(
              b.cross(EdgeVector(mesh, to, next)), a.cross(EdgeVector(mesh, from, next)));
          }
        }
        MatrixAt(rotations, v) = ProjectOnRotations(products);
      }
    });
  return rotations;
}

std::vector<Matrices> RingFrames(
  const TriangleMesh& mesh, const std::vector<Points>& keys, const ExecutionContext& context)
{
  // First the rotations from the first key frame to each.
  const std::size_t count = keys.size();
  std::vector<Matrices> frames{ Identities(mesh.NumberOfVertices()) };
  for (std::size_t k = 1; k < count; ++k)
  {
    frames.push_back(RingRotations(mesh, keys[k - 1], keys[k], context));
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      MatrixAt(frames[k], v) *= MatrixAt(frames[k - 1], v);
    }
    context.Report(static_cast<double>(k) / static_cast<double>(count));
  }
  // Then the same from a frame of the mean one-ring, which no key frame owns more
  // than another.
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      std::vector<Eigen::Vector3d> ring;
      for (int v = begin; v < end; ++v)
      {
        ring.assign(mesh.Valence(v), Eigen::Vector3d::Zero());
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          for (std::size_t k = 0; k < count; ++k)
          {
            ring[d - mesh.RingBegin(v)] +=
              MatrixAt(frames[k], v).transpose() * EdgeVector(mesh, keys[k], d);
          }
        }
        const Eigen::Matrix3d frame = FrameOfRing(mesh, ring, v);
        for (Matrices& ofKey : frames)
        {
          MatrixAt(ofKey, v) *= frame;
        }
      }
    });
  context.Report(1.0);
  return frames;
}
}
