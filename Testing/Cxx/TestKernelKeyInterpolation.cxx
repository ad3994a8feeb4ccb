// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Morph/KeyInterpolation.h"

#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using cartan::Field;
using cartan::KeyInterpolation;

namespace
{
const std::vector<double> Uneven = { 0.0, 0.15, 0.4, 0.9, 1.0 };

Field Rows(const std::vector<double>& parameters,
  const std::vector<std::function<double(double)>>& functions)
{
  Field values(functions.size(), parameters.size());
  for (std::size_t row = 0; row < functions.size(); ++row)
  {
    for (std::size_t k = 0; k < parameters.size(); ++k)
    {
      values(row, k) = functions[row](parameters[k]);
    }
  }
  return values;
}

Field RandomRows(int rows, int keys)
{
  shapes::Random random(4);
  return Field::NullaryExpr(rows, keys, [&random]() { return random(); });
}
}

TEST(KeyInterpolation, ReturnsTheKeys)
{
  const Field values = RandomRows(20, 5);
  const KeyInterpolation interpolation(Uneven, values);
  for (int k = 0; k < 5; ++k)
  {
    EXPECT_LT((interpolation.Evaluate(Uneven[k]) - values.col(k)).norm(), 1e-15);
  }
}

TEST(KeyInterpolation, IsLinearThroughTwoKeysAndBeyond)
{
  const Field values = RandomRows(20, 2);
  const KeyInterpolation interpolation({ 0.25, 0.75 }, values);
  for (const double t : { -1.0, 0.0, 0.25, 0.4, 0.75, 1.0, 3.0 })
  {
    const double s = (t - 0.25) / 0.5;
    const Eigen::VectorXd expected = (1.0 - s) * values.col(0) + s * values.col(1);
    EXPECT_LT((interpolation.Evaluate(t) - expected).norm(), 1e-14);
  }
}

TEST(KeyInterpolation, ReproducesLinesAndMonotoneParabolas)
{
  // On [0, 1] the parabola's slope is positive, and its secants differ by less
  // than the factor at which slopes are limited.
  const auto line = [](double t) { return 3.0 - 2.0 * t; };
  const auto parabola = [](double t) { return (t + 1.0) * (t + 1.0); };
  const KeyInterpolation interpolation(Uneven, Rows(Uneven, { line, parabola }));
  for (double t = 0.0; t <= 1.0; t += 0.01)
  {
    const Eigen::VectorXd values = interpolation.Evaluate(t);
    EXPECT_NEAR(values[0], line(t), 1e-14);
    EXPECT_NEAR(values[1], parabola(t), 1e-14);
  }
  // Beyond: the tangent.
  EXPECT_NEAR(interpolation.Evaluate(1.5)[1], 4.0 + 0.5 * 4.0, 1e-13);
  EXPECT_NEAR(interpolation.Evaluate(-0.5)[1], 1.0 - 0.5 * 2.0, 1e-13);
}

TEST(KeyInterpolation, StaysBetweenTheKeysBesideIt)
{
  const Field values = RandomRows(50, 5);
  const KeyInterpolation interpolation(Uneven, values);
  for (int k = 0; k < 4; ++k)
  {
    Eigen::VectorXd last = values.col(k);
    for (int step = 1; step <= 20; ++step)
    {
      const double t = Uneven[k] + step / 20.0 * (Uneven[k + 1] - Uneven[k]);
      const Eigen::VectorXd next = interpolation.Evaluate(t);
      // Every step goes the way from one key to the next.
      const Eigen::ArrayXd progress =
        (next - last).array() * (values.col(k + 1) - values.col(k)).array().sign();
      EXPECT_GT(progress.minCoeff(), -1e-14);
      last = next;
    }
  }
}

