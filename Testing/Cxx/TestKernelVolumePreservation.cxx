// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Measure/VolumeModel.h"

#include "AllTriangles.h"
#include "Kernel/Deformation/FrameDeformer.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Measure/VolumeClosing.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>

using namespace cartan;

namespace
{
const double HalfAngle = 15.0 * shapes::Pi / 180.0;

VolumeModel ModelOf(const shapes::Shape& shape, const ExecutionContext& context = {})
{
  return MeasureVolumeModel(
    shapes::MakeMesh(shape), shape.Positions, shapes::CastThroughAll(shape), context);
}

/// The mean length of one ray along the axis of the cone and of six on it, for
/// a body that makes `along` of an inward ray and `mean` of the others.
double ConeMean(double along, double mean)
{
  return (along + 6.0 * mean) / 7.0;
}

/// A closed cylinder about the z axis: the parallels of a sphere moved to equal
/// heights and widths, but for `caps` at both ends, which fill the lids.
shapes::Shape ClosedCylinder(int around, int along, int caps, double radius, double length)
{
  shapes::Shape cylinder = shapes::UvSphere(around, along + 2 * caps);
  cylinder.Positions.row(0) << 0.0, 0.0, 0.5 * length;
  cylinder.Positions.row(1) << 0.0, 0.0, -0.5 * length;
  for (int j = 0; j < along + 2 * caps; ++j)
  {
    const int inner = std::min(std::max(j - caps, 0), along - 1);
    const int outward = std::min({ j + 1, along + 2 * caps - j, caps + 1 });
    const double width = radius * outward / (caps + 1);
    for (int i = 0; i < around; ++i)
    {
      const double angle = 2.0 * shapes::Pi * i / around;
      cylinder.Positions.row(2 + j * around + i) << width * std::cos(angle),
        width * std::sin(angle), length * (0.5 - static_cast<double>(inner) / (along - 1));
    }
  }
  return cylinder;
}

/// Eq. 13 as it is printed, with its three cases.
double PrintedColumnHeight(double phi, double k1, double k2)
{
  if (k1 == 0.0 && k2 == 0.0)
  {
    return phi;
  }
  if (k1 == 0.0 || k2 == 0.0)
  {
    const double a = 1.0 / (k1 + k2) - phi;
    return (phi * phi / 2.0 + a * phi) / (a + phi);
  }
  const double a1 = 1.0 / k1 - phi;
  const double a2 = 1.0 / k2 - phi;
  return (phi * phi * phi / 3.0 + (a1 + a2) * phi * phi / 2.0 + a1 * a2 * phi) /
    ((a1 + phi) * (a2 + phi));
}

double VolumeOf(const TriangleMesh& mesh, const Points& points, int component = 0)
{
  return MeasureComponents(mesh, points)[component].Volume;
}
}

TEST(ColumnHeight, IsTheExactVolumePerAreaUnderPlaneCylinderAndSphere)
{
  const double radius = 1.7;
  for (const double phi : { 0.1, 0.5, 1.1, radius })
  {
    EXPECT_DOUBLE_EQ(ColumnHeight(phi, 0.0, 0.0), phi);
    EXPECT_NEAR(ColumnHeight(phi, 1.0 / radius, 0.0),
      (radius * radius - std::pow(radius - phi, 2)) / (2.0 * radius), 1e-14);
    EXPECT_NEAR(ColumnHeight(phi, 1.0 / radius, 1.0 / radius),
      (std::pow(radius, 3) - std::pow(radius - phi, 3)) / (3.0 * radius * radius), 1e-14);
    // The same bodies from the inside: the columns spread.
    EXPECT_NEAR(ColumnHeight(phi, -1.0 / radius, 0.0),
      (std::pow(radius + phi, 2) - radius * radius) / (2.0 * radius), 1e-14);
    EXPECT_NEAR(ColumnHeight(phi, -1.0 / radius, -1.0 / radius),
      (std::pow(radius + phi, 3) - std::pow(radius, 3)) / (3.0 * radius * radius), 1e-14);
  }
  EXPECT_NEAR(ColumnHeight(radius, 1.0 / radius, 1.0 / radius), radius / 3.0, 1e-15);
}

