// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeChange.h"

#include "Bridge/FilterRun.h"
#include "Bridge/MatchedSurfaces.h"
#include "Bridge/NeighborSteps.h"
#include "Bridge/PointArrays.h"
#include "Bridge/StretchArrays.h"
#include "Bridge/SurfacePair.h"
#include "Kernel/Measure/Areas.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Measure/EdgeLengths.h"
#include "Kernel/Measure/LocalVolumes.h"
#include "Kernel/Measure/ShapeDistance.h"
#include "Kernel/Mesh/Geometry.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkVolumeChange);

namespace
{
constexpr double Undefined = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t MostComponentsInFieldData = 16; // each is a line of a chart over time

/// The rows of output 1, one after the other.
class ChangeTable
{
public:
  ChangeTable()
  {
    this->Quantity->SetName("Quantity");
    this->Reference->SetName("Reference");
    this->Current->SetName("Current");
    this->RelativeChange->SetName("RelativeChange");
    this->Note->SetName("Note");
  }

  void Add(const std::string& quantity, double reference, double current, double change,
    const std::string& note)
  {
    this->Quantity->InsertNextValue(quantity);
    this->Reference->InsertNextValue(reference);
    this->Current->InsertNextValue(current);
    this->RelativeChange->InsertNextValue(change);
    this->Note->InsertNextValue(note);
  }

  /// Returns the relative change, NaN with a note where the reference is zero.
  double Add(const std::string& quantity, double reference, double current, std::string note = {})
  {
    const double change = reference != 0.0 ? (current - reference) / reference : Undefined;
    if (reference == 0.0)
    {
      note += (note.empty() ? "" : "; ") + std::string("the reference is zero");
    }
    this->Add(quantity, reference, current, change, note);
    return change;
  }

  void MoveTo(vtkTable* table)
  {
    table->AddColumn(this->Quantity);
    table->AddColumn(this->Reference);
    table->AddColumn(this->Current);
    table->AddColumn(this->RelativeChange);
    table->AddColumn(this->Note);
  }

private:
  vtkNew<vtkStringArray> Quantity;
  vtkNew<vtkDoubleArray> Reference;
  vtkNew<vtkDoubleArray> Current;
  vtkNew<vtkDoubleArray> RelativeChange;
  vtkNew<vtkStringArray> Note;
};

/// 0 where a volume is rounding.
double WithoutRounding(const cartan::ComponentVolume& component)
{
  return cartan::EnclosesVolume(component.Volume, component.Area) ? component.Volume : 0.0;
}

/// A sum of volumes that knows what of it is rounding: of thin shells, whose triangles
/// contribute much more than what remains, a part of their area.
class Total
{
public:
  void Add(const cartan::ComponentVolume& component)
  {
    const double volume = ::WithoutRounding(component);
    this->Sum += volume;
    this->Rounding += 1e-12 * std::abs(volume) + 1e-15 * component.Area * std::sqrt(component.Area);
  }
  double WithoutRounding() const { return std::abs(this->Sum) > this->Rounding ? this->Sum : 0.0; }

private:
  double Sum = 0.0;
  double Rounding = 0.0;
};

std::string DescribeSigns(double reference, double current, const std::string& meaning)
{
  if (reference < 0.0 && current < 0.0)
  {
    return "negative: " + meaning;
  }
  return reference * current < 0.0 ? "the deformation turned it inside out" : "";
}

/// What is measured before a surface is written.
struct Changes
{
  Changes(const cartan::SurfacePair& pair, const cartan::ExecutionContext& context)
    : Borders(pair.Borders)
    , ComponentsBefore(cartan::MeasureComponents(*pair.Mesh, *pair.Reference))
    , ComponentsNow(cartan::MeasureComponents(*pair.Mesh, *pair.Current))
    , Enclosing(cartan::EnclosingComponents(*pair.Mesh, *pair.Reference, this->ComponentsBefore))
    , AreasBefore(cartan::TriangleAreas(*pair.Mesh, *pair.Reference, context))
    , AreasNow(cartan::TriangleAreas(*pair.Mesh, *pair.Current, context))
    , Edges(cartan::CompareEdgeLengths(*pair.Mesh, *pair.Reference, *pair.Current, context))
    , Distance(cartan::MeasureShapeDistance(*pair.Mesh, *pair.Reference, *pair.Current, context))
  {
  }

