// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"

#include "AdviceWords.h"
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/RegionThickness.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>
#include <tuple>

using cartan::AsRigidAsPossibleDeformer;
using cartan::DeformedSurface;
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::InitialGuess;
using cartan::LaplacianWeights;
using cartan::Matrices;
using cartan::MatrixAt;
using cartan::Points;
using cartan::RigidityEnergy;
using cartan::RotationFromVector;
using cartan::SolverBackend;
using cartan::TriangleMesh;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::MakeMesh;
using shapes::ManyThreads;
using shapes::Shape;

namespace
{
constexpr RigidityEnergy AllEnergies[] = { RigidityEnergy::Spokes, RigidityEnergy::SpokesAndRims,
  RigidityEnergy::SmoothedRotations };

constexpr InitialGuess AllGuesses[] = { InitialGuess::RestShape, InitialGuess::PreviousResult,
  InitialGuess::RotationInvariant, InitialGuess::ShapePreserving };

/// Handle 1 and 2 are the ends of the extent along `axis`; 2 moves.
HandleProblem MakeProblem(const Shape& shape, int axis, double share = 0.1)
{
  return shapes::ProblemOf(shape, shapes::EndsAlong(shape, axis, share));
}

/// A turn by a rotation vector about `center`, then a shift.
HandleMotion Turn(
  const Vector3d& vector, const Vector3d& center, const Vector3d& shift = Vector3d::Zero())
{
  HandleMotion motion;
  motion.RotationVector = vector;
  motion.Linear = RotationFromVector(vector);
  motion.Translation = center - motion.Linear * center + shift;
  return motion;
}

HandleTargets Targets(const HandleMotion& motion)
{
  HandleTargets targets;
  targets.Motions = { motion };
  return targets;
}

/// A bend that moves the camel's or elephant's head a good way.
HandleTargets BendOf(const Shape& shape)
{
  const double size = cartan::BoundingDiagonal(shape.Positions);
  return Targets(Turn({ 0.8, -0.5, 0.9 }, shape.Positions.colwise().mean().transpose(),
    size * Vector3d(0.1, 0.05, -0.08)));
}

DeformedSurface Deform(AsRigidAsPossibleDeformer& deformer, const HandleTargets& targets,
  const cartan::ExecutionContext& context = {})
{
  DeformedSurface result;
  deformer.Deform(targets, true, result, context);
  return result;
}

double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff() / cartan::BoundingDiagonal(a);
}

/// The sums of the header, term by term over the whole mesh, with the rotations
/// given. `coupling` is alpha times squared thickness.
double BruteForceEnergy(const HandleProblem& problem, RigidityEnergy energy,
  const Points& positions, const Matrices& rotations, double coupling)
{
  const TriangleMesh& mesh = *problem.Mesh;
  const Points& rest = *problem.Rest;
  double sum = 0.0;
  const auto residual = [&](int i, int a, int b)
  {
    return ((positions.row(a) - positions.row(b)).transpose() -
      MatrixAt(rotations, i) * (rest.row(a) - rest.row(b)).transpose())
      .squaredNorm();
  };
  if (energy == RigidityEnergy::SpokesAndRims)
  {
    const Points weights = cartan::CornerWeights(mesh, rest, problem.PositionWeights);
    for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      for (int cell = 0; cell < 3; ++cell)
      {
        for (int apex = 0; apex < 3; ++apex)
        {
          sum += 2.0 / 3.0 * weights(t, apex) *
            residual(mesh.GetTriangles()(t, cell), mesh.GetTriangles()(t, (apex + 1) % 3),
              mesh.GetTriangles()(t, (apex + 2) % 3));
        }
      }
    }
    return sum;
  }
  const Eigen::VectorXd weights =
    cartan::SymmetricPart(mesh, cartan::EdgeWeights(mesh, rest, problem.PositionWeights))
      .cwiseMax(0.0);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int i = mesh.Origin(d);
    const int j = mesh.Neighbor(d);
    sum += weights[d] *
      (residual(i, i, j) +
        coupling * (MatrixAt(rotations, i) - MatrixAt(rotations, j)).squaredNorm());
  }
  return sum;
}

