// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeChange.h"

#include "Kernel/Measure/Measures.h"
#include "KernelBridge.h"
#include "SurfacePair.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkVolumeChange);

/// The reference's local volumes with their factorization, kept while the
/// reference stays the same.
class vtkVolumeChange::Internals
{
public:
  const cartan::LocalVolumes& Get(
    const cartan::SurfacePair& pair, const cartan::ExecutionContext& context)
  {
    if (!this->Volumes || !IsEqual(this->Triangles, pair.Mesh.GetTriangles()) ||
      !IsEqual(this->Reference, pair.Reference))
    {
      this->Volumes.reset();
      this->Volumes = std::make_unique<cartan::LocalVolumes>(
        std::make_shared<const cartan::TriangleMesh>(pair.Mesh), pair.Reference, context);
      this->Triangles = pair.Mesh.GetTriangles();
      this->Reference = pair.Reference;
    }
    return *this->Volumes;
  }

private:
  template <typename Rows>
  static bool IsEqual(const Rows& a, const Rows& b)
  {
    return a.rows() == b.rows() && a == b;
  }

  std::unique_ptr<cartan::LocalVolumes> Volumes;
  cartan::Triangles Triangles;
  cartan::Points Reference;
};

namespace
{
constexpr double Undefined = std::numeric_limits<double>::quiet_NaN();

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

/// Below this part of what its area could enclose, a volume is rounding.
double WithoutRounding(const cartan::ComponentVolume& component)
{
  const double limit = 1e-14 * component.Area * std::sqrt(component.Area);
  return std::abs(component.Volume) > limit ? component.Volume : 0.0;
}

std::string DescribeSigns(double reference, double current, const std::string& meaning)
{
  if (reference < 0.0 && current < 0.0)
  {
    return "negative: " + meaning;
  }
  return reference * current < 0.0 ? "the deformation turned it inside out" : "";
}

/// The volume of everything; NaN unless all components are closed.
double AddVolume(const std::vector<cartan::ComponentVolume>& reference,
  const std::vector<cartan::ComponentVolume>& current, ChangeTable& table)
{
  double volumeBefore = 0.0;
  double volumeNow = 0.0;
  int open = 0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    volumeBefore += WithoutRounding(reference[i]);
    volumeNow += WithoutRounding(current[i]);
    open += reference[i].IsClosed ? 0 : 1;
  }
  if (open > 0)
  {
    const std::string note = reference.size() == 1 ? "the surface is open and encloses no volume"
                                                   : std::to_string(open) + " of " +
        std::to_string(reference.size()) + " components are open and enclose no volume";
    table.Add("Volume", Undefined, Undefined, Undefined, note);
    return Undefined;
  }
  return table.Add("Volume", volumeBefore, volumeNow,
    DescribeSigns(volumeBefore, volumeNow, "the surface is oriented inwards"));
}

void AddComponents(const std::vector<cartan::ComponentVolume>& reference,
  const std::vector<cartan::ComponentVolume>& current, ChangeTable& table)
{
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    const std::string quantity = "Volume of component " + std::to_string(i);
    if (!reference[i].IsClosed)
    {
      table.Add(quantity, Undefined, Undefined, Undefined, "open: it encloses no volume");
      continue;
    }
    const double before = WithoutRounding(reference[i]);
    const double now = WithoutRounding(current[i]);
    table.Add(quantity, before, now,
      DescribeSigns(before, now, "oriented inwards, or the wall of a cavity"));
  }
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

void AddPointScalars(vtkPolyData* output, const char* name, const Eigen::VectorXd& values)
{
  cartan::AddPointArray(output, name, values.data(), values.size(), 1);
}

void AddCellAreaRatio(vtkPolyData* output, const cartan::SurfacePair& pair,
  const Eigen::VectorXd& triangleAreasBefore, const Eigen::VectorXd& triangleAreasNow)
{
  Eigen::VectorXd before = Eigen::VectorXd::Zero(output->GetNumberOfCells());
  Eigen::VectorXd now = before;
  for (int t = 0; t < pair.Mesh.NumberOfTriangles(); ++t)
  {
    before[pair.CellIds[t]] += triangleAreasBefore[t];
    now[pair.CellIds[t]] += triangleAreasNow[t];
  }
  const Eigen::VectorXd ratios = cartan::Ratios(before, now);
  vtkNew<vtkDoubleArray> array;
  array->SetName("AreaRatio");
  array->SetNumberOfValues(ratios.size());
  std::copy(ratios.data(), ratios.data() + ratios.size(), array->GetPointer(0));
  output->GetCellData()->AddArray(array);
}

void AddFieldValue(vtkPolyData* output, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  output->GetFieldData()->AddArray(array);
}
}

