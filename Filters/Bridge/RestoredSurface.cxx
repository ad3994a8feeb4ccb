// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/RestoredSurface.h"

#include "Bridge/PointArrays.h"
#include "Bridge/PreparedSurface.h"
#include "Kernel/Mesh/Geometry.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace cartan
{
namespace
{
/// An array of ids as vtkPrepareSurface writes it, with values from `least` to
/// below `limit`, and of `size` values.
std::vector<vtkIdType> ReadIds(
  vtkFieldData* data, const char* name, vtkIdType size, vtkIdType least, vtkIdType limit)
{
  vtkDataArray* array = data->GetArray(name);
  if (!array || array->GetNumberOfComponents() != 1)
  {
    throw Error(ErrorCode::BadInput,
      std::string("The prepared surface has no array ") + name +
        ": connect the output of Prepare Surface, or of a filter after it that passes its arrays.");
  }
  IdSample bad;
  std::vector<vtkIdType> ids(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    ids[i] = static_cast<vtkIdType>(array->GetTuple1(static_cast<vtkIdType>(i)));
    if (ids[i] < least || ids[i] >= limit)
    {
      bad.Add(static_cast<long long>(i));
    }
  }
  if (array->GetNumberOfTuples() != size || !bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      std::string("The array ") + name + " does not fit the original surface (" +
        std::to_string(array->GetNumberOfTuples()) + " values for " + std::to_string(size) + ", " +
        std::to_string(bad.GetCount()) +
        " of them out of range): connect the surface that Prepare Surface had as its input.");
  }
  return ids;
}

/// How points and cells of the two surfaces belong together.
struct Correspondence
{
  std::vector<vtkIdType> OriginalPoints; // of each prepared point
  std::vector<vtkIdType> PreparedPoints; // of each original point, or -1
  std::vector<vtkIdType> OriginalCells;  // of each prepared cell, or -1
  std::vector<vtkIdType> PreparedCells;  // of each original cell, the first, or -1
};

Correspondence ReadCorrespondence(vtkPolyData* prepared, vtkPolyData* original)
{
  const vtkIdType numberOfPoints = original->GetNumberOfPoints();
  const vtkIdType numberOfCells = original->GetNumberOfCells();
  Correspondence ids;
  ids.OriginalPoints = ReadIds(
    prepared->GetPointData(), OriginalPointIds, prepared->GetNumberOfPoints(), 0, numberOfPoints);
  ids.PreparedPoints = ReadIds(
    prepared->GetFieldData(), PreparedPointIds, numberOfPoints, -1, prepared->GetNumberOfPoints());
  ids.OriginalCells = ReadIds(
    prepared->GetCellData(), OriginalCellIds, prepared->GetNumberOfCells(), -1, numberOfCells);
  ids.PreparedCells.assign(static_cast<std::size_t>(numberOfCells), -1);
  for (std::size_t cell = ids.OriginalCells.size(); cell-- > 0;)
  {
    if (ids.OriginalCells[cell] >= 0)
    {
      ids.PreparedCells[ids.OriginalCells[cell]] = static_cast<vtkIdType>(cell);
    }
  }
  return ids;
}

/// Where each original point goes, and in `parted` those whose copies went
/// different ways: there, the middle. A point in the place of its prepared point
/// before goes exactly where that one is.
Points MovedPoints(
  const Correspondence& ids, const Points& prepared, const Points& original, IdSample& parted)
{
  Points first = original;
  // Of the differences from the first: copies in the same place leave it exactly.
  Points sum = Points::Zero(original.rows(), 3);
  std::vector<int> count(original.rows(), 0);
  std::vector<char> isParted(original.rows(), 0);
  const auto add = [&](vtkIdType v, vtkIdType from)
  {
    const Eigen::RowVector3d rest = original.row(v);
    const Eigen::RowVector3d place =
      prepared.row(from) + (rest - original.row(ids.OriginalPoints[from]));
    if (count[v] == 0)
    {
      first.row(v) = place;
    }
    const Eigen::RowVector3d mean = first.row(v) + sum.row(v) / std::max(count[v], 1);
    // Copies that move alike do so but for the last digits of a solution.
    isParted[v] = isParted[v] ||
      (count[v] > 0 &&
        (place - mean).norm() > 1e-6 * ((place - rest).norm() + (mean - rest).norm()));
    sum.row(v) += place - first.row(v);
    ++count[v];
  };
  for (std::size_t v = 0; v < ids.PreparedPoints.size(); ++v)
  {
    if (ids.PreparedPoints[v] >= 0)
    {
      add(static_cast<vtkIdType>(v), ids.PreparedPoints[v]);
    }
  }
  for (std::size_t from = 0; from < ids.OriginalPoints.size(); ++from)
  {
    const vtkIdType v = ids.OriginalPoints[from];
    if (ids.PreparedPoints[v] != static_cast<vtkIdType>(from))
    {
      add(v, static_cast<vtkIdType>(from));
    }
  }
  for (Eigen::Index v = 0; v < sum.rows(); ++v)
  {
    first.row(v) += sum.row(v) / std::max(count[v], 1);
    if (isParted[v])
    {
      parted.Add(v);
    }
  }
  return first;
}

void WritePoints(vtkPolyData* original, const Points& positions, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(original->GetPoints()->GetDataType());
  points->DeepCopy(original->GetPoints());
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
  {
    points->SetPoint(v, positions.row(v).data());
  }
  output->SetPoints(points);
}

/// Whether the tuples of an array differ from those that they come from, where
/// there is exactly one of these.
bool HasChanged(vtkAbstractArray* prepared, vtkAbstractArray* original,
  const std::vector<vtkIdType>& originalIds, const std::vector<vtkIdType>& preparedIds)
{
  if (prepared->GetDataType() != original->GetDataType() ||
    prepared->GetNumberOfComponents() != original->GetNumberOfComponents())
  {
    return true;
  }
  std::vector<int> count(originalIds.size(), 0);
  for (const vtkIdType id : preparedIds)
  {
    if (id >= 0)
    {
      ++count[id];
    }
  }
  const int components = prepared->GetNumberOfComponents();
  for (std::size_t i = 0; i < originalIds.size(); ++i)
  {
    for (int c = 0; count[i] == 1 && originalIds[i] >= 0 && c < components; ++c)
    {
      const vtkVariant a = prepared->GetVariantValue(static_cast<vtkIdType>(i) * components + c);
      const vtkVariant b = original->GetVariantValue(originalIds[i] * components + c);
      if (a != b)
      {
        return true;
      }
    }
  }
  return false;
}

/// Carries the arrays of the prepared points or cells to the original ones.
void CarryArrays(vtkDataSetAttributes* prepared, const std::vector<vtkIdType>& originalIds,
  const std::vector<vtkIdType>& preparedIds, vtkDataSetAttributes* original,
  vtkDataSetAttributes* output)
{
  const std::set<std::string> own = { OriginalPointIds, OriginalCellIds, CopyOf, JoinedPoints };
  for (int index = 0; index < prepared->GetNumberOfArrays(); ++index)
  {
    vtkAbstractArray* array = prepared->GetAbstractArray(index);
    const char* name = array->GetName();
    if (!name || own.count(name) > 0 ||
      array == prepared->GetAbstractAttribute(vtkDataSetAttributes::NORMALS))
    {
      continue;
    }
    vtkAbstractArray* before = original->GetAbstractArray(name);
    if (before && !HasChanged(array, before, originalIds, preparedIds))
    {
      continue;
    }
    auto carried = vtk::TakeSmartPointer(array->NewInstance());
    carried->SetName(name);
    carried->SetNumberOfComponents(array->GetNumberOfComponents());
    carried->CopyComponentNames(array);
    carried->SetNumberOfTuples(static_cast<vtkIdType>(preparedIds.size()));
    auto* numbers = vtkDataArray::SafeDownCast(carried);
    if (numbers)
    {
      numbers->Fill(0.0);
    }
    const bool keeps = before && before->GetDataType() == array->GetDataType() &&
      before->GetNumberOfComponents() == array->GetNumberOfComponents();
    for (std::size_t i = 0; i < preparedIds.size(); ++i)
    {
      const auto tuple = static_cast<vtkIdType>(i);
      if (preparedIds[i] >= 0)
      {
        carried->SetTuple(tuple, preparedIds[i], array);
      }
      else if (keeps)
      {
        carried->SetTuple(tuple, tuple, before);
      }
    }
    output->AddArray(carried);
  }
}

/// Unit normals of points and cells of the original's own triangles; zero where
/// there is none.
struct ComputedNormals
{
  Points OfPoints;
  Points OfCells;
};

/// Rows of length zero stay that.
void NormalizeRows(Points& rows)
{
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    rows.row(i).stableNormalize();
  }
}

