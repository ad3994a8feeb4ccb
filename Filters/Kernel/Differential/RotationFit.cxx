// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/RotationFit.h"

#include "Algebra/Rotation.h"
#include "Mesh/Geometry.h"

namespace cartan
{
Matrices FitRotations(const TriangleMesh& mesh, const Points& reference, const Points& current,
  const ExecutionContext& context, const Eigen::VectorXd& edgeWeights)
{
  const Points referenceNormals = VertexNormals(mesh, reference, context);
  const Points currentNormals = VertexNormals(mesh, current, context);
  Matrices rotations(mesh.NumberOfVertices(), 9);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        double size = 0.0;
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const int w = mesh.Neighbor(d);
          const Eigen::RowVector3d before = reference.row(w) - reference.row(v);
          const Eigen::RowVector3d after = current.row(w) - current.row(v);
          const double weight = edgeWeights.size() ? edgeWeights[d] : 1.0;
          covariance += weight * after.transpose() * before;
          size += weight * before.norm() * after.norm();
        }
        // The edges of a flat ring, or of one whose edges are all but in line,
        // leave the rotation to rounding; the normal settles it.
        covariance += size * currentNormals.row(v).transpose() * referenceNormals.row(v);
        MatrixAt(rotations, v) = size > 0.0 ? ProjectOnRotations(covariance / size)
                                            : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
      }
    });
  return rotations;
}

std::vector<Eigen::Matrix3d> FitComponentRotations(const TriangleMesh& mesh, const Points& from,
  const Points& fromCenters, const Points& to, const Points& toCenters,
  const Eigen::VectorXd& weights)
{
  std::vector<Eigen::Matrix3d> rotations(mesh.NumberOfComponents(), Eigen::Matrix3d::Zero());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && weights[v] > 0.0)
    {
      const int c = mesh.Component(v);
      rotations[c] += weights[v] * (to.row(v) - toCenters.row(c)).transpose() *
        (from.row(v) - fromCenters.row(c));
    }
  }
  for (Eigen::Matrix3d& rotation : rotations)
  {
    rotation = ProjectOnRotations(rotation);
  }
  return rotations;
}
}
