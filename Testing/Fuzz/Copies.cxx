// SPDX-License-Identifier: BSD-3-Clause
#include "Copies.h"

#include "Defects.h"
#include "Shapes.h"

#include <algorithm>
#include <map>
#include <set>

namespace fuzz
{
namespace
{
constexpr double Joined = 3.0;
}

Ids HangOnPoint(Mesh& mesh, Random& random)
{
  Mesh limb = MakeShape(random);
  const std::vector<std::size_t> triangles = Triangles(mesh);
  const std::vector<std::size_t> ofLimb = Triangles(limb);
  if (triangles.empty() || ofLimb.empty())
  {
    return {};
  }
  const vtkIdType at = mesh.Polys[random.Pick(triangles)][0];
  const vtkIdType hook = limb.Polys[random.Pick(ofLimb)][0];
  const Eigen::Vector3d place = mesh.Points[static_cast<std::size_t>(at)];
  const Eigen::Vector3d from = limb.Points[static_cast<std::size_t>(hook)];
  const double scale = random.Log(0.1, 1.0) * Size(mesh.Points) / Size(limb.Points);
  const Eigen::Matrix3d rotation = random.Rotation();
  for (Eigen::Vector3d& point : limb.Points)
  {
    point = place + scale * (rotation * (point - from));
  }
  const vtkIdType copy = mesh.NumberOfPoints() + hook;
  Append(mesh, limb);
  return { at, copy };
}

Array JoinedPoints(const Mesh& mesh, const Ids& copies)
{
  Array array;
  array.Name = "JoinedPoints";
  array.IsInteger = true;
  array.Values = Eigen::VectorXd::Constant(mesh.NumberOfPoints(), -1.0);
  for (const vtkIdType copy : copies)
  {
    array.Values(copy, 0) = Joined;
  }
  return array;
}

Ids Copies(const Mesh& mesh)
{
  Ids copies;
  const Array* array = mesh.Find("JoinedPoints");
  for (Eigen::Index i = 0; array && i < array->Values.rows(); ++i)
  {
    if (array->Values(i, 0) == Joined)
    {
      copies.push_back(i);
    }
  }
  return copies;
}

void KeepTogether(const Mesh& joined, std::vector<Eigen::Vector3d>& points)
{
  const Ids copies = Copies(joined);
  for (const vtkIdType copy : copies)
  {
    points[static_cast<std::size_t>(copy)] = points[static_cast<std::size_t>(copies[0])];
  }
}

Ids BorderPoints(const Mesh& mesh)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> uses;
  const auto use = [&](const Ids& ids)
  {
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      ++uses[std::minmax(ids[i], ids[(i + 1) % ids.size()])];
    }
  };
  std::for_each(mesh.Polys.begin(), mesh.Polys.end(), use);
  for (const Ids& ids : mesh.Strips)
  {
    for (std::size_t i = 2; i < ids.size(); ++i)
    {
      use({ ids[i - 2], ids[i - 1], ids[i] });
    }
  }
  std::set<vtkIdType> points;
  for (const auto& [edge, count] : uses)
  {
    if (count == 1 && edge.second < mesh.NumberOfPoints())
    {
      points.insert({ edge.first, edge.second });
    }
  }
  return Ids(points.begin(), points.end());
}
}
