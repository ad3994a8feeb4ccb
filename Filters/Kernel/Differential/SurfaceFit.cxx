// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/SurfaceFit.h"

#include "Differential/MonomialFactor.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace cartan
{
namespace
{
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Regularization, relative to the number of points. In coordinates of unit
/// variance the third derivatives are of the size of one mean distance over the
/// radius of curvature. This much leaves them alone in a full two-ring and
/// gives way to a quadric where the points do not determine them.
constexpr double CubicRidge = 1e-3;

/// Enough for a solution that rounding cannot move where not even a quadric is
/// determined, too little to be seen elsewhere.
constexpr double TinyRidge = 1e-10;

/// Regularization of the fit of normal curvatures, relative to the sum of
/// squares of all terms of the same order. A slope that a curvature can stand
/// for as well gives way to it, since the normal is known, and so does a third
/// derivative; both are free where the points determine them. Values three
/// times as large or small make little difference.
constexpr double SlopeShare = 0.03;
constexpr double CurvatureShare = 1e-8;
constexpr double CubicShare = 0.1;

/// Keeps what is zero from being divided by zero.
constexpr double NoDivisor = 1e-300;

/// How many more points than parameters a fit must have for its residuals to
/// tell anything.
constexpr double LeastFreedom = 1.0;

/// Axes in the plane normal to Normal along which the coordinates of the points
/// are uncorrelated, and the lengths that are units along them.
struct PlaneAxes
{
  Eigen::Vector3d Normal;
  Eigen::Vector3d A;
  Eigen::Vector3d B;
  double UnitA = 0.0;
  double UnitB = 0.0;

  /// Units of one standard deviation about the vertex. False if the points
  /// coincide.
  bool Fit(const Neighborhood& neighborhood, const Eigen::Vector3d& normal);

  /// The derivatives of the height along the axes become the form on the
  /// surface. False where they are no numbers.
  bool ToSecondForm(const Vector9& fit, SecondForm& form) const;

  /// The Frobenius norm of the third derivatives, in which mixed ones occur three times.
  double Change(const Vector9& fit) const;

  /// The standard error of the form, by the covariance s^2 P M P of the
  /// coefficients P b of a fit to heights, where P = W^T W is the inverse of the
  /// matrix M + R with its ridge, and s^2 the sum of squared residuals over the number of
  /// points less that of parameters, trace(P M) = 9 - trace(P R).
  double StandardError(
    const Matrix9& w, const Vector9& ridge, double squaredResiduals, int numberOfPoints) const;
};

bool PlaneAxes::Fit(const Neighborhood& neighborhood, const Eigen::Vector3d& normal)
{
  this->Normal = normal;
  this->A = normal.unitOrthogonal();
  this->B = normal.cross(this->A);
  double aa = 0.0;
  double ab = 0.0;
  double bb = 0.0;
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    const double x = neighborhood.Offset(i).dot(this->A);
    const double y = neighborhood.Offset(i).dot(this->B);
    aa += x * x;
    ab += x * y;
    bb += y * y;
  }
  const double turn = 0.5 * std::atan2(2.0 * ab, aa - bb);
  this->A = std::cos(turn) * this->A + std::sin(turn) * this->B;
  this->B = normal.cross(this->A);
  const double mean = 0.5 * (aa + bb);
  const double spread = std::hypot(0.5 * (aa - bb), ab);
  // Where all points are in one line the other direction gets no say.
  this->UnitA = std::sqrt((mean + spread) / neighborhood.Size());
  this->UnitB =
    std::max(std::sqrt(std::max(mean - spread, 0.0) / neighborhood.Size()), 1e-6 * this->UnitA);
  return mean > 0.0;
}

bool PlaneAxes::ToSecondForm(const Vector9& fit, SecondForm& form) const
{
  const double slopeA = fit[0] / this->UnitA;
  const double slopeB = fit[1] / this->UnitB;
  const double hessianAa = fit[2] / (this->UnitA * this->UnitA);
  const double hessianAb = fit[3] / (this->UnitA * this->UnitB);
  const double hessianBb = fit[4] / (this->UnitB * this->UnitB);

  // From the graph of a function to an orthonormal frame: u along the surface
  // over a, and v = n x u, which is (r_b - (F / E) r_a) / sqrt(G - F^2 / E) with
  // the first form E, F, G of the tangents r_a, r_b.
  const double e = 1.0 + slopeA * slopeA;
  const double shear = slopeA * slopeB / e;
  const double width = 1.0 + slopeB * slopeB - shear * slopeA * slopeB;
  const double size = std::sqrt(1.0 + slopeA * slopeA + slopeB * slopeB);
  form.Normal = (this->Normal - slopeA * this->A - slopeB * this->B) / size;
  form.U = (this->A + slopeA * this->Normal) / std::sqrt(e);
  form.V = form.Normal.cross(form.U);
  form.Uu = -hessianAa / (size * e);
  form.Uv = -(hessianAb - shear * hessianAa) / (size * std::sqrt(e * width));
  form.Vv = -(hessianBb - 2.0 * shear * hessianAb + shear * shear * hessianAa) / (size * width);
  return std::isfinite(form.Uu * form.Vv) && std::isfinite(form.Uv * form.Uv);
}

double PlaneAxes::Change(const Vector9& fit) const
{
  const double a = this->UnitA;
  const double b = this->UnitB;
  const Eigen::Array4d derivatives(
    fit[5] / (a * a * a), fit[6] / (a * a * b), fit[7] / (a * b * b), fit[8] / (b * b * b));
  return std::sqrt((derivatives.square() * Eigen::Array4d(1.0, 3.0, 3.0, 1.0)).sum());
}

double PlaneAxes::StandardError(
  const Matrix9& w, const Vector9& ridge, double squaredResiduals, int numberOfPoints) const
{
  const double left = numberOfPoints - 9.0 + w.colwise().squaredNorm().dot(ridge.transpose());
  if (left < LeastFreedom)
  {
    return std::numeric_limits<double>::infinity();
  }
  // P M P = P - P R P. The mixed derivative occurs twice in the tensor.
  const Eigen::Array3d units(
    this->UnitA * this->UnitA, this->UnitA * this->UnitB, this->UnitB * this->UnitB);
  const Eigen::Array3d count(1.0, 2.0, 1.0);
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const Vector9 column = w.transpose() * w.col(2 + i);
    const double variance = column[2 + i] - column.cwiseAbs2().dot(ridge);
    sum += count[i] * variance / (units[i] * units[i]);
  }
  return std::sqrt(std::max(squaredResiduals, 0.0) / left * std::max(sum, 0.0));
}