TEST(ColumnHeight, IntegratesToTheVolumeBetweenTwoTori)
{
  const double major = 2.0;
  const double minor = 0.7;
  const double phi = 0.4;
  double volume = 0.0;
  const int count = 1000;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * shapes::Pi * i / count;
    const double toAxis = major + minor * std::cos(angle);
    volume += ColumnHeight(phi, 1.0 / minor, std::cos(angle) / toAxis) *
      (2.0 * shapes::Pi * toAxis) * (2.0 * shapes::Pi * minor / count);
  }
  const double exact =
    2.0 * shapes::Pi * shapes::Pi * major * (minor * minor - std::pow(minor - phi, 2));
  EXPECT_NEAR(volume, exact, 1e-12 * exact);
}

TEST(ColumnHeight, IsThePrintedFormulaWithoutItsCases)
{
  for (const double phi : { 0.05, 0.3 })
  {
    for (const double k1 : { -1.3, 0.0, 0.4, 1.1 })
    {
      for (const double k2 : { -0.7, 0.0, 0.9 })
      {
        EXPECT_NEAR(ColumnHeight(phi, k1, k2), PrintedColumnHeight(phi, k1, k2), 1e-14);
      }
    }
  }
}

TEST(ColumnHeight, SolvesTheOrdinaryDifferentialEquationOfTheColumn)
{
  // Eq. 10, dh/dt = 1 - h div e_3, outward from the bottom of the column, where
  // the curvatures are those of the parallel surfaces.
  const double k1 = 0.8;
  const double k2 = -0.5;
  const auto parallel = [](double k, double depth) { return k / (1.0 - k * depth); };
  const auto height = [&](double t)
  {
    const double above = 1.0 - t; // what lies between this surface and the outermost
    return ColumnHeight(t, parallel(k1, above), parallel(k2, above));
  };
  for (const double t : { 0.2, 0.5, 0.9 })
  {
    const double step = 1e-5;
    const double derivative = (height(t + step) - height(t - step)) / (2.0 * step);
    const double divergence = parallel(k1, 1.0 - t) + parallel(k2, 1.0 - t);
    EXPECT_NEAR(derivative, 1.0 - height(t) * divergence, 1e-9);
  }
}

TEST(ColumnDepth, IsHalfTheDepthOrHalfASmallerPositiveRadius)
{
  EXPECT_DOUBLE_EQ(ColumnDepth(3.0, 0.0, 0.0), 1.5);
  EXPECT_DOUBLE_EQ(ColumnDepth(3.0, -100.0, -5.0), 1.5);
  EXPECT_DOUBLE_EQ(ColumnDepth(3.0, 2.0, -5.0), 0.25);
  EXPECT_DOUBLE_EQ(ColumnDepth(3.0, 2.0, 4.0), 0.125);
}

TEST(VolumeGradient, AgreesWithDifferencesOfTheVolume)
{
  const shapes::Shape shape = shapes::Noisy(
    shapes::Union(shapes::Icosphere(1), shapes::Bar(2, 3, 4, { 1.0, 2.0, 3.0 })), 0.1);
  const TriangleMesh mesh = shapes::MakeMesh(shape);
  const Points gradient = VolumeGradient(mesh, shape.Positions);
  const auto volume = [&](const Points& points)
  { return VolumeOf(mesh, points, 0) + VolumeOf(mesh, points, 1); };
  for (Eigen::Index i = 0; i < shape.Positions.size(); ++i)
  {
    // The volume is linear in each coordinate: any step is exact.
    Points above = shape.Positions;
    Points below = shape.Positions;
    above.data()[i] += 0.5;
    below.data()[i] -= 0.5;
    EXPECT_NEAR(gradient.data()[i], volume(above) - volume(below), 1e-12);
  }
  EXPECT_LT(gradient.colwise().sum().norm(), 1e-13);
}

