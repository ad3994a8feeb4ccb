// SPDX-License-Identifier: BSD-3-Clause
#include "Reproduce.h"

#include "vtkNew.h"
#include "vtkXMLPolyDataWriter.h"

#include <fstream>
#include <iomanip>
#include <sstream>

namespace fuzz
{
namespace
{
void WriteSurface(const Mesh& mesh, const std::string& name)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(name.c_str());
  writer->SetInputData(ToPolyData(mesh));
  writer->SetDataModeToBinary();
  writer->Write();
}

template <typename Values>
std::string List(const Values& values, Eigen::Index count)
{
  std::ostringstream text;
  text << std::setprecision(17);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const auto value = static_cast<double>(values[static_cast<std::size_t>(i)]);
    text << (i > 0 ? ", " : "");
    if (std::isfinite(value))
    {
      text << value;
    }
    else
    {
      text << "float('" << value << "')";
    }
  }
  return text.str();
}

std::string List(const Eigen::Vector3d& vector)
{
  return List(std::vector<double>(vector.data(), vector.data() + 3), 3);
}

void PrintSettings(std::ostream& out, const Case& of)
{
  for (const Setting& setting : of.Settings)
  {
    const std::string values =
      List(setting.Values, static_cast<Eigen::Index>(setting.Values.size()));
    const bool isOfRegion = setting.Name.compare(0, 6, "Region") == 0 && setting.Name.size() > 6 &&
      setting.Name != "RegionSource";
    if (setting.IsOfIds)
    {
      out << "    filter.SetSourceToSelectedPoints()\n    filter.SetNumberOfPointIds("
          << setting.Values.size() << ")\n    for i, id in enumerate([" << values
          << "]):\n        filter.SetPointId(i, int(id))\n";
    }
    else if (isOfRegion)
    {
      out << "    filter.SetRegion(filter.GetRegion() or vtkSphere())\n"
          << "    filter.GetRegion().Set" << setting.Name.substr(6) << "(" << values << ")\n";
    }
    else
    {
      const bool isInteger = setting.Power == 0.0 && setting.Values.size() == 1 &&
        setting.Values[0] == std::floor(setting.Values[0]);
      out << "    filter.Set" << setting.Name << "(" << (isInteger ? "int(" : "") << values
          << (isInteger ? ")" : "") << ")\n";
    }
  }
}

void PrintMotions(std::ostream& out, const Case& of)
{
  for (const HandleMotion& motion : of.Motions)
  {
    out << "    motion = vtkHandleMotion()\n";
    if (motion.IsMatrix)
    {
      const Eigen::Matrix4d rows = motion.Matrix.transpose();
      out << "    motion.SetMatrixElements(["
          << List(std::vector<double>(rows.data(), rows.data() + 16), 16) << "])\n"
          << "    motion.SetModeToMatrix()\n";
    }
    else
    {
      const Eigen::Vector3d scale = Eigen::Vector3d::Constant(motion.Scale);
      out << "    motion.SetAxis(" << List(motion.Axis) << ")\n"
          << "    motion.SetAngle(" << List(std::vector<double>{ motion.Angle }, 1) << ")\n"
          << "    motion.SetScale(" << List(scale) << ")\n"
          << "    motion.SetCenter(" << List(motion.Center) << ")\n"
          << "    motion.SetTranslation(" << List(motion.Translation) << ")\n";
    }
    out << "    filter.SetHandleMotion(" << motion.Id << ", motion)\n";
  }
  for (const char* name : { "TargetPosition", "RotationVector", "Transform", "ConstraintWeight" })
  {
    if (of.IsDeformation() && of.Surface.Find(name))
    {
      out << "    filter.Set" << name << "ArrayName('" << name << "')\n";
    }
  }
}

/// ", name=[...]" of one cloud, if it has such a list.
std::string Option(const char* name, std::size_t cloud, const std::vector<Ids>& lists)
{
  return cloud < lists.size() ? std::string(", ") + name + "=[" +
      List(lists[cloud], static_cast<Eigen::Index>(lists[cloud].size())) + "]"
                              : "";
}