/// A second form in the plane of axes that are normal to its normal.
struct PlanarForm
{
  PlanarForm(const SecondForm& form, const PlaneAxes& axes)
  {
    const double cosine = axes.A.dot(form.U);
    const double sine = axes.A.dot(form.V);
    const double mixed = 2.0 * cosine * sine * form.Uv;
    this->Aa = cosine * cosine * form.Uu + mixed + sine * sine * form.Vv;
    this->Bb = sine * sine * form.Uu - mixed + cosine * cosine * form.Vv;
    this->Ab = cosine * sine * (form.Vv - form.Uu) + (cosine * cosine - sine * sine) * form.Uv;
  }

  /// Adds to the tangential part (x, y) of an offset from the vertex, of this height, what makes
  /// it as long as the chord on a circle of curvature: along the direction in which the normal
  /// turns on the way, a length t becomes (t^2 + h^2)^1/2. In coordinates corrected so,
  /// cylinders as well as spheres are exactly quadratic.
  ///
  /// (t^2 + h^2)^1/2 - t = h tan(turn / 4) on a circle, where h / t is the tangent of half the
  /// turn, which the turn that the form says bounds up to 120 degrees. Where the form is no
  /// circle's, as along the asymptotic directions of a saddle, t may be anything, and of either
  /// sign; there the correction fades out.
  void LengthenToChord(double height, double& x, double& y) const
  {
    const double turnA = this->Aa * x + this->Ab * y;
    const double turnB = this->Ab * x + this->Bb * y;
    const double along = turnA * x + turnB * y; // t times the turn
    const double squared = x * x + y * y;
    const double size = std::abs(height);
    // The tangent over the turn: h / t, or the turn's squared bound over that where it is less.
    const double tangent = std::min(size / (std::abs(along) + NoDivisor),
      std::abs(along) / (size * squared / (squared + size * size + NoDivisor) + NoDivisor));
    const double turnSquared = turnA * turnA + turnB * turnB;
    const double longer = std::copysign(
      size * tangent / (1.0 + std::sqrt(1.0 + tangent * tangent * turnSquared)), along);
    x += longer * turnA;
    y += longer * turnB;
  }

  double Aa;
  double Ab;
  double Bb;
};

/// The monomials of the cubic without a constant: slopes in the plane, the
/// higher ones in chord-length coordinates.
Vector9 Monomials(
  const Eigen::Vector3d& offset, const PlaneAxes& axes, const std::optional<PlanarForm>& earlier)
{
  const double planarX = offset.dot(axes.A);
  const double planarY = offset.dot(axes.B);
  double x = planarX;
  double y = planarY;
  if (earlier)
  {
    earlier->LengthenToChord(offset.dot(axes.Normal), x, y);
  }
  else
  {
    // A point straight above the vertex has no direction in the plane; the
    // bound keeps it from deciding alone.
    const double planar = std::sqrt(planarX * planarX + planarY * planarY);
    const double toChord = planar > 0.0 ? std::min(offset.norm() / planar, 3.0) : 1.0;
    x *= toChord;
    y *= toChord;
  }
  x /= axes.UnitA;
  y /= axes.UnitB;
  Vector9 monomials;
  monomials << planarX / axes.UnitA, planarY / axes.UnitB, 0.5 * x * x, x * y, 0.5 * y * y,
    x * x * x / 6.0, 0.5 * x * x * y, 0.5 * x * y * y, y * y * y / 6.0;
  return monomials;
}