/// alpha times the squared thickness of what is free.
double Coupling(const HandleProblem& problem, RigidityEnergy energy, double bending)
{
  std::vector<char> isFree;
  for (const int handle : problem.Handle)
  {
    isFree.push_back(handle == 0 ? 1 : 0);
  }
  const double thickness = cartan::RegionThickness(*problem.Mesh, *problem.Rest, isFree);
  return energy == RigidityEnergy::SmoothedRotations ? bending * thickness * thickness : 0.0;
}

/// A bar along z whose upper end bends by `degrees` about an axis parallel to x
/// so that a middle line of constant length would become an arc.
HandleTargets BendBar(double degrees, double length)
{
  const double angle = degrees * shapes::Pi / 180.0;
  const double radius = length / angle;
  // The arc's center is at y = radius; a turn about -x tilts +z toward +y.
  return Targets(Turn({ -angle, 0.0, 0.0 }, { 0.0, radius, 0.0 },
    RotationFromVector({ -angle, 0.0, 0.0 }) * Vector3d(0.0, 0.0, -length)));
}
}

//------------------------------------------------------------------------------
TEST(AsRigidAsPossibleDeformer, NeverRaisesTheEnergy)
{
  const Shape shape = shapes::RealMesh("camel");
  const HandleTargets targets = BendOf(shape);
  for (const LaplacianWeights weights :
    { LaplacianWeights::Uniform, LaplacianWeights::Cotangent, LaplacianWeights::MeanValue })
  {
    for (const RigidityEnergy energy : AllEnergies)
    {
      for (const InitialGuess guess : AllGuesses)
      {
        HandleProblem problem = MakeProblem(shape, 1);
        problem.PositionWeights = weights;
        AsRigidAsPossibleDeformer deformer(problem, energy, guess);
        deformer.SetIteration(15, 0.0);
        Deform(deformer, targets);
        const std::vector<double>& energies = deformer.GetEnergies();
        ASSERT_EQ(energies.size(), 16u);
        EXPECT_EQ(deformer.GetNumberOfIterations(), 15);
        for (std::size_t i = 1; i < energies.size(); ++i)
        {
          EXPECT_LE(energies[i], energies[i - 1] * (1.0 + 1e-13));
        }
        EXPECT_LT(energies.back(), energies.front());
        EXPECT_GT(energies.back(), 0.0);
      }
    }
  }
}

TEST(AsRigidAsPossibleDeformer, DoesNotDependOnTheOrderOfVertices)
{
  const Shape shape = shapes::RealMesh("elephant");
  Shape reversed = shape;
  reversed.Positions = shape.Positions.colwise().reverse();
  reversed.Faces = (shape.NumberOfVertices() - 1 - shape.Faces.array()).matrix();
  for (const RigidityEnergy energy : AllEnergies)
  {
    for (const InitialGuess guess : { InitialGuess::RestShape, InitialGuess::ShapePreserving })
    {
      AsRigidAsPossibleDeformer deformer(MakeProblem(shape, 0), energy, guess);
      AsRigidAsPossibleDeformer other(MakeProblem(reversed, 0), energy, guess);
      const Points expected = Deform(deformer, BendOf(shape)).Positions;
      const Points found = Deform(other, BendOf(shape)).Positions.colwise().reverse();
      EXPECT_LT((found - expected).rowwise().norm().maxCoeff(),
        1e-6 * cartan::BoundingDiagonal(shape.Positions));
    }
  }
}

TEST(AsRigidAsPossibleDeformer, SaysUntilWhenSmoothedRotationsMove)
{
  const Shape shape = shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 }, true);
  const HandleProblem problem = MakeProblem(shape, 2);
  const HandleTargets targets = BendOf(shape);
  const auto warning = [&](InitialGuess guess, int iterations)
  {
    AsRigidAsPossibleDeformer deformer(problem, RigidityEnergy::SmoothedRotations, guess);
    deformer.SetIteration(iterations, 1e-4);
    Deform(deformer, targets);
    return deformer.GetWarning();
  };
  EXPECT_NE(warning(InitialGuess::RestShape, 2).find("have not settled: the last of 2 iterations"),
    std::string::npos);
  EXPECT_NE(warning(InitialGuess::RestShape, 2)
              .find(shapes::Advice("Raise MaximumIterations, or guess SHAPE_PRESERVING.")),
    std::string::npos);
  EXPECT_EQ(warning(InitialGuess::RestShape, 30), "");
  EXPECT_EQ(warning(InitialGuess::ShapePreserving, 5), "");
}

