// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLaplacianSpectrum.h"

#include "Bridge/CountSteps.h"
#include "Bridge/FilterRun.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Spectral/SpectralField.h"

#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <numeric>

vtkStandardNewMacro(vtkLaplacianSpectrum);

static_assert(static_cast<int>(cartan::SpectrumOperator::Graph) == vtkLaplacianSpectrum::GRAPH &&
    static_cast<int>(cartan::SpectrumOperator::Cotangent) == vtkLaplacianSpectrum::COTANGENT,
  "the enumerations agree");

namespace
{
/// Modes [First, Last), or all others.
struct Band
{
  int First;
  int Last;
  bool IsComplement;

  cartan::Field Of(
    const cartan::LaplacianSpectrum& spectrum, const cartan::SpectralField& field) const
  {
    return this->IsComplement ? field.ComplementOfBand(spectrum, this->First, this->Last)
                              : field.Band(spectrum, this->First, this->Last);
  }
};

void FillTable(const cartan::LaplacianSpectrum& spectrum, const cartan::SpectralField& positions,
  const Eigen::RowVector3d& origin, vtkTable* table)
{
  vtkNew<vtkIntArray> modes;
  modes->SetName("Mode");
  modes->SetNumberOfValues(spectrum.NumberOfModes());
  std::iota(modes->GetPointer(0), modes->GetPointer(0) + spectrum.NumberOfModes(), 0);
  table->AddColumn(modes);
  cartan::AddColumn(table, "Eigenvalue", spectrum.Eigenvalues);
  const Eigen::MatrixXd ofOrigin =
    spectrum.Coefficients(cartan::Field(origin.replicate(spectrum.Modes.rows(), 1)));
  const Eigen::MatrixXd coefficients = positions.GetCoefficients() + ofOrigin;
  const char* const axes[] = { "X", "Y", "Z" };
  for (int axis = 0; axis < 3; ++axis)
  {
    cartan::AddColumn(table, axes[axis], coefficients.col(axis));
  }
  cartan::AddColumn(table, "Energy", positions.Energies(spectrum));
}

/// Coefficients of a point array, and the array of the same approximation.
void AddApproximatedArray(vtkPolyData* input, const std::string& name,
  const cartan::LaplacianSpectrum& spectrum, const Band* band, vtkPolyData* output, vtkTable* table)
{
  vtkDataArray* array = input->GetPointData()->GetArray(name.c_str());
  const int components = array ? array->GetNumberOfComponents() : 1;
  std::vector<int> used;
  for (Eigen::Index v = 0; v < spectrum.Mass.size(); ++v)
  {
    if (spectrum.Mass[v] > 0.0)
    {
      used.push_back(static_cast<int>(v));
    }
  }
  const cartan::Field read = cartan::ReadPointArray(input, name, components, used, "point");
  cartan::Field values = cartan::Field::Zero(spectrum.Mass.size(), components);
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    values.row(used[i]) = read.row(static_cast<Eigen::Index>(i));
  }
  const cartan::SpectralField field(spectrum, values);
  for (int c = 0; c < components; ++c)
  {
    cartan::AddColumn(table, components > 1 ? name + "_" + std::to_string(c) : name,
      field.GetCoefficients().col(c));
  }
  if (band)
  {
    cartan::AddArray(output->GetPointData(), name + "Approximation", band->Of(spectrum, field));
  }
}
}

vtkLaplacianSpectrum::vtkLaplacianSpectrum()
{
  this->SetNumberOfOutputPorts(2);
}

void vtkLaplacianSpectrum::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Operator: " << this->Operator << "\n";
  os << indent << "NumberOfModes: " << this->NumberOfModes << "\n";
  os << indent << "Approximation: " << this->Approximation << "\n";
  os << indent << "ApproximationModes: " << this->ApproximationModes << "\n";
  os << indent << "FirstMode: " << this->FirstMode << "\n";
  os << indent << "PlayModes: " << this->PlayModes << "\n";
  os << indent << "GenerateModes: " << this->GenerateModes << "\n";
  os << indent << "CoefficientArrayName: " << this->CoefficientArrayName << "\n";
  os << indent << "ModeMemoryLimit: " << this->ModeMemoryLimit << "\n";
}

int vtkLaplacianSpectrum::FillOutputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetOutputType(info, "vtkTable")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

vtkTable* vtkLaplacianSpectrum::GetSpectrumTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

int vtkLaplacianSpectrum::RequestInformation(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (this->PlayModes)
  {
    cartan::SetCountSteps(outputVector, 1, this->NumberOfModes);
  }
  return this->Superclass::RequestInformation(request, inputVector, outputVector);
}

void vtkLaplacianSpectrum::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  vtkPolyData* input = run.Input();
  const auto surface = run.ReadSurface();
  cartan::ContentKey key = surface->Key;
  key.Add(static_cast<std::uint64_t>(this->Operator));
  key.Add(static_cast<std::uint64_t>(this->NumberOfModes));
  key.Add(static_cast<std::uint64_t>(this->ModeMemoryLimit)); // which may refuse
  const auto spectrum = run.Keep<cartan::LaplacianSpectrum>(key,
    [&]
    {
      return std::make_unique<cartan::LaplacianSpectrum>(cartan::ComputeSpectrum(*surface->Mesh,
        *surface->Positions, static_cast<cartan::SpectrumOperator>(this->Operator),
        this->NumberOfModes, std::uint64_t{ 1000000 } * this->ModeMemoryLimit,
        cartan::SolverBackend::Automatic, context.Part(0.1, 0.9)));
    });

  vtkInformation* info = run.OutputInformation();
  const int asked = this->PlayModes ? cartan::CountOfTime(info, this->ApproximationModes)
                                    : this->ApproximationModes;
  const int all = spectrum->NumberOfModes();
  const int last = asked == 0 ? all : std::min(asked, all);
  Band band{ 0, last, this->Approximation == HIGH_PASS };
  if (this->Approximation == BAND_PASS)
  {
    band.First = std::min(this->FirstMode, last);
  }
  const bool isApproximated = this->Approximation != NONE;
  const cartan::SpectralField positions(*spectrum, *surface->Positions);
  if (isApproximated)
  {
    const cartan::Points approximation = band.Of(*spectrum, positions);
    run.Warn(
      cartan::WriteSurface(*surface, approximation, input, run.Output(), context.Part(0.9, 0.95)));
  }
  else
  {
    run.Output()->ShallowCopy(input);
  }
  FillTable(*spectrum, positions, surface->Origin.transpose(), run.OutputTable(1));
  if (!this->CoefficientArrayName.empty())
  {
    AddApproximatedArray(input, this->CoefficientArrayName, *spectrum,
      isApproximated ? &band : nullptr, run.Output(), run.OutputTable(1));
  }
  if (this->GenerateModes)
  {
    cartan::AddArray(run.Output()->GetPointData(), "Modes", spectrum->Modes);
  }
  if (this->PlayModes)
  {
    run.Output()->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), last);
  }
  context.Report(1.0);
}
