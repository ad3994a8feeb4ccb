// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/TransitionBand.h"

#include "Algebra/AnchoredSystem.h"
#include "Base/Constants.h"
#include "Base/Error.h"
#include "Differential/Laplacian.h"
#include "Mesh/GeodesicDistance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace cartan
{
namespace
{
/// Below, the harmonic map has decayed to rounding and has no angle.
constexpr double SmallestRadius = 1e-9;

/// A cotangent weight counts as at least this; those of equilateral triangles are .58.
constexpr double SmallestWeight = 1e-6;

/// Angles, in turns, and areas, in parts of a triangle's extents, are known no better.
constexpr double Imprecision = 1e-12;

[[noreturn]] void ThrowTooWide(int vertex, double width, const std::string& role)
{
  throw Error(ErrorCode::BadInput,
    "A transition of " + std::to_string(width) + " is too wide for the " + role +
      ": from the loop of point " + std::to_string(vertex) +
      " it reaches another boundary or another transition, or the surface ends. " +
      (role == "source" ? "Lower TransitionWidth, or SourceTransitionWidth where that is not 0."
                        : "Lower TransitionWidth."));
}

double LongestEdge(const TriangleMesh& mesh, const Points& points)
{
  double longest = 0.0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    longest = std::max(longest, (points.row(mesh.Neighbor(d)) - points.row(mesh.Origin(d))).norm());
  }
  return longest;
}

/// Euler's number of the part of the mesh all of whose vertices are in each band, which
/// is that of the band itself: an annulus has 0.
std::vector<int> EulerNumbers(
  const TriangleMesh& mesh, const std::vector<int>& loopOf, std::size_t numberOfLoops)
{
  std::vector<int> numbers(numberOfLoops, 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (loopOf[v] < 0)
    {
      continue;
    }
    ++numbers[loopOf[v]];
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int other = mesh.Neighbor(d);
      numbers[loopOf[v]] -= other > v && loopOf[other] >= 0;
    }
  }
  for (Eigen::Index t = 0; t < mesh.GetTriangles().rows(); ++t)
  {
    const auto corners = mesh.GetTriangles().row(t);
    if (loopOf[corners[0]] >= 0 && loopOf[corners[1]] >= 0 && loopOf[corners[2]] >= 0)
    {
      ++numbers[loopOf[corners[0]]];
    }
  }
  return numbers;
}

/// Spreads the numbers of loops over the vertices within the width.
void SpreadLoops(const TriangleMesh& mesh, const std::vector<std::vector<int>>& loops, double width,
  const std::string& role, TransitionBands& bands)
{
  bands.LoopOf.assign(mesh.NumberOfVertices(), -1);
  for (std::size_t loop = 0; loop < loops.size(); ++loop)
  {
    for (const int v : loops[loop])
    {
      bands.LoopOf[v] = static_cast<int>(loop);
    }
  }
  for (std::size_t loop = 0; loop < loops.size(); ++loop)
  {
    const auto number = static_cast<int>(loop);
    std::vector<int> reached = loops[loop];
    for (std::size_t next = 0; next < reached.size(); ++next)
    {
      for (int d = mesh.RingBegin(reached[next]); d < mesh.RingEnd(reached[next]); ++d)
      {
        const int v = mesh.Neighbor(d);
        if (bands.LoopOf[v] == number || !(bands.Distances[v] < width))
        {
          continue;
        }
        if (bands.LoopOf[v] >= 0 || mesh.IsBoundary(v))
        {
          ThrowTooWide(loops[loop].front(), width, role);
        }
        bands.LoopOf[v] = number;
        reached.push_back(v);
      }
    }
  }
}

