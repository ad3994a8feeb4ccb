// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceComparison.h"

#include "Bridge/FilterRun.h"
#include "Bridge/MatchedPieces.h"
#include "Bridge/SurfacePair.h"
#include "Kernel/Measure/ShapeDistance.h"

#include "vtkInformation.h"
#include "vtkPolyData.h"

vtkSurfaceComparison::vtkSurfaceComparison()
{
  this->SetNumberOfInputPorts(2);
}

void vtkSurfaceComparison::SetReferenceConnection(vtkAlgorithmOutput* reference)
{
  this->SetInputConnection(1, reference);
}

void vtkSurfaceComparison::SetReferenceData(vtkPolyData* reference)
{
  this->SetInputData(1, reference);
}

int vtkSurfaceComparison::FillInputPortInformation(int port, vtkInformation* info)
{
  // Optional for the pipeline: a filter may be made first and get its reference then.
  return port == 1 ? SetPortType(info, "vtkPolyData", true)
                   : this->Superclass::FillInputPortInformation(port, info);
}

void vtkSurfaceComparison::Measure(cartan::FilterRun&) {}

void vtkSurfaceComparison::Execute(cartan::FilterRun& run)
{
  vtkPolyData* input = run.Input(0);
  vtkPolyData* reference = run.Input(1);
  if (!reference && !this->NeedsReference())
  {
    run.Output()->ShallowCopy(input);
    this->Measure(run);
    return;
  }
  if (!reference)
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      "There is no reference to compare with, such as the surface before it was deformed.");
  }
  const std::string advice =
    "Give both the same points and cells in the same order, such as a surface before and after it "
    "was deformed.";
  if (run.Pieces())
  {
    const cartan::MatchedPieces pieces = cartan::ReadMatchedPieces(run, { input, reference },
      { "input", "reference" }, 1, cartan::ShapeDistances::LooksAt, advice);
    const cartan::MatchedSurfaces& matched = pieces.Matched;
    run.Output()->ShallowCopy(input);
    this->Compare({ matched.Mesh, matched.Cells, matched.Positions[1], matched.Positions[0], {},
                    pieces.Model->TheSurface->Key, pieces.Model->Rows },
      run);
    return;
  }
  const cartan::MatchedSurfaces matched = cartan::ReadMatchedSurfaces(
    { input, reference }, { "input", "reference" }, advice, run.Context().Part(0.0, 0.1));
  run.KeepSurface(matched.Surfaces[1]); // the other one is new with every motion
  run.Warn(matched.Warning);
  run.Output()->ShallowCopy(input);
  cartan::SurfacePair pair{ matched.Mesh, matched.Cells, matched.Positions[1], matched.Positions[0],
    matched.Surfaces[1]->Borders, cartan::KeyOfSurface(reference) };
  // Its polygons may be triangulated as the current surface's are.
  pair.ReferenceKey.AddBytes(
    matched.Mesh->GetTriangles().data(), matched.Mesh->GetTriangles().size() * sizeof(int));
  this->Compare(pair, run);
}
