// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/Rotation.h"

#include "Kernel/Algebra/ClosestRotation.h"
#include "TestShapes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

using cartan::ProjectOnRotations;
using cartan::RotationFromVector;
using cartan::VectorFromRotation;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace
{
Matrix3d RandomMatrix(shapes::Random& random)
{
  Matrix3d matrix;
  for (int i = 0; i < 9; ++i)
  {
    matrix(i) = random();
  }
  return matrix;
}

Matrix3d RandomRotation(shapes::Random& random)
{
  return Eigen::Quaterniond{ random(), random(), random(), random() }
    .normalized()
    .toRotationMatrix();
}

/// The largest trace(R^T A) over all rotations, as the largest eigenvalue of
/// Davenport's 4 x 4 matrix: no singular values, no determinant, valid for all
/// signs and ranks. |A - R|^2 = |A|^2 + 3 - 2 trace(R^T A).
double LargestTrace(const Matrix3d& a)
{
  Eigen::Matrix4d k;
  const Vector3d z(a(2, 1) - a(1, 2), a(0, 2) - a(2, 0), a(1, 0) - a(0, 1));
  k.topLeftCorner<3, 3>() = a + a.transpose() - a.trace() * Matrix3d::Identity();
  k.topRightCorner<3, 1>() = z;
  k.bottomLeftCorner<1, 3>() = z.transpose();
  k(3, 3) = a.trace();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(k).eigenvalues().maxCoeff();
}

void ExpectClosestRotation(const Matrix3d& a)
{
  const Matrix3d r = ProjectOnRotations(a);
  EXPECT_LT((r.transpose() * r - Matrix3d::Identity()).norm(), 1e-13) << a;
  EXPECT_NEAR(r.determinant(), 1.0, 1e-13) << a;
  EXPECT_NEAR((r.transpose() * a).trace(), LargestTrace(a), 1e-13 * (1e-300 + a.norm())) << a;
}
}

TEST(ClosestRotation, AgreesWithTheQuaternionMethodForAllSignsAndRanks)
{
  shapes::Random random(1);
  int reflections = 0;
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Matrix3d a = RandomMatrix(random);
    reflections += a.determinant() < 0.0;
    ExpectClosestRotation(a);
    // Rank two, one, and nearly so.
    const Vector3d u(a.col(0));
    const Vector3d v(a.col(1));
    ExpectClosestRotation(u * v.transpose() + v * a.row(2));
    ExpectClosestRotation(u * v.transpose());
    ExpectClosestRotation(u * v.transpose() + 1e-9 * a);
    ExpectClosestRotation(u * v.transpose() + v * a.row(2) - 1e-5 * a);
  }
  EXPECT_GT(reflections, 500);
}

TEST(ClosestRotation, FromAGuessIsTheSame)
{
  // A near guess, a rotation that has nothing to do with A, and the worst one:
  // half a turn away.
  shapes::Random random(9);
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Matrix3d a = RandomMatrix(random);
    const Vector3d u(a.col(0));
    const Vector3d v(a.col(1));
    const Matrix3d rankTwo = u * v.transpose() + v * a.row(2);
    for (const Matrix3d& matrix : { a, rankTwo, Matrix3d(rankTwo - 1e-5 * a),
           Matrix3d(u * v.transpose()), Matrix3d(1e-9 * a), RandomRotation(random) })
    {
      const Matrix3d closest = ProjectOnRotations(matrix);
      for (const Matrix3d& guess :
        { closest, Matrix3d(closest * RotationFromVector(0.01 * Vector3d(random(), 1, 1))),
          RandomRotation(random),
          Matrix3d(closest * RotationFromVector(Vector3d(shapes::Pi, 0, 0))),
          Matrix3d(closest * RotationFromVector(Vector3d(0, 0, shapes::Pi))) })
      {
        const Matrix3d r = ProjectOnRotations(matrix, guess);
        ASSERT_LT((r.transpose() * r - Matrix3d::Identity()).norm(), 1e-13);
        ASSERT_NEAR(r.determinant(), 1.0, 1e-13);
        ASSERT_NEAR((r.transpose() * matrix).trace(), LargestTrace(matrix), 1e-13 * matrix.norm())
          << matrix << "\nguess\n"
          << guess;
      }
    }
  }
}