ComputedNormals ComputeNormals(
  const TriangleSoup& soup, const Points& positions, vtkIdType numberOfCells)
{
  const Points areaVectors = TriangleAreaVectors(positions, soup.Faces);
  ComputedNormals normals{ Points::Zero(positions.rows(), 3), Points::Zero(numberOfCells, 3) };
  for (Eigen::Index t = 0; t < areaVectors.rows(); ++t)
  {
    normals.OfCells.row(soup.CellIds[t]) += areaVectors.row(t);
    for (int corner = 0; corner < 3; ++corner)
    {
      normals.OfPoints.row(soup.Faces(t, corner)) += areaVectors.row(t);
    }
  }
  NormalizeRows(normals.OfPoints);
  NormalizeRows(normals.OfCells);
  return normals;
}

/// Turns normals by the smallest rotation from `before` to `after`, row by row.
void TurnNormals(vtkDataSetAttributes* attributes, const Points& before, const Points& after)
{
  vtkDataArray* old = attributes->GetNormals();
  if (!old)
  {
    return;
  }
  auto turned = vtk::TakeSmartPointer(old->NewInstance());
  turned->DeepCopy(old);
  for (Eigen::Index i = 0; i < before.rows(); ++i)
  {
    if (before.row(i) == after.row(i) || before.row(i).isZero(0.0) || after.row(i).isZero(0.0))
    {
      continue;
    }
    Eigen::Vector3d normal;
    turned->GetTuple(i, normal.data());
    const Eigen::Vector3d from = before.row(i);
    const Eigen::Vector3d to = after.row(i);
    normal = Eigen::Quaterniond::FromTwoVectors(from, to) * normal;
    turned->SetTuple(i, normal.data());
  }
  attributes->SetNormals(turned);
}
}

