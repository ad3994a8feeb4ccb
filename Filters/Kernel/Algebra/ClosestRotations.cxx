// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/ClosestRotations.h"

#include "Algebra/Rotation.h"

#include <cmath>
#include <cstddef>

namespace cartan
{
namespace
{
/// So many matrices at once hide that each step waits for the one before.
constexpr int LaneCount = 8;
using Lanes = Eigen::Array<double, LaneCount, 1>;

/// One matrix in each lane.
struct LaneMatrix
{
  Lanes Entries[9];

  Lanes& operator()(int row, int column) { return this->Entries[3 * column + row]; }
  const Lanes& operator()(int row, int column) const { return this->Entries[3 * column + row]; }

  Lanes SquaredNorm() const
  {
    Lanes sum = this->Entries[0].square();
    for (int i = 1; i < 9; ++i)
    {
      sum += this->Entries[i].square();
    }
    return sum;
  }
};

LaneMatrix LaneProduct(const LaneMatrix& a, const LaneMatrix& b)
{
  LaneMatrix product;
  for (int c = 0; c < 3; ++c)
  {
    for (int r = 0; r < 3; ++r)
    {
      product(r, c) = a(r, 0) * b(0, c) + a(r, 1) * b(1, c) + a(r, 2) * b(2, c);
    }
  }
  return product;
}

/// d I - f A^T A.
LaneMatrix LessSquare(const Lanes& d, double f, const LaneMatrix& a)
{
  LaneMatrix result;
  for (int c = 0; c < 3; ++c)
  {
    for (int r = 0; r <= c; ++r)
    {
      result(r, c) = -f * (a(0, r) * a(0, c) + a(1, r) * a(1, c) + a(2, r) * a(2, c));
      result(c, r) = result(r, c);
    }
    result(c, c) += d;
  }
  return result;
}

LaneMatrix LaneCofactors(const LaneMatrix& a)
{
  LaneMatrix cofactors;
  for (int c = 0; c < 3; ++c)
  {
    const int d = (c + 1) % 3;
    const int e = (c + 2) % 3;
    for (int r = 0; r < 3; ++r)
    {
      const int s = (r + 1) % 3;
      const int t = (r + 2) % 3;
      cofactors(r, c) = a(s, d) * a(t, e) - a(t, d) * a(s, e);
    }
  }
  return cofactors;
}

/// The rotation R closest to A, |A| = 1, in closed form. With the singular values of A, the
/// smallest with the sign of det A, trace(R^T A) is their sum x, the largest root of
///
///   f(x) = (x^2 - 1)^2 - 8 x det A - 4 |cof A|^2,
///
/// and with k = (x^2 - 1) / 2, the sum of their products of two,
///
///   R = [(k + 1) A + x cof A - A A^T A] / (k x - det A)
///
/// (Markley, Attitude Determination Using Vector Observations: A Fast Optimal Matrix Algorithm,
/// Journal of the Astronautical Sciences, 1993). The denominator is the product of the sums of
/// two singular values: 1.5 for rotations, zero where several rotations are equally close.
struct LargestTrace
{
  LaneMatrix Rotation;
  Lanes Denominator;
  Lanes LastStep; ///< squared, of the root

  explicit LargestTrace(const LaneMatrix& a)
  {
    const LaneMatrix cofactors = LaneCofactors(a);
    const Lanes determinant =
      a(0, 0) * cofactors(0, 0) + a(1, 0) * cofactors(1, 0) + a(2, 0) * cofactors(2, 0);
    const Lanes squared = cofactors.SquaredNorm();
    // All roots are real, so Newton's method comes down to the largest from any number above.
    // k^2 = |cof A|^2 + 2 x det A and x <= 3^1/2 give one that is exact for rotations and
    // matrices of rank two; four steps from it are enough for all but mirrored ones.
    Lanes x = (1.0 + 2.0 * (squared + 2.0 * std::sqrt(3.0) * determinant.max(0.0)).sqrt()).sqrt();
    Lanes step = x;
    for (int i = 0; i < 4; ++i)
    {
      const Lanes twiceK = x.square() - 1.0;
      step = (twiceK.square() - 8.0 * determinant * x - 4.0 * squared) /
        (4.0 * (x * twiceK) - 8.0 * determinant);
      x -= step;
    }
    const Lanes k = 0.5 * (x.square() - 1.0);
    this->LastStep = step.square();
    this->Denominator = k * x - determinant;
    const Lanes inverse = 1.0 / this->Denominator;
    LaneMatrix r = LaneProduct(a, LessSquare(k + 1.0, 1.0, a));
    for (int i = 0; i < 9; ++i)
    {
      r.Entries[i] = inverse * (r.Entries[i] + x * cofactors.Entries[i]);
    }
    // A step of R <- R (3 I - R^T R) / 2 takes rounding off the lengths.
    this->Rotation = LaneProduct(r, LessSquare(Lanes::Constant(1.5), 0.5, r));
  }

  /// Whether it is right up to rounding: where the root has been reached and the denominator is
  /// not small, which would divide rounding.
  bool IsReached(int lane) const
  {
    return this->Denominator[lane] > 0.1 && this->LastStep[lane] < 1e-18;
  }
};
}

void ProjectAllOnRotations(double* matrices, int count)
{
  for (int first = 0; first < count; first += LaneCount)
  {
    const int lanes = std::min(LaneCount, count - first);
    double* const begin = matrices + 9 * static_cast<std::ptrdiff_t>(first);
    LaneMatrix a;
    for (int i = 0; i < 9; ++i)
    {
      // Lanes without a matrix repeat the first.
      for (int lane = 0; lane < LaneCount; ++lane)
      {
        a.Entries[i][lane] = begin[lane < lanes ? 9 * lane + i : i];
      }
    }
    const Lanes inverse = 1.0 / a.SquaredNorm().sqrt();
    for (Lanes& entries : a.Entries)
    {
      entries *= inverse;
    }
    const LargestTrace found(a);
    for (int lane = 0; lane < lanes; ++lane)
    {
      Eigen::Map<Eigen::Matrix3d> matrix(begin + static_cast<std::ptrdiff_t>(9) * lane);
      if (!found.IsReached(lane))
      {
        matrix = ProjectOnRotations(Eigen::Matrix3d(matrix));
        continue;
      }
      for (int i = 0; i < 9; ++i)
      {
        matrix.data()[i] = found.Rotation.Entries[i][lane];
      }
    }
  }
}
}
