// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cmath>

namespace cartan
{
/// The Cholesky factor of the normal equations of N monomials. There are two for each vertex:
/// loops of a length that the compiler knows take a third of the time of Eigen's, which are made
/// for large matrices.
template <int N>
class MonomialFactor
{
public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  /// Adds m m^T to the lower triangle of a sum.
  static void AddSquare(const Vector& m, Matrix& sum)
  {
    for (int j = 0; j < N; ++j)
    {
      for (int i = j; i < N; ++i)
      {
        sum(i, j) += m[i] * m[j];
      }
    }
  }

  /// Of a matrix whose lower triangle is read. Not a number where it is not positive.
  explicit MonomialFactor(const Matrix& matrix)
    : Lower(matrix)
  {
    for (int j = 0; j < N; ++j)
    {
      for (int k = 0; k < j; ++k)
      {
        for (int i = j; i < N; ++i)
        {
          this->Lower(i, j) -= this->Lower(i, k) * this->Lower(j, k);
        }
      }
      const double pivot = std::sqrt(this->Lower(j, j));
      this->Inverse[j] = 1.0 / pivot;
      this->Lower(j, j) = pivot;
      for (int i = j + 1; i < N; ++i)
      {
        this->Lower(i, j) *= this->Inverse[j];
      }
    }
  }

  /// The squares of L's diagonal.
  Vector Pivots() const { return this->Lower.diagonal().cwiseAbs2(); }

  Vector Solve(Vector values) const
  {
    for (int j = 0; j < N; ++j)
    {
      values[j] *= this->Inverse[j];
      for (int i = j + 1; i < N; ++i)
      {
        values[i] -= this->Lower(i, j) * values[j];
      }
    }
    for (int j = N - 1; j >= 0; --j)
    {
      for (int i = j + 1; i < N; ++i)
      {
        values[j] -= this->Lower(i, j) * values[i];
      }
      values[j] *= this->Inverse[j];
    }
    return values;
  }

  Matrix InverseOfLower() const
  {
    Matrix inverse = Matrix::Zero();
    for (int c = 0; c < N; ++c)
    {
      inverse(c, c) = this->Inverse[c];
      for (int j = c; j < N; ++j)
      {
        inverse(j, c) = j == c ? this->Inverse[c] : inverse(j, c) * this->Inverse[j];
        for (int i = j + 1; i < N; ++i)
        {
          inverse(i, c) -= this->Lower(i, j) * inverse(j, c);
        }
      }
    }
    return inverse;
  }

private:
  Matrix Lower;
  Vector Inverse; ///< of the diagonal
};
}
