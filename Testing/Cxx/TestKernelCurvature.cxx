// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Differential/Curvature.h"
#include "Kernel/Mesh/Geometry.h"

#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>
#include <vector>

using namespace cartan;

namespace
{
struct Exact
{
  double Mean;
  double Gaussian;
};
using ExactCurvature = std::function<Exact(const Eigen::Vector3d&)>;

Exact OnTorus(const Eigen::Vector3d& p)
{
  const double major = 2.0;
  const double minor = 0.7;
  const double cosine = (std::hypot(p[0], p[1]) - major) / minor;
  const double alongTube = 1.0 / minor;
  const double aroundAxis = cosine / (major + minor * cosine);
  return { 0.5 * (alongTube + aroundAxis), alongTube * aroundAxis };
}

Exact OnSaddle(const Eigen::Vector3d& p)
{
  // Graph of f = (x^2 - y^2) / 2: gradient (x, -y), Hessian diag(1, -1).
  const double w = 1.0 + p[0] * p[0] + p[1] * p[1];
  return { -((1.0 + p[1] * p[1]) - (1.0 + p[0] * p[0])) / (2.0 * std::pow(w, 1.5)),
    -1.0 / (w * w) };
}

const Eigen::Vector3d HalfAxes(1.0, 1.5, 0.8);

Exact OnEllipsoid(const Eigen::Vector3d& p)
{
  const Eigen::Array3d squares = HalfAxes.array().square();
  const double g = (p.array().square() / squares.square()).sum();
  const double product = squares.prod();
  return { std::abs(p.squaredNorm() - squares.sum()) / (2.0 * product * std::pow(g, 1.5)),
    1.0 / (product * g * g) };
}

/// The largest error of the mean and Gaussian curvature over all vertices.
double LargestError(const shapes::Shape& shape, const ExactCurvature& exact)
{
  const TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  const Curvatures curvatures = FitCurvatures(mesh, shape.Positions);
  double largest = 0.0;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    const Exact expected = exact(shape.Positions.row(v));
    largest = std::max({ largest, std::abs(curvatures.Mean[v] - expected.Mean),
      std::abs(curvatures.Gaussian[v] - expected.Gaussian) });
  }
  return largest;
}

/// The power of the edge length with which the largest error shrinks, over two
/// refinements by two.
double Order(const std::function<shapes::Shape(int refinement)>& make, const ExactCurvature& exact)
{
  return 0.5 * std::log2(LargestError(make(0), exact) / LargestError(make(2), exact));
}

Curvatures Fit(const shapes::Shape& shape)
{
  return FitCurvatures(TriangleMesh(shape.NumberOfVertices(), shape.Faces), shape.Positions);
}

/// A surface of revolution about the z axis through rings of `around` points,
/// with these radii and heights.
shapes::Shape Turned(
  int around, const std::vector<double>& radii, const std::vector<double>& heights)
{
  shapes::PatchOptions options;
  options.CountU = around;
  options.CountV = static_cast<int>(radii.size()) - 1;
  options.PeriodicU = true;
  return shapes::Patch(options,
    [&](double u, double v)
    {
      const auto ring = static_cast<std::size_t>(std::lround(v * options.CountV));
      return Eigen::Vector3d(radii[ring] * std::cos(2 * shapes::Pi * u),
        radii[ring] * std::sin(2 * shapes::Pi * u), heights[ring]);
    });
}

/// How many vertices' curvatures are open.
int CountOpen(const Curvatures& curvatures)
{
  return static_cast<int>(
    std::count(curvatures.States.begin(), curvatures.States.end(), CurvatureState::Open));
}