std::optional<PlanarForm> ToPlane(const SecondForm* form, const PlaneAxes& axes)
{
  return form ? std::optional<PlanarForm>(PlanarForm(*form, axes)) : std::nullopt;
}

/// The Frobenius norms of the derivative tensors, in which a mixed derivative occurs
/// several times: they do not depend on the choice of axes.
Vector9 RidgeOfCubic(int numberOfPoints)
{
  Vector9 ridge;
  ridge << TinyRidge, TinyRidge, TinyRidge, 2.0 * TinyRidge, TinyRidge, CubicRidge,
    3.0 * CubicRidge, 3.0 * CubicRidge, CubicRidge;
  return numberOfPoints * ridge;
}

/// The squared distance within which a quarter of the points is, without those
/// in the same place up to single precision.
double NearQuarterSquared(const Neighborhood& neighborhood)
{
  std::vector<double> squares;
  double farthest = 0.0;
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    squares.push_back(neighborhood.Offset(i).squaredNorm());
    farthest = std::max(farthest, squares.back());
  }
  const auto end = std::remove_if(
    squares.begin(), squares.end(), [&](double square) { return square <= 1e-12 * farthest; });
  const auto quarter = squares.begin() + (end - squares.begin()) / 4;
  std::nth_element(squares.begin(), quarter, end);
  return *quarter;
}
}

double SecondForm::HalfTurnSine(const Eigen::Vector3d& edge) const
{
  const double u = edge.dot(this->U);
  const double v = edge.dot(this->V);
  const double planarSquared = u * u + v * v;
  if (!(planarSquared > 0.0))
  {
    return 0.0;
  }
  // The chord of a turn by t on a circle of curvature k is 2 sin(t / 2) / k long.
  const double curvature =
    (this->Uu * u * u + 2.0 * this->Uv * u * v + this->Vv * v * v) / planarSquared;
  return 0.5 * std::abs(curvature) * edge.norm();
}

double Determination(const Neighborhood& neighborhood, const Eigen::Vector3d& normal)
{
  PlaneAxes axes;
  if (!axes.Fit(neighborhood, normal))
  {
    return 0.0;
  }
  using Vector5 = Eigen::Matrix<double, 5, 1>;
  using Matrix5 = Eigen::Matrix<double, 5, 5>;
  Matrix5 matrix = Matrix5::Zero();
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    if (neighborhood.IsClose(i))
    {
      // Without chord lengths, which bend straight rows.
      const double x = neighborhood.Offset(i).dot(axes.A) / axes.UnitA;
      const double y = neighborhood.Offset(i).dot(axes.B) / axes.UnitB;
      Vector5 monomials;
      monomials << x, y, 0.5 * x * x, x * y, 0.5 * y * y;
      MonomialFactor<5>::AddSquare(monomials, matrix);
    }
  }
  matrix.diagonal().array() += TinyRidge * neighborhood.Size();
  // The squares of the factor's diagonal are what earlier columns leave over.
  const Vector5 left = MonomialFactor<5>(matrix).Pivots();
  const double smallest = (left.tail<3>().array() / matrix.diagonal().tail<3>().array()).minCoeff();
  return left.allFinite() ? smallest : 0.0;
}

bool FitCubic(const Neighborhood& neighborhood, const Eigen::Vector3d& normal,
  const SecondForm* earlier, SecondForm& form)
{
  PlaneAxes axes;
  if (!axes.Fit(neighborhood, normal))
  {
    return false;
  }
  const std::optional<PlanarForm> planar = ToPlane(earlier, axes);
  Matrix9 matrix = Matrix9::Zero();
  Vector9 rightHandSide = Vector9::Zero();
  double squaredHeights = 0.0;
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    const Vector9 monomials = Monomials(neighborhood.Offset(i), axes, planar);
    const double height = neighborhood.Offset(i).dot(normal);
    MonomialFactor<9>::AddSquare(monomials, matrix);
    rightHandSide += height * monomials;
    squaredHeights += height * height;
  }
  const Vector9 ridge = RidgeOfCubic(neighborhood.Size());
  matrix.diagonal() += ridge;
  const MonomialFactor<9> factor(matrix);
  const Vector9 fit = factor.Solve(rightHandSide);
  if (earlier)
  {
    // |h - X x|^2 = h.h - x.b - x.R x for (X^T X + R) x = b = X^T h.
    const double squaredResiduals =
      squaredHeights - fit.dot(rightHandSide) - fit.cwiseAbs2().dot(ridge);
    form.StandardError =
      axes.StandardError(factor.InverseOfLower(), ridge, squaredResiduals, neighborhood.Size());
    form.Change = axes.Change(fit);
  }
  return axes.ToSecondForm(fit, form);
}

