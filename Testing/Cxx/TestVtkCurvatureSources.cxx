// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCurvatureError.h"

#include "AdviceWords.h"
#include "TestShapes.h"
#include "TestSurfaces.h"

#include <gtest/gtest.h>

#include "vtkArcSource.h"
#include "vtkConeSource.h"
#include "vtkCylinderSource.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkLineSource.h"
#include "vtkLinearSubdivisionFilter.h"
#include "vtkLoopSubdivisionFilter.h"
#include "vtkNew.h"
#include "vtkParametricEnneper.h"
#include "vtkParametricFunctionSource.h"
#include "vtkParametricTorus.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPrepareSurface.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"
#include "vtkSuperquadricSource.h"
#include "vtkTrivialProducer.h"
#include "vtkTubeFilter.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

// The curvatures of what VTK's own sources make, by closed formulas.

namespace
{
struct Principal
{
  double Maximum;
  double Minimum;
};
using Exact = std::function<Principal(const double* point)>;
using Choice = std::function<bool(vtkPolyData* surface, vtkIdType id)>;

struct Result
{
  double LargestError = 0.0; ///< of a principal curvature at the chosen points
  /// The same at the chosen ones whose array says that they are determined,
  /// relative to the larger principal curvature.
  double LargestTrusted = 0.0;
  vtkIdType Chosen = 0;
  vtkIdType Undetermined = 0; ///< of all points
  std::string Warning;
};

Result Measure(vtkAlgorithm* source, const Exact& exact, const Choice& isChosen)
{
  vtkNew<vtkCurvatureError> filter;
  vtkNew<surfaces::Observer> messages;
  surfaces::Observe(filter.GetPointer(), messages);
  filter->SetInputConnection(source->GetOutputPort());
  filter->Update();
  EXPECT_FALSE(messages->GetError()) << messages->GetErrorMessage();
  vtkPolyData* output = filter->GetOutput();
  vtkDataArray* maximum = output->GetPointData()->GetArray("MaximumCurvature");
  vtkDataArray* minimum = output->GetPointData()->GetArray("MinimumCurvature");
  vtkDataArray* isDetermined = output->GetPointData()->GetArray("CurvatureIsDetermined");
  Result result;
  result.Warning = messages->GetWarning() ? messages->GetWarningMessage() : std::string();
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    result.Undetermined += isDetermined->GetTuple1(i) == 0.0 ? 1 : 0;
    if (isChosen(output, i))
    {
      const Principal expected = exact(output->GetPoint(i));
      const double error = std::max(std::abs(maximum->GetTuple1(i) - expected.Maximum),
        std::abs(minimum->GetTuple1(i) - expected.Minimum));
      result.LargestError = std::max(result.LargestError, error);
      if (isDetermined->GetTuple1(i) != 0.0)
      {
        result.LargestTrusted = std::max(result.LargestTrusted,
          error / std::max(std::abs(expected.Maximum), std::abs(expected.Minimum)));
      }
      ++result.Chosen;
    }
  }
  return result;
}

bool Everywhere(vtkPolyData*, vtkIdType)
{
  return true;
}

/// The points of a vtkCylinderSource's side, whose stored normals are radial.
bool OnSide(vtkPolyData* cylinder, vtkIdType id)
{
  double normal[3];
  cylinder->GetPointData()->GetNormals()->GetTuple(id, normal);
  return std::abs(normal[1]) < 0.5;
}

