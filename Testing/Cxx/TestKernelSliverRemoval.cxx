// SPDX-License-Identifier: BSD-3-Clause
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"
#include "SliverShapes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>

/// Caps and needles must not be felt around them.
namespace
{
using namespace slivers;

void ExpectLikeClean(
  const Shape& clean, const Shape& spoiled, const std::string& what, double tolerance = 1e-9)
{
  const Eigen::Index count = clean.Positions.rows();
  for (const auto& [name, make] : deformers::All())
  {
    SCOPED_TRACE(name + ", " + what);
    const Points expected = Deform(make, ProblemOf(clean));
    const Points found = Deform(make, cartan::WithoutSlivers(ProblemOf(spoiled)));
    EXPECT_LT((found.topRows(count) - expected).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_TRUE(found.allFinite());
  }
}

TEST(SliverRemoval, CapsAreNotFelt)
{
  for (const double height : { 4e-2, 1e-4, 1e-8, 0.0 })
  {
    Shape spoiled = Tube();
    const Shape clean = spoiled;
    SplitTriangle(
      spoiled, MiddleTriangle(clean), { 0.5 * (1.0 - height), 0.5 * (1.0 - height), height });
    ExpectLikeClean(clean, spoiled, "height " + std::to_string(height));
  }
}

TEST(SliverRemoval, NeedlesAreNotFelt)
{
  for (const double part : { 3e-4, 1e-8, 0.0 })
  {
    Shape spoiled = Tube();
    const Shape clean = spoiled;
    const int t = MiddleTriangle(clean);
    SplitEdge(spoiled, clean.Faces(t, 0), clean.Faces(t, 1), part);
    ExpectLikeClean(clean, spoiled, "part " + std::to_string(part));
  }
}

/// A cap in a triangle that is one itself.
TEST(SliverRemoval, CapsInThinTrianglesAreNotFelt)
{
  for (const double height : { 3e-3, 3e-5 })
  {
    Shape thin = Tube();
    const int t = MiddleTriangle(thin);
    const int low = SplitTriangle(thin, t, { 0.5 * (1.0 - height), 0.5 * (1.0 - height), height });
    int cap = 0;
    while ((thin.Faces.row(cap).array() == low).count() == 0)
    {
      ++cap;
    }
    Shape spoiled = thin;
    SplitTriangle(spoiled, cap, { 0.4, 0.3, 0.3 });
    const Eigen::Index count = thin.Positions.rows();
    for (const auto& [name, make] : deformers::All())
    {
      const Points expected = Deform(make, cartan::WithoutSlivers(ProblemOf(thin)));
      const Points found = Deform(make, cartan::WithoutSlivers(ProblemOf(spoiled)));
      EXPECT_LT((found.topRows(count) - expected).cwiseAbs().maxCoeff(), 1e-9) << name;
    }
  }
}

/// Several needles at one vertex leave triangles that are tiny as a whole. One of
/// their points stays, not always the same.
TEST(SliverRemoval, CrowdsAreNotFelt)
{
  const Shape clean = Tube();
  const cartan::TriangleMesh mesh(clean.NumberOfVertices(), clean.Faces);
  const int center = clean.Faces(MiddleTriangle(clean), 0);
  for (const double part : { 1e-6, 1e-8, 1e-12, 0.0 })
  {
    Shape spoiled = clean;
    for (int d = mesh.RingBegin(center); d < mesh.RingEnd(center); ++d)
    {
      SplitEdge(spoiled, center, mesh.Neighbor(d), part);
    }
    ASSERT_EQ(spoiled.NumberOfVertices(), clean.NumberOfVertices() + mesh.Valence(center));
    ExpectLikeClean(clean, spoiled, "part " + std::to_string(part), 1e-9 + 0.5 * part);
  }
}

TEST(SliverRemoval, PointsRideOnTheirTriangle)
{
  Shape spoiled = Tube();
  const int t = MiddleTriangle(spoiled);
  const Eigen::RowVector3i corners = spoiled.Faces.row(t);
  const Eigen::Vector3d weights(0.495, 0.495, 0.01);
  const int added = SplitTriangle(spoiled, t, weights);
  const HandleProblem problem = cartan::WithoutSlivers(ProblemOf(spoiled));
  ASSERT_EQ(problem.Riders.size(), 1u);
  EXPECT_FALSE(problem.Mesh->IsUsed(added));
  DeformedSurface result;
  deformers::All()["RotationInvariant"](problem, {})->Deform(Bend(), true, result, {});
  Eigen::RowVector3d expected = Eigen::RowVector3d::Zero();
  Eigen::Matrix<double, 1, 9> transform = Eigen::Matrix<double, 1, 9>::Zero();
  for (int i = 0; i < 3; ++i)
  {
    expected += weights[i] * result.Positions.row(corners[i]);
    transform += weights[i] * result.Transforms.row(corners[i]);
  }
  EXPECT_LT((result.Positions.row(added) - expected).norm(), 1e-12);
  EXPECT_LT((result.Transforms.row(added) - transform).norm(), 1e-12);
}

/// Points on caps of points on caps, off the plane of their triangles.
Shape Nested()
{
  Shape shape = Tube();
  for (int k = 0; k < 12; ++k)
  {
    const int t = (7 * k) % static_cast<int>(shape.Faces.rows());
    const int added = SplitTriangle(shape, t, { 0.6, 0.39, 0.01 });
    shape.Positions.row(added) *= 1.0001;
    SplitTriangle(shape, t, { 0.3, 0.69, 0.01 });
    const int other = (5 * k + 100) % static_cast<int>(shape.Faces.rows());
    SplitEdge(shape, shape.Faces(other, 0), shape.Faces(other, 1), 1e-6);
  }
  return shape;
}

TEST(SliverRemoval, LeavesNoneWhereTheyHangOnOthers)
{
  const HandleProblem problem = cartan::WithoutSlivers(ProblemOf(Nested()));
  EXPECT_GT(problem.Riders.size(), 12u);
  const HandleProblem again = cartan::WithoutSlivers(
    [&]
    {
      HandleProblem without = problem;
      without.Whole.reset();
      without.Riders.clear();
      return without;
    }());
  EXPECT_EQ(again.Mesh, problem.Mesh);
}

TEST(SliverRemoval, KeepsWhatDoesNotMoveToTheLastBit)
{
  const HandleProblem problem = cartan::WithoutSlivers(ProblemOf(Nested()));
  DeformedSurface result;
  result.Positions = *problem.Rest;
  cartan::CarryRiders(problem.Riders, *problem.Rest, result);
  EXPECT_EQ(result.Positions, *problem.Rest);
}

TEST(SliverRemoval, CarriesRidersByRigidMotionsAndScales)
{
  const HandleProblem problem = cartan::WithoutSlivers(ProblemOf(Nested()));
  for (unsigned int seed = 1; seed <= 3; ++seed)
  {
    const shapes::RigidMotion motion = shapes::RandomRigidMotion(seed);
    const Points expected = (1.0 + seed) *
      ((*problem.Rest * motion.Rotation.transpose()).rowwise() + motion.Translation.transpose());
    DeformedSurface result;
    result.Positions = expected;
    for (const cartan::Rider& rider : problem.Riders)
    {
      result.Positions.row(rider.Vertex).setConstant(std::nan(""));
    }
    cartan::CarryRiders(problem.Riders, *problem.Rest, result);
    EXPECT_LT((result.Positions - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

/// A vertex with more than three triangles, or of a handle, stays: the cap is
/// flipped.
TEST(SliverRemoval, FlipsCapsThatCannotBeTakenOut)
{
  Shape spoiled = Tube();
  const int t = MiddleTriangle(spoiled);
  const int a = spoiled.Faces(t, 0);
  const int b = spoiled.Faces(t, 1);
  const int added = SplitTriangle(spoiled, t, { 0.4995, 0.4995, 0.001 });
  HandleProblem problem = ProblemOf(spoiled);
  problem.Handle[added] = 2;
  const HandleProblem flipped = cartan::WithoutSlivers(problem);
  EXPECT_TRUE(flipped.Riders.empty());
  EXPECT_EQ(flipped.Mesh->NumberOfTriangles(), problem.Mesh->NumberOfTriangles());
  EXPECT_EQ(flipped.Mesh->Valence(added), 4);
  EXPECT_EQ(flipped.Mesh->Valence(a), problem.Mesh->Valence(a) - 1);
  EXPECT_EQ(flipped.Mesh->Valence(b), problem.Mesh->Valence(b) - 1);
  EXPECT_EQ(flipped.Whole, problem.Mesh);
}

TEST(SliverRemoval, LeavesOutCapsAcrossTheBorder)
{
  // A square whose lower side has the cap (0, 1, 4) and a fan around 4.
  Shape shape;
  shape.Positions.resize(5, 3);
  shape.Positions << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.001, 0;
  shape.Faces.resize(4, 3);
  shape.Faces << 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4;
  HandleProblem problem = ProblemOf(shape);
  problem.Handle = { 1, 1, 2, 2, 0 };
  const HandleProblem without = cartan::WithoutSlivers(problem);
  EXPECT_EQ(without.Mesh->NumberOfTriangles(), 3);
  EXPECT_TRUE(without.Mesh->IsBoundary(4));
}

TEST(SliverRemoval, LeavesGoodMeshesAndFlatBodiesAlone)
{
  for (const Shape& shape : { Tube(), shapes::Icosphere(2), shapes::Torus(24, 12) })
  {
    const HandleProblem problem = ProblemOf(shape);
    const HandleProblem same = cartan::WithoutSlivers(problem);
    EXPECT_EQ(same.Mesh, problem.Mesh);
    EXPECT_EQ(same.Whole, nullptr);
  }
  // Four points almost in a plane: every flip or removal would close it up.
  Shape flat;
  flat.Positions.resize(4, 3);
  flat.Positions << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, 0.001, 0.001;
  flat.Faces.resize(4, 3);
  flat.Faces << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  HandleProblem problem = ProblemOf(flat);
  problem.Handle = { 1, 1, 2, 0 };
  EXPECT_EQ(cartan::WithoutSlivers(problem).Mesh, problem.Mesh);
}

/// Parts as CAD tessellates them: long fans of needles and caps.
TEST(SliverRemoval, MechanicalPartsKeepTheirSize)
{
  for (const std::string name : { "mpi", "mpi_triang", "joint", "anchor" })
  {
    Shape part = shapes::RealMesh(name);
    part.Positions.rowwise() -= part.Positions.colwise().mean().eval();
    int axis = 0;
    (part.Positions.colwise().maxCoeff() - part.Positions.colwise().minCoeff()).maxCoeff(&axis);
    const HandleProblem problem =
      cartan::WithoutSlivers(shapes::ProblemOf(part, shapes::EndsAlong(part, axis, 0.1)));
    for (const auto& [method, make] : deformers::All())
    {
      EXPECT_LT(cartan::BoundingDiagonal(Deform(make, problem)),
        1.5 * cartan::BoundingDiagonal(part.Positions))
        << name << ", " << method;
    }
  }
}

TEST(SliverRemoval, CapsOfHandlesAreNotFelt)
{
  // Of the moving handle's edge next to the free vertices.
  const Shape clean = Tube();
  const HandleProblem problem = ProblemOf(clean);
  int triangle = -1;
  int first = -1;
  for (int t = 0; t < clean.Faces.rows(); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      const auto handle = [&](int corner) { return problem.Handle[clean.Faces(t, corner % 3)]; };
      if (handle(i) == 2 && handle(i + 1) == 2 && handle(i + 2) == 0)
      {
        triangle = t;
        first = i;
      }
    }
  }
  ASSERT_GE(triangle, 0);
  Shape spoiled = clean;
  Eigen::Vector3d weights = Eigen::Vector3d::Constant(0.4999);
  weights[(first + 2) % 3] = 0.0002;
  const int added = SplitTriangle(spoiled, triangle, weights);
  HandleProblem held = ProblemOf(spoiled);
  held.Handle[added] = 2;
  const HandleProblem without = cartan::WithoutSlivers(held);
  ASSERT_EQ(without.Riders.size(), 1u);
  for (const auto& [name, make] : deformers::All())
  {
    const Points found = Deform(make, without);
    const Points difference = found.topRows(added) - Deform(make, problem);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9) << name;
    const Eigen::Vector3d rest = spoiled.Positions.row(added);
    EXPECT_LT((found.row(added).transpose() - Bend().Motions[0].Linear * rest).norm(), 1e-12)
      << name;
  }
}

TEST(SliverRemoval, VolumesAreClosedWithoutThem)
{
  Shape bar = shapes::Bar(3, 3, 12, { 0.6, 0.6, 2.0 });
  bar.Positions.rowwise() -= bar.Positions.colwise().mean().eval();
  const int added = SplitTriangle(bar, MiddleTriangle(bar), { 0.495, 0.495, 0.01 });
  bar.Positions.row(added) *= 1.001;
  const HandleProblem problem = cartan::WithoutSlivers(ProblemOf(bar));
  ASSERT_EQ(problem.Riders.size(), 1u);
  cartan::RotationInvariantDeformer deformer(problem);
  auto model = std::make_shared<cartan::VolumeModel>();
  const auto before = cartan::MeasureComponents(*problem.Mesh, *problem.Rest);
  model->LocalDepth.setConstant(problem.Rest->rows(), 0.6);
  model->EnclosesVolume = { 1 };
  model->Volumes = { before[0].Volume };
  deformer.SetVolumeModel(model);
  deformer.SetCloseVolume(true);
  DeformedSurface result;
  deformer.Deform(Bend(), false, result, {});
  const auto after = cartan::MeasureComponents(*problem.Mesh, result.Positions);
  EXPECT_NEAR(after[0].Volume / before[0].Volume, 1.0, 1e-9);
  // The sliver adds what its tetrahedron changes by.
  const auto wholeBefore = cartan::MeasureComponents(*problem.Whole, *problem.Rest);
  const auto wholeAfter = cartan::MeasureComponents(*problem.Whole, result.Positions);
  EXPECT_NEAR(wholeAfter[0].Volume / wholeBefore[0].Volume, 1.0, 1e-6);
}
}
