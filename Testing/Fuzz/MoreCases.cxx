// SPDX-License-Identifier: BSD-3-Clause
#include "MoreCases.h"

#include "Defects.h"

#include "vtkCurveDeformation.h"
#include "vtkLandmarkHandles.h"
#include "vtkSurfaceDeformation.h"
#include "vtkSurfaceMorph.h"

#include <algorithm>
#include <numeric>

namespace fuzz
{
namespace
{
template <typename Class, typename Value>
Setting NewSetting(const char* name, void (Class::*set)(Value), double value)
{
  Setting setting;
  setting.Name = name;
  setting.Values = { value };
  setting.Apply = [set](vtkAlgorithm* filter, const std::vector<double>& v)
  { (static_cast<Class*>(filter)->*set)(static_cast<Value>(v[0])); };
  return setting;
}

void Replace(Case& made, const char* name, double value)
{
  for (Setting& setting : made.Settings)
  {
    setting.Values = setting.Name == name ? std::vector<double>{ value } : setting.Values;
  }
}

/// The source curve passes the ends of the path, and perhaps a point between.
void FindSource(Case& made, Random& random)
{
  const auto ids = std::find_if(made.Settings.begin(), made.Settings.end(),
    [](const Setting& setting) { return setting.Name == "PointIds"; });
  if (ids == made.Settings.end() || ids->Values.size() < 2)
  {
    return;
  }
  const std::vector<double> path = ids->Values;
  ids->Values = { path.front(), path.back() };
  if (path.size() > 2 && random.Chance(0.3))
  {
    ids->Values.insert(ids->Values.begin() + 1, path[path.size() / 2]);
  }
  using Class = vtkCurveDeformation;
  made.Settings.push_back(NewSetting("Source", &Class::SetSource,
    random.Pick<int>(
      { Class::SHORTEST_PATH, Class::FEATURE_EDGES, Class::SILHOUETTE, Class::GEODESIC })));
  made.Settings.push_back(
    NewSetting("FeatureAngle", &Class::SetFeatureAngle, random.Real(0.0, 60.0)));
  Setting view;
  view.Name = "ViewDirection";
  view.Type = Kind::Vector;
  const Eigen::Vector3d direction = random.Log(1e-3, 1e3) * random.Direction();
  view.Values.assign(direction.data(), direction.data() + 3);
  view.Apply = [](vtkAlgorithm* filter, const std::vector<double>& v)
  { static_cast<Class*>(filter)->SetViewDirection(v[0], v[1], v[2]); };
  made.Settings.push_back(view);
}

/// Some points of the target curve say which point of the source curve they are.
void AddKeys(Case& made, Random& random)
{
  const auto ids = std::find_if(made.Settings.begin(), made.Settings.end(),
    [](const Setting& setting) { return setting.Name == "PointIds"; });
  if (made.Clouds.empty() || ids == made.Settings.end())
  {
    return;
  }
  Ids keys;
  for (const double id : ids->Values)
  {
    keys.push_back(random.Chance(0.4) ? static_cast<vtkIdType>(id) : -1);
  }
  made.CloudKeys = { keys };
}

/// The second set in another order, each landmark with its name.
void NameLandmarks(Case& made, Random& random)
{
  Ids names(made.Clouds[0].size());
  std::iota(names.begin(), names.end(), 0);
  made.CloudNames = { names, names };
  random.Shuffle(made.CloudNames[1]);
  const std::vector<Eigen::Vector3d> to = made.Clouds[1];
  for (std::size_t i = 0; i < to.size(); ++i)
  {
    made.Clouds[1][i] = to[static_cast<std::size_t>(made.CloudNames[1][i])];
  }
  made.Settings.push_back(
    NewSetting("Matching", &vtkLandmarkHandles::SetMatching, vtkLandmarkHandles::NAME));
}

Eigen::Vector3d MeanOf(const std::vector<Eigen::Vector3d>& points, const Ids& ids)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const vtkIdType id : ids)
  {
    sum += points[static_cast<std::size_t>(id)];
  }
  return sum / static_cast<double>(ids.size());
}

/// A tetrahedron from each triangle to the middle, a new point of the surface in no triangle.
void FillWithTetrahedra(Case& made)
{
  Mesh& mesh = made.Surface;
  Ids corners;
  for (const std::size_t t : Triangles(mesh))
  {
    corners.insert(corners.end(), mesh.Polys[t].begin(), mesh.Polys[t].end());
  }
  if (corners.empty() || !mesh.Strips.empty())
  {
    return;
  }
  const vtkIdType middle = mesh.AddPoint(MeanOf(mesh.Points, corners));
  for (std::vector<Eigen::Vector3d>& points : made.Others)
  {
    points.push_back(MeanOf(points, corners));
  }
  for (Array& array : mesh.Arrays)
  {
    array.Values.conservativeResize(middle + 1, Eigen::NoChange);
    array.Values.row(middle) = array.Values.row(corners[0]);
    array.Values(middle, 0) = array.Name == "PointId" ? static_cast<double>(middle)
      : array.Name == "Handle"                        ? 0.0
      : array.Name == "JoinedPoints"                  ? -1.0
                                                      : array.Values(middle, 0);
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
  {
    made.Tetrahedra.push_back({ corners[i], corners[i + 1], corners[i + 2], middle });
  }
}
}

void AddChoices(Case& made, Random& random)
{
  if (random.Chance(0.2))
  {
    Replace(made, "Solver", vtkSurfaceDeformation::CONJUGATE_GRADIENTS);
  }
  if (made.Filter == "SurfaceMorph" && random.Chance(0.2))
  {
    Replace(made, "Method", vtkSurfaceMorph::PYRAMID_COORDINATES);
  }
  const bool isChosen = random.Chance(0.3);
  if (made.Filter == "CurveDeformation")
  {
    isChosen ? FindSource(made, random) : AddKeys(made, random);
  }
  else if (made.Filter == "LandmarkHandles" && isChosen)
  {
    NameLandmarks(made, random);
  }
  else if ((made.Filter == "CarryAlong" || made.Filter == "VolumetricDeformation") && isChosen)
  {
    FillWithTetrahedra(made);
  }
  if (made.Surface.IsFloat)
  {
    RoundToFloat(made.Surface.Points);
    std::for_each(made.Others.begin(), made.Others.end(), RoundToFloat);
  }
}
}