TEST(AsRigidAsPossibleDeformer, SettlesSmoothedRotationsInFewSolves)
{
  // A twisted and a bent bar, and a sheet that is pulled up.
  const Shape bar = shapes::Bar(8, 8, 44, { 1.0, 1.0, 5.5 });
  const Shape plane = shapes::Plane(60, 1.0, 0.2, 3);
  HandleProblem pulled = MakeProblem(plane, 0);
  for (int v = 0; v < plane.NumberOfVertices(); ++v)
  {
    const double distance = plane.Positions.row(v).head<2>().cwiseAbs().maxCoeff();
    pulled.Handle[v] = distance < 0.06 ? 2 : distance > 0.45 ? 1 : 0;
  }
  const std::tuple<HandleProblem, HandleTargets, double> cases[] = {
    { MakeProblem(bar, 2), Targets(Turn({ 0.0, 0.0, 2.4 }, Vector3d::Zero())), 0.3 },
    { MakeProblem(bar, 2), Targets(Turn({ 0.0, 0.0, 2.4 }, Vector3d::Zero())), 0.03 },
    { MakeProblem(bar, 2), BendBar(120.0, 4.4), 0.3 },
    { MakeProblem(bar, 2), BendBar(120.0, 4.4), 0.03 },
    { pulled, Targets(Turn(Vector3d::Zero(), Vector3d::Zero(), { 0, 0, 0.3 })), 0.3 },
    { pulled, Targets(Turn(Vector3d::Zero(), Vector3d::Zero(), { 0, 0, 0.3 })), 0.03 },
  };
  for (const auto& [problem, targets, alpha] : cases)
  {
    AsRigidAsPossibleDeformer deformer(problem, RigidityEnergy::SmoothedRotations);
    deformer.SetBending(alpha);
    deformer.SetIteration(1000, 0.0);
    Deform(deformer, targets);
    const std::vector<double> energies = deformer.GetEnergies();
    EXPECT_LT(deformer.GetResidual(), 1e-9);
    // An iteration is two solves, and the first one has another.
    ASSERT_GT(energies.size(), 19u);
    EXPECT_LT(energies[19], 1.01 * energies.back());
    // The residual tells what the last step and all after it gain.
    for (const int iterations : { 6, 9, 12 })
    {
      deformer.SetIteration(iterations, 0.0);
      Deform(deformer, targets);
      const double before = energies[iterations - 1];
      const double gain = (before - energies.back()) / before;
      shapes::ShowFigure("gain over residual", gain / deformer.GetResidual());
      EXPECT_LT(gain, 10.0 * deformer.GetResidual());
      EXPECT_GT(gain, 0.02 * deformer.GetResidual());
    }
  }
}

TEST(AsRigidAsPossibleDeformer, ReportsTheEnergyOfItsDefinition)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleTargets targets = BendOf(shape);
  for (const LaplacianWeights weights :
    { LaplacianWeights::Uniform, LaplacianWeights::Cotangent, LaplacianWeights::MeanValue })
  {
    for (const RigidityEnergy energy : AllEnergies)
    {
      HandleProblem problem = MakeProblem(shape, 0);
      problem.PositionWeights = weights;
      AsRigidAsPossibleDeformer deformer(problem, energy);
      deformer.SetBending(0.003);
      for (const int iterations : { 0, 4 })
      {
        deformer.SetIteration(iterations, 0.0);
        const DeformedSurface result = Deform(deformer, targets);
        const double expected = BruteForceEnergy(
          problem, energy, result.Positions, result.Transforms, Coupling(problem, energy, 0.003));
        EXPECT_NEAR(deformer.GetEnergies().back(), expected, 1e-11 * expected);
      }
    }
  }
}