vtkVolumeChange::vtkVolumeChange()
  : Internal(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

vtkVolumeChange::~vtkVolumeChange() = default;

void vtkVolumeChange::SetReferenceConnection(vtkAlgorithmOutput* reference)
{
  this->SetInputConnection(1, reference);
}

void vtkVolumeChange::SetReferenceData(vtkPolyData* reference)
{
  this->SetInputData(1, reference);
}

vtkTable* vtkVolumeChange::GetChangeTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

int vtkVolumeChange::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
    return 1;
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

int vtkVolumeChange::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkTable");
    return 1;
  }
  return this->Superclass::FillOutputPortInformation(port, info);
}

void vtkVolumeChange::ForgetResults()
{
  this->RelativeVolumeChange = Undefined;
  this->RelativeAreaChange = Undefined;
  this->EdgeLengthRMS = Undefined;
  this->EdgeLengthMax = Undefined;
  this->ShapeDistance = Undefined;
}

int vtkVolumeChange::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* reference = vtkPolyData::GetData(inputVector[1]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, 0);
  vtkTable* outputTable = vtkTable::GetData(outputVector, 1);
  this->ForgetResults();

  return cartan::RunGuarded(this,
    [&]
    {
      const cartan::SurfacePair pair = cartan::ReadSurfacePair(input, reference);
      cartan::Warn(this, pair.Warning);
      const cartan::ExecutionContext context = cartan::MakeContext(this);

      const cartan::TriangleMesh& mesh = pair.Mesh;
      const auto componentsBefore = cartan::MeasureComponents(mesh, pair.Reference);
      const auto componentsNow = cartan::MeasureComponents(mesh, pair.Current);
      const Eigen::VectorXd areasBefore = cartan::TriangleAreas(mesh, pair.Reference, context);
      const Eigen::VectorXd areasNow = cartan::TriangleAreas(mesh, pair.Current, context);
      const cartan::EdgeLengthChange edges =
        cartan::CompareEdgeLengths(mesh, pair.Reference, pair.Current, context);
      const cartan::ShapeDistance distance =
        cartan::MeasureShapeDistance(mesh, pair.Reference, pair.Current, context);

      output->ShallowCopy(input);
      if (this->ComputeLocalVolume)
      {
        const cartan::LocalVolumes& volumes = this->Internal->Get(pair, context.Part(0.1, 0.8));
        const Eigen::VectorXd localVolume = volumes.Measure(pair.Current, context.Part(0.8, 1.0));
        AddPointScalars(output, "LocalVolume", localVolume);
        AddPointScalars(
          output, "LocalVolumeRatio", cartan::Ratios(volumes.GetReference(), localVolume));
      }
      AddPointScalars(output, "AreaRatio",
        cartan::Ratios(
          cartan::BarycentricAreas(mesh, areasBefore), cartan::BarycentricAreas(mesh, areasNow)));
      AddPointScalars(output, "EdgeLengthRatio", edges.VertexRatio);
      AddPointScalars(output, "ShapeDistanceDensity", distance.Density);
      AddCellAreaRatio(output, pair, areasBefore, areasNow);

      ChangeTable table;
      this->RelativeVolumeChange = AddVolume(componentsBefore, componentsNow, table);
      this->RelativeAreaChange =
        table.Add("Area", TotalArea(componentsBefore), TotalArea(componentsNow));
      const std::string edgeNote = edges.ZeroLength.IsEmpty() ? ""
                                                              : "without " +
          std::to_string(edges.ZeroLength.GetCount()) + " edges of length zero in the reference";
      this->EdgeLengthRMS = edges.RootMeanSquare;
      this->EdgeLengthMax = edges.Maximum;
      table.Add("EdgeLengthRMS", 0.0, edges.RootMeanSquare, edges.RootMeanSquare, edgeNote);
      table.Add("EdgeLengthMax", 0.0, edges.Maximum, edges.Maximum, edgeNote);
      this->ShapeDistance = distance.Total;
      table.Add("ShapeDistance", 0.0, distance.Total, Undefined,
        "a distance from the reference: Current is the measure");
      if (componentsBefore.size() > 1)
      {
        AddComponents(componentsBefore, componentsNow, table);
      }
      table.MoveTo(outputTable);
      output->GetPointData()->SetActiveScalars("AreaRatio");
      AddFieldValue(output, "RelativeVolumeChange", this->RelativeVolumeChange);
      AddFieldValue(output, "ShapeDistance", this->ShapeDistance);
    });
}

void vtkVolumeChange::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ComputeLocalVolume: " << this->ComputeLocalVolume << "\n";
  os << indent << "RelativeVolumeChange: " << this->RelativeVolumeChange << "\n";
  os << indent << "RelativeAreaChange: " << this->RelativeAreaChange << "\n";
  os << indent << "EdgeLengthRMS: " << this->EdgeLengthRMS << "\n";
  os << indent << "EdgeLengthMax: " << this->EdgeLengthMax << "\n";
  os << indent << "ShapeDistance: " << this->ShapeDistance << "\n";
}
