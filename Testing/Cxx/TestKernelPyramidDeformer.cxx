// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Deformation/PyramidDeformer.h"

#include "AdviceWords.h"
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using cartan::DeformedSurface;
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::InitialGuess;
using cartan::MatrixAt;
using cartan::Points;
using cartan::PyramidDeformer;
using cartan::RotationFromVector;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::Shape;

namespace
{
constexpr InitialGuess PyramidGuesses[] = { InitialGuess::RestShape, InitialGuess::PreviousResult,
  InitialGuess::RotationInvariant, InitialGuess::ShapePreserving };

HandleTargets MoveEnd(const Vector3d& turn, const Vector3d& shift)
{
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].RotationVector = turn;
  targets.Motions[0].Linear = RotationFromVector(turn);
  targets.Motions[0].Translation = shift;
  return targets;
}

Shape SmallBar()
{
  return shapes::Noisy(shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 }), 0.02, 5);
}

HandleProblem EndsOf(const Shape& shape, int axis)
{
  return shapes::ProblemOf(shape, shapes::EndsAlong(shape, axis, 0.15));
}

DeformedSurface Deformed(PyramidDeformer& deformer, const HandleTargets& targets,
  const cartan::ExecutionContext& context = {})
{
  DeformedSurface result;
  deformer.Deform(targets, true, result, context);
  return result;
}

/// E with each turn about the normal found by search: the third axis goes to the mean by
/// area of the normals of the triangles, which are summed one by one.
double EnergyBySearch(const HandleProblem& problem, const Points& x)
{
  const cartan::TriangleMesh& mesh = *problem.Mesh;
  const Points& rest = *problem.Rest;
  const auto normals = [&mesh](const Points& points)
  {
    Points sums = Points::Zero(points.rows(), 3);
    for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      const auto corners = mesh.GetTriangles().row(t);
      const Vector3d a = (points.row(corners[1]) - points.row(corners[0])).transpose();
      const Vector3d b = (points.row(corners[2]) - points.row(corners[0])).transpose();
      for (int c = 0; c < 3; ++c)
      {
        sums.row(corners[c]) += a.cross(b).transpose();
      }
    }
    return Points(sums.rowwise().normalized());
  };
  const Points before = normals(rest);
  const Points after = normals(x);
  const Eigen::VectorXd weights =
    cartan::SymmetricPart(mesh, cartan::EdgeWeights(mesh, rest, problem.PositionWeights))
      .cwiseMax(0.0);
  double energy = 0.0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const Vector3d n = after.row(v).transpose();
    const Matrix3d tilt =
      Eigen::Quaterniond::FromTwoVectors(before.row(v).transpose(), n).toRotationMatrix();
    const auto sumAt = [&](double angle)
    {
      const Matrix3d rotation = RotationFromVector(angle * n) * tilt;
      double sum = 0.0;
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        const Vector3d was = (rest.row(mesh.Neighbor(d)) - rest.row(v)).transpose();
        const Vector3d is = (x.row(mesh.Neighbor(d)) - x.row(v)).transpose();
        sum += weights[d] * (is - rotation * was).squaredNorm();
      }
      return sum;
    };
    // The sum is a + b cos(angle - c).
    const double at0 = sumAt(0.0);
    const double at90 = sumAt(0.5 * shapes::Pi);
    const double at180 = sumAt(shapes::Pi);
    const double mean = 0.5 * (at0 + at180);
    energy += sumAt(std::atan2(mean - at90, mean - at0));
  }
  return energy;
}
}

TEST(PyramidDeformer, LeavesTheRestPoseAndFollowsRigidMotions)
{
  const Shape bar = SmallBar();
  HandleProblem problem = EndsOf(bar, 2);
  problem.Moving = { 1, 2 };
  const double size = cartan::BoundingDiagonal(bar.Positions);
  for (const InitialGuess guess : PyramidGuesses)
  {
    PyramidDeformer deformer(problem, guess);
    HandleTargets targets;
    targets.Motions.resize(2);
    EXPECT_LT(
      (Deformed(deformer, targets).Positions - bar.Positions).cwiseAbs().maxCoeff(), 1e-9 * size);
    EXPECT_TRUE(deformer.HasConverged());
    const HandleMotion motion = MoveEnd({ 0.7, -0.4, 1.1 }, { 3.0, 2.0, -1.0 }).Motions[0];
    targets.Motions = { motion, motion };
    const Points expected =
      (bar.Positions * motion.Linear.transpose()).rowwise() + motion.Translation.transpose();
    EXPECT_LT(
      (Deformed(deformer, targets).Positions - expected).cwiseAbs().maxCoeff(), 1e-8 * size);
    EXPECT_EQ(deformer.GetWarning(), "");
  }
}

