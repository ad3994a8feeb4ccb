// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/MergedSurfaceWriter.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/UsedVertices.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributesFieldList.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <type_traits>

namespace cartan
{
namespace
{
bool IsReal(vtkDataArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

/// One tuple of the output for each element: from the target, or else the source.
struct Elements
{
  std::vector<vtkIdType> TargetIds; ///< -1: none
  std::vector<vtkIdType> SourceIds;
  std::vector<int> Origins;
  const char* IdsName;
  /// Empty, or how much is the source's, and where on the target the rest is from.
  std::vector<double> SourceParts;
  std::vector<SurfacePlace> TargetPlaces;
};

vtkIdType NearestCorner(const SurfacePlace& place)
{
  Eigen::Index nearest = 0;
  place.Weights.maxCoeff(&nearest);
  return place.Corners[nearest];
}

/// Interpolates a tuple between the corners of its place on the target, and between that
/// and the source's.
void FadeTuple(const Elements& elements, const vtkDataSetAttributesFieldList& fields,
  vtkDataSetAttributes* target, vtkDataSetAttributes* source, vtkDataSetAttributes* output,
  vtkIdType i)
{
  const SurfacePlace& place = elements.TargetPlaces[i];
  const double part = elements.SourceParts[i];
  fields.TransformData(0, target, output,
    [&](vtkAbstractArray* from, vtkAbstractArray* to)
    {
      to->InsertTuple(i, NearestCorner(place), from);
      vtkDataArray* const values = vtkDataArray::SafeDownCast(from);
      if (values && IsReal(values))
      {
        for (int c = 0; c < values->GetNumberOfComponents(); ++c)
        {
          double value = 0.0;
          for (int corner = 0; corner < 3; ++corner)
          {
            value += place.Weights[corner] * values->GetComponent(place.Corners[corner], c);
          }
          vtkDataArray::SafeDownCast(to)->SetComponent(i, c, value);
        }
      }
    });
  if (!(part > 0.0))
  {
    return;
  }
  const vtkIdType id = elements.SourceIds[i];
  fields.TransformData(1, source, output,
    [&](vtkAbstractArray* from, vtkAbstractArray* to)
    {
      vtkDataArray* const values = vtkDataArray::SafeDownCast(from);
      if (values && IsReal(values))
      {
        vtkDataArray* const results = vtkDataArray::SafeDownCast(to);
        for (int c = 0; c < values->GetNumberOfComponents(); ++c)
        {
          results->SetComponent(
            i, c, (1.0 - part) * results->GetComponent(i, c) + part * values->GetComponent(id, c));
        }
      }
      else if (part > 0.5)
      {
        to->InsertTuple(i, id, from);
      }
    });
}

/// What is carried over, without what is made anew or means something else afterwards.
template <typename Attributes>
vtkSmartPointer<Attributes> Carried(Attributes* attributes, const char* idsName)
{
  auto carried = vtkSmartPointer<Attributes>::New();
  carried->ShallowCopy(attributes);
  carried->SetGlobalIds(nullptr);
  carried->SetPedigreeIds(nullptr);
  if (vtkDataArray* normals = attributes->GetNormals())
  {
    carried->RemoveArray(normals->GetName());
    carried->SetNormals(nullptr);
  }
  carried->RemoveArray(idsName);
  carried->RemoveArray("MergeOrigin");
  carried->RemoveArray("SourcePart");
  return carried;
}

template <typename Attributes>
void WriteAttributes(
  const Elements& elements, Attributes* target, Attributes* source, Attributes* output)
{
  const auto ofTarget = Carried(target, elements.IdsName);
  const auto ofSource = Carried(source, elements.IdsName);
  vtkDataSetAttributesFieldList fields(2);
  fields.IntersectFieldList(ofTarget);
  fields.IntersectFieldList(ofSource);
  const auto count = static_cast<vtkIdType>(elements.Origins.size());
  fields.CopyAllocate(output, vtkDataSetAttributes::COPYTUPLE, count, 0);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName(elements.IdsName);
  ids->SetNumberOfValues(count);
  vtkNew<vtkIntArray> origins;
  origins->SetName("MergeOrigin");
  origins->SetNumberOfValues(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const bool isTargets = elements.TargetIds[i] >= 0;
    const vtkIdType id = isTargets ? elements.TargetIds[i] : elements.SourceIds[i];
    if (elements.SourceParts.empty() || elements.SourceParts[i] == 1.0)
    {
      fields.CopyData(isTargets ? 0 : 1, isTargets ? ofTarget : ofSource, id, output, i);
    }
    else
    {
      FadeTuple(elements, fields, ofTarget, ofSource, output, i);
    }
    ids->SetValue(i, id);
    origins->SetValue(i, elements.Origins[i]);
  }
  output->AddArray(ids);
  output->AddArray(origins);
}

/// `numbers` are the output's points of the joined vertices.
void WriteCells(const MergedInput& target, const MergedInput& source, const JoinedSurface& joined,
  const std::vector<vtkIdType>& numbers, vtkPolyData* output)
{
  Elements cells{ {}, {}, {}, "OriginalCellIds", {}, {} };
  vtkNew<vtkCellArray> polygons;
  for (Eigen::Index f = 0; f < joined.Faces.rows(); ++f)
  {
    polygons->InsertNextCell(
      { numbers[joined.Faces(f, 0)], numbers[joined.Faces(f, 1)], numbers[joined.Faces(f, 2)] });
    const bool isSources = joined.IsSourceFace[f];
    const Surface& read = isSources ? *source.Read : *target.Read;
    const vtkIdType id = read.Cells->CellIds[joined.OriginalFaces[f]];
    cells.TargetIds.push_back(isSources ? -1 : id);
    cells.SourceIds.push_back(isSources ? id : -1);
    cells.Origins.push_back(isSources ? 1 : 0);
  }
  output->SetPolys(polygons);
  WriteAttributes(
    cells, target.Data->GetCellData(), source.Data->GetCellData(), output->GetCellData());
}
}

void WriteMergedSurface(const MergedInput& target, const MergedInput& source,
  const JoinedSurface& joined, const TriangleMesh& mesh, const Points& positions,
  const Fading& fading, vtkPolyData* output)
{
  const bool fades = fading.SourceParts.size() > 0;
  Elements points{ {}, {}, {}, "OriginalPointIds", {}, {} };
  std::vector<vtkIdType> numbers(joined.NumberOfVertices(), -1);
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataType(target.Data->GetPoints()->GetDataType());
  const std::vector<int> used = UsedVertices(mesh);
  for (const int v : used)
  {
    const int ofTarget = joined.TargetVertices[v];
    // To the origin and back would cost coordinates their last bit.
    const bool isInPlace = ofTarget >= 0 && ofTarget < target.Read->Positions->rows() &&
      positions.row(v) == target.Read->Positions->row(ofTarget);
    const Eigen::Vector3d point = isInPlace
      ? Eigen::Vector3d(target.Data->GetPoint(ofTarget))
      : Eigen::Vector3d(positions.row(v).transpose() + target.Read->Origin);
    numbers[v] = coordinates->InsertNextPoint(point.data());
    points.TargetIds.push_back(
      fades && ofTarget >= 0 ? NearestCorner(fading.TargetPlaces[v]) : ofTarget);
    points.SourceIds.push_back(joined.SourceVertices[v]);
    points.Origins.push_back(joined.IsSeam[v] ? 2 : ofTarget >= 0 ? 0 : 1);
    if (fades)
    {
      points.SourceParts.push_back(fading.SourceParts[v]);
      points.TargetPlaces.push_back(fading.TargetPlaces[v]);
    }
  }
  output->SetPoints(coordinates);
  WriteAttributes(
    points, target.Data->GetPointData(), source.Data->GetPointData(), output->GetPointData());
  WriteCells(target, source, joined, numbers, output);
  if (fades)
  {
    AddPointArray(output, "SourcePart", Eigen::VectorXd(fading.SourceParts(used)));
  }
  if (target.Data->GetPointData()->GetNormals() || source.Data->GetPointData()->GetNormals())
  {
    const Points normals = VertexNormals(mesh, positions)(used, Eigen::all);
    AddPointArray(output, "Normals", normals);
    output->GetPointData()->SetActiveNormals("Normals");
  }
}
}