/// Of a torus around the axis with this index.
Exact OfTorus(double major, double minor, int axis)
{
  return [=](const double* p)
  {
    const double distance = std::hypot(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    const double cosine = (distance - major) / minor;
    return Principal{ 1.0 / minor, cosine / (major + minor * cosine) };
  };
}

/// A vtkParametricTorus; as it comes, it has a seam.
vtkSmartPointer<vtkPrepareSurface> ClosedTorus(int around, int aroundTube)
{
  vtkNew<vtkParametricTorus> torus;
  vtkNew<vtkParametricFunctionSource> source;
  source->SetParametricFunction(torus);
  source->SetUResolution(around + 1);
  source->SetVResolution(aroundTube + 1);
  vtkNew<vtkPrepareSurface> closed;
  closed->SetInputConnection(source->GetOutputPort());
  closed->SetTolerance(1e-6);
  return closed;
}

Result MeasureTorus(int around, int aroundTube)
{
  return Measure(ClosedTorus(around, aroundTube), OfTorus(1.0, 0.5, 2), Everywhere);
}

/// The source's surface, each point moved by up to `distance` in each coordinate and from
/// there back onto the surface.
vtkSmartPointer<vtkTrivialProducer> Jittered(vtkAlgorithm* source, double distance,
  unsigned int seed, const std::function<surfaces::Point(const surfaces::Point&)>& ontoSurface)
{
  source->Update();
  vtkNew<vtkPolyData> moved;
  moved->DeepCopy(source->GetOutputDataObject(0));
  shapes::Random random(seed);
  for (vtkIdType i = 0; i < moved->GetNumberOfPoints(); ++i)
  {
    surfaces::Point point;
    moved->GetPoint(i, point.data());
    for (double& coordinate : point)
    {
      coordinate += distance * random();
    }
    moved->GetPoints()->SetPoint(i, ontoSurface(point).data());
  }
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(moved);
  return producer;
}

/// A straight one of radius .5 with rows + 1 rows.
Result MeasureTube(int sides, int rows)
{
  vtkNew<vtkLineSource> line;
  line->SetPoint1(0, 0, 0);
  line->SetPoint2(0, 0, 4);
  line->SetResolution(rows);
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputConnection(line->GetOutputPort());
  tube->SetRadius(0.5);
  tube->SetNumberOfSides(sides);
  return Measure(
    tube,
    [](const double*) {
      return Principal{ 2.0, 0.0 };
    },
    Everywhere);
}
}

TEST(CurvatureOfSources, SideOfACylinderHasTwoRowsAndIsFlagged)
{
  for (const int resolution : { 6, 7, 12, 24, 100, 500 })
  {
    for (const double height : { 0.1, 1.0, 10.0, 100.0 })
    {
      vtkNew<vtkCylinderSource> cylinder;
      cylinder->SetResolution(resolution);
      cylinder->SetHeight(height);
      const Result result = Measure(
        cylinder,
        [](const double*) {
          return Principal{ 2.0, 0.0 };
        },
        OnSide);
      EXPECT_LT(result.LargestError, 0.03) << resolution << " " << height;
      EXPECT_EQ(result.Chosen, 2 * resolution);
      // The caps are flat, which their points determine well enough.
      EXPECT_EQ(result.Undetermined, 2 * resolution);
      const std::string count = std::to_string(2 * resolution) + " points (ids 0, 1, 2, 3, 4, ...)";
      EXPECT_NE(result.Warning.find("The curvature of the input is not determined at " + count),
        std::string::npos)
        << result.Warning;
    }
  }
}

TEST(CurvatureOfSources, CapsOfACylinderAreFlat)
{
  vtkNew<vtkCylinderSource> cylinder;
  cylinder->SetResolution(24);
  const Result result = Measure(
    cylinder,
    [](const double*) {
      return Principal{ 0.0, 0.0 };
    },
    [](vtkPolyData* surface, vtkIdType id) { return !OnSide(surface, id); });
  EXPECT_EQ(result.Chosen, 48);
  EXPECT_LT(result.LargestError, 1e-5);
}

TEST(CurvatureOfSources, ThreeRowsAsTheWarningAsksForDetermineATube)
{
  EXPECT_NE(MeasureTube(12, 1).Warning.find(shapes::Advice(
              "For reliable values use at least three evenly spaced rows of points in every "
              "direction.")),
    std::string::npos);
  for (const int sides : { 8, 12, 24 })
  {
    const Result result = MeasureTube(sides, 8);
    EXPECT_LT(result.LargestError, 0.05 * 2.0) << sides;
    EXPECT_EQ(result.Undetermined, 0);
    EXPECT_EQ(result.Warning, "");
  }
}

