// SPDX-License-Identifier: BSD-3-Clause
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/SliverRemoval.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>

/// Caps and needles must not be felt around them.
namespace
{
using cartan::DeformedSurface;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::Points;
using shapes::Shape;

constexpr int Around = 14;
constexpr int Along = 16;

/// Along z from -1 to 1, open.
Shape Tube()
{
  Shape tube = shapes::OpenCylinder(Around, Along, 0.4, 2.0);
  tube.Positions.rowwise() -= tube.Positions.colwise().mean().eval();
  return tube;
}

HandleProblem ProblemOf(const Shape& shape)
{
  HandleProblem problem;
  problem.Mesh =
    std::make_shared<const cartan::TriangleMesh>(shape.NumberOfVertices(), shape.Faces);
  problem.Rest = std::make_shared<const Points>(shape.Positions);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const double z = shape.Positions(v, 2);
    problem.Handle.push_back(z < -0.8 ? 1 : z > 0.8 ? 2 : 0);
  }
  problem.Moving = { 2 };
  return problem;
}

HandleTargets Bend(double angle = 0.9)
{
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].RotationVector = { angle, 0.0, 0.3 * angle };
  targets.Motions[0].Linear = cartan::RotationFromVector(targets.Motions[0].RotationVector);
  return targets;
}

/// Splits triangle t by a point at the barycentric coordinates, given last.
int SplitTriangle(Shape& shape, int t, const Eigen::Vector3d& weights)
{
  const Eigen::RowVector3i corners = shape.Faces.row(t);
  const int added = shape.NumberOfVertices();
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) = weights[0] * shape.Positions.row(corners[0]) +
    weights[1] * shape.Positions.row(corners[1]) + weights[2] * shape.Positions.row(corners[2]);
  const Eigen::Index count = shape.Faces.rows();
  shape.Faces.conservativeResize(count + 2, 3);
  shape.Faces.row(t) << corners[0], corners[1], added;
  shape.Faces.row(count) << corners[1], corners[2], added;
  shape.Faces.row(count + 1) << corners[2], corners[0], added;
  return added;
}

/// A point at `part` of the edge from a to b splits its triangles.
void SplitEdge(Shape& shape, int a, int b, double part)
{
  const int added = shape.NumberOfVertices();
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) =
    (1.0 - part) * shape.Positions.row(a) + part * shape.Positions.row(b);
  const Eigen::Index count = shape.Faces.rows();
  for (Eigen::Index f = 0; f < count; ++f)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int from = shape.Faces(f, i);
      const int to = shape.Faces(f, (i + 1) % 3);
      const int apex = shape.Faces(f, (i + 2) % 3);
      if ((from == a && to == b) || (from == b && to == a))
      {
        shape.Faces.row(f) << from, added, apex;
        shape.Faces.conservativeResize(shape.Faces.rows() + 1, 3);
        shape.Faces.row(shape.Faces.rows() - 1) << added, to, apex;
        break;
      }
    }
  }
}

/// A triangle about the middle of the tube.
int MiddleTriangle(const Shape& shape)
{
  int best = 0;
  double least = 1e9;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    double height = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      height += shape.Positions(shape.Faces(t, i), 2) / 3.0;
    }
    if (std::abs(height) < least)
    {
      least = std::abs(height);
      best = static_cast<int>(t);
    }
  }
  return best;
}

Points Deform(const deformers::MakeDeformer& make, const HandleProblem& problem)
{
  DeformedSurface result;
  make(problem, {})->Deform(Bend(), false, result, {});
  return result.Positions;
}

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

TEST(SliverRemoval, ComponentsKeepTheirNumbers)
{
  // The first vertex of the first component would be taken out otherwise.
  Shape cap = Tube();
  const int added = SplitTriangle(cap, MiddleTriangle(cap), { 0.4995, 0.4995, 0.001 });
  cap.Positions.row(0).swap(cap.Positions.row(added));
  for (int i = 0; i < cap.Faces.size(); ++i)
  {
    int& v = cap.Faces.data()[i];
    v = v == 0 ? added : v == added ? 0 : v;
  }
  const HandleProblem problem = ProblemOf(shapes::Union(cap, Tube()));
  const HandleProblem without = cartan::WithoutSlivers(problem);
  ASSERT_NE(without.Mesh, problem.Mesh);
  for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
  {
    EXPECT_EQ(without.Mesh->Component(v), problem.Mesh->Component(v));
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

TEST(SliverRemoval, OrderOfVerticesDoesNotMatter)
{
  // Two caps in one triangle: flipping the older one first would leave another mesh.
  Shape caps = Tube();
  const int middle = MiddleTriangle(caps);
  SplitTriangle(caps, middle, { 0.499, 0.4992, 0.0018 });
  SplitTriangle(caps, static_cast<int>(caps.Faces.rows()) - 2, { 0.498, 0.4992, 0.0028 });
  // The first vertex, which stays, is still the first.
  const int last = caps.NumberOfVertices() - 1;
  Shape reversed = caps;
  reversed.Positions.bottomRows(last) = caps.Positions.bottomRows(last).colwise().reverse().eval();
  reversed.Faces = caps.Faces.unaryExpr([last](int v) { return v > 0 ? last + 1 - v : 0; });
  for (const auto& [name, make] : deformers::All())
  {
    if (name != "SmoothedRotations") // fits one vertex after the other
    {
      const Points found = Deform(make, cartan::WithoutSlivers(ProblemOf(caps)));
      const Points other = Deform(make, cartan::WithoutSlivers(ProblemOf(reversed)));
      const auto difference = found.bottomRows(last) - other.bottomRows(last).colwise().reverse();
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9) << name;
    }
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
