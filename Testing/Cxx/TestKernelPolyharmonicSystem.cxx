// SPDX-License-Identifier: BSD-3-Clause
#include "HandleShapes.h"
#include "Kernel/Deformation/LaplacianDeformer.h"
#include "Kernel/Deformation/MultiresolutionDeformer.h"
#include "Kernel/Deformation/PolyharmonicSystem.h"
#include "Kernel/Differential/LaplaceOperator.h"
#include "Kernel/Mesh/Geometry.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace
{
using cartan::HandleProblem;
using cartan::Points;

/// A bumpy plane with a moving handle in the middle, a ring of pinned points
/// around it at some distance, and free points beyond that nothing reaches.
HandleProblem Island(int count, cartan::LaplacianWeights weights)
{
  const shapes::Shape shape = shapes::Graph(
    count, 2.0, [](double x, double y) { return 0.2 * std::sin(3.0 * x) * std::cos(2.0 * y); },
    0.1);
  const Eigen::Vector3d center = shape.Positions.colwise().mean();
  HandleProblem problem = shapes::ProblemOf(shape,
    [&](const Eigen::Vector3d& x)
    {
      const double radius = (x - center).head<2>().norm();
      return radius < 0.15 ? 2 : radius > 0.5 && radius < 0.75 ? 1 : 0;
    });
  problem.Weights = weights;
  return problem;
}

/// The same by dense matrices over the whole mesh.
Points SolveDensely(
  const HandleProblem& problem, int order, const Points& rightHandSide, const Points& values)
{
  const cartan::TriangleMesh& mesh = *problem.Mesh;
  const Eigen::MatrixXd laplacian = cartan::Laplacian(
    mesh, cartan::SymmetricPart(mesh, cartan::EdgeWeights(mesh, *problem.Rest, problem.Weights)));
  Eigen::VectorXd mass = Eigen::VectorXd::Ones(mesh.NumberOfVertices());
  if (problem.Weights != cartan::LaplacianWeights::Uniform)
  {
    mass = cartan::MixedVoronoiAreas(mesh, *problem.Rest);
    mass /= mass.mean();
  }
  Eigen::MatrixXd matrix = laplacian;
  for (int k = 1; k < order; ++k)
  {
    matrix = (matrix * mass.cwiseInverse().asDiagonal() * laplacian).eval();
  }
  const std::vector<char> isUnknown = cartan::UnknownVertices(problem, cartan::Hold::AllHandles);
  std::vector<int> unknowns;
  std::vector<int> others;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    (isUnknown[v] ? unknowns : others).push_back(v);
  }
  const Eigen::VectorXd stiffness =
    0.5 * cartan::SquaredSoftWeights(problem, isUnknown, cartan::Hold::AllHandles);
  matrix += stiffness.asDiagonal();
  const Eigen::MatrixXd free = matrix(unknowns, unknowns);
  const Points loaded = rightHandSide + stiffness.asDiagonal() * values;
  const Eigen::MatrixXd reduced = Eigen::MatrixXd(loaded)(unknowns, Eigen::all) -
    matrix(unknowns, others) * Eigen::MatrixXd(values)(others, Eigen::all);
  const Eigen::MatrixXd solution = free.llt().solve(reduced);
  Points result = values;
  for (std::size_t i = 0; i < unknowns.size(); ++i)
  {
    result.row(unknowns[i]) = solution.row(i);
  }
  return result;
}

TEST(PolyharmonicSystem, IsThatOfTheWholeMesh)
{
  for (const auto weights : { cartan::LaplacianWeights::Uniform,
         cartan::LaplacianWeights::Cotangent, cartan::LaplacianWeights::MeanValue })
  {
    for (const bool isSoft : { false, true })
    {
      HandleProblem problem = Island(18, weights);
      if (isSoft)
      {
        problem.SoftWeights.setConstant(
          problem.Mesh->NumberOfVertices(), std::numeric_limits<double>::infinity());
        for (std::size_t v = 0; v < problem.Handle.size(); v += 3)
        {
          problem.SoftWeights[static_cast<Eigen::Index>(v)] = 2.0;
        }
      }
      for (int order = 1; order <= 3; ++order)
      {
        const cartan::PolyharmonicSystem system(
          problem, order, cartan::SolverBackend::Automatic, {});
        Points positions = *problem.Rest;
        positions.col(2).array() += 0.3;
        Points rightHandSide = Points::Random(positions.rows(), 3);
        const Points expected = SolveDensely(problem, order, rightHandSide, positions);
        system.Solve(system.Gather(rightHandSide), positions);
        EXPECT_LT((positions - expected).cwiseAbs().maxCoeff(), 1e-8) << order;
      }
    }
  }
}