TEST(ClosestRotation, IsABetterFitThanItsNeighbors)
{
  shapes::Random random(2);
  for (int trial = 0; trial < 300; ++trial)
  {
    const Matrix3d a = RandomMatrix(random);
    const Matrix3d r = ProjectOnRotations(a);
    for (int neighbor = 0; neighbor < 10; ++neighbor)
    {
      const Vector3d step = 1e-3 * Vector3d{ random(), random(), random() };
      EXPECT_LE((a - r).norm(), (a - r * RotationFromVector(step)).norm() + 1e-15);
    }
  }
}

TEST(ClosestRotation, OfARotationIsItself)
{
  shapes::Random random(3);
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Matrix3d r = RandomRotation(random);
    EXPECT_LT((ProjectOnRotations(r) - r).norm(), 3e-15);
    const Matrix3d halfTurn =
      RotationFromVector(shapes::Pi * Vector3d{ random(), random(), random() }.normalized());
    EXPECT_LT((ProjectOnRotations(halfTurn) - halfTurn).norm(), 3e-15);
  }
  EXPECT_LT((ProjectOnRotations(Matrix3d::Identity()) - Matrix3d::Identity()).norm(), 1e-16);
}

TEST(ClosestRotation, IsTheRotationTimesAStretch)
{
  // A = R S with S symmetric and positive definite has R as its rotation.
  shapes::Random random(4);
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Matrix3d r = RandomRotation(random);
    const Matrix3d q = RandomRotation(random);
    const Vector3d stretch = Vector3d{ 1.1 + random(), 1.1 + random(), 1.1 + random() };
    const Matrix3d a = r * q * stretch.asDiagonal() * q.transpose();
    EXPECT_LT((ProjectOnRotations(a) - r).norm(), 1e-13);
    // Turning A turns the result.
    EXPECT_LT((ProjectOnRotations(q * a) - q * r).norm(), 1e-13);
  }
}

TEST(ClosestRotation, FlipsTheSmallestStretchOfAReflection)
{
  const Matrix3d a = Vector3d(3.0, 2.0, -0.5).asDiagonal();
  EXPECT_LT((ProjectOnRotations(a) - Matrix3d::Identity()).norm(), 1e-15);
  const Matrix3d b = Vector3d(-0.5, 3.0, 2.0).asDiagonal();
  EXPECT_LT((ProjectOnRotations(b) - Matrix3d::Identity()).norm(), 1e-15);
  ExpectClosestRotation(-Matrix3d::Identity());
}

TEST(ClosestRotation, OfRankTwoIsDeterminedAndOfRankOneStillARotation)
{
  shapes::Random random(5);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Matrix3d r = RandomRotation(random);
    const Matrix3d rankTwo = r * Vector3d(2.0, 0.7, 0.0).asDiagonal();
    EXPECT_LT((ProjectOnRotations(rankTwo) - r).norm(), 1e-13);
    const Matrix3d rankOne = r * Vector3d(2.0, 0.0, 0.0).asDiagonal();
    EXPECT_LT((ProjectOnRotations(rankOne).col(0) - r.col(0)).norm(), 1e-13);
    ExpectClosestRotation(rankOne);
  }
  EXPECT_EQ(ProjectOnRotations(Matrix3d::Zero()), Matrix3d::Identity());
}

