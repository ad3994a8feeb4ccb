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
    // Triangles of other ranks are of no cell.
    if (cell < numberOfCells && areas[t] > largest[cell])
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

/// Adds what `add` makes of stretches to points and cells. The vertices of a piece go on with
/// those of other ranks.
template <typename Add>
void AddToBoth(const SurfaceStretches& stretches, vtkPolyData* output, const Add& add)
{
  add(output->GetPointData(), stretches.OfPoints, output->GetNumberOfPoints());
  add(output->GetCellData(), stretches.OfCells, output->GetNumberOfCells());
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
  AddToBoth(stretches, output,
    [](vtkDataSetAttributes* attributes, const Stretches& of, vtkIdType count)
    {
      AddArray(attributes, "Stretch1", of.Larger.head(count));
      AddArray(attributes, "Stretch2", of.Smaller.head(count));
      AddArray(attributes, "StretchDirection1", of.LargerDirections.topRows(count));
      AddArray(attributes, "StretchDirection2", of.SmallerDirections.topRows(count));
    });
}

void AddRateArrays(const SurfaceStretches& stretches, double interval, vtkPolyData* output)
{
  AddToBoth(stretches, output,
    [interval](vtkDataSetAttributes* attributes, const Stretches& of, vtkIdType count)
    {
      const auto rates = [&](const Eigen::VectorXd& values) -> Eigen::VectorXd
      { return Strains(values.head(count), StrainMeasure::Hencky) / interval; };
      AddArray(attributes, "StretchRate1", rates(of.Larger));
      AddArray(attributes, "StretchRate2", rates(of.Smaller));
    });
}

void AddStrainArrays(const SurfaceStretches& stretches, StrainMeasure measure, vtkPolyData* output)
{
  static const char* const names[] = { "BiotStrain", "GreenLagrangeStrain", "HenckyStrain",
    "EulerAlmansiStrain" };
  const std::string name = names[static_cast<int>(measure)];
  AddToBoth(stretches, output,
    [&](vtkDataSetAttributes* attributes, const Stretches& of, vtkIdType count)
    {
      AddArray(attributes, name + "1", Strains(of.Larger.head(count), measure));
      AddArray(attributes, name + "2", Strains(of.Smaller.head(count), measure));
    });
}
}
