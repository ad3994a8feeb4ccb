// SPDX-License-Identifier: BSD-3-Clause
#include "Ids.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/HandleLaplacian.h"
#include "Kernel/Measure/ShapeDistance.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

using namespace cartan;

namespace
{
/// A shape with the handles that `handleOf` gives its vertices.
HandleProblem ProblemOf(const shapes::Shape& shape, std::vector<int> moving,
  const std::function<int(const Eigen::Vector3d&)>& handleOf)
{
  HandleProblem problem;
  problem.Mesh = std::make_shared<TriangleMesh>(shapes::MakeMesh(shape));
  problem.Rest = std::make_shared<Points>(shape.Positions);
  problem.Moving = std::move(moving);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    problem.Handle.push_back(handleOf(shape.Positions.row(v)));
  }
  return problem;
}

/// A bar along z from 0 to 5, pinned below .8 and held by handle 2 above 4.2.
HandleProblem BarProblem(std::vector<int> moving = { 2 })
{
  return ProblemOf(shapes::Bar(4, 4, 25, { 1.0, 1.0, 5.0 }), std::move(moving),
    [](const Eigen::Vector3d& p) { return p[2] < 0.81 ? 1 : (p[2] > 4.19 ? 2 : 0); });
}

HandleMotion Turn(const Eigen::Vector3d& rotationVector)
{
  HandleMotion motion;
  motion.RotationVector = rotationVector;
  motion.Linear = RotationFromVector(rotationVector);
  return motion;
}

HandleTargets Turns(const std::vector<Eigen::Vector3d>& rotationVectors)
{
  HandleTargets targets;
  for (const Eigen::Vector3d& rotation : rotationVectors)
  {
    targets.Motions.push_back(Turn(rotation));
  }
  return targets;
}

DeformedSurface Deform(SurfaceDeformer& deformer, const HandleTargets& targets)
{
  DeformedSurface result;
  deformer.Deform(targets, true, result, {});
  return result;
}

/// The plane of Figs. 4, 7 and 10: a circle of handle points in the middle, each
/// of which turns about the tangent of the circle; the boundary is pinned.
struct CircleOnPlane
{
  explicit CircleOnPlane(int count, double jitter = 0.0)
    : Shape(shapes::Plane(count, 2.0, jitter))
    , Problem(ProblemOf(this->Shape, { 2 },
        [count](const Eigen::Vector3d& p)
        {
          const bool isBoundary = p.head<2>().cwiseAbs().maxCoeff() > 1.0 - 1e-9;
          const bool isCircle = std::abs(p.head<2>().norm() - 0.4) < 1.5 / count;
          return isBoundary ? 1 : (isCircle ? 2 : 0);
        }))
  {
  }

  HandleTargets Targets(double angle) const
  {
    HandleTargets targets;
    targets.Motions.resize(1);
    targets.Vertices = shapes::Ids(this->Shape.NumberOfVertices());
    targets.Positions = this->Shape.Positions;
    targets.RotationVectors = Points::Zero(this->Shape.NumberOfVertices(), 3);
    targets.Transforms.resize(this->Shape.NumberOfVertices(), 9);
    for (int v = 0; v < this->Shape.NumberOfVertices(); ++v)
    {
      if (this->Problem.Handle[v] == 2)
      {
        const Eigen::RowVector3d p = this->Shape.Positions.row(v);
        targets.RotationVectors.row(v) = angle * Eigen::RowVector3d(-p[1], p[0], 0.0).normalized();
      }
      MatrixAt(targets.Transforms, v) =
        RotationFromVector(targets.RotationVectors.row(v).transpose());
    }
    return targets;
  }

  shapes::Shape Shape;
  HandleProblem Problem;
};

/// The rotation of conformal coordinates, by the stereographic projection of the
/// unit quaternions (App. D), not by the angle.
Eigen::Quaterniond QuaternionOf(const Eigen::Vector3d& eta)
{
  const double denominator = 4.0 + eta.squaredNorm();
  const Eigen::Vector3d vector = 4.0 * eta / denominator;
  return Eigen::Quaterniond(
    (4.0 - eta.squaredNorm()) / denominator, vector[0], vector[1], vector[2]);
}