TEST(AsRigidAsPossibleDeformer, ConvergesToWhereTheGradientVanishes)
{
  const Shape shape = shapes::Noisy(shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 }), 0.02, 5);
  const HandleTargets targets = BendOf(shape);
  for (const RigidityEnergy energy : AllEnergies)
  {
    const HandleProblem problem = MakeProblem(shape, 2);
    AsRigidAsPossibleDeformer deformer(problem, energy);
    deformer.SetIteration(5000, 1e-15);
    deformer.SetBending(0.01);
    const DeformedSurface result = Deform(deformer, targets);
    EXPECT_TRUE(deformer.HasConverged());
    shapes::ShowFigure("steps to convergence", deformer.GetNumberOfIterations());
    // With the rotations at their best, the change of the energy with positions
    // and rotations is zero to first order: central differences of the sums.
    const double coupling = Coupling(problem, energy, 0.01);
    const double at = deformer.GetEnergies().back();
    shapes::Random random(6);
    double largest = 0.0;
    for (int trial = 0; trial < 40; ++trial)
    {
      Points direction = Points::Zero(shape.NumberOfVertices(), 3);
      Points spin = direction;
      for (int v = 0; v < shape.NumberOfVertices(); ++v)
      {
        if (problem.Handle[v] == 0)
        {
          direction.row(v) = Eigen::RowVector3d{ random(), random(), random() };
          spin.row(v) = Eigen::RowVector3d{ random(), random(), random() };
        }
      }
      const auto energyAt = [&](double t)
      {
        Matrices rotations = result.Transforms;
        for (int v = 0; v < shape.NumberOfVertices(); ++v)
        {
          MatrixAt(rotations, v) =
            MatrixAt(result.Transforms, v) * RotationFromVector(t * spin.row(v).transpose());
        }
        return BruteForceEnergy(
          problem, energy, result.Positions + t * direction, rotations, coupling);
      };
      const double h = 1e-4;
      const double slope = (energyAt(h) - energyAt(-h)) / (2 * h);
      const double curvature = (energyAt(h) + energyAt(-h) - 2.0 * at) / (h * h);
      EXPECT_GT(curvature, 0.0);
      // How far along this direction the minimum lies.
      largest = std::max(largest, std::abs(slope) / curvature);
    }
    shapes::ShowFigure("largest distance from the minimum along random directions", largest);
    EXPECT_LT(largest, 1e-6);
  }
}

TEST(AsRigidAsPossibleDeformer, MovesRigidlyWhenAllHandlesDo)
{
  const Shape shape = shapes::RealMesh("elephant");
  const shapes::RigidMotion rigid = shapes::RandomRigidMotion(7, 3.0);
  HandleMotion motion;
  motion.Linear = rigid.Rotation;
  motion.RotationVector = cartan::VectorFromRotation(rigid.Rotation);
  motion.Translation = rigid.Translation;
  HandleTargets targets;
  targets.Motions = { motion, motion };
  for (const RigidityEnergy energy : AllEnergies)
  {
    for (const bool isSoft : { false, true })
    {
      HandleProblem problem = MakeProblem(shape, 0);
      problem.Moving = { 1, 2 };
      if (isSoft)
      {
        problem.SoftWeights = Eigen::VectorXd::Constant(shape.NumberOfVertices(), 0.5);
      }
      for (const InitialGuess guess :
        { InitialGuess::RotationInvariant, InitialGuess::ShapePreserving })
      {
        AsRigidAsPossibleDeformer deformer(problem, energy, guess);
        const DeformedSurface result = Deform(deformer, targets);
        EXPECT_LT(Distance(result.Positions, rigid(shape.Positions)), 1e-10);
        EXPECT_LT(deformer.GetEnergies().back(), 1e-20 * shape.Positions.squaredNorm());
        EXPECT_TRUE(deformer.HasConverged());
        for (int v = 0; v < shape.NumberOfVertices(); ++v)
        {
          ASSERT_LT((MatrixAt(result.Transforms, v) - rigid.Rotation).norm(), 1e-7);
        }
      }
    }
  }
}

TEST(AsRigidAsPossibleDeformer, DoesNothingWithoutMotion)
{
  // The elephant has thousands of negative cotangents.
  const Shape shape = shapes::RealMesh("elephant");
  const HandleProblem problem = MakeProblem(shape, 0);
  for (const RigidityEnergy energy : AllEnergies)
  {
    for (const InitialGuess guess : AllGuesses)
    {
      AsRigidAsPossibleDeformer deformer(problem, energy, guess);
      const DeformedSurface result = Deform(deformer, Targets(HandleMotion()));
      EXPECT_LT(Distance(result.Positions, shape.Positions), 1e-12);
      EXPECT_LT(deformer.GetEnergies().back(), 1e-20 * shape.Positions.squaredNorm());
      for (int v = 0; v < shape.NumberOfVertices(); ++v)
      {
        if (problem.Handle[v] > 0)
        {
          ASSERT_EQ(result.Positions.row(v), shape.Positions.row(v));
        }
      }
    }
  }
}

