// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Differential/Hinges.h"

#include "Kernel/Differential/DualForest.h"
#include "Kernel/Differential/Laplacian.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>

using cartan::DualForest;
using cartan::HingeTopology;
using cartan::Points;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::MakeMesh;
using shapes::Pi;
using shapes::Shape;

TEST(HingeTopology, HasEveryEdgeOnce)
{
  for (const Shape& shape : { shapes::Icosphere(1), shapes::Plane(3), shapes::Torus(5, 4) })
  {
    const cartan::TriangleMesh mesh = MakeMesh(shape);
    const HingeTopology topology(mesh);
    EXPECT_EQ(topology.NumberOfEdges(), mesh.NumberOfEdges());
    // A triangle has three edges; hinges are those that two triangles have.
    EXPECT_EQ(topology.NumberOfEdges() + topology.NumberOfHinges(), 3 * mesh.NumberOfTriangles());
    for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
    {
      for (int corner = 0; corner < 3; ++corner)
      {
        const auto ends = topology.Edges.row(topology.CornerEdges(t, corner));
        EXPECT_EQ(std::minmax(ends[0], ends[1]),
          std::minmax(topology.Corners(t, corner), topology.Corners(t, (corner + 1) % 3)));
      }
    }
    for (const cartan::Hinge& hinge : topology.Hinges)
    {
      EXPECT_EQ(topology.CornerEdges(hinge.Left, hinge.LeftCorner), hinge.Edge);
      EXPECT_EQ(topology.CornerEdges(hinge.Right, hinge.RightCorner), hinge.Edge);
      EXPECT_EQ(topology.Corners(hinge.Left, hinge.LeftCorner),
        topology.Corners(hinge.Right, (hinge.RightCorner + 1) % 3));
    }
  }
}

TEST(LayOut, HasTheLengthsItIsMadeOf)
{
  const Shape shape = shapes::Noisy(shapes::Plane(8), 0.05);
  const HingeTopology topology(MakeMesh(shape));
  const Eigen::VectorXd lengths = cartan::EdgeLengths(topology, shape.Positions);
  const cartan::Layouts layouts = cartan::LayOut(topology, lengths);
  for (int t = 0; t < topology.NumberOfTriangles(); ++t)
  {
    const Eigen::Vector2d a = cartan::LayoutEdge(layouts, t, 0);
    const Eigen::Vector2d c = cartan::LayoutEdge(layouts, t, 2);
    for (int corner = 0; corner < 3; ++corner)
    {
      EXPECT_NEAR(cartan::LayoutEdge(layouts, t, corner).norm(),
        lengths[topology.CornerEdges(t, corner)], 1e-15);
    }
    EXPECT_EQ(a[1], 0.0);
    EXPECT_GT(c[0] * a[1] - c[1] * a[0], 0.0); // counter-clockwise
  }
}

TEST(LayOut, MakesFlatTrianglesOfLengthsThatMakeNone)
{
  const HingeTopology topology(
    MakeMesh(Shape{ shapes::ToPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }),
      shapes::ToTriangles({ { 0, 1, 2 } }) }));
  // In every order: exactly flat, flat but for rounding, and beyond.
  for (const double longest : { 0.3, 0.1 + 0.2, 0.5 })
  {
    std::vector<double> lengths = { 0.1, 0.2, longest };
    do
    {
      const cartan::Layouts layouts =
        cartan::LayOut(topology, Eigen::Map<const Eigen::VectorXd>(lengths.data(), 3));
      for (int corner = 0; corner < 3; ++corner)
      {
        EXPECT_LT(std::abs(cartan::LayoutEdge(layouts, 0, corner)[1]), 1e-16);
      }
    } while (std::next_permutation(lengths.begin(), lengths.end()));
  }
}

TEST(HingeAngles, AreSignedAndTheAnglesOfSolids)
{
  const auto angles = [](const Shape& shape)
  {
    const cartan::HingeTopology topology(MakeMesh(shape));
    return cartan::HingeAngles(
      topology, shape.Positions, cartan::HingeNormals(topology, shape.Positions));
  };
  // Between the normals of an icosahedron's faces: pi minus the dihedral angle.
  EXPECT_LT((angles(shapes::Icosphere(0)).array() - (Pi - std::acos(-std::sqrt(5.0) / 3.0)))
              .abs()
              .maxCoeff(),
    1e-13);
  const Eigen::VectorXd box = angles(shapes::Bar(1, 1, 1, { 1, 2, 3 }));
  EXPECT_EQ(box.size(), 18);
  EXPECT_EQ(((box.array() - 0.5 * Pi).abs() < 1e-13).count(), 12);
  EXPECT_EQ((box.array().abs() < 1e-13).count(), 6);
  EXPECT_LT(
    (angles(shapes::Inverted(shapes::Bar(1, 1, 1, { 1, 2, 3 }))).array() + 0.5 * Pi).maxCoeff(),
    0.5 * Pi + 1e-13);
}