  const cartan::CoincidentBorders& Borders;
  std::vector<cartan::ComponentVolume> ComponentsBefore;
  std::vector<cartan::ComponentVolume> ComponentsNow;
  std::vector<int> Enclosing;  ///< the component around each one, -1 if there is none
  Eigen::VectorXd AreasBefore; ///< of triangles
  Eigen::VectorXd AreasNow;
  cartan::EdgeLengthChange Edges;
  cartan::ShapeDistance Distance;
};

/// How to close what looks closed; empty if nothing does.
std::string DescribeBorders(const cartan::CoincidentBorders& borders)
{
  if (borders.IsEmpty())
  {
    return {};
  }
  std::ostringstream text;
  text << "; " << borders.NumberOfEdges
       << " border edges coincide: merge their points (Prepare Surface, Tolerance "
       << borders.RelativeTolerance << ") to close it";
  return text.str();
}

/// The volume of everything; NaN unless all components are closed.
double AddVolume(const Changes& changes, ChangeTable& table)
{
  // Volumes of both signs may cancel, as those of the two sides of a shell.
  Total before;
  Total now;
  std::size_t open = 0;
  const std::size_t count = changes.ComponentsBefore.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    before.Add(changes.ComponentsBefore[i]);
    now.Add(changes.ComponentsNow[i]);
    open += changes.ComponentsBefore[i].IsClosed ? 0 : 1;
  }
  if (open > 0)
  {
    const std::string note = count == 1 ? "the surface is open and encloses no volume"
                                        : std::to_string(open) + " of " + std::to_string(count) +
        " components are open and enclose no volume";
    table.Add("Volume", Undefined, Undefined, Undefined, note + DescribeBorders(changes.Borders));
    return Undefined;
  }
  const double volumeBefore = before.WithoutRounding();
  const double volumeNow = now.WithoutRounding();
  return table.Add("Volume", volumeBefore, volumeNow,
    DescribeSigns(volumeBefore, volumeNow, "the surface is oriented inward"));
}

/// Where a closed component lies in another, and whether its orientation fits.
std::string DescribePlace(const Changes& changes, std::size_t component)
{
  const int around = changes.Enclosing[component];
  const double own = changes.ComponentsBefore[component].Volume;
  if (around < 0)
  {
    return own < 0.0 ? "oriented inward" : "";
  }
  const std::string inside = "inside component " + std::to_string(around);
  if (own * changes.ComponentsBefore[around].Volume < 0.0)
  {
    return own < 0.0 ? "the wall of a cavity " + inside : "";
  }
  return inside +
    " and oriented like it: its volume counts twice. A cavity's wall is oriented "
    "the other way (Prepare Surface, Alternate Nested)";
}

/// Returns the relative change.
double AddComponent(const Changes& changes, std::size_t i, ChangeTable& table)
{
  const std::string quantity = "Volume of component " + std::to_string(i);
  if (!changes.ComponentsBefore[i].IsClosed)
  {
    table.Add(quantity, Undefined, Undefined, Undefined, "open: it encloses no volume");
    return Undefined;
  }
  const double before = WithoutRounding(changes.ComponentsBefore[i]);
  const double now = WithoutRounding(changes.ComponentsNow[i]);
  const std::string place = DescribePlace(changes, i);
  return table.Add(
    quantity, before, now, before > 0.0 && now > 0.0 ? place : DescribeSigns(before, now, place));
}

double TotalArea(const std::vector<cartan::ComponentVolume>& components)
{
  double area = 0.0;
  for (const cartan::ComponentVolume& component : components)
  {
    area += component.Area;
  }
  return area;
}

void AddCellAreaRatio(vtkPolyData* output, const cartan::SurfacePair& pair, const Changes& changes)
{
  Eigen::VectorXd before = Eigen::VectorXd::Zero(output->GetNumberOfCells());
  Eigen::VectorXd now = before;
  for (int t = 0; t < pair.Mesh->NumberOfTriangles(); ++t)
  {
    before[pair.Cells->CellIds[t]] += changes.AreasBefore[t];
    now[pair.Cells->CellIds[t]] += changes.AreasNow[t];
  }
  cartan::AddArray(output->GetCellData(), "AreaRatio", cartan::Ratios(before, now));
}

