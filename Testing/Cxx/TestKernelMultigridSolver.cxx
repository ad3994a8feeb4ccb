// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "RealMeshes.h"

#include "Kernel/Algebra/ConstrainedSolver.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Differential/Laplacian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace
{
using cartan::ConstrainedSolver;
using cartan::Error;
using cartan::ErrorCode;
using cartan::SolverBackend;
using cartan::SolverStatus;
using cartan::SparseMatrix;
using shapes::Advice;
using shapes::Shape;

/// The tests that solve need hypre.
class MultigridSolver : public testing::Test
{
protected:
  void SetUp() override
  {
    if (!cartan::HasHypre())
    {
      GTEST_SKIP() << "built without hypre";
    }
  }
};

/// The cotangent Laplacian of an uneven square of about count^2 vertices plus `shift`.
SparseMatrix SquareMatrix(int count, double shift)
{
  const Shape plane = shapes::Plane(count, 1.0, 0.3);
  const cartan::TriangleMesh mesh = shapes::MakeMesh(plane);
  SparseMatrix identity(mesh.NumberOfVertices(), mesh.NumberOfVertices());
  identity.setIdentity();
  return cartan::Laplacian(
           mesh, cartan::EdgeWeights(mesh, plane.Positions, cartan::LaplacianWeights::Cotangent)) +
    shift * identity;
}

/// The same with one side held, as surfaces with handles are.
SparseMatrix HeldSquare(int count)
{
  SparseMatrix matrix = SquareMatrix(count, 0.0);
  for (int i = 0; i <= count; ++i)
  {
    matrix.coeffRef(i, i) += 1.0;
  }
  return matrix;
}

SparseMatrix LowerOf(const SparseMatrix& matrix)
{
  return matrix.triangularView<Eigen::Lower>();
}

/// For a ConstrainedSolver.
std::vector<char> FirstFixed(const SparseMatrix& matrix)
{
  std::vector<char> isFixed(matrix.rows(), 0);
  isFixed[0] = 1;
  return isFixed;
}

Eigen::MatrixXd RandomColumns(Eigen::Index rows, int columns)
{
  shapes::Random random(3);
  Eigen::MatrixXd values(rows, columns);
  std::generate(values.data(), values.data() + values.size(), [&] { return random() - 0.5; });
  return values;
}

/// The counts of steps for each column.
std::vector<int> StepsOf(cartan::SymmetricSolver& solver, const Eigen::MatrixXd& rightHandSide)
{
  std::vector<int> steps;
  for (Eigen::Index column = 0; column < rightHandSide.cols(); ++column)
  {
    int count = 0;
    const cartan::ExecutionContext context(nullptr, [&](double) { return ++count > 0; });
    EXPECT_EQ(solver.Solve(rightHandSide.col(column), context), SolverStatus::Ok);
    steps.push_back(count);
  }
  return steps;
}

TEST_F(MultigridSolver, ReachesItsToleranceForAnyNumberOfUnknownsAndColumns)
{
  for (const int count : { 1, 2, 7, 40 })
  {
    const SparseMatrix matrix = SquareMatrix(count, 1e-3);
    const auto solver = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients);
    ASSERT_EQ(solver->Analyze(LowerOf(matrix)), SolverStatus::Ok);
    ASSERT_EQ(solver->Factorize(LowerOf(matrix)), SolverStatus::Ok);
    Eigen::MatrixXd rightHandSide = RandomColumns(matrix.rows(), 4);
    rightHandSide.col(1).setZero();
    // Their squares are beyond what numbers can count.
    rightHandSide.col(2) *= 1e-200;
    rightHandSide.col(3) *= 1e+200;
    ASSERT_EQ(solver->Solve(rightHandSide), SolverStatus::Ok);
    const Eigen::MatrixXd left = rightHandSide - matrix * solver->GetSolution();
    for (int column = 0; column < 4; ++column)
    {
      EXPECT_LE(left.col(column).stableNorm(), 1.001e-10 * rightHandSide.col(column).stableNorm())
        << count;
    }
    EXPECT_TRUE(solver->GetSolution().col(1).isZero(0.0));
    const Eigen::MatrixXd narrow = solver->GetSolution();
    ASSERT_EQ(solver->Solve(rightHandSide.leftCols(1)), SolverStatus::Ok);
    EXPECT_EQ(solver->GetSolution(), narrow.leftCols(1));
  }
}