TEST(AsRigidAsPossibleDeformer, DoesNotDependOnTheUnit)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleTargets targets = BendOf(shape);
  for (const RigidityEnergy energy : AllEnergies)
  {
    const HandleProblem problem = MakeProblem(shape, 0);
    AsRigidAsPossibleDeformer original(problem, energy);
    const DeformedSurface expected = Deform(original, targets);
    for (const double unit : { 1e-6, 1e-3, 1e3 })
    {
      HandleProblem scaled = problem;
      scaled.Rest = std::make_shared<const Points>(unit * shape.Positions);
      HandleTargets scaledTargets = targets;
      scaledTargets.Motions[0].Translation *= unit;
      AsRigidAsPossibleDeformer deformer(scaled, energy);
      const DeformedSurface result = Deform(deformer, scaledTargets);
      EXPECT_LT(Distance(result.Positions, unit * expected.Positions), 1e-9);
      EXPECT_NEAR(deformer.GetEnergies().back() / (unit * unit), original.GetEnergies().back(),
        1e-9 * original.GetEnergies().back());
      EXPECT_EQ(deformer.GetNumberOfIterations(), original.GetNumberOfIterations());
    }
  }
}

TEST(AsRigidAsPossibleDeformer, CommutesWithRigidMotionsOfEverything)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleTargets targets = BendOf(shape);
  const shapes::RigidMotion rigid = shapes::RandomRigidMotion(9, 5.0);
  HandleTargets conjugated = targets;
  HandleMotion& motion = conjugated.Motions[0];
  motion.Linear = rigid.Rotation * motion.Linear * rigid.Rotation.transpose();
  motion.RotationVector = rigid.Rotation * motion.RotationVector;
  motion.Translation = rigid.Rotation * targets.Motions[0].Translation + rigid.Translation -
    motion.Linear * rigid.Translation;
  for (const RigidityEnergy energy : AllEnergies)
  {
    HandleProblem problem = MakeProblem(shape, 0);
    AsRigidAsPossibleDeformer original(problem, energy);
    problem.Rest = std::make_shared<const Points>(rigid(shape.Positions));
    AsRigidAsPossibleDeformer moved(problem, energy);
    EXPECT_LT(
      Distance(Deform(moved, conjugated).Positions, rigid(Deform(original, targets).Positions)),
      1e-9);
  }
}

/// A turn so large that steps are cut short.
TEST(AsRigidAsPossibleDeformer, CutsStepsAlikeWhateverTheAxes)
{
  const Shape bar = shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 });
  const shapes::RigidMotion rigid = shapes::RandomRigidMotion(9, 5.0);
  HandleTargets targets = Targets(Turn({ 1.0, 0.0, 2.8 }, Vector3d::Zero()));
  HandleTargets conjugated = targets;
  HandleMotion& motion = conjugated.Motions[0];
  motion.Linear = rigid.Rotation * motion.Linear * rigid.Rotation.transpose();
  motion.Translation += rigid.Translation - motion.Linear * rigid.Translation;
  HandleProblem problem = MakeProblem(bar, 2);
  AsRigidAsPossibleDeformer original(
    problem, RigidityEnergy::SmoothedRotations, InitialGuess::RestShape);
  problem.Rest = std::make_shared<const Points>(rigid(bar.Positions));
  AsRigidAsPossibleDeformer moved(
    problem, RigidityEnergy::SmoothedRotations, InitialGuess::RestShape);
  original.SetIteration(3, 0.0);
  moved.SetIteration(3, 0.0);
  const Points expected = rigid(Deform(original, targets).Positions);
  EXPECT_LT(Distance(Deform(moved, conjugated).Positions, expected), 1e-9);
}

