// SPDX-License-Identifier: BSD-3-Clause
#include "SteeringCases.h"

#include "Defects.h"
#include "Deformed.h"

#include "vtkCurveDeformation.h"

#include <algorithm>
#include <map>
#include <set>

namespace fuzz
{
namespace
{
/// Some points lie on the surface at rest, others beside it.
void AddCarrier(Case& made, Random& random)
{
  const double distance =
    random.Chance(0.4) ? 0.0 : Size(made.Surface.Points) * random.Log(1e-3, 0.1);
  const Eigen::Vector3d away = distance * random.Direction();
  std::vector<Eigen::Vector3d> rest = made.Surface.Points;
  std::for_each(rest.begin(), rest.end(), [&](Eigen::Vector3d& point) { point += away; });
  made.Others = { rest, Deformed(rest, random) };
}

void AddLandmarks(Case& made, Random& random)
{
  const double size = Size(made.Surface.Points);
  const Eigen::Vector3d shift = 0.2 * size * random.Vector();
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  const int count = random.Integer(1, 8);
  for (int i = 0; i < count; ++i)
  {
    const Eigen::Vector3d point = random.Pick(made.Surface.Points);
    from.push_back(point + 1e-3 * size * random.Vector());
    to.push_back(point + shift + 0.05 * size * random.Vector());
  }
  made.Clouds = { from, to };
}

std::map<vtkIdType, std::set<vtkIdType>> NeighborsOf(const Mesh& mesh)
{
  std::map<vtkIdType, std::set<vtkIdType>> neighbors;
  for (const std::size_t t : Triangles(mesh))
  {
    const Ids& ids = mesh.Polys[t];
    for (int c = 0; c < 3; ++c)
    {
      neighbors[ids[c]].insert(ids[(c + 1) % 3]);
      neighbors[ids[(c + 1) % 3]].insert(ids[c]);
    }
  }
  return neighbors;
}

/// Along edges in one direction; no two points of it are neighbors but those in a row.
Ids RandomPath(const Mesh& mesh, Random& random)
{
  const auto neighbors = NeighborsOf(mesh);
  if (neighbors.empty())
  {
    return {};
  }
  const std::vector<std::size_t> triangles = Triangles(mesh);
  const auto place = [&](vtkIdType id) { return mesh.Points[static_cast<std::size_t>(id)]; };
  Ids path = { mesh.Polys[random.Pick(triangles)][0] };
  const Eigen::Vector3d direction = random.Direction();
  const std::size_t length = static_cast<std::size_t>(random.Integer(2, 12));
  std::set<vtkIdType> near;
  while (path.size() < length)
  {
    vtkIdType best = -1;
    for (const vtkIdType next : neighbors.at(path.back()))
    {
      const bool isFree = near.count(next) == 0 && next != path[0];
      if (isFree && (best < 0 || direction.dot(place(next) - place(best)) > 0.0))
      {
        best = next;
      }
    }
    if (best < 0)
    {
      break;
    }
    near.insert(path.back());
    near.insert(neighbors.at(path.back()).begin(), neighbors.at(path.back()).end());
    path.push_back(best);
  }
  return path;
}

void SetPointIds(vtkAlgorithm* filter, const std::vector<double>& ids)
{
  auto* curve = vtkCurveDeformation::SafeDownCast(filter);
  curve->SetSourceToSelectedPoints();
  curve->SetNumberOfPointIds(static_cast<int>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    curve->SetPointId(static_cast<int>(i), static_cast<vtkIdType>(ids[i]));
  }
}

/// A path and the line that it goes to, bent and stretched.
void AddCurve(Case& made, Random& random)
{
  const Ids path = RandomPath(made.Surface, random);
  Setting ids;
  ids.Name = "PointIds";
  ids.IsOfIds = true;
  ids.Values.assign(path.begin(), path.end());
  ids.Apply = SetPointIds;
  made.Settings.push_back(ids);
  if (path.empty() || random.Chance(0.1))
  {
    return;
  }
  const double size = Size(made.Surface.Points);
  const Eigen::Vector3d shift = 0.1 * size * random.Vector();
  const Eigen::Matrix3d bend = 0.3 * random.Vector() * random.Vector().transpose();
  std::vector<Eigen::Vector3d> line;
  for (const vtkIdType id : path)
  {
    const Eigen::Vector3d along = made.Surface.Points[static_cast<std::size_t>(id)] -
      made.Surface.Points[static_cast<std::size_t>(path[0])];
    line.push_back(made.Surface.Points[static_cast<std::size_t>(path[0])] + shift + along +
      bend * along + 0.2 * along.squaredNorm() / size * random.Direction());
  }
  made.Clouds = { line };
}
}

void AddSteering(Case& made, Random& random)
{
  if (made.Filter == "CarryAlong")
  {
    AddCarrier(made, random);
  }
  else if (made.Filter == "LandmarkHandles")
  {
    AddLandmarks(made, random);
  }
  else if (made.Filter == "CurveDeformation")
  {
    AddCurve(made, random);
  }
  for (std::vector<std::vector<Eigen::Vector3d>>* all : { &made.Others, &made.Clouds })
  {
    if (made.Surface.IsFloat)
    {
      std::for_each(all->begin(), all->end(), RoundToFloat);
    }
  }
}
}