std::string WriteRestoredSurface(vtkPolyData* prepared, vtkPolyData* original, vtkPolyData* output)
{
  const Correspondence ids = ReadCorrespondence(prepared, original);
  const TriangleSoup soup = ReadTriangles(original, "original");
  IdSample parted;
  const Points moved = MovedPoints(ids, ReadPoints(prepared), soup.Positions, parted);

  output->ShallowCopy(original);
  WritePoints(original, moved, output);
  CarryArrays(prepared->GetPointData(), ids.OriginalPoints, ids.PreparedPoints,
    original->GetPointData(), output->GetPointData());
  CarryArrays(prepared->GetCellData(), ids.OriginalCells, ids.PreparedCells,
    original->GetCellData(), output->GetCellData());
  const ComputedNormals before = ComputeNormals(soup, soup.Positions, original->GetNumberOfCells());
  const ComputedNormals after = ComputeNormals(soup, moved, original->GetNumberOfCells());
  TurnNormals(output->GetPointData(), before.OfPoints, after.OfPoints);
  TurnNormals(output->GetCellData(), before.OfCells, after.OfCells);
  if (parted.IsEmpty())
  {
    return {};
  }
  return "The original has " + parted.Describe("point", "points") +
    " of which Prepare Surface made copies that have parted: placed in their middle. To keep "
    "the parts apart, go on with the prepared surface.";
}
}
