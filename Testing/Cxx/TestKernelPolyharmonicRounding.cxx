// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/LaplacianDeformer.h"
#include "Kernel/Deformation/MultiresolutionDeformer.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Differential/LaplaceOperator.h"
#include "Kernel/Measure/EdgeLengths.h"
#include "RealMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

/// Systems of order 2 and 3 where their numbers are far apart: on needles and
/// caps, in any unit, on long surfaces, and with bases that collapse.
namespace
{
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::LaplacianRotations;
using cartan::Points;

/// Puts a point at this part of the edge between two vertices, into both triangles.
void SplitEdge(shapes::Shape& shape, int from, int to, double part)
{
  const int added = shape.NumberOfVertices();
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) =
    (1.0 - part) * shape.Positions.row(from) + part * shape.Positions.row(to);
  for (Eigen::Index t = 0, count = shape.Faces.rows(); t < count; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int a = shape.Faces(t, k);
      const int b = shape.Faces(t, (k + 1) % 3);
      if (std::minmax(a, b) == std::minmax(from, to))
      {
        const int c = shape.Faces(t, (k + 2) % 3);
        shape.Faces.conservativeResize(shape.Faces.rows() + 1, 3);
        shape.Faces.row(t) << a, added, c;
        shape.Faces.row(shape.Faces.rows() - 1) << added, b, c;
        break;
      }
    }
  }
}

/// A tube along z whose ends are handles, 1 below and 2 above; with `part` >= 0,
/// three edges across the middle get a point there.
shapes::Shape Tube(int along, double length, double part = -1.0)
{
  shapes::Shape shape = shapes::OpenCylinder(16, along, 0.5, length);
  shape.Positions.rowwise() -= shape.Positions.colwise().mean().eval();
  const auto middle = [&](int v) { return std::abs(shape.Positions(v, 2)) < 0.2 * length; };
  for (int i = 0; part >= 0.0 && i < 3; ++i)
  {
    const Eigen::Index t = shape.Faces.rows() / 2 + 7 * i;
    EXPECT_TRUE(middle(shape.Faces(t, 0)) && middle(shape.Faces(t, 1)));
    SplitEdge(shape, shape.Faces(t, 0), shape.Faces(t, 1), part);
  }
  return shape;
}

HandleProblem EndsOf(const shapes::Shape& shape, double heldLength, double unit = 1.0)
{
  const double low = shape.Positions.col(2).minCoeff() + heldLength;
  const double high = shape.Positions.col(2).maxCoeff() - heldLength;
  HandleProblem problem = shapes::ProblemOf(
    shape, [&](const Eigen::Vector3d& x) { return x[2] < low ? 1
                                             : x[2] > high   ? 2
                                                             : 0; });
  problem.Rest = std::make_shared<const Points>(unit * shape.Positions);
  return problem;
}

