// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/LimitedMemoryBfgs.h"

#include <gtest/gtest.h>

#include <cmath>

using Eigen::VectorXd;

namespace
{
constexpr int Size = 40;

/// The diagonal P of the known part, and the function's Hessian P + sum over three
/// directions of u u^T.
VectorXd Known()
{
  return VectorXd::LinSpaced(Size, 1.0, 100.0);
}

VectorXd TimesHessian(const VectorXd& x)
{
  VectorXd product = Known().cwiseProduct(x);
  for (int k = 0; k < 3; ++k)
  {
    VectorXd u = VectorXd::Zero(Size);
    for (int i = 0; i < Size; ++i)
    {
      u[i] = 20.0 * std::cos((k + 1.0) * i);
    }
    product += u * u.dot(x);
  }
  return product;
}
}

TEST(LimitedMemoryBfgs, FindsTheLowestPointOfAQuadratic)
{
  // With exact searches the steps are those of preconditioned conjugate gradients
  // (Nocedal and Wright, Numerical Optimization, 2006, Theorem 6.4): P^-1 times the
  // Hessian has four different eigenvalues, so four steps reach the end.
  cartan::LimitedMemoryBfgs memory;
  VectorXd x = VectorXd::Constant(Size, 1.0) - VectorXd::LinSpaced(Size, 0.0, 3.0);
  const double start = x.norm();
  VectorXd direction;
  for (int step = 0; step < 4; ++step)
  {
    EXPECT_GT(x.norm(), 1e-6 * start);
    const VectorXd g = TimesHessian(x);
    memory.Next(g, g.cwiseQuotient(Known()), direction);
    EXPECT_LT(direction.dot(g), 0.0);
    const VectorXd curved = TimesHessian(direction);
    direction *= -direction.dot(g) / direction.dot(curved);
    x += direction;
    memory.Take(direction);
  }
  EXPECT_LT(x.norm(), 1e-10 * start);
}

TEST(LimitedMemoryBfgs, StepsDownTheKnownPartWithoutMemory)
{
  cartan::LimitedMemoryBfgs memory;
  const VectorXd g = VectorXd::LinSpaced(Size, -1.0, 2.0);
  const VectorXd z = g.cwiseQuotient(Known());
  VectorXd direction;
  memory.Next(g, z, direction);
  EXPECT_EQ(direction, -z);
  // A step along which the function curves downward teaches nothing.
  memory.Take(direction);
  memory.Next(2.0 * g, 2.0 * z, direction);
  EXPECT_TRUE(memory.IsEmpty());
  EXPECT_EQ(direction, -2.0 * z);
  memory.Take(direction);
  memory.Next(g, z, direction);
  EXPECT_FALSE(memory.IsEmpty());
  memory.Forget();
  memory.Next(g, z, direction);
  EXPECT_EQ(direction, -z);
}
