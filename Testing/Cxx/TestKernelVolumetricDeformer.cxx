// SPDX-License-Identifier: BSD-3-Clause
#include "Backwards.h"
#include "Kernel/Deformation/LatticeGraph.h"
#include "Kernel/Deformation/PoissonDeformer.h"
#include "Kernel/Deformation/VolumetricDeformer.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "VolumeShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace
{
using cartan::DeformedSurface;
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::LatticeOptions;
using cartan::Points;
using cartan::VolumetricDeformer;

double VolumeChange(const HandleProblem& problem, const Points& current)
{
  return cartan::MeasureComponents(*problem.Mesh, current)[0].Volume /
    cartan::MeasureComponents(*problem.Mesh, *problem.Rest)[0].Volume -
    1.0;
}

VolumetricDeformer LatticeDeformer(const HandleProblem& problem, const LatticeOptions& options = {})
{
  return VolumetricDeformer(
    problem, cartan::MakeLatticeGraph(*problem.Mesh, *problem.Rest, options));
}

DeformedSurface Deform(cartan::SurfaceDeformer& deformer, const std::vector<HandleMotion>& motions,
  const cartan::ExecutionContext& context = {})
{
  HandleTargets targets;
  targets.Motions = motions;
  DeformedSurface result;
  deformer.Deform(targets, false, result, context);
  return result;
}

HandleMotion RigidMotion()
{
  HandleMotion motion;
  motion.RotationVector = { 0.3, -1.1, 0.4 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  motion.Translation = { 3.0, -1.0, 0.5 };
  return motion;
}

Points Moved(const Points& points, const HandleMotion& motion)
{
  return (points * motion.Linear.transpose()).rowwise() + motion.Translation.transpose();
}

double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff();
}

HandleProblem Bar(const std::vector<int>& moving = { 1 })
{
  return shapes::ProblemOf(
    shapes::Bar(6, 6, 36, { 1.0, 1.0, 6.0 }, true), shapes::EndsOfBar(), moving);
}

/// A function of the message that a graph is refused with.
template <typename Make>
std::string RefusalOf(const Make& make)
{
  try
  {
    make();
  }
  catch (const cartan::Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(VolumetricDeformer, BendsLoseAThirdAtMostOfTheVolumeThatTheSurfaceAloneLoses)
{
  // Poisson editing spreads the same rotations, over the surface alone.
  const HandleProblem problem = Bar();
  cartan::PoissonDeformer surface(problem, cartan::Propagation::Harmonic);
  VolumetricDeformer volume = LatticeDeformer(problem);
  for (const double degrees : { 90.0, 170.0 })
  {
    const std::vector<HandleMotion> bend = { shapes::BendOfBar(degrees) };
    const double lost = VolumeChange(problem, Deform(surface, bend).Positions);
    volume.SetVolumeRounds(0);
    const double inside = VolumeChange(problem, Deform(volume, bend).Positions);
    volume.SetVolumeRounds(3);
    const double restored = VolumeChange(problem, Deform(volume, bend).Positions);
    EXPECT_LT(lost, -0.02);
    EXPECT_LE(std::abs(inside), std::abs(lost) / 2.0);
    EXPECT_LE(std::abs(restored), std::abs(lost) / 3.0);
    EXPECT_LE(std::abs(restored), 0.003);
  }
}

TEST(VolumetricDeformer, TetrahedraStayUprightAndKeepTheirVolume)
{
  shapes::SolidBar bar(6, 6, 36, { 1.0, 1.0, 6.0 });
  shapes::Random random(5);
  for (Eigen::Index i = bar.Surface.NumberOfVertices(); i < bar.Nodes.rows(); ++i)
  {
    bar.Nodes.row(i) += 0.03 * Eigen::RowVector3d(random(), random(), random());
  }
  ASSERT_TRUE((cartan::TetrahedronDeterminants(bar.Nodes, bar.Cells).array() > 0.0).all());
  const HandleProblem problem = shapes::ProblemOf(bar.Surface, shapes::EndsOfBar(), { 1 });
  VolumetricDeformer deformer(problem, cartan::MakeTetrahedronGraph(bar.Nodes, bar.Cells));
  for (const HandleMotion& motion : { shapes::BendOfBar(120.0), shapes::TwistOfBar(135.0) })
  {
    const Points nodes = deformer.NodesAfter(Deform(deformer, { motion }));
    EXPECT_EQ(cartan::InvertedTetrahedra(bar.Nodes, nodes, bar.Cells).GetCount(), 0u);
    const double before = cartan::TetrahedronDeterminants(bar.Nodes, bar.Cells).sum();
    const double after = cartan::TetrahedronDeterminants(nodes, bar.Cells).sum();
    EXPECT_NEAR(after / before, 1.0, 0.02);
    EXPECT_NEAR(before, 36.0, 1e-9); // six times the volume of the bar
  }
}

TEST(VolumetricDeformer, NoMotionAndRigidMotionsAreExact)
{
  const HandleProblem problem = Bar();
  VolumetricDeformer pinned = LatticeDeformer(problem);
  EXPECT_TRUE(Deform(pinned, { HandleMotion() }).Positions == *problem.Rest);

  VolumetricDeformer moving = LatticeDeformer(Bar({ 1, 2 }));
  const HandleMotion motion = RigidMotion();
  const DeformedSurface result = Deform(moving, { motion, motion });
  EXPECT_LT(Distance(result.Positions, Moved(*problem.Rest, motion)), 1e-12 * 10.0);
  EXPECT_LT(
    Distance(moving.NodesAfter(result), Moved(moving.GetGraph().Nodes, motion)), 1e-12 * 10.0);
}

TEST(VolumetricDeformer, TheOnlyHandleMapsTheBodyAffinely)
{
  HandleProblem problem = Bar();
  for (int& handle : problem.Handle)
  {
    handle = handle == 1 ? 1 : 0;
  }
  HandleMotion motion = RigidMotion();
  motion.Linear *= Eigen::Vector3d(1.3, 0.8, 1.1).asDiagonal();
  motion.Linear(0, 1) += 0.2;
  VolumetricDeformer deformer = LatticeDeformer(problem);
  EXPECT_LT(Distance(Deform(deformer, { motion }).Positions, Moved(*problem.Rest, motion)), 1e-9);
}

TEST(VolumetricDeformer, WallsOfCavitiesFollow)
{
  shapes::Shape wall = shapes::Inverted(shapes::Icosphere(2, 0.6));
  const shapes::Shape outside = shapes::Icosphere(3);
  const shapes::Shape hollow = shapes::Union(outside, wall);
  // Nothing is pinned, and no handle is on the wall.
  const HandleProblem problem = shapes::ProblemOf(hollow,
    [](const Eigen::Vector3d& x) { return x[2] > 0.8 ? 1
                                     : x[2] < -0.8   ? 2
                                                     : 0; }, { 1, 2 });
  VolumetricDeformer deformer = LatticeDeformer(problem);
  const HandleMotion motion = RigidMotion();
  EXPECT_LT(
    Distance(Deform(deformer, { motion, motion }).Positions, Moved(hollow.Positions, motion)),
    1e-11);
  const auto lattice = deformer.GetGraph().Nodes.bottomRows(
    deformer.GetGraph().NumberOfNodes() - hollow.NumberOfVertices());
  ASSERT_GT(lattice.rows(), 100);
}

TEST(VolumetricDeformer, FindsASpacingThatFits)
{
  const shapes::Shape shape = shapes::Icosphere(3);
  const cartan::TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  LatticeOptions options;
  options.MostPoints = 100.0;
  const auto added = [&]
  {
    return cartan::MakeLatticeGraph(mesh, shape.Positions, options).NumberOfNodes() -
      shape.NumberOfVertices();
  };
  options.OuterLayer = false;
  EXPECT_GT(added(), 50);
  EXPECT_LE(added(), 100);
  options.Spacing = 0.1;
  const std::string refusal = RefusalOf(added);
  const std::string advice = "Set LatticeSpacing to ";
  ASSERT_NE(refusal.find(advice), std::string::npos) << refusal;
  options.Spacing = std::stod(refusal.substr(refusal.find(advice) + advice.size()));
  EXPECT_GT(added(), 50);
}

TEST(VolumetricDeformer, TheLatticeIsInside)
{
  LatticeOptions options;
  options.OuterLayer = false;
  options.Spacing = 0.1;
  const shapes::Shape sphere = shapes::Icosphere(3);
  for (const shapes::Shape& shape : { sphere, shapes::Inverted(sphere) })
  {
    const cartan::TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
    const cartan::VolumeGraph graph = cartan::MakeLatticeGraph(mesh, shape.Positions, options);
    const auto lattice = graph.Nodes.bottomRows(graph.NumberOfNodes() - shape.NumberOfVertices());
    EXPECT_LT(lattice.rowwise().norm().maxCoeff(), 1.0);
    // All that is inside, but for a skin of .29 of the spacing.
    const double expected = 4.0 / 3.0 * shapes::Pi / 0.001;
    EXPECT_LT(lattice.rows(), expected);
    EXPECT_GT(lattice.rows(), 0.88 * expected);
    std::set<int> joined;
    for (Eigen::Index e = 0; e < graph.Edges.rows(); ++e)
    {
      if (graph.Edges(e, 1) >= shape.NumberOfVertices())
      {
        joined.insert(graph.Edges(e, 0));
      }
    }
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      EXPECT_EQ(joined.count(v), 1u) << v;
    }
  }
}

TEST(VolumetricDeformer, ThinPartsAreHeldTogether)
{
  // A plate thinner than the lattice: no lattice point fits in.
  const shapes::Shape plate = shapes::Bar(10, 1, 10, { 2.0, 0.02, 2.0 });
  const HandleProblem problem = shapes::ProblemOf(plate,
    [](const Eigen::Vector3d& x) { return x[2] < 0.1            ? 2
                                     : x[2] > 1.9 && x[1] > 0.0 ? 1
                                                                : 0; },
    { 1 });
  LatticeOptions options;
  options.OuterLayer = false;
  VolumetricDeformer deformer = LatticeDeformer(problem, options);
  EXPECT_EQ(deformer.GetGraph().NumberOfNodes(), plate.NumberOfVertices());
  // One side is lifted at an end; the other stays at it.
  HandleMotion lift;
  lift.Translation = { 0.0, 0.5, 0.0 };
  const Points lifted = Deform(deformer, { lift }).Positions;
  for (int v = 0; v < plate.NumberOfVertices(); ++v)
  {
    for (int w = 0; w < v; ++w)
    {
      const Eigen::RowVector3d across = plate.Positions.row(v) - plate.Positions.row(w);
      if (std::abs(across[0]) + std::abs(across[2]) < 1e-9)
      {
        EXPECT_NEAR((lifted.row(v) - lifted.row(w)).norm(), 0.02, 0.002);
      }
    }
  }
}

TEST(VolumetricDeformer, WeightsOfARegularTetrahedronIntegrateSquaredGradients)
{
  Points corners(4, 3);
  corners << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  cartan::Tetrahedra cells(1, 4);
  cells << 0, 1, 2, 3;
  const cartan::VolumeGraph graph = cartan::MakeTetrahedronGraph(corners, cells);
  Eigen::Matrix3d gradient;
  gradient << 0.3, -1.0, 0.2, 0.7, 0.1, 2.0, -0.4, 0.6, 1.5;
  double energy = 0.0;
  for (Eigen::Index e = 0; e < graph.Edges.rows(); ++e)
  {
    const Eigen::Vector3d edge = corners.row(graph.Edges(e, 0)) - corners.row(graph.Edges(e, 1));
    energy += graph.Weights[e] * (gradient * edge).squaredNorm();
  }
  const double volume = 8.0 / 3.0;
  EXPECT_NEAR(energy * std::sqrt(8.0), volume * gradient.squaredNorm(), 1e-12);
}

TEST(VolumetricDeformer, ResultsScaleAndDoNotDependOnThreads)
{
  const HandleProblem problem = Bar();
  const HandleMotion bend = shapes::BendOfBar(120.0);
  for (const auto weights : { cartan::LaplacianWeights::Uniform,
         cartan::LaplacianWeights::Cotangent, cartan::LaplacianWeights::MeanValue })
  {
    LatticeOptions options;
    options.Weights = weights;
    VolumetricDeformer deformer = LatticeDeformer(problem, options);
    const Points result = Deform(deformer, { bend }).Positions;
    EXPECT_TRUE(Deform(deformer, { bend }, shapes::ManyThreads(3)).Positions == result);
    HandleProblem tiny = problem;
    tiny.Rest = std::make_shared<const Points>(1e-9 * *problem.Rest);
    VolumetricDeformer ofTiny = LatticeDeformer(tiny, options);
    HandleMotion tinyBend = bend;
    tinyBend.Translation *= 1e-9;
    EXPECT_LT(Distance(1e9 * Deform(ofTiny, { tinyBend }).Positions, result), 1e-9);
  }
}

TEST(VolumetricDeformer, RefusesWhatHasNoInsideAndLatticesThatAreTooFine)
{
  const auto refusal = [](const shapes::Shape& shape, double spacing)
  {
    return RefusalOf(
      [&]
      {
        LatticeOptions options;
        options.Spacing = spacing;
        const cartan::TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
        cartan::MakeLatticeGraph(mesh, shape.Positions, options);
      });
  };
  EXPECT_NE(refusal(shapes::OpenCylinder(8, 4), 0.0).find("16 border points"), std::string::npos);
  EXPECT_NE(refusal(shapes::Icosphere(1), 1e-3).find("Set LatticeSpacing to"), std::string::npos);
  EXPECT_NE(refusal(shapes::Icosphere(1), 1e-200).find("Set LatticeSpacing to"), std::string::npos);
  // A wire has few points inside, but its box has one layer at least in each direction.
  const shapes::Shape wire = shapes::Bar(1, 1, 4, { 1e-8, 1e-8, 1e3 });
  EXPECT_NE(refusal(wire, 1e-6).find("in a box of 1e+09"), std::string::npos)
    << refusal(wire, 1e-6);
  EXPECT_EQ(refusal(wire, 1e-3), "");
  shapes::Shape flat = shapes::Icosphere(1);
  flat.Positions.col(2).setZero();
  EXPECT_NE(refusal(flat, 0.0).find("encloses no volume"), std::string::npos);
}

/// A bar that is curled so that its ends all but touch: the outer layer is of many heights.
TEST(VolumetricDeformer, OrderOfVerticesDoesNotMatter)
{
  const shapes::Shape bar = shapes::Noisy(shapes::Bar(3, 3, 18, { 1.0, 1.0, 6.0 }, true), 0.01);
  HandleProblem problem = shapes::ProblemOf(bar, shapes::EndsOfBar(), { 1 });
  const double lowest = bar.Positions.col(2).minCoeff();
  shapes::Shape curled = bar;
  for (Eigen::Index v = 0; v < curled.Positions.rows(); ++v)
  {
    const double angle = shapes::Pi * (bar.Positions(v, 2) - lowest) / 6.0;
    const double arm = 0.62 + bar.Positions(v, 1) - bar.Positions.col(1).mean();
    curled.Positions.row(v) << bar.Positions(v, 0), arm * std::cos(angle), arm * std::sin(angle);
  }
  problem.Rest = std::make_shared<const Points>(curled.Positions);
  const shapes::Shape backwards = shapes::Backwards(curled);
  HandleProblem other = problem;
  other.Mesh =
    std::make_shared<const cartan::TriangleMesh>(backwards.NumberOfVertices(), backwards.Faces);
  other.Rest = std::make_shared<const Points>(backwards.Positions);
  std::reverse(other.Handle.begin(), other.Handle.end());
  HandleMotion motion = RigidMotion();
  motion.Translation = { 0.2, -0.1, 0.3 };
  VolumetricDeformer first = LatticeDeformer(problem);
  VolumetricDeformer second = LatticeDeformer(other);
  const Points expected = Deform(first, { motion }).Positions;
  const Points found = Deform(second, { motion }).Positions.colwise().reverse();
  EXPECT_GT(Distance(expected, curled.Positions), 0.1);
  EXPECT_LT(Distance(found, expected), 1e-9);
}
}