TEST(HingeTransitions, GoFromTheFrameOfATriangleToItsNeighbors)
{
  const Shape shape = shapes::Noisy(shapes::Icosphere(2), 0.05);
  const cartan::HingeTopology topology(MakeMesh(shape));
  const Points normals = cartan::HingeNormals(topology, shape.Positions);
  const cartan::Matrices transitions = cartan::HingeTransitions(topology,
    cartan::LayOut(topology, cartan::EdgeLengths(topology, shape.Positions)),
    cartan::HingeAngles(topology, shape.Positions, normals));
  const auto frame = [&](int t)
  {
    const Vector3d first =
      (shape.Positions.row(topology.Corners(t, 1)) - shape.Positions.row(topology.Corners(t, 0)))
        .normalized();
    const Vector3d normal = normals.row(t);
    Matrix3d columns;
    columns << first, normal.cross(first), normal;
    return columns;
  };
  for (int h = 0; h < topology.NumberOfHinges(); ++h)
  {
    const Matrix3d expected =
      frame(topology.Hinges[h].Left).transpose() * frame(topology.Hinges[h].Right);
    EXPECT_LT((cartan::MatrixAt(transitions, h) - expected).norm(), 1e-13);
  }
}

TEST(UnwrappedAngles, TurnTheShorterWay)
{
  // Two triangles about the z axis, opened from one angle to another.
  const auto book = [](double angle)
  {
    // The normals of pages at directions a and a + pi - angle differ by `angle`.
    const double direction = Pi - angle;
    return Shape{ shapes::ToPoints({ { 0, 0, 0 }, { 0, 0, 1 },
                    { std::cos(direction), std::sin(direction), 0.5 }, { 1, 0, 0.5 } }),
      shapes::ToTriangles({ { 0, 1, 2 }, { 1, 0, 3 } }) };
  };
  const cartan::HingeTopology topology(MakeMesh(book(0.0)));
  const auto angle = [&](double of)
  {
    const Points points = book(of).Positions;
    return cartan::HingeAngles(topology, points, cartan::HingeNormals(topology, points));
  };
  const double sign = angle(1.0)[0] > 0.0 ? 1.0 : -1.0;
  const auto turn = [&](double from, double to)
  {
    const Eigen::VectorXd first = angle(sign * from);
    return (
      cartan::UnwrappedAngles(topology, book(sign * from).Positions, first, angle(sign * to)) -
      first)[0];
  };
  EXPECT_NEAR(turn(0.1, 1.1), 1.0, 1e-12);
  EXPECT_NEAR(turn(-1.0, 1.5), 2.5, 1e-12);
  // Through shut where that is shorter.
  EXPECT_NEAR(turn(3.0, -3.0), 2 * Pi - 6.0, 1e-12);
  EXPECT_NEAR(turn(-2.0, 2.0), 4.0 - 2 * Pi, 1e-12);
  // Antipodal normals: not through shut, whatever the rounding.
  EXPECT_NEAR(turn(0.5 * Pi, -0.5 * Pi), -Pi, 1e-12);
  EXPECT_NEAR(turn(-0.5 * Pi, 0.5 * Pi), Pi, 1e-12);
  EXPECT_NEAR(turn(1.0, 1.0 - Pi), -Pi, 1e-12);
  EXPECT_NEAR(turn(-1.0, Pi - 1.0), Pi, 1e-12);
  // Shut counts as pi, and opens the way it shut.
  EXPECT_NEAR(turn(0.0, Pi), Pi, 1e-12);
  EXPECT_NEAR(turn(0.0, -Pi), Pi, 1e-12);
  EXPECT_NEAR(turn(-Pi, 0.0), -Pi, 1e-12);
  EXPECT_NEAR(turn(0.0, Pi - 1e-9), Pi - 1e-9, 1e-12);
  EXPECT_NEAR(turn(0.0, 1e-9 - Pi), Pi + 1e-9, 1e-12);
}

