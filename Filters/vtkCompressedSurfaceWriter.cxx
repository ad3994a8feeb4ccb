// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedSurfaceWriter.h"

#include "Bridge/FilterRun.h"
#include "Bridge/SurfaceCompression.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cstdio>
#include <fstream>

vtkStandardNewMacro(vtkCompressedSurfaceWriter);

/// What is collected over the time steps of one Write().
struct vtkCompressedSurfaceWriter::Internals
{
  std::vector<double> Times; ///< of the input; empty without
  std::size_t Step = 0;      ///< the one that comes next
  cartan::SurfaceCompression Surface;
  cartan::KeptResults Kept;

  bool IsLast(bool writesAll) const { return !writesAll || this->Step + 1 >= this->Times.size(); }
};

vtkCompressedSurfaceWriter::vtkCompressedSurfaceWriter()
  : Collected(std::make_unique<Internals>())
{
}

vtkCompressedSurfaceWriter::~vtkCompressedSurfaceWriter()
{
  this->SetFileName(nullptr);
}

void vtkCompressedSurfaceWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Bits: " << this->Bits << "\n";
  os << indent << "NumberOfAnchors: " << this->NumberOfAnchors << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "VisualErrorAlpha: " << this->VisualErrorAlpha << "\n";
  os << indent << "KeepPointOrder: " << this->KeepPointOrder << "\n";
  os << indent << "WritePointArrays: " << this->WritePointArrays << "\n";
  os << indent << "WriteAllTimeSteps: " << this->WriteAllTimeSteps << "\n";
  os << indent << "UsedBits: " << this->UsedBits << "\n";
  os << indent << "UsedAnchors: " << this->UsedAnchors << "\n";
  os << indent << "FileSize: " << this->FileSize << "\n";
}

int vtkCompressedSurfaceWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

vtkTypeBool vtkCompressedSurfaceWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* info = inputVector[0]->GetInformationObject(0);
  const auto steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  if (info && request->Has(vtkDemandDrivenPipeline::REQUEST_INFORMATION()))
  {
    this->Collected->Times.clear();
    if (info->Has(steps))
    {
      const double* times = info->Get(steps);
      this->Collected->Times.assign(times, times + info->Length(steps));
    }
  }
  if (info && request->Has(vtkStreamingDemandDrivenPipeline::REQUEST_UPDATE_EXTENT()) &&
    this->WriteAllTimeSteps && this->Collected->Step < this->Collected->Times.size())
  {
    info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(),
      this->Collected->Times[this->Collected->Step]);
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkCompressedSurfaceWriter::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->UsedBits = 0;
  this->UsedAnchors = 0;
  this->FileSize = 0;
  cartan::FilterRun run(this, request, inputVector, outputVector, this->Collected->Kept);
  const bool isLast = this->Collected->IsLast(this->WriteAllTimeSteps);
  const cartan::RunOutcome outcome = cartan::RunGuarded([&] { this->Execute(run); });
  if (!outcome.Problem.empty())
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    vtkErrorMacro(<< outcome.Problem);
  }
  if (outcome.IsSuccess() && !isLast)
  {
    ++this->Collected->Step;
    request->Set(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING(), 1);
    return 1;
  }
  request->Remove(vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING());
  const std::vector<double> times = std::move(this->Collected->Times);
  this->Collected = std::make_unique<Internals>();
  this->Collected->Times = times;
  this->WriteTime.Modified();
  return 1;
}

void vtkCompressedSurfaceWriter::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  if (!this->FileName || !*this->FileName)
  {
    throw cartan::Error(cartan::ErrorCode::BadInput, "There is no file to write: set FileName.");
  }
  cartan::RefuseDistributed(this);
  vtkPolyData* input = run.Input();
  const auto surface = run.ReadSurface();
  const std::size_t step = this->Collected->Step;
  double time = step < this->Collected->Times.size() ? this->Collected->Times[step] : 0.0;
  if (input->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()))
  {
    time = input->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
  }
  run.Warn(this->Collected->Surface.Add(surface, input, time, this->WritePointArrays));
  if (!this->Collected->IsLast(this->WriteAllTimeSteps))
  {
    return;
  }
  cartan::CompressionSettings settings;
  settings.Quality = { this->Bits, this->NumberOfAnchors };
  settings.MaximumError = this->MaximumError;
  settings.VisualErrorAlpha = this->VisualErrorAlpha;
  settings.KeepPointOrder = this->KeepPointOrder;
  const std::vector<unsigned char> bytes =
    this->Collected->Surface.Finish(settings, context.Part(0.1, 0.95));
  this->WriteFile(bytes);
  this->UsedBits = this->Collected->Surface.GetQuality().Bits;
  this->UsedAnchors = this->Collected->Surface.GetQuality().Anchors;
  this->FileSize = static_cast<vtkTypeInt64>(bytes.size());
  context.Report(1.0);
}

void vtkCompressedSurfaceWriter::WriteFile(const std::vector<unsigned char>& bytes) const
{
  std::ofstream file(this->FileName, std::ios::binary);
  file.write(
    reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file)
  {
    std::remove(this->FileName);
    throw cartan::Error(cartan::ErrorCode::BadInput,
      std::string(this->FileName) +
        " cannot be written: the folder is missing, not writable, or "
        "full.");
  }
}