TEST(AsRigidAsPossibleDeformer, DoesNotDependOnThreads)
{
  const Shape shape = shapes::RealMesh("camel");
  const HandleTargets targets = BendOf(shape);
  for (const RigidityEnergy energy : AllEnergies)
  {
    const HandleProblem problem = MakeProblem(shape, 1);
    AsRigidAsPossibleDeformer alone(problem, energy);
    AsRigidAsPossibleDeformer together(
      problem, energy, InitialGuess::ShapePreserving, SolverBackend::Automatic, ManyThreads(7));
    const DeformedSurface expected = Deform(alone, targets);
    const DeformedSurface result = Deform(together, targets, ManyThreads(5));
    // To the bit: each number is computed by one thread from the same numbers.
    EXPECT_EQ(result.Positions, expected.Positions);
    EXPECT_EQ(result.Transforms, expected.Transforms);
    EXPECT_EQ(together.GetEnergies(), alone.GetEnergies());
  }
}

TEST(AsRigidAsPossibleDeformer, FactorizesOnceForAllMotions)
{
  const Shape shape = shapes::RealMesh("camel");
  const HandleProblem problem = MakeProblem(shape, 1);
  for (const RigidityEnergy energy : AllEnergies)
  {
    for (const InitialGuess guess : AllGuesses)
    {
      AsRigidAsPossibleDeformer deformer(problem, energy, guess);
      deformer.SetIteration(3, 0.0);
      for (int motion = 0; motion < 10; ++motion)
      {
        Deform(deformer, Targets(Turn({ 0.1 * motion, 0.0, 0.05 }, Vector3d::Zero())));
      }
      EXPECT_EQ(deformer.GetNumberOfFactorizations(), 1);
    }
  }
}

//------------------------------------------------------------------------------
TEST(AsRigidAsPossibleDeformer, BendsByMoreThanHalfATurn)
{
  // A bar of 1 x 1 x 10; its free middle is 8 long.
  Shape shape = shapes::Bar(6, 6, 60, { 1.0, 1.0, 10.0 });
  shape.Positions.col(2).array() -= 1.0;
  const HandleProblem problem = MakeProblem(shape, 2);
  HandleTargets targets = BendBar(270.0, 8.0);
  // The arc starts at z = 0 and the handle at z = 8 goes to its end.
  std::vector<double> energies;
  for (const InitialGuess guess : { InitialGuess::ShapePreserving, InitialGuess::RestShape })
  {
    AsRigidAsPossibleDeformer deformer(problem, RigidityEnergy::Spokes, guess);
    deformer.SetIteration(500, 1e-9);
    const DeformedSurface result = Deform(deformer, targets);
    energies.push_back(deformer.GetEnergies().back());
    if (guess == InitialGuess::ShapePreserving)
    {
      // The rotation about -x grows along the bar, to 270 degrees.
      double previous = 0.0;
      double total = 0.0;
      std::vector<std::pair<double, int>> line;
      for (int v = 0; v < shape.NumberOfVertices(); ++v)
      {
        if (shape.Positions(v, 0) < -0.499 && std::abs(shape.Positions(v, 1)) < 1e-9)
        {
          line.emplace_back(shape.Positions(v, 2), v);
        }
      }
      std::sort(line.begin(), line.end());
      for (const auto& [z, v] : line)
      {
        const auto r = MatrixAt(result.Transforms, v);
        const double angle = std::atan2(r(1, 2), r(2, 2));
        const double change = std::remainder(angle - previous, 2.0 * shapes::Pi);
        EXPECT_LT(std::abs(change), 0.4);
        total += change;
        previous = angle;
      }
      EXPECT_NEAR(total * 180.0 / shapes::Pi, 270.0, 0.01);
    }
  }
  shapes::ShowFigure("270 degrees, energy from shape-preserving", energies[0]);
  shapes::ShowFigure("  from the rest shape", energies[1]);
  EXPECT_LT(energies[0], 0.7 * energies[1]);
}

TEST(AsRigidAsPossibleDeformer, FindsTheSameMinimumFromAllGuesses)
{
  const Shape shape = shapes::Bar(5, 5, 30, { 1.0, 1.0, 6.0 });
  const HandleProblem problem = MakeProblem(shape, 2);
  const HandleTargets targets =
    Targets(Turn({ 0.2, 0.1, 0.2 }, { 0.0, 0.0, 6.0 }, { 0.1, -0.1, 0.6 })); // no buckling
  for (const RigidityEnergy energy : AllEnergies)
  {
    Points expected;
    for (const InitialGuess guess : AllGuesses)
    {
      AsRigidAsPossibleDeformer deformer(problem, energy, guess);
      deformer.SetBending(1e-3);
      deformer.SetIteration(5000, 1e-14);
      const Points positions = Deform(deformer, targets).Positions;
      if (expected.rows() == 0)
      {
        expected = positions;
      }
      EXPECT_LT(Distance(positions, expected), 1e-5);
    }
  }
}