/// Back, for rotations of at most half a turn.
Eigen::Vector3d EtaOf(const Eigen::Matrix3d& rotation)
{
  Eigen::Quaterniond q(rotation);
  q.coeffs() *= (q.w() < 0.0 ? -1.0 : 1.0) / q.norm();
  return 4.0 * q.vec() / (2.0 + 2.0 * q.w());
}

/// 2 tan(angle / 4) times the axis.
Eigen::Vector3d EtaOfVector(const Eigen::Vector3d& rotationVector)
{
  const double angle = rotationVector.norm();
  return angle > 0.0 ? Eigen::Vector3d(2.0 * std::tan(angle / 4.0) / angle * rotationVector)
                     : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// E of Eq. 7 with half cotangents, from conformal coordinates of all vertices.
double ConformalEnergy(const TriangleMesh& mesh, const Points& rest, const Points& eta)
{
  const Points weights = CornerWeights(mesh, rest, LaplacianWeights::Cotangent);
  double energy = 0.0;
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    double w = 0.0;
    double q = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      const int apex = mesh.GetTriangles()(t, c);
      const int a = mesh.GetTriangles()(t, (c + 1) % 3);
      const int b = mesh.GetTriangles()(t, (c + 2) % 3);
      w += 1.0 / std::pow(4.0 + eta.row(apex).squaredNorm(), 2);
      q += weights(t, c) * (eta.row(a) - eta.row(b)).squaredNorm();
    }
    energy += w * q;
  }
  return energy;
}

Points EtasOf(const Matrices& transforms)
{
  Points etas(transforms.rows(), 3);
  for (Eigen::Index v = 0; v < transforms.rows(); ++v)
  {
    etas.row(v) = EtaOf(MatrixAt(transforms, v)).transpose();
  }
  return etas;
}

/// The largest derivative of `energy` by a coordinate of the vertices in `free`,
/// by central differences.
double LargestDerivative(
  const std::function<double(const Points&)>& energy, Points eta, const std::vector<int>& free)
{
  double largest = 0.0;
  for (const int v : free)
  {
    for (int c = 0; c < 3; ++c)
    {
      const double step = 1e-4;
      const double at = eta(v, c);
      eta(v, c) = at + step;
      const double above = energy(eta);
      eta(v, c) = at - step;
      const double below = energy(eta);
      eta(v, c) = at;
      largest = std::max(largest, std::abs(above - below) / (2.0 * step));
    }
  }
  return largest;
}

double Distance(const HandleProblem& problem, const DeformedSurface& result)
{
  return ShapeDistanceOfRotations(*problem.Mesh, *problem.Rest, result.Transforms).Total;
}
}

TEST(ConformalCoordinates, AreTwiceTheTangentOfAQuarterOfTheAngle)
{
  shapes::Random random(3);
  for (int i = 0; i < 50; ++i)
  {
    const Eigen::Vector3d axis = Eigen::Vector3d{ random(), random(), random() }.normalized();
    const double angle = 0.999 * shapes::Pi * random();
    const Eigen::Vector3d eta = EtaOfVector(angle * axis);
    EXPECT_NEAR(
      (QuaternionOf(eta).toRotationMatrix() - RotationFromVector(angle * axis)).norm(), 0.0, 1e-14);
    EXPECT_NEAR((EtaOf(RotationFromVector(angle * axis)) - eta).norm(), 0.0, 1e-12);
  }
}

TEST(ConformalCoordinates, MeasureRotationsUpToAFactorThatDependsOnTheLength)
{
  // Half the squared Frobenius norm of dR is 64 / (4 + |eta|^2)^2 |d eta|^2,
  // which is Eq. 5, in every direction.
  shapes::Random random(4);
  for (int i = 0; i < 50; ++i)
  {
    const Eigen::Vector3d eta = 3.0 * Eigen::Vector3d{ random(), random(), random() };
    const Eigen::Vector3d direction = Eigen::Vector3d{ random(), random(), random() };
    const double step = 1e-5;
    const double change = (QuaternionOf(eta + step * direction).toRotationMatrix() -
                            QuaternionOf(eta - step * direction).toRotationMatrix())
                            .squaredNorm() /
      (4.0 * step * step);
    const double expected = 64.0 / std::pow(4.0 + eta.squaredNorm(), 2) * direction.squaredNorm();
    EXPECT_NEAR(0.5 * change, expected, 1e-8 * expected);
  }
}

