// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/Curvature.h"

#include "Base/Constants.h"
#include "Differential/FitTrust.h"
#include "Differential/SurfaceFit.h"
#include "Mesh/Geometry.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

namespace cartan
{
namespace
{
/// How much is done between two reports of progress: about a quarter of a
/// second.
constexpr int VerticesPerReport = 50000;

/// Enough for a solution that rounding cannot move where the neighbors leave
/// part of the form open, too little to be seen elsewhere.
constexpr double TinyRidge = 1e-10;

/// Those of AppendCubicWeights().
constexpr int WeightsPerPoint = 5;

/// How much farther a surface may be stretched in one direction than in the other without other
/// points being the nearest ones.
constexpr double LargestStretchRatio = 2.0;

/// How often normal curvatures are fitted, each time in the normal and with the
/// chord lengths of the time before: the normal converges by a factor of ten or
/// more.
constexpr int NormalCurvatureFits = 4;

/// The mean of the normals of the triangles at v by their angles there, which
/// does not depend on how polygons are triangulated. An angle near pi, of a
/// cap, whose normal is not known well, counts as a small one. Zero where the
/// triangles cancel out.
Eigen::Vector3d AngleWeightedNormal(const TriangleMesh& mesh, const Points& points, int v)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const int next = mesh.NextAround(v, d);
    if (next >= 0)
    {
      const Eigen::Vector3d a = (points.row(mesh.Neighbor(d)) - points.row(v)).transpose();
      const Eigen::Vector3d b = (points.row(mesh.Neighbor(next)) - points.row(v)).transpose();
      const Eigen::Vector3d areaVector = a.cross(b);
      const double angle = std::atan2(areaVector.norm(), a.dot(b));
      sum += std::min(angle, 2.0 * (Pi - angle)) * areaVector.normalized();
    }
  }
  return sum.normalized();
}

/// The points to which a cubic is fitted at v. False where even five rings do not determine one.
bool CollectDetermined(Neighborhood& neighborhood, int v, const Eigen::Vector3d& normal)
{
  neighborhood.CollectBall(v);
  for (int rings = 3; Determination(neighborhood, normal) < LeastDetermination; ++rings)
  {
    if (rings > Neighborhood::MaximumRings)
    {
      return false;
    }
    neighborhood.CollectRings(v, rings);
  }
  return true;
}

/// The form at v by a cubic. False where the points leave it open.
bool FitDetermined(
  Neighborhood& neighborhood, int v, const Eigen::Vector3d& normal, SecondForm& form)
{
  // The first fit finds the normal and how chords are measured, the second one
  // the curvature.
  SecondForm first;
  return CollectDetermined(neighborhood, v, normal) &&
    FitCubic(neighborhood, normal, nullptr, first) &&
    FitCubic(neighborhood, first.Normal, &first, form);
}

/// The form at v where a cubic is not determined, from the nearest points and
/// the triangles' normals. False where it is a guess, other than on a plane, and
/// zero where there is not even that.
bool FitOpen(Neighborhood& neighborhood, int v, const Eigen::Vector3d& normal, SecondForm& form)
{
  neighborhood.CollectNearest(v);
  SecondForm found;
  bool isFound = FitNormalCurvatures(neighborhood, normal, nullptr, found);
  for (int i = 1; i < NormalCurvatureFits && isFound; ++i)
  {
    const SecondForm earlier = found;
    isFound = FitNormalCurvatures(neighborhood, earlier.Normal, &earlier, found);
  }
  if (!isFound)
  {
    return false;
  }
  form = found;
  double radius = 0.0;
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    radius = std::max(radius, neighborhood.Offset(i).norm());
  }
  return radius * std::hypot(form.Uu, form.Uv, form.Vv) < FlatTurn;
}

/// Of a determined form at v.
CurvatureState StateOf(const Neighborhood& neighborhood, const SecondForm& form,
  const TriangleMesh& mesh, const Points& points, int v)
{
  if (!MayBeWrong(neighborhood, form, mesh.IsBoundary(v)))
  {
    return CurvatureState::Determined;
  }
  return IsSplitFlat(mesh, points, v) ? CurvatureState::Split : CurvatureState::Coarse;
}

