// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/MergedSurfaceWriter.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Mesh/Geometry.h"

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
/// One tuple of the output for each element: from the target, or else the source.
struct Elements
{
  std::vector<vtkIdType> TargetIds; ///< -1: none
  std::vector<vtkIdType> SourceIds;
  std::vector<int> Origins;
  const char* IdsName;
};

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
    fields.CopyData(isTargets ? 0 : 1, isTargets ? ofTarget : ofSource, id, output, i);
    ids->SetValue(i, id);
    origins->SetValue(i, elements.Origins[i]);
  }
  output->AddArray(ids);
  output->AddArray(origins);
}
}

void WriteMergedSurface(const MergedInput& target, const MergedInput& source,
  const JoinedSurface& joined, const TriangleMesh& mesh, const Points& positions,
  vtkPolyData* output)
{
  Elements points{ {}, {}, {}, "OriginalPointIds" };
  std::vector<vtkIdType> numbers(joined.NumberOfVertices(), -1);
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataType(target.Data->GetPoints()->GetDataType());
  std::vector<int> used;
  for (int v = 0; v < joined.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      const int ofTarget = joined.TargetVertices[v];
      // To the origin and back would cost coordinates their last bit.
      const bool isInPlace =
        ofTarget >= 0 && positions.row(v) == target.Read->Positions->row(ofTarget);
      const Eigen::Vector3d point = isInPlace
        ? Eigen::Vector3d(target.Data->GetPoint(ofTarget))
        : Eigen::Vector3d(positions.row(v).transpose() + target.Read->Origin);
      numbers[v] = coordinates->InsertNextPoint(point.data());
      used.push_back(v);
      points.TargetIds.push_back(ofTarget);
      points.SourceIds.push_back(joined.SourceVertices[v]);
      points.Origins.push_back(joined.IsSeam[v] ? 2 : ofTarget >= 0 ? 0 : 1);
    }
  }
  Elements cells{ {}, {}, {}, "OriginalCellIds" };
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
  output->SetPoints(coordinates);
  output->SetPolys(polygons);
  WriteAttributes(
    points, target.Data->GetPointData(), source.Data->GetPointData(), output->GetPointData());
  WriteAttributes(
    cells, target.Data->GetCellData(), source.Data->GetCellData(), output->GetCellData());
  if (target.Data->GetPointData()->GetNormals() || source.Data->GetPointData()->GetNormals())
  {
    const Points normals = VertexNormals(mesh, positions)(used, Eigen::all);
    AddPointArray(output, "Normals", normals);
    output->GetPointData()->SetActiveNormals("Normals");
  }
}
}