TEST_F(MultigridSolver, GivesTheSameBitsAgain)
{
  const SparseMatrix lower = LowerOf(SquareMatrix(50, 1e-3));
  const Eigen::MatrixXd rightHandSide = RandomColumns(lower.rows(), 2);
  Eigen::MatrixXd first;
  for (int turn = 0; turn < 2; ++turn)
  {
    const auto solver = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients);
    ASSERT_EQ(solver->Factorize(lower), SolverStatus::Ok);
    ASSERT_EQ(solver->Solve(rightHandSide), SolverStatus::Ok);
    first = turn == 0 ? solver->GetSolution() : first;
    EXPECT_EQ(solver->GetSolution(), first);
  }
}

TEST_F(MultigridSolver, TakesFewStepsAndLittleMemoryForAnyNumberOfUnknowns)
{
  for (const int count : { 40, 80, 160 })
  {
    const SparseMatrix lower = LowerOf(HeldSquare(count));
    const auto solver = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients);
    ASSERT_EQ(solver->Factorize(lower), SolverStatus::Ok);
    for (const int steps : StepsOf(*solver, RandomColumns(lower.rows(), 2)))
    {
      EXPECT_LE(steps, 20) << count;
    }
    EXPECT_LE(solver->GetBytes(), 450 * static_cast<std::size_t>(lower.rows())) << count;
    EXPECT_GE(solver->GetBytes(), 12 * static_cast<std::size_t>(2 * lower.nonZeros())) << count;
  }
}

TEST_F(MultigridSolver, TellsIndefiniteMatricesAndThoseThatItDoesNotSolve)
{
  const auto solver = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients);
  EXPECT_EQ(solver->Factorize(LowerOf(SquareMatrix(20, -0.5))), SolverStatus::NotPositiveDefinite);
  const SparseMatrix laplacian = SquareMatrix(40, 0.0);
  const SparseMatrix cubed = laplacian * laplacian * laplacian + SquareMatrix(40, 1e-9);
  EXPECT_EQ(solver->Factorize(LowerOf(cubed)), SolverStatus::NotConverged);
  // And works afterwards.
  const SparseMatrix matrix = SquareMatrix(20, 0.5);
  EXPECT_EQ(solver->Factorize(LowerOf(matrix)), SolverStatus::Ok);
  EXPECT_EQ(solver->Solve(Eigen::MatrixXd::Constant(matrix.rows(), 1, 1.0)), SolverStatus::Ok);
  EXPECT_TRUE(solver->GetSolution().isConstant(2.0, 1e-8));
}

TEST_F(MultigridSolver, RefusesWhatDoesNotFit)
{
  const SparseMatrix matrix = SquareMatrix(20, 1e-3);
  const auto entries = static_cast<std::int64_t>(matrix.nonZeros());
  cartan::FactorLimits limits;
  limits.DirectUnknowns = 100;
  for (const bool fits : { true, false })
  {
    limits.Entries = fits ? entries : entries - 1;
    const auto solver = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients, limits);
    EXPECT_EQ(
      solver->Analyze(LowerOf(matrix)), fits ? SolverStatus::Ok : SolverStatus::OutOfMemory);
  }
  // Factors would take more.
  limits.Entries = entries / 2;
  ConstrainedSolver solver(SolverBackend::Automatic, limits);
  try
  {
    solver.Factorize(matrix, FirstFixed(matrix));
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.GetCode(), ErrorCode::OutOfMemory);
  }
  EXPECT_EQ(solver.GetBackend(), SolverBackend::ConjugateGradients);
}

TEST_F(MultigridSolver, SolvesAnotherSystemBetweenItsSteps)
{
  const SparseMatrix lower = LowerOf(SquareMatrix(30, 1e-3));
  const Eigen::MatrixXd rightHandSide = RandomColumns(lower.rows(), 1);
  const auto outer = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients);
  const auto inner = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients);
  ASSERT_EQ(outer->Factorize(lower), SolverStatus::Ok);
  ASSERT_EQ(inner->Factorize(lower), SolverStatus::Ok);
  const cartan::ExecutionContext context(
    nullptr, [&](double) { return inner->Solve(rightHandSide) == SolverStatus::Ok; });
  ASSERT_EQ(outer->Solve(rightHandSide, context), SolverStatus::Ok);
  EXPECT_EQ(outer->GetSolution(), inner->GetSolution());
}