void AddArrays(vtkPolyData* output, const cartan::SurfacePair& pair, const Changes& changes)
{
  cartan::AddPointArray(output, "AreaRatio",
    cartan::Ratios(cartan::BarycentricAreas(*pair.Mesh, changes.AreasBefore),
      cartan::BarycentricAreas(*pair.Mesh, changes.AreasNow)));
  cartan::AddPointArray(output, "EdgeLengthRatio", changes.Edges.VertexRatio);
  cartan::AddPointArray(output, "ShapeDistanceDensity", changes.Distance.Density);
  AddCellAreaRatio(output, pair, changes);
  output->GetPointData()->SetActiveScalars("AreaRatio");
}

/// The table, and its numbers by name.
std::map<std::string, double> FillTable(const Changes& changes, vtkTable* output)
{
  std::map<std::string, double> results;
  ChangeTable table;
  results["RelativeVolumeChange"] = AddVolume(changes, table);
  results["RelativeAreaChange"] =
    table.Add("Area", TotalArea(changes.ComponentsBefore), TotalArea(changes.ComponentsNow));
  const std::size_t ofNoLength = changes.Edges.ZeroLength.GetCount();
  const std::string edgeNote = ofNoLength == 0
    ? ""
    : "without " + std::to_string(ofNoLength) + " edges of length zero in the reference";
  const auto addMeasure =
    [&](const std::string& name, double value, double change, const std::string& note)
  {
    results[name] = value;
    table.Add(name, 0.0, value, change, note);
  };
  addMeasure("EdgeLengthRMS", changes.Edges.RootMeanSquare, changes.Edges.RootMeanSquare, edgeNote);
  addMeasure("EdgeLengthMax", changes.Edges.Maximum, changes.Edges.Maximum, edgeNote);
  addMeasure("ShapeDistance", changes.Distance.Total, Undefined,
    "a distance from the reference: Current is the measure");
  const std::size_t components = changes.ComponentsBefore.size();
  for (std::size_t i = 0; components > 1 && i < components; ++i)
  {
    const double change = AddComponent(changes, i, table);
    if (components <= MostComponentsInFieldData)
    {
      results["RelativeVolumeChange of component " + std::to_string(i)] = change;
    }
  }
  table.MoveTo(output);
  return results;
}
}

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
  return found == this->Results.end() ? Undefined : found->second;
}

int vtkVolumeChange::FillOutputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetOutputType(info, "vtkTable")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

void vtkVolumeChange::Compare(const cartan::SurfacePair& pair, cartan::FilterRun& run)
{
  const Changes changes(pair, run.Context().Part(0.1, 0.3));
  vtkPolyData* output = run.Output();
  if (this->ComputeLocalVolume)
  {
    const auto volumes = run.Keep<cartan::LocalVolumes>(pair.ReferenceKey,
      [&]
      {
        return std::make_unique<cartan::LocalVolumes>(
          pair.Mesh, *pair.Reference, run.Context().Part(0.3, 0.8));
      });
    const Eigen::VectorXd localVolume =
      volumes->Measure(*pair.Current, run.Context().Part(0.8, 1.0));
    cartan::AddPointArray(output, "LocalVolume", localVolume);
    cartan::AddPointArray(
      output, "LocalVolumeRatio", cartan::Ratios(volumes->GetReference(), localVolume));
  }
  AddArrays(output, pair, changes);
  this->AddStretches(pair, run);
  if (this->ComputeRates)
  {
    this->AddRates(run);
  }
  this->Results = FillTable(changes, run.OutputTable(1));
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
  cartan::AddRateArrays(cartan::MeasureStretches(*matched.Mesh, *matched.Cells, cells,
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
  const cartan::SurfaceStretches stretches = cartan::MeasureStretches(*pair.Mesh, *pair.Cells,
    output->GetNumberOfCells(), *pair.Reference, *pair.Current, run.Context());
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