/// Both ends moving, and a pinned point (handle 3) amid handle 1 that no free one
/// sees: seen from one of two handles, the other has one axis.
HandleProblem EndsWithAPinnedPoint()
{
  HandleProblem problem = BarProblem({ 1, 2 });
  const TriangleMesh& mesh = *problem.Mesh;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    bool isAmid = problem.Handle[v] == 1;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      isAmid = isAmid && problem.Handle[mesh.Neighbor(d)] == 1;
    }
    if (isAmid)
    {
      problem.Handle[v] = 3;
      break;
    }
  }
  return problem;
}

TEST(ShapePreservingDeformer, SpreadsConformalCoordinatesHarmonicallyInOneIterate)
{
  const HandleProblem problem = EndsWithAPinnedPoint();
  ShapePreservingDeformer deformer(problem);
  const Eigen::Vector3d first(0.3, -1.9, 0.4);
  const Eigen::Vector3d second(2.0, 2.5, -1.0);
  const DeformedSurface result = Deform(deformer, Turns({ first, second }));
  EXPECT_FALSE(deformer.HasSharedAxis());
  EXPECT_EQ(deformer.GetNumberOfIterations(), 1);

  // The harmonic functions from a solver of their own.
  const TriangleMesh& mesh = *problem.Mesh;
  ConstrainedSolver solver;
  std::vector<char> isFixed;
  Field values = Field::Zero(mesh.NumberOfVertices(), 3);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    isFixed.push_back(problem.Handle[v] > 0);
    if (problem.Handle[v] == 1 || problem.Handle[v] == 2)
    {
      values.row(v) = EtaOfVector(problem.Handle[v] == 1 ? first : second).transpose();
    }
  }
  solver.Factorize(
    Laplacian(mesh, EdgeWeights(mesh, *problem.Rest, LaplacianWeights::Cotangent)), isFixed);
  solver.Solve(Field::Zero(values.rows(), 3), values);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    EXPECT_LT(
      (MatrixAt(result.Transforms, v) - QuaternionOf(values.row(v).transpose()).toRotationMatrix())
        .norm(),
      1e-12);
  }
}

TEST(ShapePreservingDeformer, SpreadsAnAngleAboutASharedAxisHarmonically)
{
  const HandleProblem problem = BarProblem({ 1, 2 });
  ShapePreservingDeformer deformer(problem);
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  // Vectors of opposite directions share the axis, too.
  const DeformedSurface result = Deform(deformer, Turns({ -0.5 * axis, 1.7 * axis }));
  EXPECT_TRUE(deformer.HasSharedAxis());
  EXPECT_EQ(deformer.GetNumberOfIterations(), 0);
  EXPECT_TRUE(deformer.HasConverged());

  const TriangleMesh& mesh = *problem.Mesh;
  Field angle(mesh.NumberOfVertices(), 1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d rotation = VectorFromRotation(MatrixAt(result.Transforms, v));
    EXPECT_LT(rotation.cross(axis).norm(), 1e-12);
    angle(v, 0) = rotation.dot(axis);
  }
  const Field residual =
    Laplacian(mesh, EdgeWeights(mesh, *problem.Rest, LaplacianWeights::Cotangent)) * angle;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (problem.Handle[v] == 0)
    {
      EXPECT_NEAR(residual(v, 0), 0.0, 1e-11);
    }
  }
}

TEST(ShapePreservingDeformer, TakesASharedAxisForWhatItIsUpToRounding)
{
  const HandleProblem problem = EndsWithAPinnedPoint();
  ShapePreservingDeformer deformer(problem);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  Deform(deformer, Turns({ x, Eigen::Vector3d(2.0, 1e-7, 0.0) }));
  EXPECT_TRUE(deformer.HasSharedAxis());
  Deform(deformer, Turns({ x, Eigen::Vector3d(2.0, 1e-4, 0.0) }));
  EXPECT_FALSE(deformer.HasSharedAxis());
  Deform(deformer, Turns({ Eigen::Vector3d::Zero(), Eigen::Vector3d(2.0, 1e-4, 0.0) }));
  EXPECT_TRUE(deformer.HasSharedAxis());
  Deform(deformer, Turns({ Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero() }));
  EXPECT_TRUE(deformer.HasSharedAxis());
}

