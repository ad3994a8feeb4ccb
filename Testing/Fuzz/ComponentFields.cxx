// SPDX-License-Identifier: BSD-3-Clause
#include "ComponentFields.h"

#include "vtkDataArray.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

namespace fuzz
{
namespace
{
/// The least PointId of each component that has triangles, in the order of first points.
std::vector<double> LeastIds(const Mesh& mesh)
{
  const std::vector<vtkIdType> components = Components(mesh);
  std::vector<char> isUsed(components.size(), 0);
  for (const std::vector<Ids>* cells : { &mesh.Polys, &mesh.Strips })
  {
    for (const Ids& ids : *cells)
    {
      for (const vtkIdType id : ids)
      {
        if (ids.size() > 2 && id < mesh.NumberOfPoints())
        {
          isUsed[static_cast<std::size_t>(id)] = 1;
        }
      }
    }
  }
  const Array* ids = mesh.Find("PointId");
  std::map<vtkIdType, std::size_t> numbers;
  std::vector<double> least;
  for (std::size_t i = 0; i < components.size(); ++i)
  {
    if (isUsed[i])
    {
      const auto found = numbers.emplace(components[i], least.size());
      if (found.second)
      {
        least.push_back(std::numeric_limits<double>::infinity());
      }
      double& id = least[found.first->second];
      id = std::min(id, ids->Values(static_cast<Eigen::Index>(i), 0));
    }
  }
  return least;
}

std::string Renamed(const std::string& name, const std::vector<double>& least)
{
  const std::string words = " of component ";
  const std::size_t place = name.find(words);
  if (place == std::string::npos)
  {
    return name;
  }
  const std::size_t start = place + words.size();
  const auto number = static_cast<std::size_t>(std::strtol(name.c_str() + start, nullptr, 10));
  return number < least.size()
    ? name.substr(0, start) + "with point " + std::to_string(static_cast<long long>(least[number]))
    : name;
}
}

void NameByPoints(const Case& of, const Outcome& outcome, std::vector<Field>& fields)
{
  if (of.Filter != "VolumeChange" || !outcome.Errors.empty())
  {
    return;
  }
  const std::vector<double> least = LeastIds(of.Surface);
  for (Field& field : fields)
  {
    field.Name = Renamed(field.Name, least);
  }
  auto* quantities = outcome.Table
    ? vtkStringArray::SafeDownCast(outcome.Table->GetColumnByName("Quantity"))
    : nullptr;
  const auto first = std::stable_partition(
    fields.begin(), fields.end(), [](const Field& field) { return field.Where != Field::OfTable; });
  const std::vector<Field> columns(first, fields.end());
  fields.erase(first, fields.end());
  for (const Field& column : columns)
  {
    for (vtkIdType row = 0; quantities && row < quantities->GetNumberOfValues(); ++row)
    {
      fields.push_back(column);
      fields.back().Name = column.Name + " of " + Renamed(quantities->GetValue(row), least);
      fields.back().Values = column.Values.row(row);
    }
  }
}
}
