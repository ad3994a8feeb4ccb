// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/Curvature.h"

#include "Mesh/Geometry.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace cartan
{
namespace
{
/// A cubic has nine coefficients without its constant one; a few points more
/// than that let the fit average.
constexpr int MinimumPoints = 12;

/// Bounds the work at vertices with many neighbors and on very anisotropic
/// triangles. Twice as many have not made any error of our tests smaller.
constexpr int MaximumPoints = 64;

/// Of a vertex with more neighbors than this, such as the pole of a sphere,
/// only evenly spaced ones are taken: all of them would turn every
/// neighborhood next to it into that one fan.
constexpr int MaximumFan = 32;

/// How much is done between two reports of progress: about a quarter of a
/// second.
constexpr int VerticesPerReport = 50000;

/// Neighborhoods of fewer points than MinimumPoints grow at most this far.
constexpr int MaximumRings = 5;

/// The points a surface is fitted to around one vertex. Reused from vertex to
/// vertex, so that nothing is allocated in the loop.
class Neighborhood
{
public:
  Neighborhood(const TriangleMesh& mesh, const Points& points)
    : Mesh(mesh)
    , Positions(points)
  {
  }

  /// The two-ring of v, more rings where these are too few points (at borders),
  /// and what is connected with v inside the ball through its farthest
  /// neighbor. The ball makes up for long thin triangles, whose two-ring is
  /// just as long and thin and says little about bending the other way.
  void Collect(int v)
  {
    this->Count = 0;
    this->Add(v);
    int begin = 0;
    for (int ring = 0; ring < 2 || (ring < MaximumRings && this->Count <= MinimumPoints); ++ring)
    {
      const int end = this->Count;
      for (; begin < end; ++begin)
      {
        this->ForFan(this->Ids[begin], [this](int w) { this->Add(w); });
      }
    }

    const Eigen::RowVector3d center = this->Positions.row(v);
    double radius = 0.0;
    this->ForFan(v,
      [&](int w) { radius = std::max(radius, (this->Positions.row(w) - center).squaredNorm()); });
    // Equal distances, as in a regular grid, must not be told apart by rounding.
    radius *= 1.0001;
    for (int i = 1; i < this->Count; ++i)
    {
      if ((this->Positions.row(this->Ids[i]) - center).squaredNorm() <= radius)
      {
        this->ForFan(this->Ids[i],
          [&](int w)
          {
            if ((this->Positions.row(w) - center).squaredNorm() <= radius)
            {
              this->Add(w);
            }
          });
      }
    }
  }

  /// Without the vertex itself.
  int Size() const { return this->Count - 1; }
  int operator[](int i) const { return this->Ids[i + 1]; }

private:
  template <typename Visitor>
  void ForFan(int v, Visitor visit) const
  {
    const int step = (this->Mesh.Valence(v) + MaximumFan - 1) / MaximumFan;
    for (int d = this->Mesh.RingBegin(v); d < this->Mesh.RingEnd(v); d += step)
    {
      visit(this->Mesh.Neighbor(d));
    }
  }

  void Add(int v)
  {
    const auto end = this->Ids.begin() + this->Count;
    if (this->Count < static_cast<int>(this->Ids.size()) &&
      std::find(this->Ids.begin(), end, v) == end)
    {
      this->Ids[this->Count++] = v;
    }
  }

  const TriangleMesh& Mesh;
  const Points& Positions;
  std::array<int, MaximumPoints + 1> Ids;
  int Count = 0;
};

/// The second fundamental form in an orthonormal frame (u, v, normal), with the
/// sign that makes an outward-oriented sphere positive.
struct SecondForm
{
  Eigen::Vector3d Normal;
  Eigen::Vector3d U;
  Eigen::Vector3d V;
  double Uu = 0.0;
  double Uv = 0.0;
  double Vv = 0.0;
};

/// Regularization, relative to the number of points. In coordinates of unit
/// variance the third derivatives are of the size of one mean distance over the
/// radius of curvature. This much leaves them alone in a full two-ring and
/// gives way to a quadric where the points do not determine them.
constexpr double CubicRidge = 1e-3;

/// Enough for a solution that rounding cannot move where not even a quadric is
/// determined (few points, or all in two rows), too little to be seen elsewhere.
constexpr double TinyRidge = 1e-10;

/// The height over the chord-length coordinates of Curvature.h, as a cubic
/// without a constant, in the plane through `center` normal to `normal`. False
/// if the points coincide.
bool FitSecondForm(const Points& points, const Eigen::RowVector3d& center,
  const Neighborhood& neighborhood, const Eigen::Vector3d& normal, SecondForm& form)
{
  // Axes along which the coordinates are uncorrelated, scaled to unit variance.
  Eigen::Vector3d a = normal.unitOrthogonal();
  Eigen::Vector3d b = normal.cross(a);
  double aa = 0.0;
  double ab = 0.0;
  double bb = 0.0;
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    const Eigen::Vector3d offset = (points.row(neighborhood[i]) - center).transpose();
    const double x = offset.dot(a);
    const double y = offset.dot(b);
    aa += x * x;
    ab += x * y;
    bb += y * y;
  }
  const double turn = 0.5 * std::atan2(2.0 * ab, aa - bb);
  a = std::cos(turn) * a + std::sin(turn) * b;
  b = normal.cross(a);
  const double mean = 0.5 * (aa + bb);
  const double spread = std::hypot(0.5 * (aa - bb), ab);
  if (!(mean > 0.0))
  {
    return false;
  }
  // Where all points are in one line the other direction gets no say.
  const double scaleA = std::sqrt((mean + spread) / neighborhood.Size());
  const double scaleB =
    std::max(std::sqrt(std::max(mean - spread, 0.0) / neighborhood.Size()), 1e-6 * scaleA);

  using Vector9 = Eigen::Matrix<double, 9, 1>;
  using Matrix9 = Eigen::Matrix<double, 9, 9>;
  Matrix9 matrix = Matrix9::Zero();
  Vector9 rightHandSide = Vector9::Zero();
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    const Eigen::Vector3d offset = (points.row(neighborhood[i]) - center).transpose();
    const double height = offset.dot(normal);
    const double planarX = offset.dot(a);
    const double planarY = offset.dot(b);
    // A point straight above the vertex has no direction in the plane; the
    // bound keeps it from deciding alone.
    const double planar = std::hypot(planarX, planarY);
    const double stretch = std::min(offset.norm(), 3.0 * planar);
    const double toChord = planar > 0.0 ? stretch / planar : 1.0;
    const double x = toChord * planarX / scaleA;
    const double y = toChord * planarY / scaleB;
    Vector9 monomials;
    monomials << planarX / scaleA, planarY / scaleB, 0.5 * x * x, x * y, 0.5 * y * y,
      x * x * x / 6.0, 0.5 * x * x * y, 0.5 * x * y * y, y * y * y / 6.0;
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(monomials);
    rightHandSide += height * monomials;
  }
  // The Frobenius norms of the derivative tensors, in which a mixed derivative
  // occurs several times: they do not depend on the choice of axes.
  Vector9 ridge;
  ridge << TinyRidge, TinyRidge, TinyRidge, 2.0 * TinyRidge, TinyRidge, CubicRidge,
    3.0 * CubicRidge, 3.0 * CubicRidge, CubicRidge;
  matrix.diagonal() += neighborhood.Size() * ridge;
  const Vector9 fit = matrix.ldlt().solve(rightHandSide);

  const double slopeA = fit[0] / scaleA;
  const double slopeB = fit[1] / scaleB;
  const double hessianAa = fit[2] / (scaleA * scaleA);
  const double hessianAb = fit[3] / (scaleA * scaleB);
  const double hessianBb = fit[4] / (scaleB * scaleB);

  // From the graph of a function to an orthonormal frame: u along the surface
  // over a, and v = n x u, which is (r_b - (F / E) r_a) / sqrt(G - F^2 / E) with
  // the first form E, F, G of the tangents r_a, r_b.
  const double e = 1.0 + slopeA * slopeA;
  const double shear = slopeA * slopeB / e;
  const double width = 1.0 + slopeB * slopeB - shear * slopeA * slopeB;
  const double size = std::sqrt(1.0 + slopeA * slopeA + slopeB * slopeB);
  form.Normal = (normal - slopeA * a - slopeB * b) / size;
  form.U = (a + slopeA * normal) / std::sqrt(e);
  form.V = form.Normal.cross(form.U);
  form.Uu = -hessianAa / (size * e);
  form.Uv = -(hessianAb - shear * hessianAa) / (size * std::sqrt(e * width));
  form.Vv = -(hessianBb - 2.0 * shear * hessianAb + shear * shear * hessianAa) / (size * width);
  return std::isfinite(form.Uu * form.Vv) && std::isfinite(form.Uv * form.Uv);
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
  return curvatures;
}
}

Curvatures FitCurvatures(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  const Points normals = VertexNormals(mesh, points, context);
  Curvatures curvatures = Zero(mesh.NumberOfVertices());
  const auto fit = [&](int begin, int end)
  {
    Neighborhood neighborhood(mesh, points);
    for (int v = begin; v < end; ++v)
    {
      if (normals.row(v).isZero(0.0))
      {
        continue;
      }
      neighborhood.Collect(v);
      // The first fit finds the normal, the second one the curvature in it.
      SecondForm form;
      if (FitSecondForm(points, points.row(v), neighborhood, normals.row(v), form) &&
        FitSecondForm(points, points.row(v), neighborhood, Eigen::Vector3d(form.Normal), form))
      {
        Store(form, v, curvatures);
      }
    }
  };
  for (int first = 0; first < mesh.NumberOfVertices(); first += VerticesPerReport)
  {
    context.Report(static_cast<double>(first) / mesh.NumberOfVertices());
    context.For(std::min(VerticesPerReport, mesh.NumberOfVertices() - first),
      [&](int begin, int end) { fit(first + begin, first + end); });
  }
  context.Report(1.0);
  return curvatures;
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
