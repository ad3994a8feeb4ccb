// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSpectralWatermark.h"

#include "Bridge/FilterRun.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Bridge/SuspectAlignment.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/UsedVertices.h"
#include "Kernel/Spectral/SpectralWatermark.h"

#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

vtkStandardNewMacro(vtkSpectralWatermark);

namespace
{
void AddBitColumn(vtkTable* table, const char* name, const std::vector<char>& bits)
{
  vtkNew<vtkIntArray> column;
  column->SetName(name);
  column->SetNumberOfValues(static_cast<vtkIdType>(bits.size()));
  std::copy(bits.begin(), bits.end(), column->GetPointer(0));
  table->AddColumn(column);
}

/// Eight bits each, the highest first.
std::vector<char> BitsOfText(const std::string& text)
{
  std::vector<char> bits;
  for (const char character : text)
  {
    for (int k = 7; k >= 0; --k)
    {
      bits.push_back(static_cast<char>((static_cast<unsigned char>(character) >> k) & 1));
    }
  }
  return bits;
}

std::string TextOfBits(const std::vector<char>& bits)
{
  std::string text;
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8)
  {
    int byte = 0;
    for (std::size_t k = 0; k < 8; ++k)
    {
      byte = 2 * byte + bits[i + k];
    }
    text += byte >= 32 && byte < 127 ? static_cast<char>(byte) : '?';
  }
  return text;
}
}

vtkSpectralWatermark::vtkSpectralWatermark()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

void vtkSpectralWatermark::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mode: " << this->Mode << "\n";
  os << indent << "Message: " << this->Message << "\n";
  os << indent << "MessageFormat: " << this->MessageFormat << "\n";
  os << indent << "NumberOfBits: " << this->NumberOfBits << "\n";
  os << indent << "Key: " << (this->Key.empty() ? "(empty)" : "(set)") << "\n";
  os << indent << "Strength: " << this->Strength << "\n";
  os << indent << "PatchSize: " << this->PatchSize << "\n";
  os << indent << "ModeFraction: " << this->ModeFraction << "\n";
  os << indent << "Align: " << this->Align << "\n";
  os << indent << "ModeMemoryLimit: " << this->ModeMemoryLimit << "\n";
  os << indent << "ExtractedMessage: " << this->ExtractedMessage << "\n";
  os << indent << "BitErrors: " << this->BitErrors << "\n";
  os << indent << "WeakestConfidence: " << this->WeakestConfidence << "\n";
  os << indent << "ChanceProbability: " << this->ChanceProbability << "\n";
  os << indent << "WatermarkRMS: " << this->WatermarkRMS << "\n";
}

void vtkSpectralWatermark::SetOriginalConnection(vtkAlgorithmOutput* original)
{
  this->SetInputConnection(1, original);
}

void vtkSpectralWatermark::SetOriginalData(vtkPolyData* original)
{
  this->SetInputData(1, original);
}

int vtkSpectralWatermark::FillInputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetPortType(info, "vtkPolyData", true)
                   : this->Superclass::FillInputPortInformation(port, info);
}

int vtkSpectralWatermark::FillOutputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetOutputType(info, "vtkTable")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

vtkTable* vtkSpectralWatermark::GetBitTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

void vtkSpectralWatermark::UsePreparedInput(cartan::FilterRun&) const
{
  this->RefusePrepareInput();
}

void vtkSpectralWatermark::ForgetResults()
{
  this->ExtractedMessage.clear();
  this->BitErrors = -1;
  this->WeakestConfidence = 0.0;
  this->ChanceProbability = 1.0;
  this->WatermarkRMS = 0.0;
}

std::vector<char> vtkSpectralWatermark::MessageBits() const
{
  if (this->MessageFormat == TEXT)
  {
    return BitsOfText(this->Message);
  }
  const std::size_t other = this->Message.find_first_not_of("01");
  if (other != std::string::npos)
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      "The message of bits has another character than 0 and 1 at place " + std::to_string(other) +
        ": write bits, or choose the message format Text.");
  }
  std::vector<char> bits(this->Message.size());
  std::transform(this->Message.begin(), this->Message.end(), bits.begin(),
    [](char character) { return static_cast<char>(character == '1'); });
  return bits;
}

