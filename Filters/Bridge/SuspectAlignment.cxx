// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/SuspectAlignment.h"

#include "Kernel/Algebra/SimilarityFit.h"
#include "Kernel/Mesh/UsedVertices.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStaticCellLocator.h"
#include "vtkStaticPointLocator.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace cartan
{
namespace
{
using Similarity = Eigen::Affine3d; // maps the suspect on the original

/// The similarity that best maps the rows of `from` on those of `to`.
Similarity BestSimilarity(const Points& from, const Points& to)
{
  return Similarity(FitSimilarity(from, to));
}

Points Move(const Similarity& motion, const Points& points)
{
  return (points * motion.linear().transpose()).rowwise() + motion.translation().transpose();
}

Points Rows(const Points& points, const std::vector<int>& rows)
{
  return points(rows, Eigen::all);
}

vtkSmartPointer<vtkPolyData> MakePolyData(const Points& points, const Triangles* triangles)
{
  vtkNew<vtkPoints> locations;
  locations->SetDataTypeToDouble();
  locations->SetNumberOfPoints(points.rows());
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    locations->SetPoint(v, points.row(v).data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(locations);
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index t = 0; triangles && t < triangles->rows(); ++t)
  {
    const Eigen::Matrix<vtkIdType, 1, 3> ids = triangles->row(t).cast<vtkIdType>();
    cells->InsertNextCell(3, ids.data());
  }
  data->SetPolys(cells);
  return data;
}

/// The closest points of a triangle surface.
class ClosestPoints
{
public:
  ClosestPoints(const Points& points, const Triangles& triangles)
    : Data(MakePolyData(points, &triangles))
  {
    this->Locator->SetDataSet(this->Data);
    this->Locator->BuildLocator();
  }

  Points Of(const Points& queries) const
  {
    Points closest(queries.rows(), 3);
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      vtkIdType cell = -1;
      int part = 0;
      double squared = 0.0;
      this->Locator->FindClosestPoint(
        queries.row(i).data(), closest.row(i).data(), cell, part, squared);
    }
    return closest;
  }

private:
  vtkSmartPointer<vtkPolyData> Data;
  vtkNew<vtkStaticCellLocator> Locator;
};

/// The nearest ones of some points.
class NearestPoints
{
public:
  explicit NearestPoints(const Points& points)
    : All(points)
    , Data(MakePolyData(points, nullptr))
  {
    this->Locator->SetDataSet(this->Data);
    this->Locator->BuildLocator();
  }

  std::vector<int> RowsOf(const Points& queries) const
  {
    std::vector<int> nearest(queries.rows());
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      nearest[i] = static_cast<int>(this->Locator->FindClosestPoint(queries.row(i).data()));
    }
    return nearest;
  }

  Points Of(const Points& queries) const { return Rows(this->All, this->RowsOf(queries)); }

private:
  const Points& All;
  vtkSmartPointer<vtkPolyData> Data;
  vtkNew<vtkStaticPointLocator> Locator;
};

/// Center, axes of inertia (right-handed) and mean radius, by area: they do not depend on
/// the vertices.
struct Inertia
{
  Inertia(const Points& points, const Triangles& triangles)
  {
    double area = 0.0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    {
      const auto corner = [&](int k)
      { return Eigen::Vector3d(points.row(triangles(t, k)).transpose()); };
      const double size = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
      const Eigen::Vector3d sum = corner(0) + corner(1) + corner(2);
      area += size;
      first += size * sum / 3.0;
      second += size / 12.0 * sum * sum.transpose();
      for (int k = 0; k < 3; ++k)
      {
        second += size / 12.0 * corner(k) * corner(k).transpose();
      }
    }
    this->Center = first / area;
    second = (second / area - this->Center * this->Center.transpose()).eval();
    this->Radius = std::sqrt(second.trace());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(second);
    this->Axes = axes.eigenvectors();
    this->Axes.col(2) = this->Axes.col(0).cross(this->Axes.col(1));
  }

  Eigen::Vector3d Center;
  Eigen::Matrix3d Axes;
  double Radius = 0.0;
};