/// The triangles with a corner in a band, and their vertices.
BandCoordinates FindFaces(const TriangleMesh& mesh, const std::vector<int>& loopOf, int loop)
{
  BandCoordinates band;
  std::vector<char> isCorner(mesh.NumberOfVertices(), 0);
  std::vector<Eigen::Index> faces;
  for (Eigen::Index t = 0; t < mesh.GetTriangles().rows(); ++t)
  {
    const auto corners = mesh.GetTriangles().row(t);
    if (loopOf[corners[0]] == loop || loopOf[corners[1]] == loop || loopOf[corners[2]] == loop)
    {
      faces.push_back(t);
      for (int c = 0; c < 3; ++c)
      {
        isCorner[corners[c]] = 1;
      }
    }
  }
  band.Faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    band.Faces.row(static_cast<Eigen::Index>(f)) = mesh.GetTriangles().row(faces[f]);
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isCorner[v])
    {
      band.Vertices.push_back(v);
    }
  }
  return band;
}

/// The cotangent Laplacian of the triangles alone, with nothing that flows beyond them;
/// `numbers` (#V) are those of their vertices. No weight is negative or vanishes, so that
/// values lie between those of the neighbors.
SparseMatrix BandLaplacian(const Points& points, const Triangles& faces,
  const std::vector<int>& numbers, int numberOfVertices)
{
  std::map<std::pair<int, int>, double> weights;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int from = faces(f, (c + 1) % 3);
      const int to = faces(f, (c + 2) % 3);
      const Eigen::Vector3d a = (points.row(from) - points.row(faces(f, c))).transpose();
      const Eigen::Vector3d b = (points.row(to) - points.row(faces(f, c))).transpose();
      const double sine = a.cross(b).norm();
      weights[std::minmax(numbers[from], numbers[to])] +=
        sine > Imprecision * a.norm() * b.norm() ? 0.5 * a.dot(b) / sine : 0.0;
    }
  }
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges(
    static_cast<Eigen::Index>(weights.size()), 2);
  Eigen::VectorXd positive(edges.rows());
  Eigen::Index e = 0;
  for (const auto& [ends, weight] : weights)
  {
    edges.row(e) << ends.first, ends.second;
    positive[e] = std::max(weight, SmallestWeight);
    ++e;
  }
  return GraphLaplacian(numberOfVertices, edges, positive);
}

/// A triangle of a band in the plane of angle and distance, around its first corner.
struct AngleTriangle
{
  AngleTriangle(
    const BandCoordinates& band, const Eigen::VectorXd& bandDistances, Eigen::Index face)
    : Origin(band.Angles[band.Faces(face, 0)])
  {
    Eigen::Matrix3d corners;
    for (int c = 0; c < 3; ++c)
    {
      const int v = band.Faces(face, c);
      corners.col(c) << TurnBetween(band.Angles[v], this->Origin), bandDistances[v], 1.0;
    }
    const Eigen::Vector3d extent = corners.rowwise().maxCoeff() - corners.rowwise().minCoeff();
    this->HasArea = std::abs(corners.determinant()) > Imprecision * extent[0] * extent[1];
    this->First = this->Origin + corners.row(0).minCoeff() - Imprecision;
    this->Last = this->Origin + corners.row(0).maxCoeff() + Imprecision;
    this->ToWeights = corners.inverse();
  }

  Eigen::Vector3d WeightsAt(double angle, double distance) const
  {
    return this->ToWeights * Eigen::Vector3d(TurnBetween(angle, this->Origin), distance, 1.0);
  }

  double Origin;
  double First; ///< the smallest angle, and the largest one
  double Last;
  bool HasArea;
  Eigen::Matrix3d ToWeights;
};
}

TransitionBands FindBands(const TriangleMesh& mesh, const Points& points,
  const std::vector<std::vector<int>>& loops, double width, const std::string& role,
  const ExecutionContext& context)
{
  std::vector<int> all;
  for (const std::vector<int>& loop : loops)
  {
    all.insert(all.end(), loop.begin(), loop.end());
  }
  TransitionBands bands;
  bands.Distances = GeodesicDistance(mesh, points, all, width + LongestEdge(mesh, points), context);
  SpreadLoops(mesh, loops, width, role, bands);
  const std::vector<int> numbers = EulerNumbers(mesh, bands.LoopOf, loops.size());
  for (std::size_t loop = 0; loop < loops.size(); ++loop)
  {
    if (numbers[loop] != 0)
    {
      ThrowTooWide(loops[loop].front(), width, role);
    }
  }
  return bands;
}