TEST(KeyInterpolation, HasAContinuousDerivative)
{
  const KeyInterpolation interpolation(Uneven, RandomRows(50, 5));
  const double h = 1e-6;
  for (const double t : Uneven)
  {
    const Eigen::VectorXd before = (interpolation.Evaluate(t) - interpolation.Evaluate(t - h)) / h;
    const Eigen::VectorXd after = (interpolation.Evaluate(t + h) - interpolation.Evaluate(t)) / h;
    EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 2e-3);
  }
}

TEST(KeyInterpolation, CurvesTurnWithTheKeys)
{
  const Field values = RandomRows(30, 5);
  const Eigen::Matrix3d rotation = shapes::RandomRigidMotion(8).Rotation;
  Field turned = values;
  for (int v = 0; v < 10; ++v)
  {
    turned.middleRows<3>(3 * v) = rotation * values.middleRows<3>(3 * v);
  }
  const KeyInterpolation original(Uneven, values, 3);
  const KeyInterpolation moved(Uneven, turned, 3);
  for (const double t : { -0.2, 0.1, 0.3, 0.62, 0.95, 1.4 })
  {
    const Eigen::VectorXd expected = original.Evaluate(t);
    const Eigen::VectorXd actual = moved.Evaluate(t);
    for (int v = 0; v < 10; ++v)
    {
      EXPECT_LT((actual.segment<3>(3 * v) - rotation * expected.segment<3>(3 * v)).norm(), 1e-13);
    }
  }
}

TEST(KeyInterpolation, VectorsOnALineAreLikeNumbers)
{
  const Field values = RandomRows(20, 5);
  const Eigen::Vector3d direction(0.48, 0.6, 0.64);
  Field vectors(60, 5);
  for (int row = 0; row < 20; ++row)
  {
    vectors.middleRows<3>(3 * row) = direction * values.row(row);
  }
  const KeyInterpolation numbers(Uneven, values);
  const KeyInterpolation onLines(Uneven, vectors, 3);
  for (const double t : { -0.2, 0.1, 0.3, 0.62, 0.95, 1.4 })
  {
    const Eigen::VectorXd expected = numbers.Evaluate(t);
    const Eigen::VectorXd actual = onLines.Evaluate(t);
    for (int row = 0; row < 20; ++row)
    {
      EXPECT_LT((actual.segment<3>(3 * row) - expected[row] * direction).norm(), 1e-13);
    }
  }
}

TEST(KeyInterpolation, RunsBackwardsAsForwards)
{
  const Field values = RandomRows(50, 5);
  std::vector<double> mirrored;
  for (std::size_t k = 0; k < Uneven.size(); ++k)
  {
    mirrored.push_back(1.0 - Uneven[Uneven.size() - 1 - k]);
  }
  const KeyInterpolation forwards(Uneven, values);
  const KeyInterpolation backwards(mirrored, values.rowwise().reverse());
  for (double t = -0.2; t < 1.2; t += 0.07)
  {
    EXPECT_LT((forwards.Evaluate(t) - backwards.Evaluate(1.0 - t)).norm(), 1e-13);
  }
}

TEST(KeyInterpolation, RefusesParametersThatMakeNoSense)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto make = [](const std::vector<double>& parameters, int columns)
  { return KeyInterpolation(parameters, Field::Zero(3, columns)); };
  EXPECT_THROW(make({}, 0), cartan::Error);
  EXPECT_THROW(make({ 0.0 }, 1), cartan::Error);
  EXPECT_THROW(make({ 0.0, 1.0 }, 3), cartan::Error);
  EXPECT_THROW(make({ 0.0, 0.0 }, 2), cartan::Error);
  EXPECT_THROW(make({ 0.0, nan }, 2), cartan::Error);
  EXPECT_THROW(make({ 0.0, 1.0 }, 2).Evaluate(nan), cartan::Error);
  EXPECT_THROW(make({ 0.0, 0.5, 1.0 }, 3).Evaluate(nan), cartan::Error);
  try
  {
    make({ 0.0, 0.5, 0.25 }, 3);
    FAIL() << "accepted";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("key frame 2 is 0.25"), std::string::npos)
      << error.what();
  }
}