TEST(AsRigidAsPossibleDeformer, GoesOnFromThePreviousResult)
{
  const Shape shape = shapes::RealMesh("camel");
  const HandleTargets targets = BendOf(shape);
  AsRigidAsPossibleDeformer once(
    MakeProblem(shape, 1), RigidityEnergy::Spokes, InitialGuess::PreviousResult);
  once.SetIteration(10, 0.0);
  Deform(once, targets);
  const double after = once.GetEnergies().back();
  Deform(once, targets);
  EXPECT_NEAR(once.GetEnergies().front(), after, 1e-12 * after);
  EXPECT_LT(once.GetEnergies().back(), after);
}

TEST(AsRigidAsPossibleDeformer, BendingMakesRotationsSmooth)
{
  // A sheet that is pulled up in the middle: more alpha, less turning from
  // vertex to vertex.
  const Shape shape = shapes::Plane(30, 1.0, 0.2, 3);
  HandleProblem problem = MakeProblem(shape, 0);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const double x = shape.Positions(v, 0);
    const double y = shape.Positions(v, 1);
    problem.Handle[v] = std::hypot(x, y) < 0.06   ? 2
      : std::max(std::abs(x), std::abs(y)) > 0.49 ? 1
                                                  : 0;
  }
  const HandleTargets targets = Targets(Turn(Vector3d::Zero(), Vector3d::Zero(), { 0, 0, 0.25 }));
  double last = std::numeric_limits<double>::infinity();
  for (const double alpha : { 0.0, 0.001, 0.01, 0.1 })
  {
    AsRigidAsPossibleDeformer deformer(problem, RigidityEnergy::SmoothedRotations);
    deformer.SetBending(alpha);
    deformer.SetIteration(2000, 1e-9);
    const DeformedSurface result = Deform(deformer, targets);
    const double rough = BruteForceEnergy(problem, RigidityEnergy::SmoothedRotations,
                           result.Positions, result.Transforms, 1.0) -
      BruteForceEnergy(problem, RigidityEnergy::Spokes, result.Positions, result.Transforms, 0.0);
    shapes::ShowFigure("alpha", alpha);
    shapes::ShowFigure("  sum of w |R_i - R_j|^2", rough);
    shapes::ShowFigure("  steps", deformer.GetNumberOfIterations());
    EXPECT_LT(rough, last);
    last = rough;
    if (alpha == 0.0)
    {
      AsRigidAsPossibleDeformer spokes(problem, RigidityEnergy::Spokes);
      spokes.SetIteration(2000, 1e-9);
      EXPECT_LT(Distance(Deform(spokes, targets).Positions, result.Positions), 1e-12);
    }
  }
}

TEST(AsRigidAsPossibleDeformer, HoldsRotationsWherePositionsAreFree)
{
  const Shape shape = shapes::Bar(4, 4, 24, { 1.0, 1.0, 6.0 });
  HandleProblem problem = MakeProblem(shape, 2);
  problem.ConstrainPositions = false;
  const HandleTargets targets = Targets(Turn({ 1.2, 0.0, 0.0 }, Vector3d::Zero()));
  for (const RigidityEnergy energy : AllEnergies)
  {
    AsRigidAsPossibleDeformer deformer(problem, energy);
    deformer.SetIteration(300, 1e-8);
    const DeformedSurface result = Deform(deformer, targets);
    double inHandle = 0.0;
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      if (problem.Handle[v] == 2)
      {
        EXPECT_LT((MatrixAt(result.Transforms, v) - targets.Motions[0].Linear).norm(), 1e-14);
        inHandle = std::max(inHandle, std::abs(result.Positions(v, 0) - shape.Positions(v, 0)));
      }
      if (problem.Handle[v] == 1)
      {
        EXPECT_EQ(result.Positions.row(v), shape.Positions.row(v));
      }
    }
    // The bend is in the plane x = 0, and the handle keeps its shape.
    EXPECT_LT(inHandle, 0.05);
    EXPECT_LT(deformer.GetEnergies().back(), deformer.GetEnergies().front());
    for (std::size_t i = 1; i < deformer.GetEnergies().size(); ++i)
    {
      EXPECT_LE(deformer.GetEnergies()[i], deformer.GetEnergies()[i - 1] * (1.0 + 1e-13));
    }
  }
}