/// The 24 rotations that map coordinate axes on coordinate axes.
std::vector<Eigen::Matrix3d> AxisRotations()
{
  std::vector<Eigen::Matrix3d> rotations;
  std::array<int, 3> order = { 0, 1, 2 };
  do
  {
    for (int signs = 0; signs < 8; ++signs)
    {
      Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
      for (int k = 0; k < 3; ++k)
      {
        rotation(order[k], k) = signs & (1 << k) ? -1.0 : 1.0;
      }
      if (rotation.determinant() > 0.0)
      {
        rotations.push_back(rotation);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return rotations;
}

/// About `count` rows, evenly among all.
Points Sample(const Points& points, Eigen::Index count)
{
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.rows() / count);
  std::vector<int> rows;
  for (Eigen::Index i = 0; i < points.rows(); i += stride)
  {
    rows.push_back(static_cast<int>(i));
  }
  return Rows(points, rows);
}

/// Improves a motion by closest points; returns the root mean square distance, in units of
/// the original.
template <typename Closest>
double Iterate(const Closest& suspect, const Points& original, int rounds, Similarity& motion)
{
  double distance = HUGE_VAL;
  for (int round = 0; round < rounds; ++round)
  {
    const Points closest = suspect.Of(Move(motion.inverse(), original));
    motion = BestSimilarity(closest, original);
    const double last = distance;
    distance =
      (Move(motion, closest) - original).norm() / std::sqrt(static_cast<double>(original.rows()));
    if (distance >= (1.0 - 1e-4) * last)
    {
      break;
    }
  }
  return distance;
}

/// The motion by iterated closest points.
Similarity Register(const Surface& original, const Surface& suspect, const Points& vertices,
  const Points& others, const ClosestPoints& closest, const ExecutionContext& context)
{
  const NearestPoints nearest(others); // to choose among starts, faster than the surface
  const Inertia to(*original.Positions, original.Mesh->GetTriangles());
  const Inertia from(*suspect.Positions, suspect.Mesh->GetTriangles());
  const Points few = Sample(vertices, 200);
  const std::vector<Eigen::Matrix3d> rotations = AxisRotations();
  Similarity best;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < rotations.size(); ++i)
  {
    Similarity motion = Similarity::Identity();
    motion.linear() = to.Radius / from.Radius * to.Axes * rotations[i] * from.Axes.transpose();
    motion.translation() = to.Center - motion.linear() * from.Center;
    const double distance = Iterate(nearest, few, 6, motion);
    if (distance < least)
    {
      least = distance;
      best = motion;
    }
    context.Report(static_cast<double>(i) / static_cast<double>(rotations.size()));
  }
  Iterate(closest, Sample(vertices, 1000), 40, best);
  return best;
}

/// For each row of `vertices`, the row of `others` if they are nearest to each other, or -1.
std::vector<int> MutualMatches(const Points& vertices, const Points& others)
{
  std::vector<int> matches = NearestPoints(others).RowsOf(vertices);
  const std::vector<int> back = NearestPoints(vertices).RowsOf(others);
  for (std::size_t i = 0; i < matches.size(); ++i)
  {
    matches[i] = back[matches[i]] == static_cast<int>(i) ? matches[i] : -1;
  }
  return matches;
}

/// The motion that best maps matched rows of `from` on rows of `to`.
Similarity MotionOfMatches(const std::vector<int>& matches, const Points& from, const Points& to)
{
  std::vector<int> fromRows;
  std::vector<int> toRows;
  for (std::size_t i = 0; i < matches.size(); ++i)
  {
    if (matches[i] >= 0)
    {
      fromRows.push_back(matches[i]);
      toRows.push_back(static_cast<int>(i));
    }
  }
  return BestSimilarity(Rows(from, fromRows), Rows(to, toRows));
}
}

AlignedSuspect AlignSuspect(
  const Surface& original, const Surface& suspect, bool isMoved, const ExecutionContext& context)
{
  const std::vector<int> used = UsedVertices(*original.Mesh);
  Similarity motion = Similarity::Identity();
  motion.translation() = suspect.Origin - original.Origin;
  const bool isSame = original.Positions->rows() == suspect.Positions->rows() &&
    original.Mesh->GetTriangles().rows() == suspect.Mesh->GetTriangles().rows() &&
    original.Mesh->GetTriangles() == suspect.Mesh->GetTriangles();
  if (isSame)
  {
    motion = isMoved
      ? BestSimilarity(Rows(*suspect.Positions, used), Rows(*original.Positions, used))
      : motion;
    const Points moved = Move(motion, *suspect.Positions);
    return { moved, moved, false };
  }

  const Points vertices = Rows(*original.Positions, used);
  const Points others = Rows(*suspect.Positions, UsedVertices(*suspect.Mesh));
  const ClosestPoints closest(*suspect.Positions, suspect.Mesh->GetTriangles());
  if (isMoved)
  {
    motion = Register(original, suspect, vertices, others, closest, context.Part(0.0, 0.9));
  }
  std::vector<int> matches = MutualMatches(vertices, Move(motion, others));
  const auto isMatched = [](int match) { return match >= 0; };
  // Resampled surfaces have about half of their vertices nearest to each other.
  constexpr double NearlyAll = 0.95;
  const bool isShuffled = std::count_if(matches.begin(), matches.end(), isMatched) >=
    NearlyAll * static_cast<double>(matches.size());
  if (isShuffled && isMoved)
  {
    motion = MotionOfMatches(matches, others, vertices);
    matches = MutualMatches(vertices, Move(motion, others));
  }
  const Points onSurface = Move(motion, closest.Of(Move(motion.inverse(), vertices)));
  const Points movedOthers = Move(motion, others);
  AlignedSuspect aligned{ Move(motion, *suspect.Positions), *original.Positions, true };
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    aligned.AtOriginal.row(used[i]) = isShuffled && matches[i] >= 0
      ? movedOthers.row(matches[i])
      : onSurface.row(static_cast<Eigen::Index>(i));
  }
  context.Report(1.0);
  return aligned;
}
}