void Store(const SecondForm& form, int v, Curvatures& curvatures)
{
  const double mean = 0.5 * (form.Uu + form.Vv);
  const double difference = std::hypot(0.5 * (form.Uu - form.Vv), form.Uv);
  const double angle = 0.5 * std::atan2(2.0 * form.Uv, form.Uu - form.Vv);
  curvatures.Mean[v] = mean;
  curvatures.Gaussian[v] = form.Uu * form.Vv - form.Uv * form.Uv;
  curvatures.Maximum[v] = mean + difference;
  curvatures.Minimum[v] = mean - difference;
  const Eigen::Vector3d direction = std::cos(angle) * form.U + std::sin(angle) * form.V;
  curvatures.MaximumDirections.row(v) = direction;
  curvatures.MinimumDirections.row(v) = form.Normal.cross(direction);
}

Curvatures Zero(int numberOfVertices)
{
  Curvatures curvatures;
  curvatures.Mean.setZero(numberOfVertices);
  curvatures.Gaussian.setZero(numberOfVertices);
  curvatures.Maximum.setZero(numberOfVertices);
  curvatures.Minimum.setZero(numberOfVertices);
  curvatures.MaximumDirections.setZero(numberOfVertices, 3);
  curvatures.MinimumDirections.setZero(numberOfVertices, 3);
  curvatures.States.assign(numberOfVertices, CurvatureState::Determined);
  return curvatures;
}

/// Whether the images of two orthonormal tangents are about as long in all directions.
bool IsEvenlyStretched(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  const double mean = 0.5 * (a.squaredNorm() + b.squaredNorm());
  const double difference = std::hypot(0.5 * (a.squaredNorm() - b.squaredNorm()), a.dot(b));
  return mean + difference < LargestStretchRatio * LargestStretchRatio * (mean - difference);
}

/// Calls fit(begin, end) on ranges that cover the vertices.
template <typename Fit>
void ForVertices(int numberOfVertices, const Fit& fit, const ExecutionContext& context)
{
  for (int first = 0; first < numberOfVertices; first += VerticesPerReport)
  {
    context.Report(static_cast<double>(first) / numberOfVertices);
    context.For(std::min(VerticesPerReport, numberOfVertices - first),
      [&](int begin, int end) { fit(first + begin, first + end); });
  }
  context.Report(1.0);
}

/// By fitDetermined(neighborhood, v, normal, form) where that is true, and without a cubic where
/// it is not.
template <typename FitDetermined>
Curvatures FitAll(const TriangleMesh& mesh, const Points& points,
  const FitDetermined& fitDetermined, const ExecutionContext& context)
{
  const Points normals = VertexNormals(mesh, points, context);
  Curvatures curvatures = Zero(mesh.NumberOfVertices());
  const auto fit = [&](int begin, int end)
  {
    Neighborhood neighborhood(mesh, points, &normals);
    for (int v = begin; v < end; ++v)
    {
      const Eigen::Vector3d normal = normals.row(v).transpose();
      if (!mesh.IsUsed(v))
      {
        continue;
      }
      SecondForm form;
      if (normal.isZero(0.0))
      {
        curvatures.States[v] = CurvatureState::Open;
      }
      else if (fitDetermined(neighborhood, v, normal, form))
      {
        curvatures.States[v] = StateOf(neighborhood, form, mesh, points, v);
      }
      else
      {
        const Eigen::Vector3d byAngles = AngleWeightedNormal(mesh, points, v);
        const bool isFlat =
          FitOpen(neighborhood, v, byAngles.isZero(0.0) ? normal : byAngles, form);
        curvatures.States[v] = isFlat ? CurvatureState::Determined : CurvatureState::Open;
      }
      Store(form, v, curvatures);
    }
  };
  ForVertices(mesh.NumberOfVertices(), fit, context);
  return curvatures;
}
}

Curvatures FitCurvatures(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  return FitAll(mesh, points, FitDetermined, context);
}

CurvatureFits::CurvatureFits(std::shared_ptr<const TriangleMesh> sharedMesh,
  const Points& reference, const ExecutionContext& context)
  : Mesh(std::move(sharedMesh))
  , Begin(this->Mesh->NumberOfVertices() + 1, 0)
  , OneRingSizes(this->Mesh->NumberOfVertices(), 0)
{
  struct Part
  {
    std::vector<int> Ids;
    std::vector<float> Weights;
  };
  const Points normals = VertexNormals(*this->Mesh, reference, context);
  std::map<int, Part> parts; // by their first vertices
  std::mutex access;
  const auto collect = [&](int begin, int end)
  {
    Part part;
    Neighborhood neighborhood(*this->Mesh, reference, &normals);
    for (int v = begin; v < end; ++v)
    {
      const Eigen::Vector3d normal = normals.row(v).transpose();
      if (this->Mesh->IsUsed(v) && !normal.isZero(0.0) &&
        CollectDetermined(neighborhood, v, normal) &&
        AppendCubicWeights(neighborhood, normal, part.Weights))
      {
        for (int i = 0; i < neighborhood.Size(); ++i)
        {
          part.Ids.push_back(neighborhood.Vertex(i));
        }
        this->Begin[v + 1] = neighborhood.Size();
        this->OneRingSizes[v] = neighborhood.OneRingSize();
      }
    }
    const std::lock_guard<std::mutex> guard(access);
    parts[begin] = std::move(part);
  };
  ForVertices(this->Mesh->NumberOfVertices(), collect, context);
  std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
  this->Ids.reserve(this->Begin.back());
  this->Weights.reserve(WeightsPerPoint * static_cast<std::size_t>(this->Begin.back()));
  for (auto& [begin, part] : parts)
  {
    this->Ids.insert(this->Ids.end(), part.Ids.begin(), part.Ids.end());
    this->Weights.insert(this->Weights.end(), part.Weights.begin(), part.Weights.end());
    part = {};
  }
}

