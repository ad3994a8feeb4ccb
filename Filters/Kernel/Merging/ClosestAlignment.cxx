// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/ClosestAlignment.h"

#include "Algebra/SimilarityFit.h"
#include "Mesh/TriangleTree.h"
#include "Mesh/UsedVertices.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// How many points take part, and how often their places are found.
constexpr Eigen::Index LargestSample = 1000;
constexpr int Iterations = 100;

/// Points that move by less than this part of their extent have arrived.
constexpr double Rest = 1e-13;

Points Sample(const Points& points)
{
  const Eigen::Index step = std::max<Eigen::Index>(1, points.rows() / LargestSample);
  Points sample(points.rows() / step, 3);
  for (Eigen::Index i = 0; i < sample.rows(); ++i)
  {
    sample.row(i) = points.row(i * step);
  }
  return sample;
}

Points ClosestPoints(
  const TriangleTree& tree, const Triangles& triangles, const Points& points, const Points& queries)
{
  Points closest(queries.rows(), 3);
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const auto [triangle, place] = tree.Closest(queries.row(i).transpose());
    closest.row(i).setZero();
    for (int c = 0; c < 3; ++c)
    {
      closest.row(i) += place.Weights[c] * points.row(triangles(triangle, c));
    }
  }
  return closest;
}

/// The root of the mean squared distance from the mean.
double Extent(const Points& points)
{
  const Eigen::RowVector3d mean = points.colwise().mean();
  return (points.rowwise() - mean).norm() / std::sqrt(static_cast<double>(points.rows()));
}

/// x -> mean of `to` + s R (x - mean of `from`), s = extent of `to` / extent of `from`.
Eigen::Matrix4d Fit(const Points& from, const Points& to, bool scales)
{
  Eigen::Matrix4d fit = FitSimilarity(from, to, false);
  const double before = Extent(from);
  if (scales && before > 0.0)
  {
    fit.topLeftCorner<3, 3>() *= Extent(to) / before;
    const Eigen::Vector3d mean = from.colwise().mean();
    const Eigen::Vector3d goal = to.colwise().mean();
    fit.topRightCorner<3, 1>() = goal - fit.topLeftCorner<3, 3>() * mean;
  }
  return fit;
}
}

Eigen::Matrix4d AlignToSurface(const Points& from, const TriangleMesh& mesh, const Points& points,
  bool scales, const ExecutionContext& context)
{
  const TriangleTree tree(mesh.GetTriangles(), points);
  const Points surface = points(UsedVertices(mesh), Eigen::all);
  // As large as the surface from the start: what is much smaller has all its places on one spot.
  const double extent = Extent(from);
  const double scale = scales && extent > 0.0 ? Extent(surface) / extent : 1.0;
  Eigen::Matrix4d alignment = Eigen::Matrix4d::Identity();
  alignment.topLeftCorner<3, 3>() *= scale;
  alignment.topRightCorner<3, 1>() =
    (surface.colwise().mean() - scale * from.colwise().mean()).transpose();
  Points moving = Moved(Sample(from), alignment);
  for (int i = 0; i < Iterations; ++i)
  {
    context.Report(static_cast<double>(i) / Iterations);
    const Points places = ClosestPoints(tree, mesh.GetTriangles(), points, moving);
    const Eigen::Matrix4d step = Fit(moving, places, scales);
    const Points next = Moved(moving, step);
    const double moved = (next - moving).norm() / std::sqrt(static_cast<double>(next.rows()));
    const bool hasArrived = moved <= Rest * Extent(next);
    moving = next;
    alignment = step * alignment;
    if (hasArrived)
    {
      break;
    }
  }
  return alignment;
}
}