TEST(ClosestRotation, DoesNotDependOnTheUnit)
{
  shapes::Random random(6);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Matrix3d a = RandomMatrix(random);
    if (std::abs(a.determinant()) < 0.02) // nearly ambiguous ones lose digits
    {
      continue;
    }
    for (const double unit : { 1e-100, 1e-18, 1e-9, 1e6, 1e100 })
    {
      EXPECT_LT((ProjectOnRotations(unit * a) - ProjectOnRotations(a)).norm(), 1e-12) << unit;
    }
  }
}

TEST(ClosestRotation, OfABlendOfRotationsAboutOneAxisTurnsByTheBlendsAngle)
{
  for (const double angle : { 0.1, 1.0, 2.0, 3.0, 3.1415 })
  {
    const Matrix3d blend =
      0.5 * (Matrix3d::Identity() + RotationFromVector(angle * Vector3d::UnitY()));
    const Matrix3d half = RotationFromVector(0.5 * angle * Vector3d::UnitY());
    EXPECT_LT((ProjectOnRotations(blend) - half).norm(), 1e-11) << angle;
  }
}

TEST(ClosestRotation, IsTheSameFromAnyGuess)
{
  shapes::Random random(9);
  double worst = 0.0;
  const auto expectClosest = [&](const Matrix3d& a, const Matrix3d& guess)
  {
    const Matrix3d r = ProjectOnRotations(a, guess);
    EXPECT_LT((r.transpose() * r - Matrix3d::Identity()).norm(), 1e-14) << a;
    EXPECT_NEAR(r.determinant(), 1.0, 1e-14) << a;
    EXPECT_NEAR((r.transpose() * a).trace(), LargestTrace(a), 1e-14 * (1e-300 + 10.0 * a.norm()))
      << a;
    // The gradient sees an error of the rotation to first order.
    const Matrix3d m = r.transpose() * a;
    worst = std::max(worst, (m - m.transpose()).norm() / (1e-300 + a.norm()));
  };
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Matrix3d a = RandomMatrix(random);
    const Matrix3d far = RandomRotation(random);
    const Vector3d turn = Vector3d{ random(), random(), random() };
    const Matrix3d flat = a.col(0) * a.row(0) + a.col(1) * a.row(1);
    const Matrix3d line = a.col(0) * a.row(0);
    for (const Matrix3d& matrix :
      { a, flat, line, Matrix3d(flat + 1e-5 * far), Matrix3d(line + 1e-9 * flat) })
    {
      for (const double unit : { 1.0, 1e-60, 1e60 })
      {
        expectClosest(unit * matrix, far);
        expectClosest(unit * matrix, Matrix3d::Identity());
        for (const double size : { 1.0, 0.1, 1e-3, 1e-6, 1e-12, 0.0 })
        {
          expectClosest(
            unit * matrix, ProjectOnRotations(matrix) * RotationFromVector(size * turn));
        }
      }
    }
  }
  EXPECT_LT(worst, 2e-15);
  EXPECT_EQ(ProjectOnRotations(Matrix3d::Zero(), Matrix3d::Identity()), Matrix3d::Identity());
  // The worst of guesses: by half a turn, where the gradient vanishes too.
  const Matrix3d halfTurn = Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  EXPECT_EQ(ProjectOnRotations(Matrix3d::Identity(), halfTurn), Matrix3d::Identity());
}

TEST(ClosestRotation, DoesNotDriftOffTheRotations)
{
  shapes::Random random(10);
  Matrix3d rotation = Matrix3d::Identity();
  for (int step = 0; step < 100000; ++step)
  {
    const Matrix3d next =
      rotation * RotationFromVector(0.01 * Vector3d{ random(), random(), random() });
    rotation = ProjectOnRotations(next * Vector3d(2.0, 1.0, 1e-7).asDiagonal(), rotation);
  }
  EXPECT_LT((rotation.transpose() * rotation - Matrix3d::Identity()).norm(), 1e-15);
}