BandCoordinates FindCoordinates(const TriangleMesh& mesh, const Points& points,
  const TransitionBands& bands, int loopNumber, const std::vector<int>& loop,
  const Eigen::VectorXd& loopAngles, const ExecutionContext& context)
{
  BandCoordinates band = FindFaces(mesh, bands.LoopOf, loopNumber);
  std::vector<int> numbers(mesh.NumberOfVertices(), -1);
  for (std::size_t i = 0; i < band.Vertices.size(); ++i)
  {
    numbers[band.Vertices[i]] = static_cast<int>(i);
  }
  const auto size = static_cast<int>(band.Vertices.size());
  Anchors anchors = Anchors::After(size, size);
  anchors.Vertices = band.Vertices;
  Field directions = Field::Zero(size, 2);
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const double angle = 2.0 * Pi * loopAngles[static_cast<Eigen::Index>(i)];
    anchors.IsHard[numbers[loop[i]]] = 1;
    directions.row(numbers[loop[i]]) << std::cos(angle), std::sin(angle);
  }
  AnchoredSystem system;
  system.Factorize(BandLaplacian(points, band.Faces, numbers, size), anchors, context);
  system.Interpolate(directions);
  band.Angles = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int i = 0; i < size; ++i)
  {
    if (!(directions.row(i).norm() > SmallestRadius))
    {
      throw Error(ErrorCode::BadInput,
        "A transition is so much longer than the loop of point " + std::to_string(loop.front()) +
          " that nothing says where its points are around it. Lower TransitionWidth.");
    }
    band.Angles[band.Vertices[i]] = std::atan2(directions(i, 1), directions(i, 0)) / (2.0 * Pi);
  }
  return band;
}

double TurnBetween(double a, double b)
{
  return std::remainder(a - b, 1.0);
}

std::vector<SurfacePlace> PlacesInBand(const BandCoordinates& band,
  const Eigen::VectorXd& bandDistances, const Eigen::VectorXd& angles,
  const Eigen::VectorXd& distances)
{
  const auto size = static_cast<std::size_t>(angles.size());
  // In the order of their angles in [0, 1), so that those beside a triangle are found fast.
  std::vector<std::pair<double, int>> order(size);
  for (std::size_t i = 0; i < size; ++i)
  {
    const double angle = angles[static_cast<Eigen::Index>(i)];
    order[i] = { angle - std::floor(angle), static_cast<int>(i) };
  }
  std::sort(order.begin(), order.end());
  std::vector<SurfacePlace> places(size);
  std::vector<double> fits(size, -std::numeric_limits<double>::infinity());
  for (Eigen::Index f = 0; f < band.Faces.rows(); ++f)
  {
    const AngleTriangle triangle(band, bandDistances, f);
    if (!triangle.HasArea)
    {
      continue;
    }
    for (double lap = std::floor(triangle.First); lap <= triangle.Last; ++lap)
    {
      auto next =
        std::lower_bound(order.begin(), order.end(), std::make_pair(triangle.First - lap, -1));
      for (; next != order.end() && next->first <= triangle.Last - lap; ++next)
      {
        const int i = next->second;
        const Eigen::Vector3d weights = triangle.WeightsAt(angles[i], distances[i]);
        if (weights.minCoeff() > fits[i])
        {
          fits[i] = weights.minCoeff();
          const Eigen::Vector3d inside = weights.cwiseMax(0.0);
          places[i] = { { band.Faces(f, 0), band.Faces(f, 1), band.Faces(f, 2) },
            inside / inside.sum() };
        }
      }
    }
  }
  return places;
}
}