std::shared_ptr<const cartan::SpectralWatermark> vtkSpectralWatermark::MakeWatermark(
  cartan::FilterRun& run, const cartan::Surface& surface)
{
  // Patches and modes are those of the connectivity alone.
  const cartan::Triangles& triangles = surface.Mesh->GetTriangles();
  cartan::ContentKey key;
  key.Add(static_cast<std::uint64_t>(surface.Mesh->NumberOfVertices()));
  key.AddBytes(triangles.data(), triangles.size() * sizeof(int));
  key.Add(static_cast<std::uint64_t>(this->PatchSize)).Add(this->ModeFraction);
  key.Add(static_cast<std::uint64_t>(this->ModeMemoryLimit)); // which may refuse
  return run.Keep<cartan::SpectralWatermark>(key,
    [&]
    {
      cartan::SpectralWatermark::Settings settings;
      settings.PatchSize = this->PatchSize;
      settings.ModeFraction = this->ModeFraction;
      settings.MaximumBytes = std::uint64_t{ 1000000 } * this->ModeMemoryLimit;
      return std::make_unique<cartan::SpectralWatermark>(
        *surface.Mesh, settings, run.Context().Part(0.15, 0.7));
    });
}

void vtkSpectralWatermark::Embed(cartan::FilterRun& run)
{
  const std::vector<char> bits = this->MessageBits();
  const auto surface = run.ReadSurface();
  const auto watermark = this->MakeWatermark(run, *surface);
  const double diagonal =
    cartan::BoundingDiagonal(*surface->Positions, surface->Mesh->GetTriangles());
  const cartan::Points signal = watermark->Signal(bits, this->Key, this->Strength * diagonal);
  vtkPolyData* output = run.Output();
  run.Warn(cartan::WriteSurface(
    *surface, *surface->Positions + signal, run.Input(), output, run.Context().Part(0.7, 1.0)));
  vtkNew<vtkIntArray> patches;
  patches->SetName("Patch");
  patches->SetNumberOfValues(output->GetNumberOfPoints());
  std::copy(watermark->GetPatchOfVertex().begin(), watermark->GetPatchOfVertex().end(),
    patches->GetPointer(0));
  output->GetPointData()->AddArray(patches);
  const auto count = static_cast<double>(cartan::UsedVertices(*surface->Mesh).size());
  this->WatermarkRMS =
    cartan::AddFieldValue(output, "WatermarkRMS", signal.norm() / std::sqrt(count));
  AddBitColumn(run.OutputTable(1), "Bit", bits);
}

void vtkSpectralWatermark::Extract(cartan::FilterRun& run)
{
  if (!run.Input(1))
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      "The original surface is missing: connect it to input port 1 (Original).");
  }
  const std::vector<char> expected = this->MessageBits();
  const auto suspect = run.ReadSurface();
  const auto original =
    cartan::ReadSurface(run.Input(1), "original", run.Context().Part(0.1, 0.15));
  run.KeepSurface(original);
  run.Warn(original->Describe("original", run.Input(1)));
  const auto watermark = this->MakeWatermark(run, *original);
  const cartan::AlignedSuspect aligned =
    cartan::AlignSuspect(*original, *suspect, this->Align, run.Context().Part(0.7, 0.95));
  const int count = expected.empty() ? this->NumberOfBits : static_cast<int>(expected.size());
  const cartan::WatermarkReading reading =
    watermark->Read(aligned.AtOriginal - *original->Positions, count, this->Key);

  vtkPolyData* output = run.Output();
  const Eigen::RowVector3d shift = (original->Origin - suspect->Origin).transpose();
  run.Warn(cartan::WriteSurface(
    *suspect, aligned.Moved.rowwise() + shift, run.Input(), output, run.Context().Part(0.95, 1.0)));
  vtkTable* table = run.OutputTable(1);
  AddBitColumn(table, "Bit", reading.Bits);
  cartan::AddColumn(table, "Score", reading.Scores);
  const Eigen::VectorXd confidences = reading.Scores.unaryExpr(&cartan::WatermarkConfidence);
  cartan::AddColumn(table, "Confidence", confidences);
  this->WeakestConfidence =
    cartan::AddFieldValue(output, "WeakestConfidence", confidences.minCoeff());
  this->ChanceProbability = cartan::ChanceOfScores(reading.Scores);
  if (!expected.empty())
  {
    AddBitColumn(table, "Expected", expected);
    this->BitErrors = static_cast<int>(std::inner_product(expected.begin(), expected.end(),
      reading.Bits.begin(), 0, std::plus<int>(), std::not_equal_to<char>()));
    cartan::AddFieldValue(output, "BitErrors", this->BitErrors);
    this->ChanceProbability = cartan::ChanceOfMatches(count - this->BitErrors, count);
  }
  cartan::AddFieldValue(output, "ChanceProbability", this->ChanceProbability);
  if (this->MessageFormat == TEXT)
  {
    this->ExtractedMessage = TextOfBits(reading.Bits);
    return;
  }
  for (const char bit : reading.Bits)
  {
    this->ExtractedMessage += bit ? '1' : '0';
  }
}

void vtkSpectralWatermark::Execute(cartan::FilterRun& run)
{
  this->Mode == EMBED ? this->Embed(run) : this->Extract(run);
  run.Context().Report(1.0);
}
