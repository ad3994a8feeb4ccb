// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/StretchArrays.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Measure/Areas.h"

#include "vtkCellData.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace cartan
{
namespace
{
/// The rows of triangles as rows of cells.
Stretches ToCells(const Stretches& triangles, const Connectivity& cells, vtkIdType numberOfCells,
  const Eigen::VectorXd& areas)
{
  Stretches result{ Eigen::VectorXd::Ones(numberOfCells), Eigen::VectorXd::Ones(numberOfCells),
    Points::Zero(numberOfCells, 3), Points::Zero(numberOfCells, 3) };
  Eigen::VectorXd largest = Eigen::VectorXd::Constant(numberOfCells, -1.0);
  for (Eigen::Index t = 0; t < triangles.Larger.size(); ++t)
  {
    const Eigen::Index cell = cells.CellIds[t];
    if (areas[t] > largest[cell])
    {
      largest[cell] = areas[t];
      result.Larger[cell] = triangles.Larger[t];
      result.Smaller[cell] = triangles.Smaller[t];
      result.LargerDirections.row(cell) = triangles.LargerDirections.row(t);
      result.SmallerDirections.row(cell) = triangles.SmallerDirections.row(t);
    }
  }
  return result;
}

void AddTo(vtkDataSetAttributes* attributes, const Stretches& stretches)
{
  AddArray(attributes, "Stretch1", stretches.Larger);
  AddArray(attributes, "Stretch2", stretches.Smaller);
  AddArray(attributes, "StretchDirection1", stretches.LargerDirections);
  AddArray(attributes, "StretchDirection2", stretches.SmallerDirections);
}
}

SurfaceStretches MeasureStretches(const RingStretches& ofPoints, const TriangleMesh& mesh,
  const Connectivity& cells, vtkIdType numberOfCells, const Points& reference,
  const Points& current, const ExecutionContext& context)
{
  return { ofPoints.Measure(current, context),
    ToCells(TriangleStretches(mesh, reference, current, context), cells, numberOfCells,
      TriangleAreas(mesh, reference, context)) };
}

void AddStretchArrays(const SurfaceStretches& stretches, vtkPolyData* output)
{
  AddTo(output->GetPointData(), stretches.OfPoints);
  AddTo(output->GetCellData(), stretches.OfCells);
}

void AddRateArrays(const SurfaceStretches& stretches, double interval, vtkPolyData* output)
{
  const auto add = [&](vtkDataSetAttributes* attributes, const Stretches& of)
  {
    AddArray(attributes, "StretchRate1", Strains(of.Larger, StrainMeasure::Hencky) / interval);
    AddArray(attributes, "StretchRate2", Strains(of.Smaller, StrainMeasure::Hencky) / interval);
  };
  add(output->GetPointData(), stretches.OfPoints);
  add(output->GetCellData(), stretches.OfCells);
}

void AddStrainArrays(const SurfaceStretches& stretches, StrainMeasure measure, vtkPolyData* output)
{
  static const char* const names[] = { "BiotStrain", "GreenLagrangeStrain", "HenckyStrain",
    "EulerAlmansiStrain" };
  const std::string name = names[static_cast<int>(measure)];
  const auto add = [&](vtkDataSetAttributes* attributes, const Stretches& of)
  {
    AddArray(attributes, name + "1", Strains(of.Larger, measure));
    AddArray(attributes, name + "2", Strains(of.Smaller, measure));
  };
  add(output->GetPointData(), stretches.OfPoints);
  add(output->GetCellData(), stretches.OfCells);
}
}
