// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/LocalVolumes.h"

#include "Differential/Laplacian.h"
#include "Differential/RotationFit.h"
#include "Measure/ComponentVolumes.h"
#include "Measure/ImplicitSmoothing.h"
#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cartan
{
namespace
{
constexpr double Undefined = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d AreaVector(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return 0.5 * (b - a).cross(c - a);
}

/// b_v, the differences of the centers around a vertex, each turned with its triangle.
Eigen::Vector3d TurnedDifferences(const TriangleMesh& mesh, const Points& cornerWeights,
  const Points& centers, const Matrices& rotations, int v)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const int t = mesh.LeftTriangle(d);
    if (t < 0)
    {
      continue;
    }
    const auto corners = mesh.GetTriangles().row(t);
    const int corner = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
    const int next = (corner + 1) % 3;
    const int last = (corner + 2) % 3;
    const Eigen::Matrix3d turn = (MatrixAt(rotations, v) + MatrixAt(rotations, corners[next]) +
                                   MatrixAt(rotations, corners[last])) /
      3.0;
    const Eigen::RowVector3d center = centers.row(v);
    sum += turn *
      (cornerWeights(t, last) * (center - centers.row(corners[next])) +
        cornerWeights(t, next) * (center - centers.row(corners[last])))
        .transpose();
  }
  return sum;
}
}

LocalVolumes::LocalVolumes(std::shared_ptr<const TriangleMesh> sharedMesh, const Points& reference,
  const ExecutionContext& context, std::shared_ptr<const DistributedRows> pieces)
  : Mesh(std::move(sharedMesh))
  , Pieces(std::move(pieces))
  , Parts(*this->Mesh, this->Pieces.get())
  , Positions(reference)
  , CornerWeight(CornerWeights(*this->Mesh, reference, LaplacianWeights::Cotangent, context))
  , Centers(reference)
{
  const TriangleMesh& mesh = *this->Mesh;
  const std::vector<ComponentVolume> components = MeasureComponents(mesh, reference, this->Parts);
  std::vector<double> steps;
  for (const ComponentVolume& component : components)
  {
    const bool enclosesVolume = component.EnclosesVolume();
    const double length = enclosesVolume ? 6.0 * component.Volume / component.Area : 0.0;
    this->EnclosesVolume.push_back(enclosesVolume);
    steps.push_back(length * length);
  }
  this->Factorize(reference, steps, context);
  Field centers = reference;
  this->Solve(centers, Field(), context);
  this->Centers = centers;
  this->Reference = this->Sum(reference, this->Centers);
  context.Report(1.0);
}

void LocalVolumes::Factorize(
  const Points& reference, const std::vector<double>& steps, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Mesh;
  const Eigen::VectorXd weights =
    EdgeWeights(mesh, reference, LaplacianWeights::Cotangent, context);
  const Anchors anchors = SmoothingAnchors(mesh, reference, steps, &this->Parts);
  if (!this->Pieces)
  {
    this->System.Factorize(Laplacian(mesh, weights), anchors, context);
    return;
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!anchors.IsHard[v])
    {
      this->Unknowns.push_back(v);
    }
  }
  if (std::none_of(steps.begin(), steps.end(), [](double step) { return step > 0.0; }))
  {
    return; // so it is on all ranks
  }
  this->Stiffness = anchors.Stiffness(this->Unknowns);
  SparseMatrix lower = Laplacian(mesh, weights, this->Unknowns).triangularView<Eigen::Lower>();
  lower.diagonal() += this->Stiffness;
  this->OnPieces = std::make_unique<PieceSystem>(this->Pieces, this->Unknowns, lower);
}

/// `centers` has the places that anchors pull to, and gets the solution.
void LocalVolumes::Solve(
  Field& centers, const Field& rightHandSide, const ExecutionContext& context) const
{
  if (!this->Pieces)
  {
    this->System.Solve(rightHandSide, centers, context);
    return;
  }
  if (!this->OnPieces)
  {
    return;
  }
  Eigen::MatrixXd complete = this->Stiffness.asDiagonal() * centers(this->Unknowns, Eigen::all);
  if (rightHandSide.size())
  {
    complete += rightHandSide(this->Unknowns, Eigen::all);
  }
  centers(this->Unknowns, Eigen::all) = this->OnPieces->Solve(complete, context);
}

