// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>

namespace cartan
{
/// Descent directions for a function whose Hessian is known in part (Nocedal, Updating
/// Quasi-Newton Matrices with Limited Storage, 1980; Nocedal and Wright, Numerical
/// Optimization, 2006, Algorithm 7.4): -H g, where H is the inverse of the known part P,
/// scaled, and corrected by the last steps s and the differences y of gradients that
/// they made. The inverse is applied once per gradient, as that of y follows.
class LimitedMemoryBfgs
{
public:
  void Forget()
  {
    this->Count = 0;
    this->HasStep = false;
  }

  bool IsEmpty() const { return this->Count == 0; }

  /// The direction where the gradient is g, with z = P^-1 g. It leads downhill: where
  /// rounding leaves none that does, it is -z.
  void Next(const Eigen::VectorXd& g, const Eigen::VectorXd& z, Eigen::VectorXd& direction)
  {
    if (this->HasStep)
    {
      this->Remember(g, z);
    }
    this->Gradient = g;
    this->Solved = z;
    this->HasStep = false;
    direction = z;
    this->Rest = g;
    const int used = std::min(this->Count, Memory);
    std::array<double, Memory> factors{};
    for (int i = 1; i <= used; ++i)
    {
      const int k = (this->Count - i) % Memory;
      factors[k] = this->Steps.col(k).dot(this->Rest) / this->Products[k];
      this->Rest -= factors[k] * this->Differences.col(k);
      direction -= factors[k] * this->SolvedDifferences.col(k);
    }
    direction *= this->Count > 0 ? this->Scale : 1.0;
    for (int i = used; i >= 1; --i)
    {
      const int k = (this->Count - i) % Memory;
      const double factor = this->Differences.col(k).dot(direction) / this->Products[k];
      direction += (factors[k] - factor) * this->Steps.col(k);
    }
    direction = -direction;
    if (!(direction.dot(g) < 0.0))
    {
      this->Forget();
      direction = -z;
    }
  }

  /// Tells which step was taken from there.
  void Take(const Eigen::VectorXd& step)
  {
    this->Step = step;
    this->HasStep = true;
  }

private:
  void Remember(const Eigen::VectorXd& g, const Eigen::VectorXd& z)
  {
    const Eigen::VectorXd difference = g - this->Gradient;
    const double product = this->Step.dot(difference);
    // Only where the function curves upward is H a descent's.
    if (!(product > SmallestCosine * this->Step.norm() * difference.norm()))
    {
      return;
    }
    if (this->Count == 0)
    {
      this->Steps.resize(g.size(), Memory);
      this->Differences.resize(g.size(), Memory);
      this->SolvedDifferences.resize(g.size(), Memory);
    }
    const int k = this->Count++ % Memory;
    this->Steps.col(k) = this->Step;
    this->Differences.col(k) = difference;
    this->SolvedDifferences.col(k) = z - this->Solved;
    this->Products[k] = product;
    this->Scale = product / difference.dot(this->SolvedDifferences.col(k));
  }

  /// How many past steps are seen. More gain little, and each costs three vectors.
  static constexpr int Memory = 12;
  static constexpr double SmallestCosine = 1e-10;

  int Count = 0;
  bool HasStep = false;
  double Scale = 1.0;
  std::array<double, Memory> Products{};
  Eigen::MatrixXd Steps;
  Eigen::MatrixXd Differences;
  Eigen::MatrixXd SolvedDifferences;
  Eigen::VectorXd Gradient;
  Eigen::VectorXd Solved;
  Eigen::VectorXd Step;
  Eigen::VectorXd Rest;
};
}