TEST_F(MultigridSolver, SaysWhereARightHandSideIsNotFinite)
{
  const SparseMatrix matrix = SquareMatrix(5, 1e-3);
  ConstrainedSolver solver(SolverBackend::ConjugateGradients);
  solver.Factorize(matrix, FirstFixed(matrix));
  for (const double value : { std::nan(""), std::numeric_limits<double>::infinity() })
  {
    Eigen::MatrixXd rightHandSide = RandomColumns(matrix.rows() - 1, 2);
    rightHandSide(7, 1) = value;
    EXPECT_THROW(solver.SolveFree(rightHandSide), Error) << value;
  }
}

TEST_F(MultigridSolver, StopsBetweenSteps)
{
  const SparseMatrix lower = LowerOf(SquareMatrix(30, 1e-3));
  const auto solver = cartan::MakeSymmetricSolver(SolverBackend::ConjugateGradients);
  ASSERT_EQ(solver->Factorize(lower), SolverStatus::Ok);
  const Eigen::MatrixXd rightHandSide = RandomColumns(lower.rows(), 3);
  std::vector<double> progress;
  const cartan::ExecutionContext stop(nullptr,
    [&](double fraction)
    {
      progress.push_back(fraction);
      return progress.size() < 12;
    });
  EXPECT_THROW(solver->Solve(rightHandSide, stop), Error);
  EXPECT_EQ(progress.size(), 12u);
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_LE(progress.back(), 1.0);
  EXPECT_EQ(solver->Solve(rightHandSide), SolverStatus::Ok);
}

TEST_F(MultigridSolver, IsChosenForManyUnknownsWhereItConverges)
{
  cartan::FactorLimits limits;
  limits.DirectUnknowns = 100;
  const auto solve = [&](const SparseMatrix& matrix, SolverBackend backend)
  {
    ConstrainedSolver solver(backend, limits);
    solver.Factorize(matrix, FirstFixed(matrix));
    cartan::Field values = cartan::Field::Zero(matrix.rows(), 1);
    values(0, 0) = 1.0;
    solver.Solve(cartan::Field(RandomColumns(matrix.rows(), 1)), values);
    return std::make_pair(solver.GetBackend(), values);
  };
  const SolverBackend direct = cartan::HasCholmod() ? SolverBackend::Cholmod : SolverBackend::Eigen;
  const SparseMatrix laplacian = SquareMatrix(20, 0.0);
  const SparseMatrix cubed = laplacian * laplacian * laplacian;
  EXPECT_EQ(solve(laplacian, SolverBackend::Automatic).first, SolverBackend::ConjugateGradients);
  EXPECT_EQ(solve(laplacian, SolverBackend::Eigen).first, SolverBackend::Eigen);
  EXPECT_EQ(solve(SquareMatrix(5, 0.0), SolverBackend::Automatic).first, direct);
  const cartan::Field values = solve(laplacian, SolverBackend::Automatic).second;
  EXPECT_LT((values - solve(laplacian, SolverBackend::Eigen).second).norm(), 1e-8 * values.norm());
  // What it does not solve is factorized, or refused where nothing else is allowed.
  EXPECT_EQ(solve(cubed, SolverBackend::Automatic).first, direct);
  try
  {
    solve(cubed, SolverBackend::ConjugateGradients);
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.GetCode(), ErrorCode::NotConverged);
    EXPECT_NE(std::string(error.what()).find(Advice("Choose a direct solver, Eigen or CHOLMOD.")),
      std::string::npos)
      << error.what();
    EXPECT_NO_THROW(solve(cubed, direct));
  }
}

/// All methods on one surface with one solver: positions, or what they say.
struct Results
{
  std::map<std::string, cartan::Points> Positions;
  std::map<std::string, std::string> Messages;
};

Results Deform(const cartan::HandleProblem& problem, SolverBackend backend,
  const std::set<std::string>& methods = {})
{
  cartan::HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].RotationVector = Eigen::Vector3d(0.5, 0.2, -0.3);
  targets.Motions[0].Linear = cartan::RotationFromVector(targets.Motions[0].RotationVector);
  targets.Motions[0].Translation = Eigen::Vector3d(0.1, 0.3, 0.2);
  Results results;
  for (const auto& [name, make] : deformers::All(backend))
  {
    if (!methods.empty() && methods.count(name) == 0)
    {
      continue;
    }
    try
    {
      cartan::DeformedSurface result;
      make(problem, {})->Deform(targets, false, result, {});
      results.Positions[name] = result.Positions;
    }
    catch (const Error& error)
    {
      results.Messages[name] = error.what();
    }
  }
  return results;
}

