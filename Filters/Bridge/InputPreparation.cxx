// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/InputPreparation.h"

#include "Bridge/RestoredSurface.h"
#include "Kernel/Base/Bytes.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace cartan
{
std::size_t InputPreparation::GetBytes() const
{
  return TotalBytes(this->Soup.Faces, this->Soup.Positions, this->Soup.CellIds,
    this->Repaired.Positions, this->Repaired.Faces, this->Repaired.OriginalPoints,
    this->Repaired.OriginalTriangles, this->Repaired.PreparedPoints, this->Repaired.CopyOf);
}

std::unique_ptr<InputPreparation> PrepareInput(
  vtkPolyData* input, const std::string& role, const ExecutionContext& context)
{
  auto preparation = std::make_unique<InputPreparation>();
  preparation->Soup = ReadTriangles(input, role, context.Part(0.0, 0.2));
  preparation->Repaired =
    RepairSurface(preparation->Soup.Positions, preparation->Soup.Faces, {}, context.Part(0.2, 1.0));
  return preparation;
}

vtkSmartPointer<vtkPolyData> ApplyPreparation(
  const InputPreparation& preparation, vtkPolyData* input)
{
  auto prepared = vtkSmartPointer<vtkPolyData>::New();
  WritePreparedSurface(input, preparation.Soup, preparation.Repaired, false, true, prepared);
  return prepared;
}

std::string RestoreResult(
  vtkPolyData* result, vtkPolyData* input, vtkPolyData* original, vtkPolyData* output)
{
  const std::string warning = WriteRestoredSurface(result, original, output);
  vtkFieldData* fields = result->GetFieldData();
  for (int index = 0; index < fields->GetNumberOfArrays(); ++index)
  {
    vtkAbstractArray* array = fields->GetAbstractArray(index);
    if (!array->GetName() || input->GetFieldData()->GetAbstractArray(array->GetName()) != array)
    {
      output->GetFieldData()->AddArray(array);
    }
  }
  vtkDataArray* scalars = result->GetPointData()->GetScalars();
  if (scalars && scalars->GetName())
  {
    output->GetPointData()->SetActiveScalars(scalars->GetName());
  }
  return warning;
}
}