/// The hull of points of which no four lie in a plane, by trying each triangle.
shapes::Shape ConvexHull(const Points& points)
{
  std::vector<Eigen::Vector3i> faces;
  const int count = static_cast<int>(points.rows());
  for (int a = 0; a < count; ++a)
  {
    for (int b = a + 1; b < count; ++b)
    {
      for (int c = b + 1; c < count; ++c)
      {
        const Eigen::Vector3d ab = points.row(b) - points.row(a);
        const Eigen::Vector3d ac = points.row(c) - points.row(a);
        const Eigen::Vector3d normal = ab.cross(ac);
        const double height = points.row(a).dot(normal);
        int above = 0;
        for (int d = 0; d < count; ++d)
        {
          above += d != a && d != b && d != c && points.row(d).dot(normal) > height ? 1 : 0;
        }
        if (above == 0)
        {
          faces.emplace_back(a, b, c);
        }
        else if (above == count - 3)
        {
          faces.emplace_back(a, c, b);
        }
      }
    }
  }
  return { points, shapes::ToTriangles(faces) };
}

bool AllFinite(const Curvatures& curvatures)
{
  return curvatures.Mean.allFinite() && curvatures.Gaussian.allFinite() &&
    curvatures.Maximum.allFinite() && curvatures.Minimum.allFinite() &&
    curvatures.MaximumDirections.allFinite() && curvatures.MinimumDirections.allFinite();
}
}