TEST(ShapePreservingDeformer, ConformalAndAngularPathAgreeWhereAxesAllButAgree)
{
  // Not the same field, but the same at both ends and close to it between.
  const HandleProblem problem = EndsWithAPinnedPoint();
  ShapePreservingDeformer deformer(problem);
  deformer.SetIteration(100, 1e-10);
  const Eigen::Vector3d tilted(2.0, 1e-4, 0.0);
  const DeformedSurface conformal =
    Deform(deformer, Turns({ Eigen::Vector3d(-1.0, 0, 0), tilted }));
  ASSERT_FALSE(deformer.HasSharedAxis());
  ASSERT_TRUE(deformer.HasConverged());
  const DeformedSurface angular =
    Deform(deformer, Turns({ Eigen::Vector3d(-1.0, 0, 0), Eigen::Vector3d(2.0, 0, 0) }));
  ASSERT_TRUE(deformer.HasSharedAxis());
  EXPECT_LT((conformal.Transforms - angular.Transforms).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(ShapePreservingDeformer, MakesTheAngleLinearInTheHandlesAngle)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer deformer(problem);
  const Eigen::Vector3d axis = Eigen::Vector3d(0.2, -0.4, 1.0).normalized();
  const double angle = 2.0 * shapes::Pi / 3.0;
  const DeformedSurface once = Deform(deformer, Turns({ angle * axis }));
  const DeformedSurface fourTimes = Deform(deformer, Turns({ 4.0 * angle * axis }));
  double largest = 0.0;
  for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d rotation = VectorFromRotation(MatrixAt(once.Transforms, v));
    largest = std::max(
      largest, (RotationFromVector(4.0 * rotation) - MatrixAt(fourTimes.Transforms, v)).norm());
  }
  EXPECT_LT(largest, 1e-10);
  EXPECT_EQ(deformer.GetNumberOfFactorizations(), 1);
}

TEST(ShapePreservingDeformer, WindsTheSurfaceByTheLapsOfTheHandle)
{
  // The polar angle about the bar's axis, followed along a line from one end to
  // the other.
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer deformer(problem);
  std::vector<int> line;
  for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
  {
    const auto p = problem.Rest->row(v);
    if (p[0] == 0.5 && p[1] == 0.5)
    {
      line.push_back(v);
    }
  }
  std::sort(line.begin(), line.end(),
    [&](int a, int b) { return (*problem.Rest)(a, 2) < (*problem.Rest)(b, 2); });
  ASSERT_EQ(line.size(), 26u);
  for (const double degrees : { 120.0, 480.0, -480.0 })
  {
    const double angle = degrees * shapes::Pi / 180.0;
    const DeformedSurface result = Deform(deformer, Turns({ angle * Eigen::Vector3d::UnitZ() }));
    double wound = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i)
    {
      const Eigen::RowVector2d a = result.Positions.row(line[i - 1]).head<2>();
      const Eigen::RowVector2d b = result.Positions.row(line[i]).head<2>();
      wound += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
    }
    EXPECT_NEAR(wound, angle, 1e-9) << degrees;
  }
}

