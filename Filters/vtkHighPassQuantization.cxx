// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHighPassQuantization.h"

#include "Bridge/FilterRun.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Compression/HighPassQuantization.h"
#include "Kernel/Compression/QualitySearch.h"
#include "Kernel/Mesh/UsedVertices.h"

#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <cmath>
#include <memory>

vtkStandardNewMacro(vtkHighPassQuantization);

namespace
{
/// A code with the surface that is decoded from it.
struct Decoded
{
  Decoded(const cartan::Surface& surface, const cartan::HighPassCoder& coder, int bits,
    double alpha, const cartan::ExecutionContext& context)
    : Code(coder.Encode(*surface.Positions, bits))
    , Positions(coder.Decode(this->Code, context))
    , Errors(
        cartan::VisualError(*surface.Mesh, *surface.Positions, this->Positions, alpha, context))
  {
    const auto count = static_cast<double>(cartan::UsedVertices(*surface.Mesh).size());
    this->RootMeanSquare = this->Errors.norm() / std::sqrt(count);
  }

  cartan::HighPassCode Code;
  cartan::Points Positions;
  Eigen::VectorXd Errors;
  double RootMeanSquare = 0.0;
};

/// The fewest bits that meet the bound.
std::unique_ptr<Decoded> DecodedWithFewestBits(const cartan::Surface& surface,
  const cartan::HighPassCoder& coder, double maximumError, double alpha,
  const cartan::ExecutionContext& context)
{
  const double diagonal =
    (surface.Positions->colwise().maxCoeff() - surface.Positions->colwise().minCoeff()).norm();
  std::unique_ptr<Decoded> decoded;
  cartan::FewestBits(
    [&](int bits)
    {
      decoded = std::make_unique<Decoded>(
        surface, coder, bits, alpha, context.Part((bits - 1.0) / 16.0, bits / 16.0));
      return decoded->RootMeanSquare / diagonal;
    },
    maximumError, coder.NumberOfAnchors());
  return decoded;
}
}

void vtkHighPassQuantization::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Bits: " << this->Bits << "\n";
  os << indent << "NumberOfAnchors: " << this->NumberOfAnchors << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "VisualErrorAlpha: " << this->VisualErrorAlpha << "\n";
  os << indent << "BitsPerPoint: " << this->BitsPerPoint << "\n";
  os << indent << "VisualErrorRMS: " << this->VisualErrorRMS << "\n";
  os << indent << "UsedBits: " << this->UsedBits << "\n";
}

void vtkHighPassQuantization::ForgetResults()
{
  this->BitsPerPoint = 0.0;
  this->VisualErrorRMS = 0.0;
  this->UsedBits = 0;
}

void vtkHighPassQuantization::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  vtkPolyData* input = run.Input();
  const auto surface = run.ReadSurface();
  cartan::ContentKey key = surface->Key;
  key.Add(static_cast<std::uint64_t>(this->NumberOfAnchors));
  const auto coder = run.Keep<cartan::HighPassCoder>(key,
    [&]
    {
      return std::make_unique<cartan::HighPassCoder>(surface->Mesh, *surface->Positions,
        this->NumberOfAnchors, cartan::SolverBackend::Automatic, context.Part(0.1, 0.6));
    });
  const cartan::ExecutionContext rest = context.Part(0.6, 0.95);
  const std::unique_ptr<Decoded> found = this->MaximumError > 0.0
    ? DecodedWithFewestBits(*surface, *coder, this->MaximumError, this->VisualErrorAlpha, rest)
    : std::make_unique<Decoded>(*surface, *coder, this->Bits, this->VisualErrorAlpha, rest);
  const Decoded& decoded = *found;

  vtkPolyData* output = run.Output();
  run.Warn(
    cartan::WriteSurface(*surface, decoded.Positions, input, output, context.Part(0.95, 1.0)));
  cartan::AddPointArray(output, "VisualError", decoded.Errors);
  vtkNew<vtkIntArray> anchors;
  anchors->SetName("Anchor");
  anchors->SetNumberOfValues(output->GetNumberOfPoints());
  anchors->Fill(0.0);
  for (const int v : decoded.Code.Anchors)
  {
    anchors->SetValue(v, 1);
  }
  output->GetPointData()->AddArray(anchors);
  this->UsedBits = decoded.Code.Bits;
  cartan::AddFieldValue(output, "Bits", this->UsedBits);
  this->BitsPerPoint =
    cartan::AddFieldValue(output, "BitsPerPoint", decoded.Code.BitsPerVertex(*surface->Mesh));
  this->VisualErrorRMS = cartan::AddFieldValue(output, "VisualErrorRMS", decoded.RootMeanSquare);
  cartan::AddFieldValue(output, "VisualErrorMax", decoded.Errors.cwiseAbs().maxCoeff());
  context.Report(1.0);
}
