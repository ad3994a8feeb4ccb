// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/LandmarkReader.h"

#include "Kernel/Mesh/UsedVertices.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStaticPointLocator.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

namespace cartan
{
namespace
{
constexpr std::size_t MostDescribed = 5;

std::string Lowercase(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

/// The array of this name in lower case, null if there is none.
vtkAbstractArray* FindArray(vtkDataSetAttributes* arrays, const std::string& lowercase)
{
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    const char* name = arrays->GetArrayName(i);
    if (name && Lowercase(name) == lowercase)
    {
      return arrays->GetAbstractArray(i);
    }
  }
  return nullptr;
}

std::vector<std::string> ReadNames(vtkDataSetAttributes* arrays)
{
  vtkStringArray* names = nullptr;
  for (const char* name : { "label", "name", "landmark" })
  {
    names = names ? names : vtkStringArray::SafeDownCast(FindArray(arrays, name));
  }
  for (int i = 0; i < arrays->GetNumberOfArrays() && !names; ++i)
  {
    names = vtkStringArray::SafeDownCast(arrays->GetAbstractArray(i));
  }
  std::vector<std::string> texts;
  for (vtkIdType k = 0; names && k < names->GetNumberOfValues(); ++k)
  {
    texts.push_back(names->GetValue(k));
  }
  return texts;
}

Points ReadPointSet(vtkPointSet* input)
{
  Points positions(input->GetNumberOfPoints(), 3);
  for (vtkIdType k = 0; k < input->GetNumberOfPoints(); ++k)
  {
    input->GetPoint(k, positions.row(k).data());
  }
  return positions;
}

Points ReadTable(vtkTable* table, const std::string& role)
{
  static const std::array<std::array<const char*, 3>, 4> columns = { { { "x", "y", "z" },
    { "points:0", "points:1", "points:2" }, { "r", "a", "s" }, { "l", "p", "s" } } };
  for (const auto& names : columns)
  {
    vtkDataArray* coordinates[3];
    for (int i = 0; i < 3; ++i)
    {
      coordinates[i] = vtkDataArray::SafeDownCast(FindArray(table->GetRowData(), names[i]));
    }
    if (coordinates[0] && coordinates[1] && coordinates[2])
    {
      Points positions(table->GetNumberOfRows(), 3);
      for (vtkIdType k = 0; k < table->GetNumberOfRows(); ++k)
      {
        for (int i = 0; i < 3; ++i)
        {
          positions(k, i) = coordinates[i]->GetTuple1(k);
        }
      }
      return positions;
    }
  }
  throw Error(ErrorCode::BadInput,
    "The table of landmarks " + role +
      " has no three numeric columns of coordinates: name them x, y and z.");
}

std::vector<Eigen::Index> NotFinite(const Points& positions)
{
  std::vector<Eigen::Index> bad;
  for (Eigen::Index k = 0; k < positions.rows(); ++k)
  {
    if (!positions.row(k).allFinite())
    {
      bad.push_back(k);
    }
  }
  return bad;
}

void ReadAccuracies(
  vtkDataSetAttributes* arrays, const std::string& name, const std::string& role, LandmarkSet& set)
{
  vtkDataArray* array = arrays->GetArray(name.c_str());
  if (!array || array->GetNumberOfComponents() != 1)
  {
    throw Error(ErrorCode::BadInput,
      "The landmarks " + role + " have no numeric array \"" + name +
        "\" of one component: leave AccuracyArrayName empty, or add the array.");
  }
  set.Accuracies.resize(set.Size());
  std::vector<Eigen::Index> bad;
  for (Eigen::Index k = 0; k < set.Size(); ++k)
  {
    set.Accuracies[k] = array->GetTuple1(k);
    if (!(set.Accuracies[k] >= 0.0) || !std::isfinite(set.Accuracies[k]))
    {
      bad.push_back(k);
    }
  }
  if (!bad.empty())
  {
    throw Error(ErrorCode::BadInput,
      "The array \"" + name + "\" has " + set.Describe(bad) +
        " with an accuracy that is negative, infinite or NaN: give lengths, 0 for exactly.");
  }
}
}

std::string LandmarkSet::Describe(Eigen::Index k) const
{
  const std::string number = std::to_string(k);
  return this->Names.empty() ? number : number + " (" + this->Names[k] + ")";
}

std::string LandmarkSet::Describe(const std::vector<Eigen::Index>& landmarks) const
{
  std::string text =
    std::to_string(landmarks.size()) + (landmarks.size() == 1 ? " landmark: " : " landmarks: ");
  for (std::size_t i = 0; i < std::min(landmarks.size(), MostDescribed); ++i)
  {
    text += (i ? ", " : "") + this->Describe(landmarks[i]);
  }
  return text + (landmarks.size() > MostDescribed ? ", ..." : "");
}

LandmarkSet ReadLandmarks(
  vtkDataObject* input, const std::string& role, const std::string& accuracyArray)
{
  auto* points = vtkPointSet::SafeDownCast(input);
  auto* table = vtkTable::SafeDownCast(input);
  LandmarkSet set;
  if ((!points || points->GetNumberOfPoints() == 0) && (!table || table->GetNumberOfRows() == 0))
  {
    throw Error(ErrorCode::BadInput,
      "There are no landmarks " + role +
        ": connect points, such as a point source, or a table of landmarks.");
  }
  set.Positions = points ? ReadPointSet(points) : ReadTable(table, role);
  vtkDataSetAttributes* arrays =
    points ? static_cast<vtkDataSetAttributes*>(points->GetPointData()) : table->GetRowData();
  set.Names = ReadNames(arrays);
  set.Names.resize(set.Names.size() == static_cast<std::size_t>(set.Size()) ? set.Size() : 0);
  const std::vector<Eigen::Index> bad = NotFinite(set.Positions);
  if (!bad.empty())
  {
    throw Error(ErrorCode::BadInput,
      "The landmarks " + role + " have " + set.Describe(bad) +
        " with a NaN or infinite coordinate: remove or repair these landmarks.");
  }
  if (!accuracyArray.empty())
  {
    ReadAccuracies(arrays, accuracyArray, role, set);
  }
  return set;
}

LandmarkSet InOrderOf(const LandmarkSet& named, const LandmarkSet& set)
{
  std::map<std::string, Eigen::Index> places;
  for (std::size_t k = 0; k < set.Names.size(); ++k)
  {
    if (!places.emplace(set.Names[k], static_cast<Eigen::Index>(k)).second)
    {
      throw Error(ErrorCode::BadInput,
        "Two landmarks to have the name " + set.Names[k] +
          ": name each once, or choose Matching by order.");
    }
  }
  LandmarkSet sorted = set;
  std::map<std::string, bool> isTaken;
  for (std::size_t k = 0; k < static_cast<std::size_t>(named.Size()); ++k)
  {
    const auto found = k < named.Names.size() ? places.find(named.Names[k]) : places.end();
    if (found == places.end() || !isTaken.emplace(found->first, true).second)
    {
      throw Error(ErrorCode::BadInput,
        "The landmarks to have no partner of their own for landmark " +
          named.Describe(static_cast<Eigen::Index>(k)) +
          ": give both sets the same names, each once, or choose Matching by order.");
    }
    sorted.Positions.row(static_cast<Eigen::Index>(k)) = set.Positions.row(found->second);
    sorted.Names[k] = found->first;
  }
  return sorted;
}

NearestVertices FindNearestVertices(
  const TriangleMesh& mesh, const Points& points, const Points& queries)
{
  const std::vector<int> used = UsedVertices(mesh);
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (const int v : used)
  {
    places->InsertNextPoint(points.row(v).data());
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(places);
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(cloud);
  locator->BuildLocator();
  NearestVertices found;
  found.Distances.resize(queries.rows());
  for (Eigen::Index k = 0; k < queries.rows(); ++k)
  {
    const int v = used[locator->FindClosestPoint(queries.row(k).data())];
    found.Vertices.push_back(v);
    found.Distances[k] = (points.row(v) - queries.row(k)).norm();
  }
  return found;
}
}