TEST(CurvatureOfSources, OpenConeAwayFromItsApexAndSeam)
{
  for (const int resolution : { 12, 24, 100 })
  {
    vtkNew<vtkConeSource> cone;
    cone->SetResolution(resolution);
    cone->SetCapping(false);
    // The base of radius .5 is at x = -.5; the apex is at x = .5.
    const double expected = 1.0 / std::hypot(1.0, 0.5) / 0.5;
    const Result result = Measure(
      cone,
      [expected](const double*) {
        return Principal{ expected, 0.0 };
      },
      [](vtkPolyData* surface, vtkIdType id)
      {
        const double* point = surface->GetPoint(id);
        return point[0] < 0.0;
      });
    EXPECT_LT(result.LargestError, 0.05 * expected) << resolution;
    EXPECT_GE(result.Chosen, resolution);
    EXPECT_NE(result.Warning, "");
  }
}

TEST(CurvatureOfSources, SpheresAreExactAtTheirPolesAndBorders)
{
  for (const int resolution : { 8, 20, 60 })
  {
    for (const double end : { 180.0, 100.0 })
    {
      vtkNew<vtkSphereSource> sphere;
      sphere->SetThetaResolution(resolution);
      sphere->SetPhiResolution(resolution);
      sphere->SetEndPhi(end);
      const Result result = Measure(
        sphere,
        [](const double*) {
          return Principal{ 2.0, 2.0 };
        },
        Everywhere);
      EXPECT_LT(result.LargestError, 2e-3) << resolution << " " << end;
      EXPECT_EQ(result.Undetermined, 0);
    }
  }
}

TEST(CurvatureOfSources, TorusOfDefaultResolution)
{
  const Result result = MeasureTorus(50, 50);
  EXPECT_LT(result.LargestError, 0.05 * 2.0);
  EXPECT_EQ(result.Undetermined, 0);
  EXPECT_EQ(result.Warning, "");
}

TEST(CurvatureOfSources, CoarseToriAreRightOrFlagged)
{
  for (const int around : { 8, 12, 20, 30 })
  {
    for (const int aroundTube : { 8, 12, 16, 20, 30 })
    {
      const Result result = MeasureTorus(around, aroundTube);
      EXPECT_LT(result.LargestTrusted, 0.05) << around << " " << aroundTube;
      EXPECT_NE(result.Warning.find("may be off by more than 5 % at " +
                  std::to_string(result.Undetermined) + " points"),
        std::string::npos)
        << around << " " << aroundTube << result.Warning;
    }
  }
}

TEST(CurvatureOfSources, JitteredToriAndSpheresAreRightOrFlagged)
{
  const auto ontoTorus = [](const surfaces::Point& p)
  {
    // From the core circle of radius 1 out to .5.
    const double distance = std::hypot(p[0], p[1]);
    const double scale = 0.5 / std::hypot(distance - 1.0, p[2]);
    const double stretch = (1.0 + scale * (distance - 1.0)) / distance;
    return surfaces::Point{ stretch * p[0], stretch * p[1], scale * p[2] };
  };
  const auto ontoSphere = [](const surfaces::Point& p)
  {
    const double scale = 0.5 / std::hypot(p[0], p[1], p[2]);
    return surfaces::Point{ scale * p[0], scale * p[1], scale * p[2] };
  };
  for (const int resolution : { 8, 12, 24, 50 })
  {
    for (const double jitter : { 0.1, 0.2 })
    {
      for (unsigned int seed = 1; seed <= 3; ++seed)
      {
        const double edge = surfaces::FullTurn * 0.5 / resolution;
        const Result ofTorus =
          Measure(Jittered(ClosedTorus(resolution, resolution), jitter * edge, seed, ontoTorus),
            OfTorus(1.0, 0.5, 2), Everywhere);
        EXPECT_LT(ofTorus.LargestTrusted, 0.05) << resolution << " " << jitter << " " << seed;
        vtkNew<vtkSphereSource> sphere;
        sphere->SetThetaResolution(resolution);
        sphere->SetPhiResolution(resolution);
        const Result ofSphere = Measure(
          Jittered(sphere, jitter * edge, seed, ontoSphere),
          [](const double*) {
            return Principal{ 2.0, 2.0 };
          },
          Everywhere);
        EXPECT_LT(ofSphere.LargestTrusted, 0.05) << resolution << " " << jitter << " " << seed;
        EXPECT_TRUE(resolution < 50 || ofTorus.Undetermined < ofTorus.Chosen / 5)
          << ofTorus.Undetermined;
      }
    }
  }
}