HandleMotion Turn(double degrees, double unit = 1.0)
{
  HandleMotion motion;
  motion.RotationVector = { degrees * shapes::Pi / 180.0, 0.0, 0.0 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  motion.Translation = Eigen::Vector3d(0.1, 0.0, 0.2) * unit;
  return motion;
}

using Method =
  std::function<std::unique_ptr<cartan::SurfaceDeformer>(const HandleProblem& problem)>;

std::map<std::string, Method> Methods()
{
  std::map<std::string, Method> methods;
  const auto laplacian = [](LaplacianRotations rotations)
  {
    return [rotations](const HandleProblem& problem)
    { return std::make_unique<cartan::LaplacianDeformer>(problem, rotations); };
  };
  methods["none"] = laplacian(LaplacianRotations::None);
  methods["estimated"] = laplacian(LaplacianRotations::Estimated);
  methods["implicit"] = laplacian(LaplacianRotations::Implicit);
  for (int order = 1; order <= 3; ++order)
  {
    methods["smoothness " + std::to_string(order)] = [order](const HandleProblem& problem)
    { return std::make_unique<cartan::MultiresolutionDeformer>(problem, order); };
  }
  return methods;
}

Points Deform(cartan::SurfaceDeformer& deformer, const HandleMotion& motion)
{
  cartan::HandleTargets targets;
  targets.Motions = { motion };
  cartan::DeformedSurface result;
  deformer.Deform(targets, false, result, {});
  return result.Positions;
}

double Difference(const Points& a, const Points& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(PolyharmonicRounding, ShortEdgesLeaveTheIdentityExactAndTheBendAsItIs)
{
  const shapes::Shape clean = Tube(30, 4.0);
  const HandleProblem cleanProblem = EndsOf(clean, 0.4);
  for (const auto& [name, make] : Methods())
  {
    const Points expected = Deform(*make(cleanProblem), Turn(60.0));
    for (const double part : { 1e-3, 1e-5, 1e-6, 1e-9, 1e-12, 1e-15, 0.0 })
    {
      const shapes::Shape shape = Tube(30, 4.0, part);
      const HandleProblem problem = EndsOf(shape, 0.4);
      const auto method = make(problem);
      EXPECT_EQ(Deform(*method, HandleMotion()), shape.Positions) << name << ", " << part;
      const Points bent = Deform(*method, Turn(60.0));
      // Less than a tenth of an edge of the clean mesh.
      EXPECT_LT(Difference(bent.topRows(expected.rows()), expected), 1e-2) << name << ", " << part;
    }
  }
}

TEST(PolyharmonicRounding, NoUnitMatters)
{
  const shapes::Shape shape = Tube(30, 4.0, 1e-5);
  for (auto weights : { cartan::LaplacianWeights::Cotangent, cartan::LaplacianWeights::MeanValue })
  {
    for (const auto& [name, make] : Methods())
    {
      HandleProblem problem = EndsOf(shape, 0.4);
      problem.Weights = weights;
      const Points expected = Deform(*make(problem), Turn(60.0));
      for (const double unit : { 1e-9, 1e-3, 1e3, 1e6 })
      {
        HandleProblem scaled = EndsOf(shape, 0.4, unit);
        scaled.Weights = weights;
        const Points result = Deform(*make(scaled), Turn(60.0, unit));
        EXPECT_LT(Difference(result / unit, expected), 1e-6) << name << ", " << unit;
      }
    }
  }
}

TEST(PolyharmonicRounding, IsMeasuredAndSaidAndTheAdviceHelps)
{
  // The condition of order 3 grows like the sixth power of the length in edges.
  const shapes::Shape shape = Tube(1600, 1600 * 0.2);
  HandleProblem problem = EndsOf(shape, 1.0);
  cartan::MultiresolutionDeformer smooth(problem, 3);
  Deform(smooth, Turn(40.0));
  for (const std::string& part : { std::string("Rounding in the system of order 3"),
         shapes::Advice("Use a method of order 1, such as Rotation Invariant Deformation, or hold "
                        "more points.") })
  {
    EXPECT_NE(smooth.GetWarning().find(part), std::string::npos) << smooth.GetWarning();
  }

  cartan::RotationInvariantDeformer first(problem);
  const Points bent = Deform(first, Turn(40.0));
  EXPECT_EQ(first.GetWarning(), "");
  EXPECT_LT(cartan::CompareEdgeLengths(*problem.Mesh, shape.Positions, bent).Maximum, 0.05);

  // Rings are held all along.
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    if (problem.Handle[v] == 0 && std::fmod(shape.Positions(v, 2) + 160.0, 20.0) < 0.7)
    {
      problem.Handle[v] = 1;
    }
  }
  cartan::MultiresolutionDeformer held(problem, 3);
  EXPECT_EQ(held.GetWarning().find("Rounding"), std::string::npos) << held.GetWarning();
}

TEST(PolyharmonicRounding, RefinementReachesTheKnownSolution)
{
  for (int order = 1; order <= 2; ++order)
  {
    const HandleProblem problem = EndsOf(Tube(100, 20.0, 1e-6), 0.5);
    const cartan::PolyharmonicSystem system(problem, order, cartan::SolverBackend::Automatic, {});
    EXPECT_LT(system.GetMeasuredError(), cartan::PolyharmonicSystem::WarnedError) << order;
    EXPECT_EQ(system.GetWarning(), "") << order;
  }
}

TEST(MultiresolutionDeformer, SpreadsFramesWhereTheBaseCollapses)
{
  // A camel whose legs hang between handles: its base leaves them next to points.
  shapes::Shape camel = shapes::RealMesh("camel");
  const Points centered = camel.Positions.rowwise() - camel.Positions.colwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centered.transpose() * centered);
  camel.Positions = centered * axes.eigenvectors();
  const HandleProblem problem = shapes::ProblemOf(camel, shapes::EndsAlong(camel, 2, 0.2));
  HandleMotion motion;
  motion.RotationVector = { 40.0 * shapes::Pi / 180.0, 0.0, 0.0 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  for (int order = 1; order <= 3; ++order)
  {
    cartan::MultiresolutionDeformer deformer(problem, order);
    const Points result = Deform(deformer, motion);
    EXPECT_GT(deformer.GetNumberOfSpreadFrames(), 0);
    EXPECT_NE(deformer.GetWarning().find("collapsed"), std::string::npos);
    std::vector<double> stretches;
    for (int d = 0; d < problem.Mesh->NumberOfDirectedEdges(); ++d)
    {
      const int v = problem.Mesh->Origin(d);
      const int w = problem.Mesh->Neighbor(d);
      if (problem.Handle[v] == 0 || problem.Handle[w] == 0)
      {
        const double before = (camel.Positions.row(v) - camel.Positions.row(w)).norm();
        stretches.push_back(std::abs((result.row(v) - result.row(w)).norm() / before - 1.0));
      }
    }
    std::sort(stretches.begin(), stretches.end());
    const double quantile = stretches[stretches.size() * 95 / 100];
    shapes::ShowFigure("95 % of edges change by less, order " + std::to_string(order), quantile);
    EXPECT_LT(quantile, 0.6) << order;
    EXPECT_EQ(Deform(deformer, HandleMotion()), camel.Positions) << order;
  }
}

TEST(LaplaceOperator, IsBoundedByRatiosThatOrdinaryMeshesNeverMeet)
{
  for (const auto weights :
    { cartan::LaplacianWeights::Cotangent, cartan::LaplacianWeights::MeanValue })
  {
    const shapes::Shape ordinary = shapes::Saddle(20, 1.0, 0.1);
    const cartan::TriangleMesh mesh = shapes::MakeMesh(ordinary);
    const cartan::LaplaceOperator laplace(mesh, ordinary.Positions, weights);
    const Eigen::VectorXd plain =
      cartan::SymmetricPart(mesh, cartan::EdgeWeights(mesh, ordinary.Positions, weights));
    EXPECT_LT((laplace.GetWeights() - plain).cwiseAbs().maxCoeff(), 1e-12 * plain.maxCoeff());

    for (const double part : { 0.5, 1e-4, 1e-9, 0.0 })
    {
      const shapes::Shape shape = Tube(30, 4.0, part);
      const cartan::TriangleMesh split = shapes::MakeMesh(shape);
      const cartan::LaplaceOperator bounded(split, shape.Positions, weights);
      const double unit = weights == cartan::LaplacianWeights::Cotangent ? 1.0 : plain.maxCoeff();
      EXPECT_LT(bounded.GetWeights().cwiseAbs().maxCoeff(),
        2.0 * unit / cartan::LaplaceOperator::SmallestSlack);
      for (int d = 0; d < split.NumberOfDirectedEdges(); ++d)
      {
        EXPECT_GE(bounded.GetMass()[split.Neighbor(d)],
          0.999 * cartan::LaplaceOperator::SmallestMassRatio * bounded.GetMass()[split.Origin(d)]);
      }
    }
  }
}
}
