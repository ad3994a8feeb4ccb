// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/Areas.h"

#include "Mesh/Geometry.h"

#include <limits>

namespace cartan
{
Eigen::VectorXd TriangleAreas(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  return 0.5 * TriangleAreaVectors(points, mesh.GetTriangles(), context).rowwise().norm();
}

Eigen::VectorXd BarycentricAreas(const TriangleMesh& mesh, const Eigen::VectorXd& triangleAreas)
{
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      areas[mesh.GetTriangles()(t, corner)] += triangleAreas[t] / 3.0;
    }
  }
  return areas;
}

Eigen::VectorXd Ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& current)
{
  Eigen::VectorXd ratios(reference.size());
  for (Eigen::Index i = 0; i < reference.size(); ++i)
  {
    if (reference[i] > 0.0)
    {
      ratios[i] = current[i] / reference[i];
    }
    else
    {
      ratios[i] =
        reference[i] == 0.0 && current[i] == 0.0 ? 1.0 : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return ratios;
}
}
