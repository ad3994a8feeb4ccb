// SPDX-License-Identifier: BSD-3-Clause
#include "Backwards.h"
#include "Kernel/Differential/Curvature.h"
#include "Kernel/Measure/ShapeDistance.h"
#include "MeasureShapes.h"

#include <gtest/gtest.h>

/// A measure is of a surface: the order of points and triangles says nothing, however many
/// points there are around one.
namespace
{
using cartan::Points;
using shapes::Shape;

/// Uneven, with poles of many neighbors and triangles that are long and thin there.
Shape Uneven(int meridians)
{
  return shapes::Noisy(shapes::UvSphere(meridians, 9), 0.004);
}

Points Bent(const Points& points)
{
  Points bent = points;
  bent.col(0).array() += 0.2 * points.col(2).array().square();
  return bent;
}

void ExpectSameBackwards(const Eigen::VectorXd& values, const Eigen::VectorXd& backwards)
{
  const double size = values.cwiseAbs().maxCoeff();
  EXPECT_LT((values - backwards.reverse()).cwiseAbs().maxCoeff(), 1e-9 * size);
}

class PointOrder : public ::testing::TestWithParam<int>
{
};

TEST_P(PointOrder, SaysNothingAboutMeasures)
{
  const Shape shape = Uneven(GetParam());
  const Shape backwards = shapes::Backwards(shape);
  const cartan::TriangleMesh mesh = shapes::MakeMesh(shape);
  const cartan::TriangleMesh other = shapes::MakeMesh(backwards);
  const cartan::Curvatures curvatures = cartan::FitCurvatures(mesh, shape.Positions);
  const cartan::Curvatures others = cartan::FitCurvatures(other, backwards.Positions);
  ExpectSameBackwards(curvatures.Mean, others.Mean);
  ExpectSameBackwards(curvatures.Gaussian, others.Gaussian);
  ExpectSameBackwards(
    cartan::MeasureShapeDistance(mesh, shape.Positions, Bent(shape.Positions)).Density,
    cartan::MeasureShapeDistance(other, backwards.Positions, Bent(backwards.Positions)).Density);
}

// Below and above the neighbors that are all taken, and of which only some are.
INSTANTIATE_TEST_SUITE_P(Meridians, PointOrder, ::testing::Values(12, 31, 40, 70));
}