TEST(PyramidDeformer, NeverRaisesItsEnergyWhichIsThatOfItsDefinition)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = EndsOf(shape, 0);
  const double size = cartan::BoundingDiagonal(shape.Positions);
  const HandleTargets targets = MoveEnd({ 0.5, -0.3, 0.6 }, size * Vector3d(0.1, 0.05, -0.08));
  for (const InitialGuess guess : PyramidGuesses)
  {
    PyramidDeformer deformer(problem, guess);
    deformer.SetIteration(25, 0.0);
    const DeformedSurface result = Deformed(deformer, targets);
    const std::vector<double>& energies = deformer.GetEnergies();
    ASSERT_EQ(energies.size(), 26u);
    for (std::size_t i = 1; i < energies.size(); ++i)
    {
      EXPECT_LE(energies[i], energies[i - 1]);
    }
    EXPECT_LT(energies.back(), energies.front());
    // Rings of held points alone do not count in it, but do not change.
    const double expected = EnergyBySearch(problem, result.Positions);
    EXPECT_NEAR(deformer.GetVertexEnergies().sum(), energies.back(), 1e-12 * expected);
    EXPECT_NEAR(energies.back(), expected, 1e-9 * expected);
  }
}

TEST(PyramidDeformer, ConvergesToWhereTheSlopeVanishes)
{
  const Shape bar = SmallBar();
  const HandleProblem problem = EndsOf(bar, 2);
  PyramidDeformer deformer(problem);
  deformer.SetIteration(5000, 1e-14);
  const DeformedSurface result = Deformed(deformer, MoveEnd({ 0.6, 0.2, 0.5 }, { 0.0, -1.0, 0.2 }));
  EXPECT_TRUE(deformer.HasConverged());
  shapes::ShowFigure("iterations", deformer.GetNumberOfIterations());
  const double at = EnergyBySearch(problem, result.Positions);
  shapes::Random random(6);
  for (int trial = 0; trial < 30; ++trial)
  {
    Points direction = Points::Zero(bar.NumberOfVertices(), 3);
    for (int v = 0; v < bar.NumberOfVertices(); ++v)
    {
      if (problem.Handle[v] == 0)
      {
        direction.row(v) = Eigen::RowVector3d{ random(), random(), random() };
      }
    }
    const double h = 1e-4;
    const double ahead = EnergyBySearch(problem, result.Positions + h * direction);
    const double behind = EnergyBySearch(problem, result.Positions - h * direction);
    const double slope = (ahead - behind) / (2.0 * h);
    const double curvature = (ahead + behind - 2.0 * at) / (h * h);
    EXPECT_GT(curvature, 0.0);
    // How far along this direction the lowest point lies.
    EXPECT_LT(std::abs(slope) / curvature, 1e-5);
  }
}

TEST(PyramidDeformer, TurnsTheSurfaceAroundAHandleThatIsShifted)
{
  // A square sheet held at its border, whose middle is pulled up: the sides must tilt, which
  // no linear method of frames finds.
  const Shape plane = shapes::Plane(24, 1.0, 0.1, 3);
  HandleProblem problem = shapes::ProblemOf(plane,
    [](const Vector3d& p)
    {
      const double distance = p.head<2>().cwiseAbs().maxCoeff();
      return distance < 0.08 ? 2 : distance > 0.45 ? 1 : 0;
    });
  PyramidDeformer deformer(problem);
  const HandleTargets targets = MoveEnd(Vector3d::Zero(), { 0.0, 0.0, 0.3 });
  const auto tilts = [&](const DeformedSurface& result)
  {
    // The mean over free points of how far their planes turn from the vertical.
    double sum = 0.0;
    int count = 0;
    for (int v = 0; v < plane.NumberOfVertices(); ++v)
    {
      if (problem.Handle[v] == 0)
      {
        sum += std::acos(std::clamp(MatrixAt(result.Transforms, v)(2, 2), -1.0, 1.0));
        ++count;
      }
    }
    return sum / count;
  };
  deformer.SetIteration(0, 0.0);
  Deformed(deformer, targets);
  const double guessed = deformer.GetEnergies().back();
  deformer.SetIteration(500, 1e-6);
  const double found = tilts(Deformed(deformer, targets));
  shapes::ShowFigure("mean tilt", found);
  EXPECT_LT(deformer.GetEnergies().back(), 0.7 * guessed);
  // The slope from the border to the middle is .3 / .37, 39 degrees, in the middle of each side.
  EXPECT_GT(found, 0.3);
}