TEST(AsRigidAsPossibleDeformer, HardensFromSoftHandles)
{
  const Shape shape = shapes::Bar(4, 4, 24, { 1.0, 1.0, 6.0 });
  HandleProblem problem = MakeProblem(shape, 2);
  const HandleTargets targets = BendOf(shape);
  AsRigidAsPossibleDeformer hard(problem);
  hard.SetIteration(2000, 1e-12);
  const Points expected = Deform(hard, targets).Positions;
  double last = std::numeric_limits<double>::infinity();
  for (const double weight : { 0.3, 3.0, 30.0, 3000.0 })
  {
    problem.SoftWeights = Eigen::VectorXd::Constant(shape.NumberOfVertices(), weight);
    AsRigidAsPossibleDeformer soft(problem);
    soft.SetIteration(2000, 1e-12);
    const double distance = Distance(Deform(soft, targets).Positions, expected);
    EXPECT_LT(distance, last);
    last = distance;
  }
  EXPECT_LT(last, 1e-5);
}

TEST(AsRigidAsPossibleDeformer, LeavesWhatNoMovingHandleReachesAsItIs)
{
  const Shape torus = shapes::Torus(40, 12);
  const Shape shape = shapes::Union(torus, torus);
  HandleProblem problem;
  problem.Mesh = std::make_shared<const TriangleMesh>(MakeMesh(shape));
  problem.Rest = std::make_shared<const Points>(shape.Positions);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const int column = v % 40;
    problem.Handle.push_back(v < torus.NumberOfVertices() ? (column < 3                        ? 2
                                                                : column == 10 || column == 32 ? 1
                                                                                               : 0)
                                                          : (column == 0 ? 3 : 0));
  }
  problem.Moving = { 2 };
  for (const RigidityEnergy energy : AllEnergies)
  {
    AsRigidAsPossibleDeformer deformer(problem, energy);
    const DeformedSurface result =
      Deform(deformer, Targets(Turn({ 0.0, 0.7, 0.0 }, { 2, 0, 0 }, { 0.5, 0, 0.5 })));
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      const int column = v % 40;
      const bool isTouched = v < torus.NumberOfVertices() && (column < 10 || column > 32);
      ASSERT_EQ(result.Positions.row(v) != shape.Positions.row(v), isTouched) << v;
    }
    // The definition over the whole mesh, handles moved rigidly included.
    HandleProblem free = problem;
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      const int column = v % 40;
      const bool isFree =
        v < torus.NumberOfVertices() && ((column > 2 && column < 10) || column > 32);
      free.Handle[v] = isFree ? 0 : 1;
    }
    const double expected = BruteForceEnergy(
      problem, energy, result.Positions, result.Transforms, Coupling(free, energy, 0.03));
    EXPECT_NEAR(deformer.GetEnergies().back(), expected, 1e-11 * expected);
  }
}

TEST(AsRigidAsPossibleDeformer, StopsWhereItIsTold)
{
  const Shape shape = shapes::RealMesh("elephant");
  const HandleTargets targets = BendOf(shape);
  AsRigidAsPossibleDeformer deformer(MakeProblem(shape, 0));
  deformer.SetIteration(1000, 1e-3);
  Deform(deformer, targets);
  EXPECT_TRUE(deformer.HasConverged());
  const std::vector<double>& energies = deformer.GetEnergies();
  for (std::size_t i = 1; i < energies.size(); ++i)
  {
    EXPECT_EQ(energies[i - 1] - energies[i] <= 1e-3 * energies[i], i + 1 == energies.size());
  }
  deformer.SetIteration(0, 1e-3);
  const Points guessed = Deform(deformer, targets).Positions;
  EXPECT_EQ(deformer.GetNumberOfIterations(), 0);
  EXPECT_FALSE(deformer.HasConverged());
  HandleProblem clamped = MakeProblem(shape, 0);
  clamped.ClampWeights = true;
  cartan::ShapePreservingDeformer linear(clamped);
  DeformedSurface expected;
  linear.Deform(targets, false, expected, {});
  EXPECT_LT(Distance(guessed, expected.Positions), 1e-14);
}
