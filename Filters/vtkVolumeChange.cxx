// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeChange.h"

#include "Bridge/FilterRun.h"
#include "Bridge/MatchedSurfaces.h"
#include "Bridge/NeighborSteps.h"
#include "Bridge/PointArrays.h"
#include "Bridge/StretchArrays.h"
#include "Bridge/SurfaceChanges.h"
#include "Kernel/Measure/Areas.h"
#include "Kernel/Measure/LocalVolumes.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <limits>

vtkStandardNewMacro(vtkVolumeChange);

vtkVolumeChange::vtkVolumeChange()
  : Steps(std::make_unique<cartan::NeighborSteps>())
{
  this->SetNumberOfOutputPorts(2);
}

vtkVolumeChange::~vtkVolumeChange() = default;

int vtkVolumeChange::RequestInformation(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Steps->ReadTimes(inputVector[0]->GetInformationObject(0));
  return this->Superclass::RequestInformation(request, inputVector, outputVector);
}

int vtkVolumeChange::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* output = outputVector->GetInformationObject(0);
  if (this->ComputeRates && output->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP()))
  {
    this->Steps->Request(inputVector[0]->GetInformationObject(0),
      output->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP()));
  }
  return this->Superclass::RequestUpdateExtent(request, inputVector, outputVector);
}

int vtkVolumeChange::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (this->ComputeRates && !this->Steps->Take(vtkPolyData::GetData(inputVector[0])))
  {
    request->Set(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING(), 1);
    return 1;
  }
  request->Remove(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING());
  const int result = this->Superclass::RequestData(request, inputVector, outputVector);
  this->Steps->Clear();
  return result;
}

void vtkVolumeChange::FollowFirstRank(
  vtkInformation* request, vtkInformationVector** inputVector, bool hasEnded)
{
  if (!hasEnded && request->Has(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING()))
  {
    this->Steps->Take(vtkPolyData::GetData(inputVector[0]));
    return;
  }
  this->Steps->Clear();
}

void vtkVolumeChange::UsePreparedInput(cartan::FilterRun& run) const
{
  if (this->ComputeRates)
  {
    this->RefusePrepareInput();
  }
  this->Superclass::UsePreparedInput(run);
}

vtkTable* vtkVolumeChange::GetChangeTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

double vtkVolumeChange::GetResult(const std::string& name) const
{
  const auto found = this->Results.find(name);
  return found == this->Results.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

int vtkVolumeChange::FillOutputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetOutputType(info, "vtkTable")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

void vtkVolumeChange::Compare(const cartan::SurfacePair& pair, cartan::FilterRun& run)
{
  const auto reference = run.Keep<cartan::ReferenceMeasures>(pair.ReferenceKey,
    [&]
    {
      auto measures =
        std::make_unique<cartan::ReferenceMeasures>(pair, run.Context().Part(0.1, 0.2));
      if (measures->MayEnclose)
      {
        run.GatherInstead("one of its components may be inside another");
      }
      return measures;
    });
  const cartan::SurfaceChanges changes(pair, *reference, run.Context().Part(0.2, 0.3));
  vtkPolyData* output = run.Output();
  if (this->ComputeLocalVolume)
  {
    const auto volumes = run.Keep<cartan::LocalVolumes>(pair.ReferenceKey,
      [&]
      {
        return std::make_unique<cartan::LocalVolumes>(
          pair.Mesh, *pair.Reference, run.Context().Part(0.3, 0.8), pair.Pieces);
      });
    const cartan::MeasuredVolumes measured =
      volumes->Measure(*pair.Current, run.Context().Part(0.8, 1.0));
    const Eigen::VectorXd& localVolume = measured.Values;
    if (!(measured.Rounding <= cartan::LargestVolumeRounding))
    {
      run.Warn("The coordinates have no digits for LocalVolume: the surface is stretched too much "
               "for its volume. Compare surfaces that are stretched less, or switch "
               "ComputeLocalVolume off.");
    }
    cartan::AddPointArray(output, "LocalVolume", localVolume);
    cartan::AddPointArray(
      output, "LocalVolumeRatio", cartan::Ratios(volumes->GetReference(), localVolume));
  }
  changes.AddArrays(output, run.Context());
  this->AddStretches(pair, run);
  if (this->ComputeRates)
  {
    this->AddRates(run);
  }
  vtkNew<vtkTable> elsewhere; // one of several ranks shows the table
  const bool isFirst = !run.Pieces() || run.Pieces()->GetRank() == 0;
  this->Results = changes.FillTable(isFirst ? run.OutputTable(1) : elsewhere.Get());
  for (const auto& [name, value] : this->Results)
  {
    cartan::AddFieldValue(output, name, value);
  }
}

void vtkVolumeChange::AddRates(cartan::FilterRun& run) const
{
  if (!this->Steps->IsComplete() || !(this->Steps->GetInterval() > 0.0))
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      "There are no rates without two time steps or more at times that increase: turn ComputeRates "
      "off, or connect a series and ask for one of its times.");
  }
  const cartan::MatchedSurfaces matched =
    cartan::ReadMatchedSurfaces({ run.Input(0), this->Steps->GetBefore(), this->Steps->GetAfter() },
      { "input", "time step before", "time step after" },
      "Give all time steps the same points and cells in the same order.", run.Context());
  const vtkIdType cells = run.Output()->GetNumberOfCells();
  const cartan::RingStretches ofPoints(matched.Mesh, matched.Positions[1], run.Context());
  cartan::AddRateArrays(cartan::MeasureStretches(ofPoints, *matched.Mesh, *matched.Cells, cells,
                          *matched.Positions[1], *matched.Positions[2], run.Context()),
    this->Steps->GetInterval(), run.Output());
}

void vtkVolumeChange::AddStretches(const cartan::SurfacePair& pair, cartan::FilterRun& run) const
{
  if (!this->ComputeStretches && this->StrainMeasure == NO_STRAIN)
  {
    return;
  }
  vtkPolyData* output = run.Output();
  const auto ofPoints = run.Keep<cartan::RingStretches>(pair.ReferenceKey,
    [&]
    { return std::make_unique<cartan::RingStretches>(pair.Mesh, pair.Reference, run.Context()); });
  const cartan::SurfaceStretches stretches = cartan::MeasureStretches(*ofPoints, *pair.Mesh,
    *pair.Cells, output->GetNumberOfCells(), *pair.Reference, *pair.Current, run.Context());
  if (this->ComputeStretches)
  {
    cartan::AddStretchArrays(stretches, output);
  }
  if (this->StrainMeasure != NO_STRAIN)
  {
    static_assert(static_cast<int>(cartan::StrainMeasure::Biot) == BIOT - 1 &&
        static_cast<int>(cartan::StrainMeasure::GreenLagrange) == GREEN_LAGRANGE - 1 &&
        static_cast<int>(cartan::StrainMeasure::Hencky) == HENCKY - 1 &&
        static_cast<int>(cartan::StrainMeasure::EulerAlmansi) == EULER_ALMANSI - 1,
      "the enumerations agree");
    cartan::AddStrainArrays(
      stretches, static_cast<cartan::StrainMeasure>(this->StrainMeasure - 1), output);
  }
}

void vtkVolumeChange::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ComputeLocalVolume: " << this->ComputeLocalVolume << "\n";
  os << indent << "ComputeStretches: " << this->ComputeStretches << "\n";
  os << indent << "ComputeRates: " << this->ComputeRates << "\n";
  os << indent << "StrainMeasure: " << this->StrainMeasure << "\n";
  for (const auto& [name, value] : this->Results)
  {
    os << indent << name << ": " << value << "\n";
  }
}
