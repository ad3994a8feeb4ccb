// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/ClosestRotations.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Types.h"
#include "TestShapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using cartan::ProjectOnRotations;
using cartan::RotationFromVector;
using cartan::VectorFromRotation;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace
{
Matrix3d AnyRotation(shapes::Random& random)
{
  return RotationFromVector(shapes::Pi * Vector3d{ random(), random(), random() });
}

/// Matrices as surfaces make them: frames that stretch, flat rings with and without their normal,
/// mirrored ones, any, and those that one by one treats only.
std::vector<Matrix3d> MatricesOfAllKinds(shapes::Random& random)
{
  const Matrix3d p = AnyRotation(random);
  const Matrix3d q = AnyRotation(random);
  std::vector<Matrix3d> matrices{ p,
    Matrix3d(AnyRotation(random) + AnyRotation(random) - AnyRotation(random)), Matrix3d::Zero(), -p,
    1e-200 * p, 1e200 * p };
  for (const Vector3d& diagonal :
    { Vector3d(1.0, 1.1, 0.9), Vector3d(1.0, 0.4, 0.6), Vector3d(1.0, 0.7, 0.0),
      Vector3d(1.0, 0.6, 1e-5), Vector3d(1.0, 0.8, -0.02), Vector3d(1.0, 0.9, -0.3),
      Vector3d(1.0, 1e-3, 1e-4), Vector3d(1.0, 0.01, -0.0099), Vector3d(1.0, 0.0, 0.0) })
  {
    matrices.emplace_back(std::exp(10.0 * random()) * p * diagonal.asDiagonal() * q);
  }
  return matrices;
}

}

TEST(ClosestRotation, OfManyIsThatOfEach)
{
  shapes::Random random(11);
  for (int trial = 0; trial < 500; ++trial)
  {
    const std::vector<Matrix3d> matrices = MatricesOfAllKinds(random);
    const auto count = static_cast<int>(matrices.size());
    cartan::Matrices rows(count, 9);
    for (int i = 0; i < count; ++i)
    {
      cartan::MatrixAt(rows, i) = matrices[i];
    }
    cartan::ProjectAllOnRotations(rows.data(), count);
    for (int i = 0; i < count; ++i)
    {
      const Matrix3d found = cartan::MatrixAt(rows, i);
      const Matrix3d r = ProjectOnRotations(matrices[i]);
      ASSERT_LT((found - r).norm(), 1e-13) << matrices[i];
      ASSERT_LT((found.transpose() * found - Matrix3d::Identity()).norm(), 1e-14) << matrices[i];
      // The neighbors make no difference.
      Matrix3d alone = matrices[i];
      cartan::ProjectAllOnRotations(alone.data(), 1);
      ASSERT_EQ(alone, found) << matrices[i];
    }
  }
}

TEST(ClosestRotation, IsWrittenWhereThereIsAMatrix)
{
  // More than a block, every third without a matrix.
  std::vector<double> angles(200, -1.0);
  cartan::ForClosestRotations(
    10, 190,
    [](int i, Eigen::Map<Matrix3d> matrix)
    {
      matrix = 2.0 * RotationFromVector(0.01 * i * Vector3d::UnitY());
      return i % 3 != 0;
    },
    [&angles](int i, const Eigen::Map<Matrix3d>& rotation)
    { angles[i] = VectorFromRotation(rotation)[1]; });
  for (int i = 0; i < 200; ++i)
  {
    EXPECT_NEAR(angles[i], i >= 10 && i < 190 && i % 3 != 0 ? 0.01 * i : -1.0, 1e-14) << i;
  }
}
