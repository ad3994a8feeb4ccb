// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "VtkTestHelpers.h"

#include "vtkCurveDeformation.h"

#include <vector>

namespace vtktest
{
/// An open polyline through points.
inline vtkSmartPointer<vtkPolyData> Line(const cartan::Points& points)
{
  auto line = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    lines->InsertCellPoint(places->InsertNextPoint(points.row(i).data()));
  }
  line->SetPoints(places);
  line->SetLines(lines);
  return line;
}

inline cartan::Points PlacesOf(vtkPolyData* surface, const std::vector<vtkIdType>& ids)
{
  cartan::Points places(static_cast<Eigen::Index>(ids.size()), 3);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    surface->GetPoint(ids[i], places.row(i).data());
  }
  return places;
}

inline void SetPointIds(vtkCurveDeformation* filter, const std::vector<vtkIdType>& ids)
{
  filter->SetNumberOfPointIds(static_cast<int>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    filter->SetPointId(static_cast<int>(i), ids[i]);
  }
}
}
