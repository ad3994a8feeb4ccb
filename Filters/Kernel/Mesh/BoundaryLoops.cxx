// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/BoundaryLoops.h"

namespace cartan
{
std::vector<BoundaryLoop> FindBoundaryLoops(const TriangleMesh& mesh)
{
  std::vector<BoundaryLoop> loops;
  std::vector<char> isDone(mesh.NumberOfVertices(), 0);
  for (int first = 0; first < mesh.NumberOfVertices(); ++first)
  {
    if (isDone[first] || !mesh.IsBoundary(first))
    {
      continue;
    }
    BoundaryLoop loop;
    loop.Component = mesh.Component(first);
    // The ring of a boundary vertex begins with the edge that has its only
    // triangle on the left.
    for (int v = first; !isDone[v]; v = mesh.Neighbor(mesh.RingBegin(v)))
    {
      isDone[v] = 1;
      loop.Vertices.push_back(v);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

LoopMeasures MeasureLoop(const Points& curve)
{
  LoopMeasures measures;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  const Eigen::RowVector3d origin = curve.row(0);
  for (Eigen::Index i = 0; i < curve.rows(); ++i)
  {
    const Eigen::Vector3d a = (curve.row(i) - origin).transpose();
    const Eigen::Vector3d b = (curve.row((i + 1) % curve.rows()) - origin).transpose();
    const double length = (b - a).norm();
    measures.Length += length;
    moment += 0.5 * length * (a + b);
    area += 0.5 * a.cross(b);
  }
  measures.Center = origin.transpose();
  if (measures.Length > 0.0)
  {
    measures.Center += moment / measures.Length;
  }
  measures.AreaVector = area;
  return measures;
}
}