Curvatures CurvatureFits::Measure(const Points& current, const ExecutionContext& context) const
{
  return FitAll(
    *this->Mesh, current,
    [&](Neighborhood& neighborhood, int v, const Eigen::Vector3d& normal, SecondForm& form)
    {
      return this->Fit(neighborhood, v, normal, form) ||
        FitDetermined(neighborhood, v, normal, form);
    },
    context);
}

/// The second fit at v to the points of the reference. False where others must be collected.
bool CurvatureFits::Fit(
  Neighborhood& neighborhood, int v, const Eigen::Vector3d& normal, SecondForm& form) const
{
  const int begin = this->Begin[v];
  const int size = this->Begin[v + 1] - begin;
  if (size == 0)
  {
    return false;
  }
  neighborhood.Take(v, this->Ids.data() + begin, size, this->OneRingSizes[v]);
  Eigen::Matrix<double, 3, WeightsPerPoint> derivatives =
    Eigen::Matrix<double, 3, WeightsPerPoint>::Zero();
  const float* weights = this->Weights.data() + WeightsPerPoint * static_cast<std::size_t>(begin);
  for (int i = 0; i < size; ++i, weights += WeightsPerPoint)
  {
    for (int k = 0; k < WeightsPerPoint; ++k)
    {
      derivatives.col(k) += static_cast<double>(weights[k]) * neighborhood.Offset(i);
    }
  }
  SecondForm first;
  if (!IsEvenlyStretched(derivatives.col(0), derivatives.col(1)) ||
    !ToSecondForm(derivatives, first))
  {
    return false;
  }
  // Evenly stretched points determine as much as before, unless they are bent.
  if (!neighborhood.FacesOneWay() ||
    (!neighborhood.AreAllClose() && Determination(neighborhood, normal) < LeastDetermination))
  {
    return false;
  }
  return FitCubic(neighborhood, first.Normal, &first, form);
}

Curvatures CurvaturesFromNormals(const TriangleMesh& mesh, const Points& points,
  const Points& normals, const ExecutionContext& context)
{
  Curvatures curvatures = Zero(mesh.NumberOfVertices());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        if (normals.row(v).isZero(0.0))
        {
          continue;
        }
        SecondForm form;
        form.Normal = normals.row(v);
        form.U = form.Normal.unitOrthogonal();
        form.V = form.Normal.cross(form.U);
        Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
        Eigen::Vector3d rightHandSide = Eigen::Vector3d::Zero();
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const int w = mesh.Neighbor(d);
          if (normals.row(w).isZero(0.0))
          {
            continue;
          }
          const Eigen::Vector3d offset = (points.row(w) - points.row(v)).transpose();
          const Eigen::Vector3d change = (normals.row(w) - normals.row(v)).transpose();
          const Eigen::Vector3d rowU(offset.dot(form.U), offset.dot(form.V), 0.0);
          const Eigen::Vector3d rowV(0.0, offset.dot(form.U), offset.dot(form.V));
          matrix += rowU * rowU.transpose() + rowV * rowV.transpose();
          rightHandSide += change.dot(form.U) * rowU + change.dot(form.V) * rowV;
        }
        // Less than two directions leave part of the form open; it is taken as 0.
        matrix.diagonal() += TinyRidge * matrix.trace() * Eigen::Vector3d(1.0, 2.0, 1.0);
        if (matrix.trace() > 0.0)
        {
          const Eigen::Vector3d solution = matrix.ldlt().solve(rightHandSide);
          form.Uu = solution[0];
          form.Uv = solution[1];
          form.Vv = solution[2];
          Store(form, v, curvatures);
        }
      }
    });
  context.Report(1.0);
  return curvatures;
}
}
