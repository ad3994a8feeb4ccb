// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SurfaceBinding.h"

#include "Base/Bytes.h"
#include "Base/Constants.h"
#include "Differential/RotationFit.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// A point nearer than this part of the diagonal is on the surface.
constexpr double OnSurface = 1e-14;

/// What two rotations differ by at most, in radians.
constexpr double LargestBlurAngle = Pi;

/// Quaternions of rotations (#V x 4), each of the sign that it is given.
Field Quaternions(const Matrices& rotations, const ExecutionContext& context)
{
  Field quaternions(rotations.rows(), 4);
  context.For(static_cast<int>(rotations.rows()),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        quaternions.row(v) =
          Eigen::Quaterniond(Eigen::Matrix3d(MatrixAt(rotations, v))).coeffs().transpose();
      }
    });
  return quaternions;
}
}

SurfaceBinding::SurfaceBinding(std::shared_ptr<const TriangleMesh> mesh,
  std::shared_ptr<const Points> rest, Points queries, const ExecutionContext& context)
  : Mesh(std::move(mesh))
  , Rest(std::move(rest))
  , Queries(std::move(queries))
  , Tree(this->Mesh->GetTriangles(), *this->Rest)
{
  this->RestSources = this->WithGroups(*this->Rest);
  this->Shares.resize(this->Queries.rows());
  this->Distances.resize(this->Queries.rows());
  context.For(static_cast<int>(this->Queries.rows()),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        this->Shares[i] = this->Bind(this->Queries.row(i).transpose(), this->Distances[i]);
      }
    });
}

void SurfaceBinding::AddPlace(
  int triangle, const ClosestPoint& place, double weight, std::vector<Share>& shares) const
{
  for (int i = 0; i < 3; ++i)
  {
    if (weight * place.Weights[i] > 0.0)
    {
      shares.push_back({ this->Mesh->GetTriangles()(triangle, i), weight * place.Weights[i] });
    }
  }
}

void SurfaceBinding::AddNear(
  const Eigen::Vector3d& query, double distance, std::vector<Share>& shares) const
{
  const std::vector<TriangleTree::Node>& nodes = this->Tree.GetNodes();
  const auto size = static_cast<int>(this->Rest->rows());
  const auto weigh = [&](double area, double away)
  {
    const double excess = std::max(0.0, distance / away - 1.0 / Reach);
    return area * excess * excess;
  };
  std::vector<int> open = { 0 };
  while (!open.empty())
  {
    const int i = open.back();
    open.pop_back();
    const TriangleTree::Node& node = nodes[i];
    const double away = node.Box.exteriorDistance(query);
    if (away >= Reach * distance || node.Area == 0.0)
    {
      continue;
    }
    if (node.Triangle >= 0)
    {
      const ClosestPoint found = this->Tree.ClosestOn(node.Triangle, query);
      this->AddPlace(node.Triangle, found, weigh(node.Area, found.Distance), shares);
    }
    else if (node.Box.diagonal().norm() <= GroupAngle * away)
    {
      const Eigen::Vector3d center = this->RestSources.row(size + i).transpose();
      const double weight = weigh(node.Area, (center - query).norm());
      if (weight > 0.0)
      {
        shares.push_back({ size + i, weight });
      }
    }
    else
    {
      open.push_back(node.Second);
      open.push_back(i + 1);
    }
  }
}

std::vector<SurfaceBinding::Share> SurfaceBinding::Bind(
  const Eigen::Vector3d& query, double& distance) const
{
  std::vector<Share> shares;
  const auto [nearest, place] = this->Tree.Closest(query);
  distance = place.Distance;
  if (distance > OnSurface * this->Tree.GetNodes()[0].Box.diagonal().norm())
  {
    this->AddNear(query, distance, shares);
  }
  if (shares.empty()) // on the surface, or the nearest triangles have no area
  {
    this->AddPlace(nearest, place, 1.0, shares);
  }
  double sum = 0.0;
  for (const Share& share : shares)
  {
    sum += share.Weight;
  }
  for (Share& share : shares)
  {
    share.Weight /= sum;
  }
  shares.shrink_to_fit();
  return shares;
}