MeasuredVolumes LocalVolumes::Measure(const Points& current, const ExecutionContext& context) const
{
  const TriangleMesh& mesh = *this->Mesh;
  Field centers = current;
  if (this->OnPieces || !this->System.GetFree().empty())
  {
    Matrices rotations = FitRotations(mesh, this->Positions, current, context);
    if (this->Pieces)
    {
      this->Pieces->UpdateGhosts(rotations);
    }
    Field rightHandSide(current.rows(), 3);
    context.For(mesh.NumberOfVertices(),
      [&](int begin, int end)
      {
        for (int v = begin; v < end; ++v)
        {
          const Eigen::Vector3d offset =
            (this->Positions.row(v) - this->Centers.row(v)).transpose();
          centers.row(v) -= (MatrixAt(rotations, v) * offset).transpose();
          rightHandSide.row(v) =
            TurnedDifferences(mesh, this->CornerWeight, this->Centers, rotations, v).transpose();
        }
      });
    this->Solve(centers, rightHandSide, context.Part(0.5, 0.9));
  }
  context.Report(1.0);
  MeasuredVolumes measured;
  measured.Values = this->Sum(current, centers);
  measured.Rounding = this->RoundingOf(measured.Values, current, centers);
  return measured;
}

/// A coordinate is off by epsilon times the largest, and an area vector by that times the longest
/// edge of its triangle, which the offset from the centers multiplies.
double LocalVolumes::RoundingOf(
  const Eigen::VectorXd& volumes, const Points& points, const Points& centers) const
{
  const TriangleMesh& mesh = *this->Mesh;
  // The largest coordinate, what multiplies its rounding, and the largest volume.
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(3);
  largest[0] = points.size() > 0 ? points.cwiseAbs().maxCoeff() : 0.0;
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto corners = mesh.GetTriangles().row(t);
    if (!this->EnclosesVolume[this->Parts.OfVertex(corners[0])])
    {
      continue;
    }
    const Eigen::Vector3d a = points.row(corners[0]);
    const Eigen::Vector3d b = points.row(corners[1]);
    const Eigen::Vector3d c = points.row(corners[2]);
    const Eigen::RowVector3d offset =
      (points(corners, Eigen::all) - centers(corners, Eigen::all)).colwise().mean();
    largest[1] = std::max(largest[1],
      std::sqrt(LongestEdgeSquared(a, b, c)) * offset.norm() + AreaVector(a, b, c).norm());
    for (const int v : corners)
    {
      largest[2] = std::max({ largest[2], std::abs(volumes[v]), std::abs(this->Reference[v]) });
    }
  }
  if (this->Pieces)
  {
    this->Pieces->Max(largest);
  }
  const double rounding = std::numeric_limits<double>::epsilon() * largest[0] * largest[1];
  return rounding > 0.0 ? rounding / largest[2] : 0.0;
}

Eigen::VectorXd LocalVolumes::Sum(const Points& points, const Points& centers) const
{
  const TriangleMesh& mesh = *this->Mesh;
  std::vector<double> rest(static_cast<std::size_t>(this->Parts.GetCount()), 0.0);
  const std::vector<ComponentVolume> inner = MeasureComponents(mesh, centers, this->Parts);
  const std::vector<ComponentVolume> outer = MeasureComponents(mesh, points, this->Parts);
  for (std::size_t component = 0; component < rest.size(); ++component)
  {
    if (outer[component].Area > 0.0)
    {
      rest[component] = inner[component].Volume / outer[component].Area;
    }
  }
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    Eigen::Vector3d p[3];
    Eigen::Vector3d c[3];
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 3; ++corner)
    {
      p[corner] = points.row(mesh.GetTriangles()(t, corner)).transpose();
      c[corner] = centers.row(mesh.GetTriangles()(t, corner)).transpose();
      offset += (p[corner] - c[corner]) / 3.0;
    }
    const Eigen::Vector3d top = AreaVector(p[0], p[1], p[2]);
    const Eigen::Vector3d bottom = AreaVector(c[0], c[1], c[2]);
    // Four times the area vector half-way.
    const Eigen::Vector3d middle = AreaVector(p[0] + c[0], p[1] + c[1], p[2] + c[2]);
    const double volume =
      (top + middle + bottom).dot(offset) / 6.0 + rest[this->Parts.OfTriangle(t)] * top.norm();
    for (int corner = 0; corner < 3; ++corner)
    {
      volumes[mesh.GetTriangles()(t, corner)] += volume / 3.0;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && !this->EnclosesVolume[this->Parts.OfVertex(v)])
    {
      volumes[v] = Undefined;
    }
  }
  return volumes;
}
}
