// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/SurfaceChanges.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Measure/Areas.h"
#include "Kernel/Mesh/Geometry.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace cartan
{
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
double WithoutRounding(const ComponentVolume& component)
{
  return EnclosesVolume(component.Volume, component.Area) ? component.Volume : 0.0;
}

/// A sum of volumes that knows what of it is rounding: of thin shells, whose triangles
/// contribute much more than what remains, a part of their area.
class Total
{
public:
  void Add(const ComponentVolume& component)
  {
    const double volume = cartan::WithoutRounding(component);
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

/// How to close what looks closed; empty if nothing does.
std::string DescribeBorders(const CoincidentBorders& borders)
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
double AddVolume(const SurfaceChanges& changes, ChangeTable& table)
{
  // Volumes of both signs may cancel, as those of the two sides of a shell.
  Total before;
  Total now;
  std::size_t open = 0;
  const std::size_t count = changes.Reference.Components.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    before.Add(changes.Reference.Components[i]);
    now.Add(changes.Components[i]);
    open += changes.Reference.Components[i].IsClosed ? 0 : 1;
  }
  if (open > 0)
  {
    const std::string note = count == 1 ? "the surface is open and encloses no volume"
                                        : std::to_string(open) + " of " + std::to_string(count) +
        " components are open and enclose no volume";
    table.Add(
      "Volume", Undefined, Undefined, Undefined, note + DescribeBorders(changes.Pair.Borders));
    return Undefined;
  }
  const double volumeBefore = before.WithoutRounding();
  const double volumeNow = now.WithoutRounding();
  return table.Add("Volume", volumeBefore, volumeNow,
    DescribeSigns(volumeBefore, volumeNow, "the surface is oriented inward"));
}

/// Where a closed component lies in another, and whether its orientation fits.
std::string DescribePlace(const SurfaceChanges& changes, std::size_t component)
{
  const int around = changes.Reference.Enclosing[component];
  const double own = changes.Reference.Components[component].Volume;
  if (around < 0)
  {
    return own < 0.0 ? "oriented inward" : "";
  }
  const std::string inside = "inside component " + std::to_string(around);
  if (own * changes.Reference.Components[around].Volume < 0.0)
  {
    return own < 0.0 ? "the wall of a cavity " + inside : "";
  }
  return inside +
    " and oriented like it: its volume counts twice. A cavity's wall is oriented "
    "the other way (Prepare Surface, Alternate Nested)";
}

/// Returns the relative change.
double AddComponent(const SurfaceChanges& changes, std::size_t i, ChangeTable& table)
{
  const std::string quantity = "Volume of component " + std::to_string(i);
  if (!changes.Reference.Components[i].IsClosed)
  {
    table.Add(quantity, Undefined, Undefined, Undefined, "open: it encloses no volume");
    return Undefined;
  }
  const double before = WithoutRounding(changes.Reference.Components[i]);
  const double now = WithoutRounding(changes.Components[i]);
  const std::string place = DescribePlace(changes, i);
  return table.Add(
    quantity, before, now, before > 0.0 && now > 0.0 ? place : DescribeSigns(before, now, place));
}

double TotalArea(const std::vector<ComponentVolume>& components)
{
  double area = 0.0;
  for (const ComponentVolume& component : components)
  {
    area += component.Area;
  }
  return area;
}
}

ReferenceMeasures::ReferenceMeasures(const SurfacePair& pair, const ExecutionContext& context)
  : Mesh(pair.Mesh)
  , Pieces(pair.Pieces)
  , Parts(*this->Mesh, this->Pieces.get())
  , Components(MeasureComponents(*pair.Mesh, *pair.Reference, this->Parts))
  , MayEnclose(pair.Pieces &&
      MayEncloseEachOther(*pair.Mesh, *pair.Reference, this->Components, this->Parts))
  , Enclosing(pair.Pieces ? std::vector<int>(this->Components.size(), -1)
                          : EnclosingComponents(*pair.Mesh, *pair.Reference, this->Components))
  , Areas(TriangleAreas(*pair.Mesh, *pair.Reference, context))
  , Shape(*pair.Mesh, pair.Reference, context, pair.Pieces)
{
}

SurfaceChanges::SurfaceChanges(
  const SurfacePair& pair, const ReferenceMeasures& reference, const ExecutionContext& context)
  : Pair(pair)
  , Reference(reference)
  , Components(MeasureComponents(*pair.Mesh, *pair.Current, reference.Parts))
  , Edges(
      CompareEdgeLengths(*pair.Mesh, *pair.Reference, *pair.Current, context, pair.Pieces.get()))
  , Distance(reference.Shape.Measure(*pair.Current, context))
{
}

void SurfaceChanges::AddArrays(vtkPolyData* output, const ExecutionContext& context) const
{
  const Eigen::VectorXd areas = TriangleAreas(*this->Pair.Mesh, *this->Pair.Current, context);
  AddPointArray(output, "AreaRatio",
    Ratios(BarycentricAreas(*this->Pair.Mesh, this->Reference.Areas),
      BarycentricAreas(*this->Pair.Mesh, areas)));
  AddPointArray(output, "EdgeLengthRatio", this->Edges.VertexRatio);
  AddPointArray(output, "ShapeDistanceDensity", this->Distance.Density);
  // Triangles of other ranks come last.
  const vtkIdType cells = output->GetNumberOfCells();
  Eigen::VectorXd before = Eigen::VectorXd::Zero(cells + 1);
  Eigen::VectorXd now = before;
  for (int t = 0; t < this->Pair.Mesh->NumberOfTriangles(); ++t)
  {
    before[this->Pair.Cells->CellIds[t]] += this->Reference.Areas[t];
    now[this->Pair.Cells->CellIds[t]] += areas[t];
  }
  AddArray(output->GetCellData(), "AreaRatio", Ratios(before, now).head(cells));
  output->GetPointData()->SetActiveScalars("AreaRatio");
}

std::map<std::string, double> SurfaceChanges::FillTable(vtkTable* output) const
{
  std::map<std::string, double> results;
  ChangeTable table;
  results["RelativeVolumeChange"] = AddVolume(*this, table);
  results["RelativeAreaChange"] =
    table.Add("Area", TotalArea(this->Reference.Components), TotalArea(this->Components));
  const std::size_t ofNoLength = this->Edges.ZeroLength.GetCount();
  const std::string edgeNote = ofNoLength == 0
    ? ""
    : "without " + std::to_string(ofNoLength) + " edges of length zero in the reference";
  const auto addMeasure =
    [&](const std::string& name, double value, double change, const std::string& note)
  {
    results[name] = value;
    table.Add(name, 0.0, value, change, note);
  };
  addMeasure("EdgeLengthRMS", this->Edges.RootMeanSquare, this->Edges.RootMeanSquare, edgeNote);
  addMeasure("EdgeLengthMax", this->Edges.Maximum, this->Edges.Maximum, edgeNote);
  addMeasure("ShapeDistance", this->Distance.Total, Undefined,
    "a distance from the reference: Current is the measure");
  const std::size_t components = this->Reference.Components.size();
  for (std::size_t i = 0; components > 1 && i < components; ++i)
  {
    const double change = AddComponent(*this, i, table);
    if (components <= MostComponentsInFieldData)
    {
      results["RelativeVolumeChange of component " + std::to_string(i)] = change;
    }
  }
  table.MoveTo(output);
  return results;
}
}