//------------------------------------------------------------------------------
TEST(RotationVector, AndBackForAllAngles)
{
  shapes::Random random(7);
  for (const double angle : { 0.0, 1e-300, 1e-20, 1e-12, 1e-9, 1e-6, 1e-3, 0.5, 1.0, 2.0, 3.0,
         shapes::Pi - 1e-3, shapes::Pi - 1e-6, shapes::Pi - 1e-9, shapes::Pi - 1e-12 })
  {
    for (int trial = 0; trial < 100; ++trial)
    {
      const Vector3d vector = angle * Vector3d{ random(), random(), random() }.normalized();
      const Matrix3d rotation = RotationFromVector(vector);
      EXPECT_LT((rotation.transpose() * rotation - Matrix3d::Identity()).norm(), 1e-14);
      EXPECT_LT((VectorFromRotation(rotation) - vector).norm(), 2e-15) << angle;
    }
  }
}

TEST(RotationVector, OfHalfATurnIsOneOfTheTwoAxes)
{
  shapes::Random random(8);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Vector3d axis = Vector3d{ random(), random(), random() }.normalized();
    const Vector3d vector = VectorFromRotation(RotationFromVector(shapes::Pi * axis));
    EXPECT_NEAR(vector.norm(), shapes::Pi, 1e-14);
    EXPECT_NEAR(std::abs(vector.dot(axis)), shapes::Pi, 1e-14);
  }
  for (int k = 0; k < 3; ++k)
  {
    Matrix3d exact = -Matrix3d::Identity();
    exact(k, k) = 1.0;
    const Vector3d vector = VectorFromRotation(exact);
    EXPECT_NEAR(std::abs(vector[k]), shapes::Pi, 1e-15);
    EXPECT_NEAR(vector.norm(), shapes::Pi, 1e-15);
  }
  EXPECT_EQ(VectorFromRotation(Matrix3d::Identity()), Vector3d::Zero());
}