TEST(PolyharmonicSystem, HasNoRoomForPointsThatNoMotionReaches)
{
  const HandleProblem small = Island(40, cartan::LaplacianWeights::Cotangent);
  const cartan::PolyharmonicSystem system(small, 3, cartan::SolverBackend::Automatic, {});
  EXPECT_LT(system.NumberOfUnknowns(), small.Mesh->NumberOfVertices() / 4);
  EXPECT_LT(system.NumberOfLocals(), small.Mesh->NumberOfVertices() / 2);
  // Rings of neighbors lie one around the other.
  for (int edges = 1; edges <= 3; ++edges)
  {
    EXPECT_GT(system.NumberWithin(edges), system.NumberWithin(edges - 1));
  }
  EXPECT_EQ(system.NumberWithin(3), system.NumberOfLocals());
}

TEST(PolyharmonicSystem, LeavesPointsThatNoMotionReachesInPlace)
{
  const HandleProblem problem = Island(24, cartan::LaplacianWeights::Cotangent);
  cartan::HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].Translation = { 0.0, 0.1, 0.4 };
  const std::vector<char> isUnknown = cartan::UnknownVertices(problem, cartan::Hold::AllHandles);
  std::vector<std::unique_ptr<cartan::SurfaceDeformer>> methods;
  for (const auto rotations : { cartan::LaplacianRotations::None,
         cartan::LaplacianRotations::Estimated, cartan::LaplacianRotations::Implicit })
  {
    methods.push_back(std::make_unique<cartan::LaplacianDeformer>(problem, rotations));
  }
  for (int order = 1; order <= 3; ++order)
  {
    methods.push_back(std::make_unique<cartan::MultiresolutionDeformer>(problem, order));
  }
  for (const auto& method : methods)
  {
    cartan::DeformedSurface result;
    method->Deform(targets, true, result, {});
    for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
    {
      if (problem.Handle[v] != 2 && !isUnknown[v])
      {
        EXPECT_EQ(result.Positions.row(v), problem.Rest->row(v));
      }
    }
    // The same with and without transforms.
    cartan::DeformedSurface without;
    method->Deform(targets, false, without, {});
    EXPECT_EQ(result.Positions, without.Positions);
  }
}

TEST(PolyharmonicSystem, MethodsThatNeedPositionsRefuseBeforeTheyFactorize)
{
  HandleProblem problem = Island(18, cartan::LaplacianWeights::Cotangent);
  problem.ConstrainPositions = false;
  int reports = 0;
  const cartan::ExecutionContext context({},
    [&reports](double)
    {
      ++reports;
      return true;
    });
  EXPECT_THROW(cartan::LaplacianDeformer(problem, cartan::LaplacianRotations::None,
                 cartan::SolverBackend::Automatic, context),
    cartan::Error);
  EXPECT_THROW(
    cartan::MultiresolutionDeformer(problem, 2, cartan::SolverBackend::Automatic, context),
    cartan::Error);
  EXPECT_EQ(reports, 0);
}

TEST(LaplaceOperator, MassesOfPointsWithoutAreaAreOne)
{
  const shapes::Shape shape = shapes::Plane(5);
  const cartan::TriangleMesh mesh(shape.NumberOfVertices() + 1, shape.Faces);
  Points points(shape.NumberOfVertices() + 1, 3);
  points << shape.Positions, Eigen::RowVector3d(9.0, 9.0, 9.0);
  const cartan::LaplaceOperator laplace(mesh, points, cartan::LaplacianWeights::Cotangent);
  EXPECT_DOUBLE_EQ(laplace.GetMass()[shape.NumberOfVertices()], 1.0);
  EXPECT_NEAR(laplace.GetMass().head(shape.NumberOfVertices()).mean(), 1.0, 1e-12);
  const cartan::LaplaceOperator scaled(mesh, 1e-6 * points, cartan::LaplacianWeights::Cotangent);
  EXPECT_LT((scaled.GetMass() - laplace.GetMass()).cwiseAbs().maxCoeff(), 1e-9);
}
}