void PrintInputs(std::ostream& out, const Case& of)
{
  if (of.Filter == "SurfaceMorph")
  {
    out << "    for key in surfaces:\n        filter.AddInputData(key)\n";
  }
  else if (of.Filter == "FrameReconstruction")
  {
    out << "    forms = vtkDiscreteForms()\n    forms.SetInputData(surfaces[0])\n"
        << "    filter.SetInputData(0, surfaces[0])\n"
        << "    filter.SetInputConnection(1, forms.GetOutputPort(1))\n";
  }
  else if (of.Filter == "DifferentialReconstruction")
  {
    out << "    made = vtkDifferentialCoordinates()\n    made.SetInputData(surfaces[-1])\n"
        << "    made.SetLaplacianWeights(" << static_cast<int>(of.Get("LaplacianWeights", 1.0))
        << ")\n    made.SetNormalization(" << static_cast<int>(of.Get("Normalization", 2.0))
        << ")\n    made.Update()\n    made.GetOutput().SetPoints(surfaces[0].GetPoints())\n"
        << "    filter.SetInputData(0, made.GetOutput())\n";
  }
  else if (of.Filter == "RestoreSurface")
  {
    out << "    prepare = vtkPrepareSurface()\n    prepare.SetInputData(surfaces[0])\n"
        << "    prepare.Update()\n    moved = prepare.GetOutput()\n"
        << "    ids = moved.GetPointData().GetArray('OriginalPointIds')\n"
        << "    for i in range(moved.GetNumberOfPoints()):\n"
        << "        moved.GetPoints().SetPoint(i, surfaces[-1].GetPoint(ids.GetValue(i)))\n"
        << "    filter.SetInputData(0, moved)\n    filter.SetInputData(1, surfaces[0])\n";
  }
  else if (of.Filter == "ExampleBasedDeformation")
  {
    out << "    filter.SetInputData(0, surfaces[0])\n"
        << "    for example in surfaces[1:]:\n        filter.AddExampleData(example)\n";
  }
  else
  {
    for (std::size_t i = 0; i < of.Clouds.size(); ++i)
    {
      out << "    surfaces.append(line([";
      for (const Eigen::Vector3d& point : of.Clouds[i])
      {
        out << "(" << List(point) << "), ";
      }
      out << "]" << Option("keys", i, of.CloudKeys) << Option("names", i, of.CloudNames) << "))\n";
    }
    out << "    for port, surface in enumerate(surfaces):\n"
        << "        filter.SetInputData(port, surface)\n";
    if (!of.Tetrahedra.empty())
    {
      out << "    filter.SetInputData(" << (of.Filter == "CarryAlong" ? 0 : 1)
          << ", grid(surfaces[0], [";
      for (const Ids& ids : of.Tetrahedra)
      {
        out << "(" << List(ids, 4) << "), ";
      }
      out << "]))\n";
    }
    if (of.Surface.Find("Region"))
    {
      out << "    filter.SetRegionArrayName('Region')\n";
    }
  }
}

/// A Python function `name` that returns the filter of a case, updated.
void PrintFunction(
  std::ostream& out, const std::string& name, const Case& of, const std::string& stem)
{
  WriteSurface(of.Surface, stem + "_0.vtp");
  for (std::size_t i = 0; i < of.Others.size(); ++i)
  {
    Mesh other = of.Surface;
    other.Points = of.Others[i];
    WriteSurface(other, stem + "_" + std::to_string(i + 1) + ".vtp");
  }
  out << "\ndef " << name << "():\n    surfaces = [read('" << stem
      << "_%d.vtp' % i) for i in range(" << of.Others.size() + 1 << ")]\n    filter = vtk"
      << of.Filter << "()\n";
  PrintInputs(out, of);
  PrintSettings(out, of);
  PrintMotions(out, of);
  out << "    return updated(filter)\n";
}

const char* const Head =
  R"(from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints, vtkSMPTools, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkSphere, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkcartan import *

def read(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()

def line(coordinates, keys=(), names=()):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    cells = vtkCellArray()
    cells.InsertNextCell(len(coordinates))
    for x in coordinates:
        cells.InsertCellPoint(points.InsertNextPoint(x))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    for array, name, values in ((vtkIdTypeArray(), 'SourcePoint', keys),
                                (vtkStringArray(), 'label', ['L%d' % k for k in names])):
        array.SetName(name)
        for value in values:
            array.InsertNextValue(value)
        if len(values):
            data.GetPointData().AddArray(array)
    return data

def grid(surface, cells):
    data = vtkUnstructuredGrid()
    data.SetPoints(surface.GetPoints())
    data.GetPointData().ShallowCopy(surface.GetPointData())
    for ids in cells:
        data.InsertNextCell(10, 4, ids)
    return data

def updated(filter):
    filter.Update()
    output = filter.GetOutput()
    print(filter.GetClassName(), output.GetNumberOfPoints(), 'points, bounds', output.GetBounds())
    return output
)";

/// Points that the two results share, by PointId.
void PrintComparison(std::ostream& out, const Motion& map)
{
  const Eigen::Matrix3d rows = (map.Scale * map.Rotation).transpose();
  out << R"(
def by_id(output):
    ids = output.GetPointData().GetArray('PointId')
    return {int(ids.GetValue(i)): output.GetPoint(i) for i in range(output.GetNumberOfPoints())}

linear = [)"
      << List(std::vector<double>(rows.data(), rows.data() + 9), 9) << "]\ntranslation = ["
      << List(map.Translation) << R"(]
before, after = by_id(original()), by_id(changed())
worst = (-1.0, None)
for i, p in before.items():
    moved = [sum(linear[3 * r + c] * p[c] for c in range(3)) + translation[r] for r in range(3)]
    if i in after:
        worst = max(worst, (max(abs(a - b) for a, b in zip(moved, after[i])), i))
print('largest difference of points, at point', worst)
)";
}
}

std::string WriteScript(const Finding& finding, const std::string& folder)
{
  const Case& changed = finding.Changed;
  const std::string stem =
    folder + "/" + std::to_string(changed.Seed) + "-" + changed.Filter + "-" + finding.Invariant;
  std::ofstream out(stem + ".py");
  out << "# Seed " << changed.Seed << ", " << finding.Invariant << ": " << finding.Text << "\n"
      << Head;
  PrintFunction(out, "changed", changed, stem + "-changed");
  if (finding.Original)
  {
    PrintFunction(out, "original", *finding.Original, stem + "-original");
    PrintComparison(out, finding.Map);
  }
  else
  {
    out << "\nchanged()\n";
  }
  return stem + ".py";
}
}