TEST(RotationVector, TurnsByTheRightHandRule)
{
  const Matrix3d quarter = RotationFromVector(Vector3d(0, 0, shapes::Pi / 2));
  EXPECT_LT((quarter * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
  // The axis stays, and the turn is by <axis> x.
  const Vector3d axis = Vector3d(1, 2, -2) / 3.0;
  const Matrix3d small = RotationFromVector(1e-8 * axis);
  const Vector3d x(0.3, -1.0, 2.0);
  EXPECT_LT((small * x - x - 1e-8 * axis.cross(x)).norm(), 1e-15);
}

TEST(RotationVector, MayExceedALap)
{
  const Vector3d axis = Vector3d(2, -1, 2) / 3.0;
  for (const double angle : { 0.3, 2.0, -1.0 })
  {
    EXPECT_LT(
      (RotationFromVector((angle + 6 * shapes::Pi) * axis) - RotationFromVector(angle * axis))
        .norm(),
      1e-14);
  }
}

//------------------------------------------------------------------------------
TEST(ClosestRotation, IsOneWhereRoundingMovesItByAsLittle)
{
  shapes::Random random(3);
  const Matrix3d left = RandomRotation(random);
  const Matrix3d right = RandomRotation(random);
  const auto made = [&](const Vector3d& diagonal) -> Matrix3d
  { return left * diagonal.asDiagonal() * right; };
  const auto moves = [&](const Matrix3d& a)
  {
    double largest = 0.0;
    for (int i = 0; i < 10; ++i)
    {
      const Matrix3d other = a + 1e-14 * RandomMatrix(random);
      largest = std::max(largest, (ProjectOnRotations(other) - ProjectOnRotations(a)).norm());
    }
    return largest;
  };
  for (const Vector3d& diagonal : { Vector3d(1, 1, 1), Vector3d(2, 1, 0.1), Vector3d(1, 1e-6, 0),
         Vector3d(1, 0.5, -0.4), Vector3d(1, 1, -0.999) })
  {
    EXPECT_TRUE(cartan::HasClosestRotation(made(diagonal))) << diagonal.transpose();
    EXPECT_EQ(cartan::ClosestRotationOrNone(made(diagonal)), ProjectOnRotations(made(diagonal)));
    EXPECT_EQ(cartan::ClosestRotationOrNone(1e-12 * made(diagonal)), Matrix3d::Identity());
    EXPECT_LT(moves(made(diagonal)), 1e-6) << diagonal.transpose();
  }
  for (const Vector3d& diagonal :
    { Vector3d(-1, -1, -1), Vector3d(1, 0.5, -0.5), Vector3d(1, 0, 0), Vector3d(0, 0, 0) })
  {
    EXPECT_FALSE(cartan::HasClosestRotation(made(diagonal))) << diagonal.transpose();
    EXPECT_EQ(cartan::ClosestRotationOrNone(made(diagonal)), Matrix3d::Identity());
    EXPECT_GT(moves(made(diagonal)), 0.1) << diagonal.transpose();
  }
}

//------------------------------------------------------------------------------
TEST(SharedAxis, IsThatOfTheLongestRotationVector)
{
  const Vector3d axis = Vector3d(2, -1, 2) / 3.0;
  Vector3d found;
  EXPECT_TRUE(cartan::FindSharedAxis({ 0.1 * axis, -7.0 * axis, Vector3d::Zero() }, found));
  EXPECT_LT((found + axis).norm(), 1e-15);
  EXPECT_TRUE(cartan::FindSharedAxis({}, found));
  EXPECT_EQ(found, Vector3d::UnitX());
  EXPECT_TRUE(cartan::FindSharedAxis({ Vector3d::Zero(), Vector3d::Zero() }, found));
  EXPECT_EQ(found, Vector3d::UnitX());
}

/// Of all rotations that take a line to a line, by trying them.
TEST(ClosestRotation, IsNearestToTheGuessWhereSeveralAreEquallyClose)
{
  shapes::Random random(7);
  for (int i = 0; i < 50; ++i)
  {
    const Matrix3d guess = RandomRotation(random);
    const Vector3d u = RandomRotation(random).col(0);
    const Vector3d v = RandomRotation(random).col(0);
    const Vector3d side = u.unitOrthogonal();
    const Vector3d other = v.unitOrthogonal();
    Matrix3d a = 2.0 * u * v.transpose(); // of a line
    if (i % 2 == 1)                       // or inside out
    {
      a += side * other.transpose() - u.cross(side) * v.cross(other).transpose();
    }
    const Matrix3d found = cartan::ClosestRotationNear(a, guess);
    EXPECT_LT((found.transpose() * found - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR((found.transpose() * a).trace(), LargestTrace(a), 1e-9);
    const double agreement = (found.transpose() * guess).trace();
    for (int k = 0; k < 36; ++k)
    {
      const Matrix3d turned = RotationFromVector(shapes::Pi / 18.0 * k * u) * found;
      EXPECT_LT((turned.transpose() * guess).trace(), agreement + 1e-9) << i << " " << k;
    }
  }
  const Matrix3d guess = RandomRotation(random);
  EXPECT_EQ(cartan::ClosestRotationNear(Matrix3d::Zero(), guess), guess);
}

TEST(SharedAxis, IsNoneWhereDirectionsDifferByMoreThanAMicroradian)
{
  const Vector3d axis = Vector3d::UnitZ();
  Vector3d found;
  for (const double angle : { 1e-9, 1.0, 10.0 })
  {
    EXPECT_TRUE(cartan::FindSharedAxis({ 20.0 * axis, angle * Vector3d(5e-7, 0, 1) }, found));
    EXPECT_FALSE(cartan::FindSharedAxis({ 20.0 * axis, angle * Vector3d(5e-6, 0, 1) }, found));
    EXPECT_FALSE(cartan::FindSharedAxis({ angle * axis, angle * Vector3d::UnitX() }, found));
  }
}