TEST(VolumeClosingSteps, GiveEachComponentTheVolumeAskedFor)
{
  const shapes::Shape shape =
    shapes::Union(shapes::Icosphere(3), shapes::Bar(4, 4, 8, { 1.0, 1.0, 3.0 }));
  const TriangleMesh mesh = shapes::MakeMesh(shape);
  const Points direction =
    shapes::Noisy({ VertexNormals(mesh, shape.Positions), shape.Faces }, 0.3).Positions;
  const std::vector<double> asked = { 5.0, 2.5 };
  const auto closed = [&](const std::vector<double>& steps)
  {
    Points points = shape.Positions;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      points.row(v) += steps[mesh.Component(v)] * direction.row(v);
    }
    return points;
  };

  const auto both = VolumeClosingSteps(mesh, shape.Positions, direction, { 1, 1 }, asked);
  EXPECT_NEAR(VolumeOf(mesh, closed(both), 0), asked[0], 1e-13);
  EXPECT_NEAR(VolumeOf(mesh, closed(both), 1), asked[1], 1e-13);

  const auto one = VolumeClosingSteps(mesh, shape.Positions, direction, { 0, 1 }, asked);
  EXPECT_EQ(one[0], 0.0);
  EXPECT_EQ(one[1], both[1]);
}

TEST(VolumeClosingSteps, AreZeroWhereTheDirectionCannotReachTheVolume)
{
  const shapes::Shape sphere = shapes::Icosphere(3);
  const TriangleMesh mesh = shapes::MakeMesh(sphere);
  const double volume = VolumeOf(mesh, sphere.Positions);
  const Points still = Points::Zero(sphere.Positions.rows(), 3);
  EXPECT_EQ(VolumeClosingSteps(mesh, sphere.Positions, still, { 1 }, { 2.0 * volume })[0], 0.0);

  // Along x and -y the volume is that of an ellipsoid, (1 + q) (1 - q), of which
  // there is never more than there is now.
  Points saddle = sphere.Positions;
  saddle.col(1) *= -1.0;
  saddle.col(2).setZero();
  saddle.row(0) *= 1.0 + 1e-6; // so that the first derivative is not zero
  EXPECT_EQ(VolumeClosingSteps(mesh, sphere.Positions, saddle, { 1 }, { 2.0 * volume })[0], 0.0);
}

TEST(VolumeClosingSteps, KeepTheirDigitsFarAway)
{
  const shapes::Shape bar = shapes::Bar(3, 3, 9, { 1.0, 1.0, 3.0 });
  const TriangleMesh mesh = shapes::MakeMesh(bar);
  const Points direction = VertexNormals(mesh, bar.Positions);
  const Points far = bar.Positions.rowwise() + Eigen::RowVector3d(3e5, -2e5, 1e5);
  const double q = VolumeClosingSteps(mesh, bar.Positions, direction, { 1 }, { 3.3 })[0];
  EXPECT_GT(q, 0.01);
  EXPECT_NEAR(VolumeClosingSteps(mesh, far, direction, { 1 }, { 3.3 })[0], q, 1e-9);
}

TEST(LocalDepth, OfABarIsItsThicknessAsTheConeSeesIt)
{
  const shapes::Shape bar = shapes::Bar(6, 6, 24, { 1.0, 1.0, 4.0 });
  const VolumeModel model = ModelOf(bar);
  int checked = 0;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d p = bar.Positions.row(v);
    const bool isMiddleOfSide =
      std::abs(std::abs(p[0]) - 0.5) < 1e-12 && std::abs(p[1]) < 0.2 && p[2] > 0.5 && p[2] < 3.5;
    if (isMiddleOfSide)
    {
      EXPECT_NEAR(model.LocalDepth[v], ConeMean(1.0, 1.0 / std::cos(HalfAngle)), 1e-6);
      ++checked;
    }
    EXPECT_TRUE(model.IsMeasured[v]);
  }
  EXPECT_GT(checked, 50);
}

TEST(LocalDepth, OfASphereIsTheMeanOfItsChords)
{
  const shapes::Shape sphere = shapes::Icosphere(3, 2.0);
  const VolumeModel model = ModelOf(sphere);
  const double exact = ConeMean(4.0, 4.0 * std::cos(HalfAngle));
  for (int v = 0; v < sphere.NumberOfVertices(); ++v)
  {
    EXPECT_NEAR(model.LocalDepth[v], exact, 0.01 * exact);
    EXPECT_NEAR(model.Offsets.row(v).norm(), 0.5 * exact, 0.01 * exact);
  }
  EXPECT_NEAR(model.Volumes[0], VolumeOf(shapes::MakeMesh(sphere), sphere.Positions), 1e-13);
}