/// The largest difference between two results, by the diagonal of the surface.
double Difference(const cartan::Points& a, const cartan::Points& b, const cartan::Points& rest)
{
  return (a - b).rowwise().norm().maxCoeff() /
    (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
}

TEST_F(MultigridSolver, DeformsByEachMethodAsTheDirectSolverOrIsRefused)
{
  const std::set<std::string> served = { "RotationInvariant", "ShapePreserving", "PoissonHarmonic",
    "PoissonGeodesic", "Multiresolution1", "Spokes", "SpokesAndRims", "SmoothedRotations",
    "Pyramid" };
  const Shape shape = shapes::Noisy(shapes::Ellipsoid(4, { 2.0, 1.0, 0.7 }), 0.01);
  const cartan::HandleProblem problem = shapes::ProblemOf(shape, shapes::EndsAlong(shape, 0, 0.15));
  const Results direct = Deform(problem, SolverBackend::Eigen);
  const Results iterative = Deform(problem, SolverBackend::ConjugateGradients);
  EXPECT_TRUE(direct.Messages.empty());
  for (const auto& [name, positions] : direct.Positions)
  {
    if (served.count(name))
    {
      ASSERT_TRUE(iterative.Positions.count(name)) << name << iterative.Messages.at(name);
      EXPECT_LT(Difference(iterative.Positions.at(name), positions, shape.Positions), 1e-8) << name;
      continue;
    }
    ASSERT_TRUE(iterative.Messages.count(name)) << name;
    EXPECT_NE(iterative.Messages.at(name).find(Advice("choose another solver, such as Automatic.")),
      std::string::npos)
      << iterative.Messages.at(name);
  }
}

TEST_F(MultigridSolver, DeformsEachSurfaceAsTheDirectSolver)
{
  std::map<std::string, Shape> surfaces = { { "bar", shapes::Bar(4, 4, 30, { 1.0, 1.0, 6.0 }) },
    { "cylinder", shapes::OpenCylinder(30, 60, 0.5, 3.0, 0.4) },
    { "torus", shapes::Torus(60, 30, 2.0, 0.7, 0.4) },
    { "plane of uneven triangles", shapes::Plane(40, 1.0, 0.45) },
    { "needles at the poles", shapes::UvSphere(150, 20) } };
  for (const char* name : { "camel", "elephant", "lion-head" })
  {
    surfaces[name] = shapes::RealMesh(name);
  }
  const std::set<std::string> methods = { "RotationInvariant", "ShapePreserving",
    "PoissonHarmonic" };
  for (const auto& [name, shape] : surfaces)
  {
    cartan::HandleProblem problem = shapes::ProblemOf(shape, shapes::EndsAlong(shape, 1, 0.2));
    for (const auto weights : { cartan::LaplacianWeights::Uniform,
           cartan::LaplacianWeights::Cotangent, cartan::LaplacianWeights::MeanValue })
    {
      problem.Weights = weights;
      const Results direct = Deform(problem, SolverBackend::Automatic, methods);
      const Results iterative = Deform(problem, SolverBackend::ConjugateGradients, methods);
      EXPECT_EQ(direct.Positions.size(), methods.size()) << name;
      for (const auto& [method, positions] : direct.Positions)
      {
        ASSERT_TRUE(iterative.Positions.count(method))
          << name << method << iterative.Messages.at(method);
        EXPECT_LT(Difference(iterative.Positions.at(method), positions, shape.Positions), 1e-8)
          << name << ", " << method << ", weights " << static_cast<int>(weights);
      }
    }
  }
}

TEST(MultigridSolverMissing, SaysWhatToDo)
{
  if (cartan::HasHypre())
  {
    EXPECT_NO_THROW(ConstrainedSolver{ SolverBackend::ConjugateGradients });
    return;
  }
  try
  {
    ConstrainedSolver solver(SolverBackend::ConjugateGradients);
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("built without hypre"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(Advice("choose Eigen's solver.")), std::string::npos);
  }
}
}
