// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh.h"

#include "Copies.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fuzz
{
namespace
{
vtkSmartPointer<vtkCellArray> ToCells(const std::vector<Ids>& cells)
{
  auto array = vtkSmartPointer<vtkCellArray>::New();
  for (const Ids& ids : cells)
  {
    array->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  return array;
}

vtkSmartPointer<vtkDataArray> ToArray(const Array& from)
{
  vtkSmartPointer<vtkDataArray> array;
  if (from.IsInteger)
  {
    array = vtkSmartPointer<vtkIntArray>::New();
  }
  else
  {
    array = vtkSmartPointer<vtkDoubleArray>::New();
  }
  array->SetName(from.Name.c_str());
  array->SetNumberOfComponents(static_cast<int>(from.Values.cols()));
  array->SetNumberOfTuples(from.Values.rows());
  for (Eigen::Index i = 0; i < from.Values.rows(); ++i)
  {
    for (int c = 0; c < from.Values.cols(); ++c)
    {
      array->SetComponent(i, c, from.Values(i, c));
    }
  }
  return array;
}
}

Eigen::MatrixXd Moved(const Eigen::MatrixXd& values, Kind type, double power, const Motion& motion)
{
  const double factor = std::pow(motion.Scale, power);
  Eigen::MatrixXd moved = values;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    switch (type)
    {
      case Kind::Scalar:
        moved.row(i) *= factor;
        break;
      case Kind::Point:
        moved.row(i) = motion(values.row(i).transpose()).transpose();
        break;
      case Kind::Vector:
        moved.row(i) = factor * (motion.Rotation * values.row(i).transpose()).transpose();
        break;
      case Kind::Transform:
      {
        using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
        const Eigen::RowVectorXd row = values.row(i);
        Matrix turned =
          motion.Rotation * Eigen::Map<const Matrix>(row.data()) * motion.Rotation.transpose();
        moved.row(i) = Eigen::Map<Eigen::RowVectorXd>(turned.data(), 9);
        break;
      }
    }
  }
  return moved;
}

const Array* Mesh::Find(const std::string& name) const
{
  const auto found = std::find_if(this->Arrays.begin(), this->Arrays.end(),
    [&](const Array& array) { return array.Name == name; });
  return found == this->Arrays.end() ? nullptr : &*found;
}

double Size(const std::vector<Eigen::Vector3d>& points)
{
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points)
  {
    if (point.allFinite())
    {
      box.extend(point);
    }
  }
  const double size = box.isEmpty() ? 0.0 : box.diagonal().norm();
  return size > 0.0 ? size : 1.0;
}

void Append(Mesh& mesh, const Mesh& other)
{
  const vtkIdType first = mesh.NumberOfPoints();
  mesh.Points.insert(mesh.Points.end(), other.Points.begin(), other.Points.end());
  const auto append = [first](std::vector<Ids>& cells, const std::vector<Ids>& others)
  {
    for (Ids ids : others)
    {
      std::for_each(ids.begin(), ids.end(), [first](vtkIdType& id) { id += first; });
      cells.push_back(std::move(ids));
    }
  };
  append(mesh.Verts, other.Verts);
  append(mesh.Lines, other.Lines);
  append(mesh.Polys, other.Polys);
  append(mesh.Strips, other.Strips);
}

void RoundToFloat(std::vector<Eigen::Vector3d>& points)
{
  for (Eigen::Vector3d& point : points)
  {
    for (double& coordinate : point)
    {
      // GCC 12 leaves both conversions out of the last rounds of a vectorized loop.
      volatile float rounded = static_cast<float>(coordinate);
      coordinate = rounded;
    }
  }
}

void Move(Mesh& mesh, const Motion& motion)
{
  for (Eigen::Vector3d& point : mesh.Points)
  {
    point = motion(point);
  }
  for (Array& array : mesh.Arrays)
  {
    array.Values = Moved(array.Values, array.Type, array.Power, motion);
  }
}

void Permute(Mesh& mesh, const std::vector<vtkIdType>& order, Random& random)
{
  const std::vector<Eigen::Vector3d> points = mesh.Points;
  std::vector<Array> arrays = mesh.Arrays;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.Points[static_cast<std::size_t>(order[i])] = points[i];
    for (std::size_t a = 0; a < arrays.size(); ++a)
    {
      mesh.Arrays[a].Values.row(order[i]) = arrays[a].Values.row(static_cast<Eigen::Index>(i));
    }
  }
  for (std::vector<Ids>* cells : { &mesh.Verts, &mesh.Lines, &mesh.Polys, &mesh.Strips })
  {
    for (Ids& ids : *cells)
    {
      for (vtkIdType& id : ids)
      {
        // Ids of no point stay that.
        id = id < mesh.NumberOfPoints() ? order[static_cast<std::size_t>(id)] : id;
      }
    }
    random.Shuffle(*cells);
  }
}

vtkSmartPointer<vtkPolyData> ToPolyData(const Mesh& mesh)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(mesh.IsFloat ? VTK_FLOAT : VTK_DOUBLE);
  points->SetNumberOfPoints(mesh.NumberOfPoints());
  for (vtkIdType i = 0; i < mesh.NumberOfPoints(); ++i)
  {
    points->SetPoint(i, mesh.Points[static_cast<std::size_t>(i)].data());
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  const auto set = [&](const std::vector<Ids>& cells, void (vtkPolyData::*setter)(vtkCellArray*))
  {
    if (!cells.empty())
    {
      (surface->*setter)(ToCells(cells));
    }
  };
  set(mesh.Verts, &vtkPolyData::SetVerts);
  set(mesh.Lines, &vtkPolyData::SetLines);
  set(mesh.Polys, &vtkPolyData::SetPolys);
  set(mesh.Strips, &vtkPolyData::SetStrips);
  for (const Array& array : mesh.Arrays)
  {
    surface->GetPointData()->AddArray(ToArray(array));
  }
  if (mesh.Find("Normals"))
  {
    surface->GetPointData()->SetActiveNormals("Normals");
  }
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("CellId");
  cellIds->SetNumberOfValues(surface->GetNumberOfCells());
  std::iota(cellIds->Begin(), cellIds->End(), 0);
  surface->GetCellData()->AddArray(cellIds);
  return surface;
}

std::vector<vtkIdType> Components(const Mesh& mesh)
{
  std::vector<vtkIdType> parent(mesh.Points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](vtkIdType id)
  {
    while (parent[static_cast<std::size_t>(id)] != id)
    {
      vtkIdType& up = parent[static_cast<std::size_t>(id)];
      up = parent[static_cast<std::size_t>(up)];
      id = up;
    }
    return id;
  };
  for (const std::vector<Ids>* cells : { &mesh.Polys, &mesh.Strips })
  {
    for (const Ids& ids : *cells)
    {
      for (const vtkIdType id : ids)
      {
        if (id < mesh.NumberOfPoints() && ids[0] < mesh.NumberOfPoints())
        {
          parent[static_cast<std::size_t>(root(id))] = root(ids[0]);
        }
      }
    }
  }
  for (const vtkIdType copy : Copies(mesh))
  {
    parent[static_cast<std::size_t>(root(copy))] = root(Copies(mesh)[0]);
  }
  for (std::size_t i = 0; i < parent.size(); ++i)
  {
    parent[i] = root(static_cast<vtkIdType>(i));
  }
  return parent;
}
}
