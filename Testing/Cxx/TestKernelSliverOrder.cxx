// SPDX-License-Identifier: BSD-3-Clause
#include "Backwards.h"
#include "SliverShapes.h"

#include <gtest/gtest.h>

/// Which slivers are taken out must not depend on how vertices are numbered.
namespace
{
using namespace slivers;

/// Returns whether there are slivers.
bool ExpectSameBackwards(const Shape& shape, double tolerance)
{
  const HandleProblem problem = cartan::WithoutSlivers(ProblemOf(shape));
  const HandleProblem other = cartan::WithoutSlivers(ProblemOf(shapes::Backwards(shape)));
  for (const auto& [name, make] : deformers::All())
  {
    const Points difference = Deform(make, problem) - Deform(make, other).colwise().reverse();
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), tolerance) << name;
  }
  return problem.Whole != nullptr;
}

TEST(SliverRemoval, OrderOfVerticesDoesNotMatter)
{
  // Two caps in one triangle: flipping the older one first would leave another mesh.
  Shape caps = Tube();
  const int middle = MiddleTriangle(caps);
  SplitTriangle(caps, middle, { 0.499, 0.4992, 0.0018 });
  SplitTriangle(caps, static_cast<int>(caps.Faces.rows()) - 2, { 0.498, 0.4992, 0.0028 });
  EXPECT_TRUE(ExpectSameBackwards(caps, 1e-9));
}

/// Two tubes, the second with a cap at its last vertex.
Shape TubeAndTubeWithCap()
{
  Shape spoiled = Tube();
  SplitTriangle(spoiled, MiddleTriangle(spoiled), { 0.499, 0.4992, 0.0018 });
  spoiled.Positions.rowwise() += Eigen::RowVector3d(0.0, 3.0, 0.0);
  return shapes::Union(Tube(), spoiled);
}

TEST(SliverRemoval, TheFirstVertexOfAPartGoesLikeAnyOther)
{
  EXPECT_TRUE(ExpectSameBackwards(TubeAndTubeWithCap(), 1e-9));
}

TEST(SliverRemoval, PartsKeepTheirNumbersInMessages)
{
  // The last vertex becomes the first one, and its part the first part, until it goes.
  const Shape shape = TubeAndTubeWithCap();
  const int count = shape.NumberOfVertices();
  Shape turned = shape;
  turned.Positions << shape.Positions.row(count - 1), shape.Positions.topRows(count - 1);
  turned.Faces = shape.Faces.unaryExpr([&](int v) { return (v + 1) % count; });
  const HandleProblem problem = cartan::WithoutSlivers(ProblemOf(turned));
  ASSERT_EQ(problem.Riders.size(), 1u);
  EXPECT_EQ(cartan::ComponentsInWhole(problem), (std::vector<long long>{ 1, 0 }));

  const HandleProblem without = cartan::WithoutSlivers(ProblemOf(shapes::Union(Tube(), Tube())));
  EXPECT_EQ(cartan::ComponentsInWhole(without), (std::vector<long long>{ 0, 1 }));
}

TEST(SliverRemoval, OrderOfEqualSliversDoesNotMatter)
{
  // All triangles of a tube that is finely cut around and twisted are caps of equal edges,
  // whose diagonals are flipped where it is twisted the one way.
  int flipped = 0;
  for (const double twist : { 0.02, -0.02 })
  {
    Shape tube = shapes::OpenCylinder(112, 4, 0.4, 2.0);
    tube.Positions.rowwise() -= tube.Positions.colwise().mean().eval();
    for (Eigen::Index v = 0; v < tube.Positions.rows(); ++v)
    {
      const Eigen::Rotation2Dd turn(twist * tube.Positions(v, 2));
      const Eigen::Vector2d turned = turn * tube.Positions.row(v).head<2>().transpose();
      tube.Positions.row(v).head<2>() = turned.transpose();
    }
    flipped += ExpectSameBackwards(tube, 1e-7) ? 1 : 0;
  }
  EXPECT_EQ(flipped, 1);
}
}