TEST(CurvatureOfSources, SplitTrianglesAreNamedOnceAndSmoothOnesCured)
{
  const vtkSmartPointer<vtkPrepareSurface> torus = ClosedTorus(50, 50);
  vtkNew<vtkLinearSubdivisionFilter> flat;
  flat->SetInputConnection(torus->GetOutputPort());
  const Result split = Measure(flat, OfTorus(1.0, 0.5, 2), Everywhere);
  EXPECT_EQ(split.Undetermined, 10000);
  EXPECT_NE(split.Warning.find("may be off by more than 5 % at 10000 points (ids 0, 1, 2, 3, 4, "
                               "...) of flat parts"),
    std::string::npos);
  EXPECT_EQ(split.Warning.find("smaller triangles"), std::string::npos);
  EXPECT_NE(split.Warning.find(shapes::Advice(
              "Where the surface should be smooth, use it before it is split, split it by "
              "vtkLoopSubdivisionFilter instead of vtkLinearSubdivisionFilter, or give tubes "
              "more sides.")),
    std::string::npos);

  EXPECT_EQ(MeasureTorus(50, 50).Warning, "");
  vtkNew<vtkLoopSubdivisionFilter> smooth;
  smooth->SetInputConnection(torus->GetOutputPort());
  EXPECT_EQ(Measure(smooth, OfTorus(1.0, 0.5, 2), Everywhere).Warning, "");
  EXPECT_NE(MeasureTube(6, 8).Warning.find("of flat parts"), std::string::npos);
  EXPECT_EQ(MeasureTube(12, 8).Warning, "");

  // The same at both inputs is said once.
  vtkNew<vtkCurvatureError> filter;
  vtkNew<surfaces::Observer> messages;
  surfaces::Observe(filter.GetPointer(), messages);
  filter->SetInputConnection(flat->GetOutputPort());
  filter->SetReferenceConnection(flat->GetOutputPort());
  filter->Update();
  EXPECT_NE(std::string(messages->GetWarningMessage())
              .find("of the input and of the reference may be off by more than 5 % at 10000"),
    std::string::npos);
}

TEST(CurvatureOfSources, TubesOfFewSidesAreRightOrFlagged)
{
  for (const int sides : { 3, 4, 6, 8, 10, 12, 24 })
  {
    for (const int rows : { 2, 4, 32 })
    {
      const Result result = MeasureTube(sides, rows);
      EXPECT_LT(result.LargestTrusted, 0.05) << sides << " " << rows;
      EXPECT_EQ(result.Undetermined == 0, result.Warning.empty());
      // Edges of 90 degrees may as well be sharp, edges of 30 or less not.
      EXPECT_TRUE(sides > 4 || result.Undetermined == result.Chosen);
      EXPECT_TRUE(sides < 12 || rows < 4 || result.Undetermined == 0) << sides << " " << rows;
    }
  }
}

TEST(CurvatureOfSources, TubesAlongAnArcAreRightOrFlagged)
{
  for (const int sides : { 4, 6, 8, 10, 24 })
  {
    for (const int rows : { 16, 32, 64 })
    {
      vtkNew<vtkArcSource> arc;
      arc->UseNormalAndAngleOn();
      arc->SetPolarVector(1.5, 0, 0);
      arc->SetAngle(180);
      arc->SetResolution(rows);
      vtkNew<vtkTubeFilter> tube;
      tube->SetInputConnection(arc->GetOutputPort());
      tube->SetRadius(0.5);
      tube->SetNumberOfSides(sides);
      // The ends, which are open, are not as good.
      const Result result = Measure(tube, OfTorus(1.5, 0.5, 2),
        [](vtkPolyData* surface, vtkIdType id)
        {
          const double* p = surface->GetPoint(id);
          return std::abs(p[1]) > 0.5 * std::abs(p[0]);
        });
      EXPECT_GT(result.Chosen, sides);
      EXPECT_LT(result.LargestTrusted, 0.05) << sides << " " << rows;
      EXPECT_EQ(result.Undetermined == 0, result.Warning.empty());
    }
  }
}

