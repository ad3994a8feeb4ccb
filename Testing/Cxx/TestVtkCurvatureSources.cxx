// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCurvatureError.h"

#include "TestSurfaces.h"

#include <gtest/gtest.h>

#include "vtkCleanPolyData.h"
#include "vtkConeSource.h"
#include "vtkCylinderSource.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkLineSource.h"
#include "vtkNew.h"
#include "vtkParametricFunctionSource.h"
#include "vtkParametricTorus.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataNormals.h"
#include "vtkSphereSource.h"
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
      result.LargestError =
        std::max({ result.LargestError, std::abs(maximum->GetTuple1(i) - expected.Maximum),
          std::abs(minimum->GetTuple1(i) - expected.Minimum) });
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
  for (const int sides : { 6, 12, 24 })
  {
    vtkNew<vtkLineSource> line;
    line->SetPoint1(0, 0, 0);
    line->SetPoint2(0, 0, 4);
    line->SetResolution(8);
    vtkNew<vtkTubeFilter> tube;
    tube->SetInputConnection(line->GetOutputPort());
    tube->SetRadius(0.5);
    tube->SetNumberOfSides(sides);
    const Result result = Measure(
      tube,
      [](const double*) {
        return Principal{ 2.0, 0.0 };
      },
      Everywhere);
    EXPECT_LT(result.LargestError, 0.1) << sides;
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
  vtkNew<vtkParametricTorus> torus;
  vtkNew<vtkParametricFunctionSource> source;
  source->SetParametricFunction(torus);
  // As it comes, its seam is inconsistently oriented.
  vtkNew<vtkCleanPolyData> merged;
  merged->SetInputConnection(source->GetOutputPort());
  merged->SetTolerance(1e-6);
  vtkNew<vtkPolyDataNormals> oriented;
  oriented->SetInputConnection(merged->GetOutputPort());
  oriented->SplittingOff();
  oriented->AutoOrientNormalsOn();
  const Result result = Measure(
    oriented,
    [](const double* p)
    {
      const double cosine = (std::hypot(p[0], p[1]) - 1.0) / 0.5;
      return Principal{ 2.0, cosine / (1.0 + 0.5 * cosine) };
    },
    Everywhere);
  EXPECT_LT(result.LargestError, 0.05 * 2.0);
  EXPECT_EQ(result.Undetermined, 0);
}