TEST(Curvature, PlaneIsExactlyFlatUpToItsBorder)
{
  for (const double jitter : { 0.0, 0.3 })
  {
    const Curvatures curvatures = Fit(shapes::Plane(12, 3.0, jitter));
    EXPECT_EQ(curvatures.Mean.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(curvatures.Gaussian.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(curvatures.Maximum.cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(curvatures.Minimum.cwiseAbs().maxCoeff(), 0.0);
  }
}

TEST(Curvature, TiltedPlaneIsFlatUpToRounding)
{
  const Curvatures curvatures = Fit(shapes::RandomRigidMotion(7)(shapes::Plane(12, 3.0, 0.3)));
  EXPECT_LT(curvatures.Mean.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(curvatures.Gaussian.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Curvature, SphereIsExactWhateverItsTriangles)
{
  for (const shapes::Shape& sphere :
    { shapes::Icosphere(0, 2.0), shapes::Icosphere(3, 2.0), shapes::UvSphere(8, 5, 2.0),
      shapes::UvSphere(60, 20, 2.0), shapes::UvSphere(200, 9, 2.0) })
  {
    const Curvatures curvatures = Fit(sphere);
    EXPECT_LT((curvatures.Mean.array() - 0.5).abs().maxCoeff(), 1e-8);
    EXPECT_LT((curvatures.Gaussian.array() - 0.25).abs().maxCoeff(), 1e-8);
  }
}

TEST(Curvature, InsideOutChangesTheSignOfTheMeanOnly)
{
  const shapes::Shape torus = shapes::Torus(24, 16);
  const Curvatures outside = Fit(torus);
  const Curvatures inside = Fit(shapes::Inverted(torus));
  EXPECT_LT((outside.Mean + inside.Mean).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((outside.Gaussian - inside.Gaussian).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((outside.Maximum + inside.Minimum).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Curvature, PolesStoredInSinglePrecisionAreRight)
{
  shapes::Shape sphere = shapes::UvSphere(180, 89);
  sphere.Positions = sphere.Positions.cast<float>().cast<double>();
  const Curvatures curvatures = Fit(sphere);
  EXPECT_LT((curvatures.Mean.array() - 1.0).abs().maxCoeff(), 1e-3);
}

TEST(Curvature, OpenCylinderIsRightAtItsBorders)
{
  const shapes::Shape cylinder = shapes::OpenCylinder(64, 20, 0.5);
  const Curvatures curvatures = Fit(cylinder);
  EXPECT_LT((curvatures.Mean.array() - 1.0).abs().maxCoeff(), 4e-3);
  EXPECT_LT((curvatures.Maximum.array() - 2.0).abs().maxCoeff(), 8e-3);
  EXPECT_LT(curvatures.Minimum.cwiseAbs().maxCoeff(), 8e-3);
}

TEST(Curvature, ConvergesWithTheSquareOfTheEdgeLengthOnRegularMeshes)
{
  EXPECT_GT(Order([](int n) { return shapes::Torus(24 << n, 10 << n); }, OnTorus), 1.7);
  EXPECT_GT(Order([](int n) { return shapes::Ellipsoid(2 + n, HalfAxes); }, OnEllipsoid), 1.7);
  EXPECT_GT(Order([](int n) { return shapes::OpenCylinder(24 << n, 8 << n); },
              [](const Eigen::Vector3d&) {
                return Exact{ 0.5, 0.0 };
              }),
    1.7);
}

TEST(Curvature, ConvergesOnIrregularMeshes)
{
  EXPECT_GT(
    Order([](int n) { return shapes::Torus(36 << n, 15 << n, 2.0, 0.7, 0.3); }, OnTorus), 1.5);
}

TEST(Curvature, ConvergesAtIrregularBorders)
{
  EXPECT_GT(Order([](int n) { return shapes::OpenCylinder(24 << n, 8 << n, 1.0, 2.0, 0.3); },
              [](const Eigen::Vector3d&) {
                return Exact{ 0.5, 0.0 };
              }),
    1.0);
  EXPECT_GT(Order([](int n) { return shapes::Saddle(10 << n, 2.0, 0.3); }, OnSaddle), 1.0);
}

TEST(Curvature, LongThinTrianglesAreNoObstacle)
{
  // The quads are 20 times as long as wide, and four make half a tube.
  EXPECT_LT(LargestError(shapes::Torus(720, 24), OnTorus), 0.06);
}

TEST(Curvature, CylindersAreExactWhateverTheirTriangles)
{
  for (const int around : { 6, 7, 10, 24, 200 })
  {
    for (const double row : { 0.02, 0.3, 3.0 })
    {
      const shapes::Shape tube = Turned(
        around, { 1, 1, 1, 1, 1, 1 }, { 0.0, row, 2.0 * row, 3.0 * row, 4.0 * row, 5.0 * row });
      const Curvatures curvatures = Fit(tube);
      EXPECT_LT((curvatures.Maximum.array() - 1.0).abs().maxCoeff(), 0.05) << around << " " << row;
      EXPECT_LT(curvatures.Minimum.cwiseAbs().maxCoeff(), 0.05) << around << " " << row;
      EXPECT_EQ(CountOpen(curvatures), 0) << around << " " << row;
    }
  }
  const Curvatures fine = Fit(shapes::OpenCylinder(80, 40, 1.0, 3.0, 0.3));
  EXPECT_LT((fine.Maximum.array() - 1.0).abs().maxCoeff(), 2e-4);
}

TEST(Curvature, TwoRowsLeaveItOpenAndAreTakenAsStraight)
{
  for (const int around : { 6, 24, 200 })
  {
    for (const double length : { 0.1, 2.0, 1000.0 })
    {
      const Curvatures cylinder = Fit(Turned(around, { 1, 1 }, { 0, length }));
      EXPECT_LT((cylinder.Maximum.array() - 1.0).abs().maxCoeff(), 0.02);
      EXPECT_LT(cylinder.Minimum.cwiseAbs().maxCoeff(), 0.02);
      EXPECT_EQ(CountOpen(cylinder), 2 * around);
    }
  }
  // A cone of 45 degrees.
  for (const int around : { 32, 128 })
  {
    const shapes::Shape cone = Turned(around, { 5, 1 }, { 0, 4 });
    const Curvatures curvatures = Fit(cone);
    EXPECT_EQ(CountOpen(curvatures), 2 * around);
    for (int v = 0; v < cone.NumberOfVertices(); ++v)
    {
      const double radius = cone.Positions.row(v).head<2>().norm();
      EXPECT_NEAR(curvatures.Maximum[v], std::sqrt(0.5) / radius, 0.03);
      EXPECT_NEAR(curvatures.Minimum[v], 0.0, 0.03);
    }
  }
}

TEST(Curvature, MoreRingsDetermineWhatTwoLeaveOpen)
{
  // Three rows close together: the third ring brings the fourth row.
  const Curvatures graded =
    Fit(Turned(24, { 1, 1, 1, 1, 1, 1 }, { 0.0, 0.02, 0.04, 0.5, 1.0, 1.5 }));
  EXPECT_LT((graded.Maximum.array() - 1.0).abs().maxCoeff(), 0.02);
  EXPECT_LT(graded.Minimum.cwiseAbs().maxCoeff(), 0.02);
}

TEST(Curvature, OpenOnlyWhereItIs)
{
  for (const shapes::Shape& shape : { shapes::Torus(24, 16), shapes::Torus(24, 16, 2.0, 0.7, 0.3),
         shapes::Torus(720, 24), shapes::Saddle(10, 2.0, 0.3), shapes::Icosphere(0),
         shapes::UvSphere(8, 5), shapes::UvSphere(200, 9), shapes::Plane(1),
         shapes::Plane(6, 1.0, 0.3), shapes::Ellipsoid(2, HalfAxes), shapes::OpenCylinder(12, 2) })
  {
    EXPECT_EQ(CountOpen(Fit(shape)), 0);
  }
}

TEST(Curvature, HullsOfPointsAreRightOrCoarse)
{
  // A corner of a hull of points inside a ball is one whatever its triangles; the
  // points of an ellipsoid have its curvatures.
  shapes::Random random(3);
  for (const int count : { 20, 60, 150 })
  {
    Points inBall(count, 3);
    Points onEllipsoid(count, 3);
    for (int i = 0; i < count; ++i)
    {
      Eigen::Vector3d direction;
      for (double& coordinate : direction)
      {
        coordinate = random();
      }
      direction.normalize();
      inBall.row(i) = (1.0 + 0.3 * random()) * direction.transpose();
      onEllipsoid.row(i) = HalfAxes.cwiseProduct(direction).transpose();
    }
    const shapes::Shape corners = ConvexHull(inBall);
    const TriangleMesh mesh(count, corners.Faces);
    const Curvatures ofCorners = FitCurvatures(mesh, inBall);
    const shapes::Shape smooth = ConvexHull(onEllipsoid);
    const Curvatures ofSmooth = Fit(smooth);
    for (int v = 0; v < count; ++v)
    {
      EXPECT_TRUE(!mesh.IsUsed(v) || ofCorners.States[v] != CurvatureState::Determined);
      if (ofSmooth.States[v] == CurvatureState::Determined)
      {
        const Exact exact = OnEllipsoid(onEllipsoid.row(v));
        const double spread = std::sqrt(exact.Mean * exact.Mean - exact.Gaussian);
        EXPECT_NEAR(ofSmooth.Maximum[v], exact.Mean + spread, 0.05 * (exact.Mean + spread));
        EXPECT_NEAR(ofSmooth.Minimum[v], exact.Mean - spread, 0.05 * (exact.Mean + spread));
      }
    }
  }
}

TEST(Curvature, NextToARightAngledEdgeIsFlat)
{
  const shapes::Shape bar = shapes::Bar(6, 6, 12, { 1, 1, 2 });
  const Curvatures curvatures = Fit(bar);
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    const Eigen::RowVector3d p = bar.Positions.row(v);
    const Eigen::Array3d toFaces(
      0.5 - std::abs(p[0]), 0.5 - std::abs(p[1]), 1.0 - std::abs(p[2] - 1.0));
    if ((toFaces < 1e-9).count() == 1)
    {
      EXPECT_LT(std::abs(curvatures.Maximum[v]), 1e-9);
      EXPECT_LT(std::abs(curvatures.Minimum[v]), 1e-9);
    }
  }
}

TEST(Curvature, SmallNoiseChangesLittle)
{
  const shapes::Shape smooth = shapes::Torus(72, 30);
  const double edge = 2.0 * shapes::Pi * 0.7 / 30.0;
  const Curvatures noisy = Fit(shapes::Noisy(smooth, 0.01 * edge));
  const Curvatures exact = Fit(smooth);
  const double rms = std::sqrt((noisy.Mean - exact.Mean).squaredNorm() / smooth.NumberOfVertices());
  EXPECT_LT(rms, 0.05);
}

TEST(Curvature, GaussBonnetHoldsInTheLimit)
{
  const shapes::Shape sphere = shapes::Ellipsoid(4, HalfAxes);
  const TriangleMesh mesh(sphere.NumberOfVertices(), sphere.Faces);
  const Eigen::VectorXd areas = MixedVoronoiAreas(mesh, sphere.Positions);
  const Curvatures curvatures = FitCurvatures(mesh, sphere.Positions);
  EXPECT_NEAR(areas.dot(curvatures.Gaussian), 4.0 * shapes::Pi, 0.1);

  const auto totalOfTorus = [](int refinement)
  {
    const shapes::Shape torus = shapes::Torus(48 << refinement, 20 << refinement, 2.0, 0.7, 0.2);
    const TriangleMesh torusMesh(torus.NumberOfVertices(), torus.Faces);
    return std::abs(MixedVoronoiAreas(torusMesh, torus.Positions)
                      .dot(FitCurvatures(torusMesh, torus.Positions).Gaussian));
  };
  EXPECT_LT(totalOfTorus(2), totalOfTorus(0) / 8.0);
}

TEST(Curvature, ValuesAgreeWithEachOther)
{
  const Curvatures c = Fit(shapes::Noisy(shapes::Torus(30, 16), 0.02));
  EXPECT_TRUE((c.Maximum.array() >= c.Minimum.array()).all());
  EXPECT_LT((c.Mean - 0.5 * (c.Maximum + c.Minimum)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((c.Gaussian - c.Maximum.cwiseProduct(c.Minimum)).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(Curvature, DirectionsAreThoseOfTheCylinder)
{
  const shapes::Shape cylinder = shapes::OpenCylinder(48, 12);
  const Curvatures curvatures = Fit(cylinder);
  for (int v = 0; v < cylinder.NumberOfVertices(); ++v)
  {
    EXPECT_NEAR(std::abs(curvatures.MinimumDirections(v, 2)), 1.0, 1e-2);
    EXPECT_NEAR(curvatures.MaximumDirections.row(v).norm(), 1.0, 1e-12);
    EXPECT_NEAR(
      curvatures.MaximumDirections.row(v).dot(curvatures.MinimumDirections.row(v)), 0.0, 1e-12);
  }
}

TEST(Curvature, InvariantToRigidMotions)
{
  // A regular grid has many equal distances and isotropic neighborhoods, the
  // hard case for anything that breaks ties by rounding.
  for (const shapes::Shape& shape : { shapes::Torus(24, 16), shapes::Saddle(10, 2.0),
         shapes::Noisy(shapes::Icosphere(3), 0.02), shapes::Bar(3, 3, 6, { 1, 1, 2 }) })
  {
    const Curvatures before = Fit(shape);
    const Curvatures after = Fit(shapes::RandomRigidMotion(11)(shape));
    EXPECT_LT((before.Mean - after.Mean).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((before.Gaussian - after.Gaussian).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Curvature, ScalesWithTheInverseLength)
{
  const shapes::Shape shape = shapes::Torus(24, 16);
  const Curvatures one = Fit(shape);
  for (const double scale : { 1e-9, 1e6 })
  {
    shapes::Shape scaled = shape;
    scaled.Positions *= scale;
    const Curvatures other = Fit(scaled);
    EXPECT_LT((one.Mean - scale * other.Mean).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((one.Gaussian - scale * scale * other.Gaussian).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Curvature, FarFromTheOriginOnlyTheCoordinatesLoseDigits)
{
  const shapes::Shape shape = shapes::Torus(24, 16);
  shapes::Shape far = shape;
  far.Positions.rowwise() += Eigen::RowVector3d(1e6, -2e6, 3e6);
  EXPECT_LT((Fit(shape).Mean - Fit(far).Mean).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(Curvature, DoesNotDependOnHowTheLoopIsSplit)
{
  const shapes::Shape shape = shapes::Torus(48, 32);
  const TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  const ExecutionContext split(
    [](int n, const ExecutionContext::Range& body)
    {
      std::thread other([&] { body(n / 3, n); });
      body(0, n / 3);
      other.join();
    },
    [](double) { return true; });
  EXPECT_EQ(
    FitCurvatures(mesh, shape.Positions).Mean, FitCurvatures(mesh, shape.Positions, split).Mean);
}

TEST(Curvature, DefinedAtDegenerateVertices)
{
  // A lone triangle, all else unused.
  Triangles triangle(1, 3);
  triangle << 0, 1, 2;
  Points points = Points::Random(6, 3);
  const Curvatures lone = FitCurvatures(TriangleMesh(6, triangle), points);
  EXPECT_LT(lone.Mean.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_TRUE(AllFinite(lone));

  // All points of the triangle in one place, then in one line.
  points.setOnes();
  EXPECT_EQ(FitCurvatures(TriangleMesh(6, triangle), points).Mean.cwiseAbs().maxCoeff(), 0.0);
  points.col(0) << 0, 1, 2, 3, 4, 5;
  EXPECT_EQ(FitCurvatures(TriangleMesh(6, triangle), points).Mean.cwiseAbs().maxCoeff(), 0.0);

  // A sphere of which a third of the points have collapsed into one.
  shapes::Shape collapsed = shapes::Icosphere(3);
  collapsed.Positions.topRows(200).rowwise() = Eigen::RowVector3d(0.0, 0.0, 1.0);
  EXPECT_TRUE(AllFinite(Fit(collapsed)));

  // A tetrahedron has three neighbors per vertex, too few for a quadric.
  shapes::Shape tetrahedron;
  tetrahedron.Positions =
    shapes::ToPoints({ { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } });
  tetrahedron.Faces = shapes::ToTriangles({ { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 1 }, { 1, 3, 2 } });
  const Curvatures corners = Fit(tetrahedron);
  EXPECT_LT((corners.Mean.array() - 1.0 / std::sqrt(3.0)).abs().maxCoeff(), 1e-6);

  // A sheet folded flat onto itself.
  shapes::Shape folded = shapes::Plane(6);
  folded.Positions.col(0) = folded.Positions.col(0).cwiseAbs();
  EXPECT_TRUE(AllFinite(Fit(folded)));
}

TEST(Curvature, ManyNeighborsCostLittle)
{
  // The rim vertices of a fan all have each other in their two-ring: without
  // a bound this takes 10^10 steps.
  const int rim = 100000;
  std::vector<Eigen::Vector3d> positions = { { 0, 0, 0.1 } };
  std::vector<Eigen::Vector3i> faces;
  for (int i = 0; i < rim; ++i)
  {
    const double angle = 2.0 * shapes::Pi * i / rim;
    positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    faces.emplace_back(0, 1 + i, 1 + (i + 1) % rim);
  }
  const TriangleMesh mesh(rim + 1, shapes::ToTriangles(faces));
  EXPECT_TRUE(AllFinite(FitCurvatures(mesh, shapes::ToPoints(positions))));
}

TEST(Curvature, StopsOnRequest)
{
  const shapes::Shape shape = shapes::Torus(24, 16);
  const ExecutionContext stopping({}, [](double) { return false; });
  EXPECT_THROW(
    FitCurvatures(TriangleMesh(shape.NumberOfVertices(), shape.Faces), shape.Positions, stopping),
    Error);
}

TEST(CurvaturesFromNormals, ExactForTheNormalsOfASphere)
{
  const shapes::Shape sphere = shapes::Icosphere(3, 2.0);
  const TriangleMesh mesh(sphere.NumberOfVertices(), sphere.Faces);
  const Points normals = 0.5 * sphere.Positions;
  const Curvatures curvatures = CurvaturesFromNormals(mesh, sphere.Positions, normals);
  EXPECT_LT((curvatures.Maximum.array() - 0.5).abs().maxCoeff(), 1e-9);
  EXPECT_LT((curvatures.Minimum.array() - 0.5).abs().maxCoeff(), 1e-9);
}

TEST(CurvaturesFromNormals, FiniteWhereThereIsNoNormal)
{
  Triangles triangle(1, 3);
  triangle << 0, 1, 2;
  const Points points = Points::Ones(4, 3);
  const TriangleMesh mesh(4, triangle);
  const Curvatures curvatures = CurvaturesFromNormals(mesh, points, VertexNormals(mesh, points));
  EXPECT_TRUE(AllFinite(curvatures));
  EXPECT_EQ(curvatures.Mean.cwiseAbs().maxCoeff(), 0.0);
}
