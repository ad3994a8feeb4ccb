// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Polygons.h"

#include "Mesh/Geometry.h"

#include <map>
#include <set>

namespace cartan
{
Points PolygonNormals(const Points& points, const Triangles& triangles,
  const std::vector<long long>& polygons, Eigen::Index count)
{
  const Points areaVectors = TriangleAreaVectors(points, triangles);
  Points normals = Points::Zero(count, 3);
  for (Eigen::Index t = 0; t < areaVectors.rows(); ++t)
  {
    normals.row(polygons[t]) += areaVectors.row(t);
  }
  for (Eigen::Index polygon = 0; polygon < count; ++polygon)
  {
    const double size = normals.row(polygon).norm();
    if (size > 0.0)
    {
      normals.row(polygon) /= size;
    }
  }
  return normals;
}

void SplitDoubledPolygonsAlike(Triangles& triangles, const std::vector<long long>& polygons)
{
  std::map<std::vector<int>, Eigen::Index> firstRow;
  for (Eigen::Index begin = 0, end = 0; begin < triangles.rows(); begin = end)
  {
    std::set<int> corners;
    for (; end < triangles.rows() && polygons[end] == polygons[begin]; ++end)
    {
      corners.insert({ triangles(end, 0), triangles(end, 1), triangles(end, 2) });
    }
    const Eigen::Index count = end - begin;
    if (count < 2 || static_cast<Eigen::Index>(corners.size()) != count + 2)
    {
      continue; // a triangle, or a strip that comes back to a point
    }
    const auto known = firstRow.emplace(std::vector<int>(corners.begin(), corners.end()), begin);
    if (!known.second)
    {
      triangles.middleRows(begin, count) = triangles.middleRows(known.first->second, count).eval();
    }
  }
}
}
