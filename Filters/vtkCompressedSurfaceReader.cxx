// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedSurfaceReader.h"

#include "Bridge/FilterRun.h"
#include "Bridge/SurfaceCompression.h"
#include "Kernel/Compression/SectionFile.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <fstream>

vtkStandardNewMacro(vtkCompressedSurfaceReader);

namespace
{
/// Throws Error(BadInput) when there is no such file.
std::vector<unsigned char> BytesOf(const std::string& name)
{
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  std::vector<unsigned char> bytes(static_cast<std::size_t>(std::max<std::streamoff>(size, 0)));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (size < 0 || !file)
  {
    throw cartan::Error(cartan::ErrorCode::BadInput, "it is not there, or may not be read");
  }
  return bytes;
}
}

/// A decoded file, found by its checksum.
struct vtkCompressedSurfaceReader::Internals
{
  std::uint32_t Checksum = 0;
  std::size_t Size = 0;
  cartan::CompressedSurface Surface;
  std::unique_ptr<cartan::HighPassCoder> Coder;

  void Read(const std::string& name, const cartan::ExecutionContext& context)
  {
    const std::vector<unsigned char> bytes = BytesOf(name);
    const std::uint32_t sum = cartan::sectionfile::Checksum(bytes.data(), bytes.size());
    if (this->Coder && sum == this->Checksum && bytes.size() == this->Size)
    {
      return;
    }
    this->Coder.reset();
    this->Surface = cartan::Decompress(bytes.data(), bytes.size());
    this->Coder = std::make_unique<cartan::HighPassCoder>(this->Surface.Mesh,
      this->Surface.Steps.front().Code.Anchors, cartan::SolverBackend::Automatic, context);
    this->Checksum = sum;
    this->Size = bytes.size();
  }

  /// The step at a time, or the last before it.
  const cartan::CodedStep& StepAt(double time) const
  {
    const cartan::CodedStep* found = &this->Surface.Steps.front();
    for (const cartan::CodedStep& step : this->Surface.Steps)
    {
      found = step.Time <= time ? &step : found;
    }
    return *found;
  }
};

vtkCompressedSurfaceReader::vtkCompressedSurfaceReader()
  : Kept(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(0);
}

vtkCompressedSurfaceReader::~vtkCompressedSurfaceReader()
{
  this->SetFileName(nullptr);
}

void vtkCompressedSurfaceReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
}

int vtkCompressedSurfaceReader::CanReadFile(const char* fileName)
{
  unsigned char magic[8] = {};
  std::ifstream file(fileName ? fileName : "", std::ios::binary);
  file.read(reinterpret_cast<char*>(magic), sizeof(magic));
  return file && cartan::sectionfile::HasMagic(magic, sizeof(magic)) ? 1 : 0;
}

int vtkCompressedSurfaceReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  std::vector<double> times;
  // What is wrong with a file is said once, by RequestData().
  cartan::RunGuarded(
    [&]
    {
      const std::vector<unsigned char> bytes = BytesOf(this->FileName ? this->FileName : "");
      times = cartan::ReadTimes(bytes.data(), bytes.size());
    });
  vtkInformation* info = outputVector->GetInformationObject(0);
  info->Remove(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  info->Remove(vtkStreamingDemandDrivenPipeline::TIME_RANGE());
  if (times.size() > 1)
  {
    const double range[2] = { times.front(), times.back() };
    info->Set(
      vtkStreamingDemandDrivenPipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

int vtkCompressedSurfaceReader::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  cartan::KeptResults none;
  cartan::FilterRun run(this, request, inputVector, outputVector, none);
  vtkInformation* info = outputVector->GetInformationObject(0);
  const cartan::RunOutcome outcome = cartan::RunGuarded(
    [&]
    {
      const cartan::ExecutionContext& context = run.Context();
      if (!this->FileName || !*this->FileName)
      {
        throw cartan::Error(cartan::ErrorCode::BadInput, "no FileName is set");
      }
      this->Kept->Read(this->FileName, context.Part(0.1, 0.7));
      const auto key = vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP();
      const cartan::CodedStep& step = this->Kept->StepAt(
        info->Has(key) ? info->Get(key) : this->Kept->Surface.Steps.front().Time);
      cartan::WriteDecodedStep(
        this->Kept->Surface, step, *this->Kept->Coder, run.Output(), context.Part(0.7, 1.0));
      run.Output()->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), step.Time);
      context.Report(1.0);
    });
  if (!outcome.IsSuccess())
  {
    run.Output()->Initialize();
  }
  if (!outcome.Problem.empty())
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    vtkErrorMacro(<< (this->FileName ? this->FileName : "A compressed surface")
                  << " cannot be read: " << outcome.Problem << ".");
  }
  return 1;
}
