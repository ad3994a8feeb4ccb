// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/CurveDeltas.h"

#include "Algebra/ConstrainedSolver.h"
#include "Algebra/Rotation.h"
#include "Base/Error.h"
#include "Differential/Laplacian.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// The mean direction of the curve's segments near x, of length 1 or 0: they count with their
/// lengths and 1 / (d^2 + h^2)^2 for their distances d. The nearest one alone would jump from
/// segment to segment. h^2 is the mean of squared lengths.
Eigen::Vector3d TangentNear(
  const Points& points, const std::vector<int>& path, bool isClosed, const Eigen::Vector3d& x)
{
  const std::size_t segments = path.size() - (isClosed ? 0 : 1);
  const auto edgeFrom = [&](std::size_t i) -> Eigen::Vector3d
  { return (points.row(path[(i + 1) % path.size()]) - points.row(path[i])).transpose(); };
  double meanSquare = 0.0;
  for (std::size_t i = 0; i < segments; ++i)
  {
    meanSquare += edgeFrom(i).squaredNorm() / static_cast<double>(segments);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < segments && meanSquare > 0.0; ++i)
  {
    const Eigen::Vector3d edge = edgeFrom(i);
    const Eigen::Vector3d way = x - points.row(path[i]).transpose();
    const double squared = edge.squaredNorm();
    const double t = squared > 0.0 ? std::clamp(way.dot(edge) / squared, 0.0, 1.0) : 0.0;
    // Without unit, so that tiny surfaces underflow nothing.
    const double part = (way - t * edge).squaredNorm() / meanSquare + 1.0;
    sum += edge / (part * part);
  }
  return sum.squaredNorm() > 0.0 ? sum.normalized() : sum;
}

/// Which vertices stay.
std::vector<char> HeldBeyond(
  const TriangleMesh& mesh, const Eigen::VectorXd& distances, double width)
{
  std::vector<char> isHeld(mesh.NumberOfVertices(), 1);
  std::vector<char> holds(mesh.NumberOfComponents(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    isHeld[v] = mesh.IsUsed(v) && distances[v] < width ? 0 : 1;
    if (mesh.IsUsed(v) && isHeld[v])
    {
      holds[mesh.Component(v)] = 1;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!isHeld[v] && !holds[mesh.Component(v)])
    {
      throw Error(ErrorCode::BadInput,
        "All points of the part with point " + std::to_string(v) +
          " are nearer to the source curve than the ridge is wide, so that nothing holds them: "
          "lower RidgeWidth.");
    }
  }
  return isHeld;
}
}

Points DeformByCurveDeltas(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& path, bool isClosed, const Eigen::VectorXd& distances,
  const CurveDeltas& deltas, const ExecutionContext& context)
{
  const std::vector<char> isHeld = HeldBeyond(mesh, distances, deltas.Width);
  const SparseMatrix laplacian =
    Laplacian(mesh, EdgeWeights(mesh, points, LaplacianWeights::Cotangent, context));
  // The change u of x has L u = d' - d, and u = 0 where x stays.
  Field changes = laplacian * Field(points);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        const double t = distances[v] / deltas.Width;
        const double part = isHeld[v] ? 0.0
          : deltas.IsSharp            ? (t > 0.0 ? 0.0 : 1.0)
                                      : std::pow(1.0 - t * t, 2);
        if (!(part > 0.0))
        {
          changes.row(v).setZero();
          continue;
        }
        const Eigen::Vector3d delta = changes.row(v);
        const Eigen::Vector3d axis = deltas.Turn == 0.0
          ? Eigen::Vector3d::Zero()
          : TangentNear(points, path, isClosed, points.row(v));
        const Eigen::Matrix3d turn = RotationFromVector(part * deltas.Turn * axis);
        changes.row(v) = ((1.0 + part * (deltas.Scale - 1.0)) * (turn * delta) - delta).transpose();
      }
    });
  ConstrainedSolver solver;
  solver.Factorize(laplacian, isHeld, {}, {}, context);
  Field moves = Field::Zero(points.rows(), 3);
  solver.Solve(changes, moves, context);
  return points + Points(moves);
}
}
