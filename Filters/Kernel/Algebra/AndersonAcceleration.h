// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>

namespace cartan
{
/// Anderson acceleration of a fixed-point iteration x <- g(x) (Walker and Ni,
/// Anderson Acceleration for Fixed-Point Iterations, 2011): with the step
/// f = g(x) - x, the next x is g - dG t where t minimizes |f - dF t|, dF and dG
/// the last differences of f and g.
class AndersonAcceleration
{
public:
  /// `regularization` is added to the normal matrix of t, relative to its
  /// diagonal. Differences become parallel near the end; so little keeps t small
  /// and changes nothing where they are independent.
  explicit AndersonAcceleration(double regularization)
    : Regularization(regularization)
  {
  }

  void Forget() { this->Count = 0; }

  /// Takes the step f = g - x from x; returns whether `next` is other than g.
  bool Next(const Eigen::VectorXd& g, const Eigen::VectorXd& f, Eigen::VectorXd& next)
  {
    if (this->Count > 0)
    {
      const int column = (this->Count - 1) % Memory;
      const int filled = std::min(this->Count, Memory);
      this->StepDifferences.col(column) = f - this->LastStep;
      this->ValueDifferences.col(column) = g - this->LastValue;
      const Eigen::VectorXd products =
        this->StepDifferences.leftCols(filled).transpose() * this->StepDifferences.col(column);
      this->Products.col(column).head(filled) = products;
      this->Products.row(column).head(filled) = products.transpose();
    }
    else
    {
      this->StepDifferences.resize(f.size(), Memory);
      this->ValueDifferences.resize(f.size(), Memory);
    }
    this->LastStep = f;
    this->LastValue = g;
    const int used = std::min(this->Count++, Memory);
    next = g;
    if (used == 0)
    {
      return false;
    }
    const auto steps = this->StepDifferences.leftCols(used);
    Eigen::MatrixXd gram = this->Products.topLeftCorner(used, used);
    gram.diagonal() *= 1.0 + this->Regularization;
    const Eigen::VectorXd factors = gram.ldlt().solve(steps.transpose() * f);
    if (!factors.allFinite())
    {
      return false;
    }
    next.noalias() -= this->ValueDifferences.leftCols(used) * factors;
    return true;
  }

private:
  /// How many past steps are seen. More gain little and cost two vectors each.
  static constexpr int Memory = 5;

  double Regularization;
  int Count = 0;
  Eigen::MatrixXd StepDifferences;
  Eigen::MatrixXd ValueDifferences;
  Eigen::Matrix<double, Memory, Memory> Products; ///< of the differences of steps
  Eigen::VectorXd LastStep;
  Eigen::VectorXd LastValue;
};
}