TEST(CurvatureOfSources, CatenoidsAreRightOrFlagged)
{
  for (const int around : { 6, 12, 24, 48 })
  {
    for (const int rows : { 2, 4, 8, 24 })
    {
      vtkNew<vtkTrivialProducer> producer;
      producer->SetOutput(surfaces::Tube(around, rows, false,
        [](double u, double v)
        {
          const double z = 3.0 * v - 1.5;
          return surfaces::Point{ std::cosh(z) * std::cos(surfaces::FullTurn * u),
            std::cosh(z) * std::sin(surfaces::FullTurn * u), z };
        }));
      // A minimal surface: k1 = -k2 = 1 / cosh(z)^2.
      const Result result = Measure(
        producer,
        [](const double* p)
        {
          const double curvature = 1.0 / (p[0] * p[0] + p[1] * p[1]);
          return Principal{ curvature, -curvature };
        },
        Everywhere);
      EXPECT_LT(result.LargestTrusted, 0.05) << around << " " << rows;
      EXPECT_NE(result.Warning, "");
    }
  }
}

TEST(CurvatureOfSources, EnnepersSurfaceOfDefaultResolutionIsRightOrFlagged)
{
  // VTK's is (u - u^3/3 + u v^2, v - v^3/3 + u^2 v, u^2 - v^2), of curvatures
  // +-2 / (1 + u^2 + v^2)^2, with u and v in [-2, 2], the first point for (-2, -2).
  const int count = 41;
  vtkNew<vtkParametricEnneper> enneper;
  vtkNew<vtkParametricFunctionSource> source;
  source->SetParametricFunction(enneper);
  source->SetUResolution(count);
  source->SetVResolution(count);
  source->Update();
  vtkIdType id = 0;
  const auto squaredParameter = [&](vtkIdType i)
  {
    const double u = -2.0 + 4.0 * static_cast<double>(i / count) / (count - 1);
    const double v = -2.0 + 4.0 * static_cast<double>(i % count) / (count - 1);
    return u * u + v * v;
  };
  const Result result = Measure(
    source,
    [&](const double*)
    {
      const double curvature = 2.0 / std::pow(1.0 + squaredParameter(id), 2);
      return Principal{ curvature, -curvature };
    },
    [&](vtkPolyData*, vtkIdType i)
    {
      id = i;
      return squaredParameter(i) < 3.0;
    });
  EXPECT_GT(result.Chosen, 500);
  EXPECT_LT(result.LargestTrusted, 0.05);
}

TEST(CurvatureOfSources, SuperquadricsAreRightOrFlagged)
{
  for (const int resolution : { 8, 16, 32, 64 })
  {
    for (const bool isToroidal : { false, true })
    {
      // A sphere of radius 1, or a torus around y of radii .75 and .25.
      vtkNew<vtkSuperquadricSource> superquadric;
      superquadric->SetSize(1.0);
      superquadric->SetToroidal(isToroidal);
      superquadric->SetThetaResolution(resolution);
      superquadric->SetPhiResolution(resolution);
      vtkNew<vtkPrepareSurface> closed;
      closed->SetInputConnection(superquadric->GetOutputPort());
      closed->SetTolerance(1e-6);
      const Exact ofSphere = [](const double*) { return Principal{ 1.0, 1.0 }; };
      const Result result =
        Measure(closed, isToroidal ? OfTorus(0.75, 0.25, 1) : ofSphere, Everywhere);
      EXPECT_LT(result.LargestTrusted, 0.05) << resolution << " " << isToroidal;
      EXPECT_TRUE(isToroidal || result.Undetermined == 0) << resolution;
    }
  }
}

TEST(CurvatureOfSources, SharpEdgesOfAConeAreFlagged)
{
  for (const int resolution : { 6, 12, 48 })
  {
    vtkNew<vtkConeSource> cone;
    cone->SetResolution(resolution);
    const Result result = Measure(
      cone,
      [](const double*) {
        return Principal{ 0.0, 0.0 };
      },
      Everywhere);
    EXPECT_EQ(result.Undetermined, result.Chosen) << resolution;
  }
}

TEST(CurvatureOfSources, SmallerTrianglesAsTheWarningAsksDetermineATorus)
{
  EXPECT_NE(MeasureTorus(25, 16).Warning.find(shapes::Advice(
              "For reliable values use smaller triangles where the surface bends, and smooth "
              "noise.")),
    std::string::npos);
  const Result fine = MeasureTorus(50, 40);
  EXPECT_EQ(fine.Warning, "");
  EXPECT_LT(fine.LargestTrusted, 0.05);
}