TEST(PyramidDeformer, DoesNotDependOnOrderUnitOrThreads)
{
  const Shape bar = SmallBar();
  const HandleTargets targets = MoveEnd({ 0.6, 0.2, 0.5 }, { 0.0, -1.0, 0.2 });
  PyramidDeformer deformer(EndsOf(bar, 2));
  const Points expected = Deformed(deformer, targets).Positions;
  PyramidDeformer threaded(EndsOf(bar, 2));
  EXPECT_EQ(Deformed(threaded, targets, shapes::ManyThreads(4)).Positions, expected);
  Shape reversed = bar;
  reversed.Positions = bar.Positions.colwise().reverse();
  reversed.Faces = (bar.NumberOfVertices() - 1 - bar.Faces.array()).matrix();
  PyramidDeformer other(EndsOf(reversed, 2));
  EXPECT_LT(
    (Deformed(other, targets).Positions.colwise().reverse() - expected).cwiseAbs().maxCoeff(),
    1e-6);
  Shape small = bar;
  small.Positions *= 1e-6;
  HandleTargets scaled = targets;
  scaled.Motions[0].Translation *= 1e-6;
  PyramidDeformer tiny(EndsOf(small, 2));
  EXPECT_LT((1e6 * Deformed(tiny, scaled).Positions - expected).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(deformer.GetNumberOfFactorizations(), 1);
}

TEST(PyramidDeformer, SaysThatItHasNotSettledAndWhatItRefuses)
{
  const Shape bar = SmallBar();
  HandleProblem problem = EndsOf(bar, 2);
  const HandleTargets targets = MoveEnd({ 0.6, 0.2, 0.5 }, { 0.0, -1.0, 0.2 });
  PyramidDeformer deformer(problem, InitialGuess::RestShape);
  deformer.SetIteration(2, 1e-4);
  Deformed(deformer, targets);
  EXPECT_NE(
    deformer.GetWarning().find("has not settled: the last of 2 iterations"), std::string::npos);
  EXPECT_NE(
    deformer.GetWarning().find(shapes::Advice("Raise MaximumIterations.")), std::string::npos);
  deformer.SetIteration(1000, 1e-4);
  Deformed(deformer, targets);
  EXPECT_EQ(deformer.GetWarning(), "");
  problem.ConstrainPositions = false;
  EXPECT_THROW(PyramidDeformer{ problem }, cartan::Error);
}

TEST(PyramidDeformer, HardensFromSoftHandles)
{
  const Shape bar = SmallBar();
  HandleProblem problem = EndsOf(bar, 2);
  const HandleTargets targets = MoveEnd({ 0.4, 0.0, 0.3 }, { 0.0, -0.5, 0.2 });
  PyramidDeformer hard(problem);
  hard.SetIteration(1000, 1e-10);
  const Points expected = Deformed(hard, targets).Positions;
  double before = 1e30;
  for (const double weight : { 3.0, 30.0, 300.0 })
  {
    problem.SoftWeights = Eigen::VectorXd::Constant(bar.NumberOfVertices(), weight);
    PyramidDeformer soft(problem);
    soft.SetIteration(2000, 1e-10);
    const double distance =
      (Deformed(soft, targets).Positions - expected).rowwise().norm().maxCoeff();
    EXPECT_LT(distance, 0.2 * before);
    before = distance;
  }
}
