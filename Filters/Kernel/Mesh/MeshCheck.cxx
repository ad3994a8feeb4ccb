// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/MeshCheck.h"

#include "Mesh/TriangleMesh.h"
#include "Mesh/TriangleShape.h"

namespace cartan
{
bool MeshReport::IsManifold() const
{
  return this->TooManyTriangles == 0 && this->OutOfRange.IsEmpty() &&
    this->RepeatedVertex.IsEmpty() && this->NonManifoldEdges.IsEmpty() &&
    this->InconsistentEdges.IsEmpty() && this->NonManifoldVertices.IsEmpty();
}

std::string MeshReport::DescribeErrors(const std::vector<long long>& cellIds) const
{
  std::string text;
  const auto add = [&text](const IdSample& sample, const char* singular, const char* plural,
                     const std::string& problem)
  {
    if (!sample.IsEmpty())
    {
      text += (text.empty() ? "" : " ") + sample.Describe(singular, plural) + problem;
    }
  };
  if (this->TooManyTriangles > 0)
  {
    text = std::to_string(this->TooManyTriangles) + " triangles; at most " +
      std::to_string(TriangleMesh::MostTriangles) +
      " are supported: decimate or split the surface.";
  }
  add(this->OutOfRange.Renamed(cellIds), "triangle", "triangles",
    " using a point that does not exist: repair the cells.");
  add(this->RepeatedVertex.Renamed(cellIds), "triangle", "triangles",
    " using a point twice: remove them with Prepare Surface.");
  add(this->NonFinite, "point", "points",
    " with a NaN or infinite coordinate: repair or remove them.");
  add(this->NonManifoldEdges, "edge", "edges",
    " with more than two triangles, ids of the first end points: cut the surface there with "
    "Prepare Surface.");
  add(this->InconsistentEdges, "edge", "edges",
    " between triangles of opposite orientation, ids of the first end points: orient the surface "
    "with Prepare Surface.");
  add(this->NonManifoldVertices, "point", "points",
    " where several fans of triangles meet: give each fan a point of its own with Prepare "
    "Surface.");
  return text;
}

void CheckPositions(const Points& points, const Triangles& triangles, MeshReport& report)
{
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    if (!points.row(v).allFinite())
    {
      report.NonFinite.Add(v);
    }
  }
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    const auto corners = triangles.row(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= points.rows())
    {
      continue;
    }
    const Eigen::Vector3d a = points.row(corners[0]);
    const Eigen::Vector3d b = points.row(corners[1]);
    const Eigen::Vector3d c = points.row(corners[2]);
    if (!HasArea((b - a).cross(c - a).norm(), LongestEdgeSquared(a, b, c)))
    {
      report.ZeroArea.Add(t);
    }
  }
}
}