TEST(LocalDepth, OfACylinderIsItsDiameterAndItsMiddleTheAxis)
{
  // Chords across get shorter as much as those along get longer: with t the
  // turn about the normal, the mean of cos a / (cos^2 a + sin^2 a cos^2 t) is 1.
  const double radius = 0.6;
  const shapes::Shape cylinder = ClosedCylinder(48, 40, 4, radius, 6.0);
  const VolumeModel model = ModelOf(cylinder);
  int checked = 0;
  for (int v = 0; v < cylinder.NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d p = cylinder.Positions.row(v);
    if (std::abs(p[2]) < 2.0)
    {
      EXPECT_NEAR(model.LocalDepth[v], 2.0 * radius, 0.01 * radius);
      const Eigen::Vector3d middle = p - model.Offsets.row(v).transpose();
      EXPECT_LT(middle.head<2>().norm(), 0.02 * radius);
      EXPECT_NEAR(middle[2], p[2], 0.01 * radius);
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(LocalDepth, OfATorusIsTheMeanOfTheChordsOfTheExactTorus)
{
  const double major = 2.0;
  const double minor = 0.7;
  const shapes::Shape torus = shapes::Torus(72, 36, major, minor);
  const VolumeModel model = ModelOf(torus);
  // Where a ray from the surface inward leaves the exact torus.
  const auto chord = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
  {
    const auto inside = [&](double s)
    {
      const Eigen::Vector3d p = from + s * direction;
      return std::hypot(p.head<2>().norm() - major, p[2]) < minor;
    };
    double below = 0.01;
    while (inside(below + 0.01))
    {
      below += 0.01;
    }
    double above = below + 0.01;
    for (int step = 0; step < 40; ++step)
    {
      (inside(0.5 * (below + above)) ? below : above) = 0.5 * (below + above);
    }
    return below;
  };
  for (int j = 0; j < 36; ++j)
  {
    const double angle = 2.0 * shapes::Pi * j / 36;
    const Eigen::Vector3d normal(std::cos(angle), 0.0, std::sin(angle));
    const Eigen::Vector3d point = Eigen::Vector3d(major, 0.0, 0.0) + minor * normal;
    const Eigen::Vector3d side = Eigen::Vector3d::UnitY();
    double mean = 0.0;
    const int turns = 60;
    for (int turn = 0; turn < turns; ++turn)
    {
      const double t = 2.0 * shapes::Pi * turn / turns;
      mean += chord(point,
                -std::cos(HalfAngle) * normal +
                  std::sin(HalfAngle) * (std::cos(t) * side + std::sin(t) * normal.cross(side))) /
        turns;
    }
    const double exact = ConeMean(chord(point, -normal), mean);
    EXPECT_NEAR(model.LocalDepth[72 * j], exact, 0.01 * exact) << "at " << angle;
  }
}

TEST(LocalDepth, TakesOneRayPerVertexAndPerNeighbor)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  const TriangleMesh mesh = shapes::MakeMesh(sphere);
  std::atomic<int> rays(0);
  const RayCaster cast = shapes::CastThroughAll(sphere);
  MeasureVolumeModel(mesh, sphere.Positions,
    [&](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
    {
      ++rays;
      return cast(from, direction);
    });
  EXPECT_EQ(rays, mesh.NumberOfVertices() + mesh.NumberOfDirectedEdges());
}

TEST(LocalDepth, GrowsWithTheSurface)
{
  const shapes::Shape unit = shapes::Noisy(shapes::Icosphere(2), 0.05);
  const VolumeModel expected = ModelOf(unit);
  for (const double size : { 1e-9, 1e6 })
  {
    shapes::Shape scaled = unit;
    scaled.Positions *= size;
    const VolumeModel model = ModelOf(scaled);
    EXPECT_LT((model.LocalDepth / size - expected.LocalDepth).norm(), 1e-9);
    EXPECT_LT((model.Offsets / size - expected.Offsets).norm(), 1e-9);
  }
}

TEST(LocalDepth, IsFilledInHarmonicallyWhereNoRayLeaves)
{
  const double radius = 0.6;
  const shapes::Shape cylinder = ClosedCylinder(24, 40, 2, radius, 6.0);
  const TriangleMesh mesh = shapes::MakeMesh(cylinder);
  const RayCaster cast = shapes::CastThroughAll(cylinder);
  const VolumeModel model = MeasureVolumeModel(mesh, cylinder.Positions,
    [&](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
    { return std::abs(from[2]) < 1.0 ? RayHit() : cast(from, direction); });
  int filled = 0;
  for (int v = 0; v < cylinder.NumberOfVertices(); ++v)
  {
    if (!model.IsMeasured[v])
    {
      EXPECT_LT(std::abs(cylinder.Positions(v, 2)), 1.0);
      EXPECT_NEAR(model.LocalDepth[v], 2.0 * radius, 0.02 * 2.0 * radius);
      ++filled;
    }
  }
  EXPECT_GT(filled, 200);
}

TEST(LocalDepth, LeavesOutRaysThatMeetASurfaceFromOutside)
{
  // A ball inside a ball: the ray along the outer one's normal runs into the
  // inner one, those of the cone pass by.
  const shapes::Shape inner = shapes::Icosphere(3, 0.45);
  const shapes::Shape outer = shapes::Icosphere(3, 2.0);
  const VolumeModel model = ModelOf(shapes::Union(outer, inner));
  const double passing = 4.0 * std::cos(HalfAngle);
  for (int v = 0; v < outer.NumberOfVertices(); ++v)
  {
    EXPECT_NEAR(model.LocalDepth[v], passing, 0.01 * passing);
  }
  EXPECT_NEAR(
    model.LocalDepth[outer.NumberOfVertices()], ConeMean(0.9, 0.9 * std::cos(HalfAngle)), 0.01);
}

TEST(VolumeModel, DoesNotDependOnTheThreads)
{
  const shapes::Shape shape = shapes::Noisy(shapes::Icosphere(3), 0.03);
  // Ranges of seven, every second from another thread, the last first.
  const ExecutionContext threads(
    [](int n, const ExecutionContext::Range& body)
    {
      std::thread other(
        [&]
        {
          for (int begin = 7; begin < n; begin += 14)
          {
            body(begin, std::min(begin + 7, n));
          }
        });
      for (int begin = (n - 1) / 14 * 14; begin >= 0; begin -= 14)
      {
        body(begin, std::min(begin + 7, n));
      }
      other.join();
    },
    nullptr);
  const VolumeModel expected = ModelOf(shape);
  const VolumeModel model = ModelOf(shape, threads);
  EXPECT_EQ(model.LocalDepth, expected.LocalDepth);
  EXPECT_EQ(model.Offsets, expected.Offsets);
}

TEST(VolumeModel, OfAComponentDoesNotDependOnTheOthers)
{
  const shapes::Shape small = shapes::Noisy(shapes::Icosphere(2, 0.2), 0.01);
  shapes::Shape large = shapes::Icosphere(3, 3.0);
  large.Positions.col(0).array() += 10.0;
  const VolumeModel alone = ModelOf(small);
  const VolumeModel together = ModelOf(shapes::Union(small, large));
  const int count = small.NumberOfVertices();
  EXPECT_LT((together.LocalDepth.head(count) - alone.LocalDepth).norm(), 1e-5);
  EXPECT_LT((together.Offsets.topRows(count) - alone.Offsets).norm(), 1e-5);
}

TEST(VolumeModel, LeavesOutComponentsThatEncloseNothingAndSaysWhy)
{
  shapes::Shape inverted = shapes::Inverted(shapes::Icosphere(1));
  inverted.Positions.col(0).array() += 5.0;
  shapes::Shape open = shapes::OpenCylinder(12, 6);
  open.Positions.col(0).array() -= 5.0;
  const shapes::Shape sphere = shapes::Icosphere(1);
  const shapes::Shape all = shapes::Union(shapes::Union(sphere, inverted), open);
  const VolumeModel model = ModelOf(all);
  ASSERT_FALSE(model.IsEmpty());
  EXPECT_EQ(model.EnclosesVolume, std::vector<char>({ 1, 0, 0 }));
  EXPECT_NE(model.Warning.find("1 open component (id 2)"), std::string::npos) << model.Warning;
  EXPECT_NE(
    model.Warning.find("1 component (id 1) that are oriented inside out"), std::string::npos)
    << model.Warning;
  const int count = all.NumberOfVertices() - sphere.NumberOfVertices();
  EXPECT_TRUE(model.LocalDepth.tail(count).isZero(0.0));
  EXPECT_TRUE(model.Offsets.bottomRows(count).isZero(0.0));
  EXPECT_GT(model.LocalDepth.head(sphere.NumberOfVertices()).minCoeff(), 1.5);

  EXPECT_TRUE(ModelOf(open).IsEmpty());
  EXPECT_TRUE(ModelOf(inverted).IsEmpty());
}

TEST(VolumeModel, IsEmptyAndSaysSoWhereNoRayFindsTheInside)
{
  const shapes::Shape sphere = shapes::Icosphere(1);
  const VolumeModel model = MeasureVolumeModel(shapes::MakeMesh(sphere), sphere.Positions,
    [](const Eigen::Vector3d&, const Eigen::Vector3d&) { return RayHit(); });
  EXPECT_TRUE(model.IsEmpty());
  EXPECT_NE(model.Warning.find("no ray"), std::string::npos) << model.Warning;
}

namespace
{
/// A bar that is pinned at one end and held by handle 2 at the other.
struct Bar
{
  explicit Bar(bool constrainPositions)
  {
    const shapes::Shape shape = shapes::Bar(4, 4, 16, { 1.0, 1.0, 4.0 });
    this->Problem.Mesh = std::make_shared<TriangleMesh>(shapes::MakeMesh(shape));
    this->Problem.Rest = std::make_shared<Points>(shape.Positions);
    this->Problem.Handle.assign(shape.NumberOfVertices(), 0);
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      const double z = shape.Positions(v, 2);
      this->Problem.Handle[v] = z < 0.6 ? 1 : (z > 3.4 ? 2 : 0);
    }
    this->Problem.Moving = { 2 };
    this->Problem.ConstrainPositions = constrainPositions;
    const RayCaster cast = shapes::CastThroughAll(shape);
    this->Model =
      std::make_shared<VolumeModel>(MeasureVolumeModel(*this->Problem.Mesh, shape.Positions,
        [this, cast](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
        {
          ++this->Rays;
          return cast(from, direction);
        }));
  }

  Points Deform(FrameDeformer& deformer, const Eigen::Matrix3d& linear)
  {
    HandleTargets targets;
    targets.Motions.resize(1);
    targets.Motions[0].Linear = linear;
    deformer.Deform(targets, false, this->Result, {});
    return this->Result.Positions;
  }

  HandleProblem Problem;
  std::shared_ptr<const VolumeModel> Model;
  std::atomic<int> Rays{ 0 };
  DeformedSurface Result;
};
}

TEST(NeutralOffset, IsLinearInTheFrames)
{
  for (const bool constrainPositions : { true, false })
  {
    Bar bar(constrainPositions);
    RotationInvariantDeformer deformer(bar.Problem);
    deformer.SetFrameProjection(FrameProjection::None);
    deformer.SetVolumeModel(bar.Model);
    deformer.SetVolumeCorrection(VolumeCorrection::NeutralOffset);
    const Eigen::Matrix3d a = shapes::RandomRigidMotion(1).Rotation;
    const Eigen::Matrix3d b = shapes::RandomRigidMotion(2).Rotation;
    const Points ofA = bar.Deform(deformer, a);
    const Points ofB = bar.Deform(deformer, b);
    const Points ofBoth = bar.Deform(deformer, 0.3 * a + 0.7 * b);
    EXPECT_LT((0.3 * ofA + 0.7 * ofB - ofBoth).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(NeutralOffset, ActsOnlyWhereTheFramesBend)
{
  // On a straight bar, o is the same all along; frames R = I + h (A - I) with a
  // linear h then need no correction, as the sum over the edges shows.
  // Projected on rotations they are curved, and the inside and outside of the
  // bend change places with the middle.
  Bar bar(true);
  RotationInvariantDeformer deformer(bar.Problem);
  deformer.SetVolumeModel(bar.Model);
  const auto effect = [&](FrameProjection projection)
  {
    const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
    deformer.SetFrameProjection(projection);
    deformer.SetVolumeCorrection(VolumeCorrection::None);
    const Points without = bar.Deform(deformer, turn);
    deformer.SetVolumeCorrection(VolumeCorrection::NeutralOffset);
    return (bar.Deform(deformer, turn) - without).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(effect(FrameProjection::None), 0.02);
  EXPECT_GT(effect(FrameProjection::Rotation), 0.1);
}

TEST(VolumeModel, IsKeptBetweenMotions)
{
  Bar bar(true);
  const int rays = bar.Rays;
  // One against the normal, and one towards each neighbor.
  EXPECT_EQ(rays, bar.Problem.Mesh->NumberOfVertices() + bar.Problem.Mesh->NumberOfDirectedEdges());
  RotationInvariantDeformer deformer(bar.Problem);
  deformer.SetVolumeModel(bar.Model);
  deformer.SetCloseVolume(true);
  const double rest = VolumeOf(*bar.Problem.Mesh, *bar.Problem.Rest);
  for (int motion = 1; motion <= 10; ++motion)
  {
    deformer.SetVolumeCorrection(
      motion % 2 ? VolumeCorrection::NeutralOffset : VolumeCorrection::FrameScaling);
    const Points bent = bar.Deform(
      deformer, Eigen::AngleAxisd(0.2 * motion, Eigen::Vector3d::UnitX()).toRotationMatrix());
    EXPECT_NEAR(VolumeOf(*bar.Problem.Mesh, bent), rest, 1e-12);
    EXPECT_EQ(deformer.GetWarning(), "");
  }
  EXPECT_EQ(bar.Rays, rays);
  EXPECT_EQ(deformer.GetNumberOfFactorizations(), 1);
}

TEST(FrameScaling, LeavesScalesOfOneBehindWhenItIsSwitchedOff)
{
  Bar bar(true);
  RotationInvariantDeformer deformer(bar.Problem);
  deformer.SetVolumeModel(bar.Model);
  deformer.SetVolumeCorrection(VolumeCorrection::FrameScaling);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  bar.Deform(deformer, turn);
  EXPECT_GT((bar.Result.FrameScale.array() - 1.0).abs().maxCoeff(), 0.01);
  deformer.SetVolumeCorrection(VolumeCorrection::None);
  bar.Deform(deformer, turn);
  ASSERT_EQ(bar.Result.FrameScale.size(), bar.Problem.Mesh->NumberOfVertices());
  EXPECT_EQ(bar.Result.FrameScale.minCoeff(), 1.0);
  EXPECT_EQ(bar.Result.FrameScale.maxCoeff(), 1.0);
}

TEST(FrameScaling, LeavesASurfaceThatMovesRigidlyAsItIs)
{
  Bar bar(true);
  bar.Problem.Moving = { 1, 2 };
  RotationInvariantDeformer deformer(bar.Problem);
  deformer.SetVolumeModel(bar.Model);
  deformer.SetVolumeCorrection(VolumeCorrection::FrameScaling);
  HandleTargets targets;
  targets.Motions.resize(2);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(5);
  for (HandleMotion& one : targets.Motions)
  {
    one.Linear = motion.Rotation;
    one.Translation = motion.Translation;
  }
  deformer.Deform(targets, false, bar.Result, {});
  EXPECT_LT((bar.Result.Positions - motion(*bar.Problem.Rest)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(CloseVolume, SaysWhereItCannotGiveTheVolumeBack)
{
  // All of the bar is held, and its end is blown up.
  Bar bar(true);
  for (int& handle : bar.Problem.Handle)
  {
    handle = std::max(handle, 1);
  }
  RotationInvariantDeformer deformer(bar.Problem);
  deformer.SetVolumeModel(bar.Model);
  deformer.SetCloseVolume(true);
  bar.Deform(deformer, 3.0 * Eigen::Matrix3d::Identity());
  EXPECT_NE(deformer.GetWarning().find("could not be closed"), std::string::npos)
    << deformer.GetWarning();
  bar.Deform(deformer, Eigen::Matrix3d::Identity());
  EXPECT_EQ(deformer.GetWarning(), "");
}