Field SurfaceBinding::WithGroups(const Field& ofVertices) const
{
  const std::vector<TriangleTree::Node>& nodes = this->Tree.GetNodes();
  const Eigen::Index size = ofVertices.rows();
  Field values(size + static_cast<Eigen::Index>(nodes.size()), ofVertices.cols());
  values.topRows(size) = ofVertices;
  const bool isRotation = ofVertices.cols() == 4;
  // Quaternions of both signs are the same rotation.
  const auto signOf = [&](Eigen::Index row, Eigen::Index like)
  { return isRotation && values.row(row).dot(values.row(like)) < 0.0 ? -1.0 : 1.0; };
  for (int i = static_cast<int>(nodes.size()) - 1; i >= 0; --i)
  {
    const TriangleTree::Node& node = nodes[i];
    if (node.Triangle >= 0)
    {
      const Eigen::RowVector3i corners = this->Mesh->GetTriangles().row(node.Triangle);
      values.row(size + i) =
        (values.row(corners[0]) + signOf(corners[1], corners[0]) * values.row(corners[1]) +
          signOf(corners[2], corners[0]) * values.row(corners[2])) /
        3.0;
      continue;
    }
    const double share = node.Area > 0.0 ? nodes[node.Second].Area / node.Area : 0.5;
    const Eigen::Index first = size + i + 1;
    const Eigen::Index second = size + node.Second;
    values.row(size + i) =
      (1.0 - share) * values.row(first) + share * signOf(second, first) * values.row(second);
  }
  return values;
}

SurfaceBinding::Carried SurfaceBinding::Evaluate(
  const Points& current, const ExecutionContext& context) const
{
  const Field places = this->WithGroups(current);
  const Field rotations = this->WithGroups(
    Quaternions(FitRotations(*this->Mesh, *this->Rest, current, context.Part(0.0, 0.5)), context));
  Carried carried;
  carried.Positions.resize(this->Queries.rows(), 3);
  carried.Rotations.resize(this->Queries.rows(), 9);
  context.For(static_cast<int>(this->Queries.rows()),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const std::vector<Share>& shares = this->Shares[i];
        const Eigen::RowVector3d restOrigin = this->RestSources.row(shares[0].Source);
        const Eigen::RowVector3d origin = places.row(shares[0].Source);
        // Sums of differences keep the digits of points that share one place.
        Eigen::RowVector3d restOffset = Eigen::RowVector3d::Zero();
        Eigen::RowVector3d offset = Eigen::RowVector3d::Zero();
        Eigen::RowVector4d rotation = Eigen::RowVector4d::Zero();
        for (const Share& share : shares)
        {
          restOffset += share.Weight * (this->RestSources.row(share.Source) - restOrigin);
          offset += share.Weight * (places.row(share.Source) - origin);
          const double sign =
            rotations.row(share.Source).dot(rotations.row(shares[0].Source)) < 0.0 ? -1.0 : 1.0;
          rotation += sign * share.Weight * rotations.row(share.Source);
        }
        const Eigen::Matrix3d turn =
          Eigen::Quaterniond(Eigen::Vector4d(rotation.transpose())).normalized().matrix();
        const Eigen::Vector3d arm = (this->Queries.row(i) - restOrigin - restOffset).transpose();
        carried.Positions.row(i) = origin + offset + (turn * arm).transpose();
        MatrixAt(carried.Rotations, i) = turn;
      }
    });
  return carried;
}

Eigen::VectorXd SurfaceBinding::RoundingErrors(const Points& current, double rounding) const
{
  const TriangleMesh& mesh = *this->Mesh;
  const Points areaVectors = TriangleAreaVectors(current, mesh.GetTriangles());
  Field longest = Field::Zero(current.rows(), 1);
  Points areas = Points::Zero(current.rows(), 3);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int v = mesh.GetTriangles()(t, i);
      const int w = mesh.GetTriangles()(t, (i + 1) % 3);
      const double length = (current.row(v) - current.row(w)).norm();
      longest(v, 0) = std::max(longest(v, 0), length);
      longest(w, 0) = std::max(longest(w, 0), length);
      areas.row(v) += areaVectors.row(t);
    }
  }
  Field angles = Field::Zero(current.rows(), 1);
  for (Eigen::Index v = 0; v < current.rows(); ++v)
  {
    const double area = areas.row(v).norm();
    const double blur = rounding * longest(v, 0);
    angles(v, 0) = blur < LargestBlurAngle * area ? blur / area : LargestBlurAngle;
  }
  const Field ofSources = this->WithGroups(angles);
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(this->Queries.rows());
  for (Eigen::Index i = 0; i < errors.size(); ++i)
  {
    Eigen::RowVector3d arm = this->Queries.row(i);
    for (const Share& share : this->Shares[i])
    {
      errors[i] += share.Weight * ofSources(share.Source, 0);
      arm -= share.Weight * this->RestSources.row(share.Source);
    }
    errors[i] *= arm.norm();
  }
  return errors;
}

int SurfaceBinding::VertexOf(Eigen::Index query) const
{
  const std::vector<Share>& shares = this->Shares[query];
  const bool isOne = shares.size() == 1 && shares[0].Source < this->Rest->rows();
  return isOne && this->Queries.row(query) == this->Rest->row(shares[0].Source) ? shares[0].Source
                                                                                : -1;
}

std::size_t SurfaceBinding::GetBytes() const
{
  return TotalBytes(
    this->Queries, this->RestSources, this->Distances, this->Tree.GetNodes(), this->Shares);
}
}