TEST(ShapePreservingDeformer, MovesRigidlyWithHandlesThatDo)
{
  for (const bool sharedAxis : { true, false })
  {
    const HandleProblem problem = BarProblem({ 1, 2 });
    ShapePreservingDeformer deformer(problem);
    deformer.SetIteration(sharedAxis ? 1 : 5, 1e-6);
    const shapes::RigidMotion motion = shapes::RandomRigidMotion(11, 20.0);
    HandleTargets targets;
    targets.Motions.assign(2, Turn(VectorFromRotation(motion.Rotation)));
    for (HandleMotion& one : targets.Motions)
    {
      one.Translation = motion.Translation;
    }
    if (!sharedAxis)
    {
      // All but the same rotation, with an axis of its own.
      Eigen::Vector3d& vector = targets.Motions[0].RotationVector;
      vector += 1e-5 * vector.norm() * vector.unitOrthogonal();
      targets.Motions[0].Linear = RotationFromVector(vector);
    }
    const DeformedSurface result = Deform(deformer, targets);
    // Seen from one handle, the other turns about one axis.
    EXPECT_TRUE(deformer.HasSharedAxis());
    const double tolerance = sharedAxis ? 1e-10 : 1e-3;
    EXPECT_LT((result.Positions - motion(*problem.Rest)).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LT(Distance(problem, result), sharedAxis ? 1e-20 : 1e-6);
    EXPECT_LT(MeasureShapeDistance(*problem.Mesh, *problem.Rest, result.Positions).Total,
      sharedAxis ? 1e-10 : 1e-6);
  }
}

TEST(ShapeDistance, DoesNotChangeWhenEitherSurfaceIsMovedRigidly)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer deformer(problem);
  const Points bent = Deform(deformer, Turns({ Eigen::Vector3d(0.0, 3.0, 0.0) })).Positions;
  const ShapeDistance expected = MeasureShapeDistance(*problem.Mesh, *problem.Rest, bent);
  EXPECT_GT(expected.Total, 1.0);
  for (const unsigned int seed : { 1u, 2u, 3u })
  {
    const auto one = shapes::RandomRigidMotion(seed, 5.0);
    const auto other = shapes::RandomRigidMotion(seed + 10, 5.0);
    const ShapeDistance moved =
      MeasureShapeDistance(*problem.Mesh, one(*problem.Rest), other(bent));
    EXPECT_NEAR(moved.Total, expected.Total, 1e-10 * expected.Total);
    EXPECT_LT((moved.Density - expected.Density).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(ShapePreservingDeformer, HasTheLeastDistanceOfAllAngles)
{
  // The harmonic angle minimizes Dist among all fields about the axis: any other
  // that agrees on the handles has more.
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer deformer(problem);
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  DeformedSurface result = Deform(deformer, Turns({ 2.0 * axis }));
  const double least = Distance(problem, result);
  shapes::Random random(7);
  for (int trial = 0; trial < 5; ++trial)
  {
    Matrices other = result.Transforms;
    for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
    {
      if (problem.Handle[v] == 0)
      {
        MatrixAt(other, v) = RotationFromVector(0.05 * random() * axis) * MatrixAt(other, v);
      }
    }
    EXPECT_GT(ShapeDistanceOfRotations(*problem.Mesh, *problem.Rest, other).Total, least);
  }
}

TEST(ConformalIteration, ConvergesToAStationaryPointOfTheEnergy)
{
  const CircleOnPlane plane(14, 0.2);
  const TriangleMesh& mesh = *plane.Problem.Mesh;
  std::vector<int> free;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (plane.Problem.Handle[v] == 0)
    {
      free.push_back(v);
    }
  }
  const auto energy = [&](const Points& eta)
  { return ConformalEnergy(mesh, plane.Shape.Positions, eta); };
  ShapePreservingDeformer deformer(plane.Problem);
  const HandleTargets targets = plane.Targets(2.0 * shapes::Pi / 3.0);
  const DeformedSurface linear = Deform(deformer, targets);
  deformer.SetIteration(100, 1e-11);
  const DeformedSurface converged = Deform(deformer, targets);
  ASSERT_TRUE(deformer.HasConverged());
  ASSERT_FALSE(deformer.HasSharedAxis());
  const double before = LargestDerivative(energy, EtasOf(linear.Transforms), free);
  const double after = LargestDerivative(energy, EtasOf(converged.Transforms), free);
  EXPECT_GT(before, 1e-3);
  EXPECT_LT(after, 1e-6 * before);
  EXPECT_LT(energy(EtasOf(converged.Transforms)), energy(EtasOf(linear.Transforms)));

  // Dist, computed from the rotations themselves, goes down as well, and is 64/3
  // of the energy up to the size of the triangles.
  const double distance = Distance(plane.Problem, converged);
  EXPECT_LT(distance, Distance(plane.Problem, linear));
  EXPECT_NEAR(64.0 / 3.0 * energy(EtasOf(converged.Transforms)), distance, 0.15 * distance);
}

TEST(ConformalIteration, IsStationaryWithSoftTargetsToo)
{
  CircleOnPlane plane(14);
  const TriangleMesh& mesh = *plane.Problem.Mesh;
  const double weight = 0.7;
  plane.Problem.SoftWeights = Eigen::VectorXd::Constant(mesh.NumberOfVertices(), weight);
  std::vector<int> all;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    all.push_back(v);
  }
  const HandleTargets targets = plane.Targets(2.0);
  // Relative to the energy near eta = 0, where W_T is 3/16 and the Dirichlet
  // energy over both directions of each edge is 2 Q.
  const auto energy = [&](const Points& eta)
  {
    double sum = ConformalEnergy(mesh, plane.Shape.Positions, eta);
    for (const int v : all)
    {
      if (plane.Problem.Handle[v] > 0)
      {
        const Eigen::Vector3d target = EtaOfVector(targets.RotationVectors.row(v).transpose());
        sum += 3.0 / 16.0 * 0.5 * weight * weight * (eta.row(v).transpose() - target).squaredNorm();
      }
    }
    return sum;
  };
  ShapePreservingDeformer deformer(plane.Problem);
  const double before =
    LargestDerivative(energy, EtasOf(Deform(deformer, targets).Transforms), all);
  deformer.SetIteration(100, 1e-11);
  const double after = LargestDerivative(energy, EtasOf(Deform(deformer, targets).Transforms), all);
  ASSERT_TRUE(deformer.HasConverged());
  EXPECT_GT(before, 1e-4);
  EXPECT_LT(after, 1e-5 * before);
}

TEST(ConformalIteration, TakesTheRoundsThatItsDocumentationNames)
{
  // On a mesh that resolves the handle; coarse ones need more, or diverge sooner.
  const CircleOnPlane plane(60);
  ShapePreservingDeformer deformer(plane.Problem);
  const auto rounds = [&](double angle, double tolerance)
  {
    deformer.SetIteration(200, tolerance);
    Deform(deformer, plane.Targets(angle));
    EXPECT_TRUE(deformer.HasConverged()) << angle;
    EXPECT_LE(deformer.GetResidual(), tolerance);
    EXPECT_GT(deformer.GetResidual(), 0.0);
    shapes::ShowFigure("rounds at " + std::to_string(angle), deformer.GetNumberOfIterations());
    return deformer.GetNumberOfIterations();
  };
  EXPECT_LE(rounds(2.0 * shapes::Pi / 3.0, 1e-3), 3);
  EXPECT_LE(rounds(2.0 * shapes::Pi / 3.0, 1e-10), 10);
  EXPECT_LE(rounds(1.5 * shapes::Pi, 1e-3), 8);
  EXPECT_LE(rounds(1.5 * shapes::Pi, 1e-10), 60);
}

TEST(ConformalIteration, RefusesToCallWhatDivergesConverged)
{
  for (const double jitter : { 0.0, 0.3 })
  {
    const CircleOnPlane plane(30, jitter);
    ShapePreservingDeformer deformer(plane.Problem);
    const HandleTargets targets = plane.Targets(1.8 * shapes::Pi);
    const double linear = Distance(plane.Problem, Deform(deformer, targets));
    deformer.SetIteration(100, 1e-3);
    const DeformedSurface best = Deform(deformer, targets);
    EXPECT_FALSE(deformer.HasConverged());
    EXPECT_GT(deformer.GetResidual(), 1e-3);
    EXPECT_NE(deformer.GetWarning().find("has not converged"), std::string::npos)
      << deformer.GetWarning();
    EXPECT_TRUE(best.Positions.allFinite());
    EXPECT_LE(Distance(plane.Problem, best), 1.05 * linear);

    // The warning is of that motion only.
    Deform(deformer, plane.Targets(0.5));
    EXPECT_TRUE(deformer.HasConverged());
    EXPECT_EQ(deformer.GetWarning(), "");
  }
}

TEST(ConformalIteration, HasNothingToDoWithoutFreeVertices)
{
  HandleProblem problem = EndsWithAPinnedPoint();
  for (int& handle : problem.Handle)
  {
    handle = handle == 0 ? 1 : handle;
  }
  ShapePreservingDeformer deformer(problem);
  deformer.SetIteration(10, 1e-3);
  const HandleTargets targets = Turns({ Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(0, 0.4, 0) });
  EXPECT_TRUE(Deform(deformer, targets).Positions.allFinite());
}

TEST(ConformalIteration, RefusesWholeTurnsAboutDifferentAxesAndSaysWhatToDo)
{
  const HandleProblem problem = EndsWithAPinnedPoint();
  ShapePreservingDeformer deformer(problem);
  try
  {
    Deform(deformer, Turns({ Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(0, 6.4, 0) }));
    FAIL() << "expected an error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.GetCode(), ErrorCode::BadInput);
    const std::string message = error.what();
    EXPECT_NE(message.find("different axes"), std::string::npos) << message;
    EXPECT_NE(message.find("the same axis, or turn in several steps"), std::string::npos)
      << message;
  }
  // Just below, it goes on.
  const DeformedSurface result =
    Deform(deformer, Turns({ Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(0, 6.2, 0) }));
  EXPECT_TRUE(result.Positions.allFinite());
}

TEST(ShapePreservingDeformer, GivesPerVertexTargetsTheFieldOfTheSameMotions)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer deformer(problem);
  for (const Eigen::Vector3d& scale : { Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 0.5, 1.5) })
  {
    HandleTargets targets = Turns({ Eigen::Vector3d(0.0, 1.2, 0.3) });
    targets.Motions[0].Linear = targets.Motions[0].Linear * scale.asDiagonal();
    targets.Motions[0].Translation << 0.5, 0.0, 0.2;
    const DeformedSurface expected = Deform(deformer, targets);
    // The stretch reaches the free points.
    double largest = 0.0;
    for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
    {
      if (problem.Handle[v] == 0)
      {
        largest = std::max(
          largest, std::abs(MatrixAt(expected.Transforms, v).determinant() - scale.prod()));
      }
    }
    EXPECT_EQ(largest > 0.1, scale.prod() != 1.0);

    const HandleMotion motion = targets.Motions[0];
    const int count = problem.Mesh->NumberOfVertices();
    targets.Vertices = shapes::Ids(count);
    targets.Positions =
      (*problem.Rest * motion.Linear.transpose()).rowwise() + motion.Translation.transpose();
    targets.RotationVectors = motion.RotationVector.transpose().replicate(count, 1);
    targets.Transforms.resize(count, 9);
    for (int v = 0; v < count; ++v)
    {
      MatrixAt(targets.Transforms, v) = motion.Linear;
    }
    const DeformedSurface perVertex = Deform(deformer, targets);
    EXPECT_LT((perVertex.Transforms - expected.Transforms).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((perVertex.Positions - expected.Positions).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(ShapePreservingDeformer, KeepsItsFactorsForAllMotionsAboutSharedAxes)
{
  for (const bool constrainPositions : { true, false })
  {
    HandleProblem problem = BarProblem();
    problem.ConstrainPositions = constrainPositions;
    ShapePreservingDeformer deformer(problem);
    const int factorizations = constrainPositions ? 1 : 2;
    for (int motion = 0; motion < 10; ++motion)
    {
      Deform(deformer, Turns({ Eigen::Vector3d(0.3 * motion, 0.1 * motion, 0.0) }));
      EXPECT_EQ(deformer.GetNumberOfFactorizations(), factorizations);
    }
  }
}

TEST(ShapePreservingDeformer, HoldsAllTheMoreTheLargerTheSoftWeights)
{
  // Fig. 7: the boundary held by a weight, its frames free to turn with the
  // handle's.
  CircleOnPlane plane(20);
  const HandleTargets targets = plane.Targets(2.0 * shapes::Pi / 3.0);
  const auto deform = [&](double boundaryWeight)
  {
    plane.Problem.SoftWeights = Eigen::VectorXd::Constant(
      plane.Shape.NumberOfVertices(), std::numeric_limits<double>::infinity());
    for (int v = 0; v < plane.Shape.NumberOfVertices(); ++v)
    {
      if (plane.Problem.Handle[v] == 1)
      {
        plane.Problem.SoftWeights[v] = boundaryWeight;
      }
    }
    ShapePreservingDeformer deformer(plane.Problem);
    deformer.SetIteration(50, 1e-8);
    return Deform(deformer, targets);
  };
  const auto turnOfBoundary = [&](const DeformedSurface& result)
  {
    double sum = 0.0;
    int count = 0;
    for (int v = 0; v < plane.Shape.NumberOfVertices(); ++v)
    {
      if (plane.Problem.Handle[v] == 1)
      {
        sum += VectorFromRotation(MatrixAt(result.Transforms, v)).norm();
        ++count;
      }
    }
    return sum / count;
  };
  const double loose = turnOfBoundary(deform(0.01));
  const double firm = turnOfBoundary(deform(1.0));
  shapes::ShowFigure("boundary's turn with weight .01", loose);
  shapes::ShowFigure("boundary's turn with weight 1", firm);
  EXPECT_GT(loose, 1.0);
  EXPECT_LT(firm, 0.3 * loose);
  const DeformedSurface held = deform(std::numeric_limits<double>::infinity());
  EXPECT_EQ(turnOfBoundary(held), 0.0);
  EXPECT_LT((deform(1e5).Positions - held.Positions).cwiseAbs().maxCoeff(), 1e-6);
}