//------------------------------------------------------------------------------
TEST(DualForest, VisitsEveryTriangleAfterItsParent)
{
  const Shape shape = shapes::Union(shapes::Icosphere(2), shapes::Plane(5));
  const HingeTopology topology(MakeMesh(shape));
  shapes::Random random(1);
  const DualForest forest(topology,
    Eigen::VectorXd::NullaryExpr(topology.NumberOfHinges(), [&random]() { return random(); }));
  EXPECT_EQ(forest.NumberOfTrees(), 2);
  EXPECT_EQ(forest.Steps.size(), static_cast<std::size_t>(topology.NumberOfTriangles()));
  std::vector<char> isVisited(topology.NumberOfTriangles(), 0);
  int roots = 0;
  for (const DualForest::Step& step : forest.Steps)
  {
    EXPECT_FALSE(isVisited[step.Triangle]);
    isVisited[step.Triangle] = 1;
    if (step.Parent < 0)
    {
      ++roots;
      continue;
    }
    EXPECT_TRUE(isVisited[step.Parent]);
    EXPECT_EQ(forest.Tree[step.Parent], forest.Tree[step.Triangle]);
    const cartan::Hinge& hinge = topology.Hinges[step.Hinge];
    EXPECT_EQ(std::minmax(hinge.Left, hinge.Right), std::minmax(step.Parent, step.Triangle));
  }
  EXPECT_EQ(roots, 2);
  EXPECT_EQ(forest.IsWhole, std::vector<char>({ 0, 0 }));
}

TEST(DualForest, LeavesOutNoHingeThatIsCheaperThanItsDetour)
{
  // What makes a spanning tree smallest.
  const HingeTopology topology(MakeMesh(shapes::Icosphere(1)));
  shapes::Random random(2);
  const Eigen::VectorXd weights =
    Eigen::VectorXd::NullaryExpr(topology.NumberOfHinges(), [&random]() { return random(); });
  const DualForest forest(topology, weights);
  std::vector<DualForest::Step> stepOf(topology.NumberOfTriangles());
  for (const DualForest::Step& step : forest.Steps)
  {
    stepOf[step.Triangle] = step;
  }
  const auto upwards = [&](int t)
  {
    std::vector<int> hinges;
    for (; stepOf[t].Parent >= 0; t = stepOf[t].Parent)
    {
      hinges.push_back(stepOf[t].Hinge);
    }
    return hinges;
  };
  for (int h = 0; h < topology.NumberOfHinges(); ++h)
  {
    std::vector<int> left = upwards(topology.Hinges[h].Left);
    std::vector<int> right = upwards(topology.Hinges[h].Right);
    while (!left.empty() && !right.empty() && left.back() == right.back())
    {
      left.pop_back();
      right.pop_back();
    }
    left.insert(left.end(), right.begin(), right.end());
    for (const int detour : left)
    {
      EXPECT_LE(weights[detour], weights[h]);
    }
  }
}

TEST(DualForest, BeginsInTheMiddleOfAStrip)
{
  shapes::PatchOptions options;
  options.CountU = 50;
  options.CountV = 1;
  const Shape strip = shapes::Patch(options, [](double u, double v) { return Vector3d(u, v, 0); });
  const HingeTopology topology(MakeMesh(strip));
  const DualForest forest(topology, Eigen::VectorXd::Zero(topology.NumberOfHinges()));
  EXPECT_EQ(forest.IsWhole, std::vector<char>({ 1 }));
  EXPECT_NEAR(forest.Steps[0].Triangle, 50, 1);
}

TEST(WalkFrames, StayRotationsHoweverLongTheWalk)
{
  shapes::PatchOptions options;
  options.CountU = 50000;
  options.CountV = 1;
  const Shape strip = shapes::Patch(options, [](double u, double v) { return Vector3d(u, v, 0); });
  const HingeTopology topology(MakeMesh(strip));
  shapes::Random random(3);
  const cartan::Matrices frames = cartan::WalkFrames(topology,
    DualForest(topology, Eigen::VectorXd::Zero(topology.NumberOfHinges())),
    cartan::HingeTransitions(topology,
      cartan::LayOut(topology, cartan::EdgeLengths(topology, strip.Positions)),
      Eigen::VectorXd::NullaryExpr(topology.NumberOfHinges(), [&random]() { return random(); })));
  for (int t = 0; t < topology.NumberOfTriangles(); ++t)
  {
    const Matrix3d frame = cartan::MatrixAt(frames, t);
    ASSERT_LT((frame.transpose() * frame - Matrix3d::Identity()).norm(), 1e-14);
    ASSERT_GT(frame.determinant(), 0.0);
  }
}

TEST(GraphLaplacian, OfTheEdgesIsThatOfTheMesh)
{
  const cartan::TriangleMesh mesh = MakeMesh(shapes::Plane(5));
  const HingeTopology topology(mesh);
  const cartan::SparseMatrix expected =
    cartan::Laplacian(mesh, Eigen::VectorXd::Constant(mesh.NumberOfDirectedEdges(), 3.0));
  const cartan::SparseMatrix matrix = cartan::GraphLaplacian(mesh.NumberOfVertices(),
    topology.Edges, Eigen::VectorXd::Constant(topology.NumberOfEdges(), 3.0));
  EXPECT_EQ((matrix - expected).norm(), 0.0);
}