bool AppendCubicWeights(
  const Neighborhood& neighborhood, const Eigen::Vector3d& normal, std::vector<float>& weights)
{
  PlaneAxes axes;
  if (!axes.Fit(neighborhood, normal))
  {
    return false;
  }
  Matrix9 matrix = RidgeOfCubic(neighborhood.Size()).asDiagonal();
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    MonomialFactor<9>::AddSquare(Monomials(neighborhood.Offset(i), axes, std::nullopt), matrix);
  }
  const MonomialFactor<9> factor(matrix);
  const double units[5] = { axes.UnitA, axes.UnitB, axes.UnitA * axes.UnitA,
    axes.UnitA * axes.UnitB, axes.UnitB * axes.UnitB };
  Eigen::Matrix<double, 9, 5> rows;
  for (int k = 0; k < 5; ++k)
  {
    rows.col(k) = factor.Solve(Vector9::Unit(k)) / units[k];
  }
  if (!rows.allFinite())
  {
    return false;
  }
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    const Vector9 monomials = Monomials(neighborhood.Offset(i), axes, std::nullopt);
    for (int k = 0; k < 5; ++k)
    {
      weights.push_back(static_cast<float>(rows.col(k).dot(monomials)));
    }
  }
  return true;
}

bool ToSecondForm(const Eigen::Matrix<double, 3, 5>& derivatives, SecondForm& form)
{
  // The first form E, F, G; v = n x u is (x_v - (F / E) x_u) / sqrt(G - F^2 / E).
  const Eigen::Vector3d tangentU = derivatives.col(0);
  const Eigen::Vector3d tangentV = derivatives.col(1);
  const double e = tangentU.squaredNorm();
  const double shear = tangentU.dot(tangentV) / e;
  const double width = tangentV.squaredNorm() - shear * shear * e;
  form.Normal = tangentU.cross(tangentV).normalized();
  form.U = tangentU / std::sqrt(e);
  form.V = form.Normal.cross(form.U);
  const Eigen::RowVector3d second = form.Normal.transpose() * derivatives.rightCols<3>();
  form.Uu = -second[0] / e;
  form.Uv = -(second[1] - shear * second[0]) / std::sqrt(e * width);
  form.Vv = -(second[2] - 2.0 * shear * second[1] + shear * shear * second[0]) / width;
  return std::isfinite(form.Uu * form.Vv) && std::isfinite(form.Uv * form.Uv);
}

bool FitNormalCurvatures(const Neighborhood& neighborhood, const Eigen::Vector3d& normal,
  const SecondForm* earlier, SecondForm& form)
{
  PlaneAxes axes;
  if (!axes.Fit(neighborhood, normal))
  {
    return false;
  }
  // The rows are already free of lengths; one unit for both axes keeps them so.
  axes.UnitA = axes.UnitB = std::sqrt(axes.UnitA * axes.UnitB);
  const std::optional<PlanarForm> planar = ToPlane(earlier, axes);
  const double added = NearQuarterSquared(neighborhood);
  Matrix9 matrix = Matrix9::Zero();
  Vector9 rightHandSide = Vector9::Zero();
  for (int i = 0; i < neighborhood.Size(); ++i)
  {
    // A point in almost the same place would decide alone, with the noise of its
    // coordinates: the distance to the nearest quarter is added to all distances.
    const Eigen::Vector3d& offset = neighborhood.Offset(i);
    const double weight = axes.UnitA * axes.UnitA / (offset.squaredNorm() + added);
    const Vector9 monomials = weight * Monomials(offset, axes, planar);
    MonomialFactor<9>::AddSquare(monomials, matrix);
    rightHandSide += weight * offset.dot(normal) * monomials;
  }
  // As in FitCubic the norms do not depend on the axes.
  const Vector9 squares = matrix.diagonal();
  const double slope = SlopeShare * (squares[0] + squares[1]);
  const double curvature = CurvatureShare * (squares[2] + squares[3] / 2.0 + squares[4]);
  const double cubic = CubicShare * (squares[5] + squares[6] / 3.0 + squares[7] / 3.0 + squares[8]);
  Vector9 ridge;
  ridge << slope, slope, curvature, 2.0 * curvature, curvature, cubic, 3.0 * cubic, 3.0 * cubic,
    cubic;
  matrix.diagonal() += ridge;
  matrix.diagonal().array() += 0.01 * curvature;
  return axes.ToSecondForm(MonomialFactor<9>(matrix).Solve(rightHandSide), form);
}
}
