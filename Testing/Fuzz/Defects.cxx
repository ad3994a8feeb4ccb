// SPDX-License-Identifier: BSD-3-Clause
#include "Defects.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace fuzz
{
namespace
{
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

const Eigen::Vector3d& At(const Mesh& mesh, vtkIdType id)
{
  return mesh.Points[static_cast<std::size_t>(id)];
}

vtkIdType AnyPoint(const Mesh& mesh, Random& random)
{
  return random.Integer(0, static_cast<int>(mesh.NumberOfPoints()) - 1);
}

Ids& AnyPolygon(Mesh& mesh, Random& random)
{
  return mesh
    .Polys[static_cast<std::size_t>(random.Integer(0, static_cast<int>(mesh.Polys.size()) - 1))];
}

void AddCaps(Mesh& mesh, Random& random)
{
  const int count = random.Integer(1, 4);
  const double height = random.Log(1e-10, 1e-2);
  for (int i = 0; i < count; ++i)
  {
    const std::vector<std::size_t> triangles = Triangles(mesh);
    if (!triangles.empty())
    {
      AddCap(mesh, random.Pick(triangles), height);
    }
  }
}

/// A point very near to a corner of a triangle, inside of it.
void AddNeedles(Mesh& mesh, Random& random)
{
  const std::vector<std::size_t> triangles = Triangles(mesh);
  if (triangles.empty())
  {
    return;
  }
  const double e = random.Log(1e-9, 1e-1);
  const std::size_t cell = random.Pick(triangles);
  const Ids t = mesh.Polys[cell];
  const vtkIdType inside =
    mesh.AddPoint((1.0 - e) * At(mesh, t[0]) + 0.5 * e * (At(mesh, t[1]) + At(mesh, t[2])));
  mesh.Polys[cell] = { t[0], t[1], inside };
  mesh.Polys.push_back({ t[1], t[2], inside });
  mesh.Polys.push_back({ t[2], t[0], inside });
}

void AddTinyPart(Mesh& mesh, Random& random)
{
  Mesh part;
  const int corners[4][3] = { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } };
  const double size = random.Log(1e-8, 1e-2);
  const Eigen::Vector3d center = At(mesh, AnyPoint(mesh, random)) + random.Vector();
  for (const auto& corner : corners)
  {
    part.AddPoint(center + size * Eigen::Vector3d(corner[0], corner[1], corner[2]));
  }
  part.Polys = { { 0, 1, 2 }, { 0, 3, 1 }, { 0, 2, 3 }, { 1, 3, 2 } };
  Append(mesh, part);
}

/// Neighboring polygons on different sides of a plane get points of their own.
void SplitSeam(Mesh& mesh, Random& random)
{
  const Eigen::Vector3d normal = random.Direction();
  const Eigen::Vector3d center = At(mesh, AnyPoint(mesh, random));
  std::map<vtkIdType, vtkIdType> copies;
  for (Ids& ids : mesh.Polys)
  {
    if (std::any_of(
          ids.begin(), ids.end(), [&](vtkIdType id) { return id >= mesh.NumberOfPoints(); }) ||
      normal.dot(At(mesh, ids[0]) - center) < 0.0)
    {
      continue;
    }
    for (vtkIdType& id : ids)
    {
      const auto found = copies.find(id);
      id = found != copies.end()
        ? found->second
        : copies.emplace(id, mesh.AddPoint(Eigen::Vector3d(At(mesh, id)))).first->second;
    }
  }
}

void MakeSoup(Mesh& mesh, Random&)
{
  for (Ids& ids : mesh.Polys)
  {
    for (vtkIdType& id : ids)
    {
      if (id < mesh.NumberOfPoints())
      {
        id = mesh.AddPoint(Eigen::Vector3d(At(mesh, id)));
      }
    }
  }
}

void AddFin(Mesh& mesh, Random& random)
{
  const Ids& ids = AnyPolygon(mesh, random);
  if (ids.size() >= 2)
  {
    const vtkIdType a = ids[0];
    const vtkIdType b = ids[1];
    mesh.Polys.push_back({ b, a, AnyPoint(mesh, random) });
  }
}

/// Two points become one, wherever they are.
void Pinch(Mesh& mesh, Random& random)
{
  const vtkIdType from = AnyPoint(mesh, random);
  const vtkIdType to = AnyPoint(mesh, random);
  for (Ids& ids : mesh.Polys)
  {
    std::replace(ids.begin(), ids.end(), from, to);
  }
}

void TurnOver(Mesh& mesh, Random& random)
{
  const std::vector<vtkIdType> components = Components(mesh);
  const vtkIdType component = random.Pick(components);
  const bool isAll = random.Chance(0.7);
  for (Ids& ids : mesh.Polys)
  {
    if (isAll ? ids[0] < mesh.NumberOfPoints() &&
          components[static_cast<std::size_t>(ids[0])] == component
              : random.Chance(0.1))
    {
      std::reverse(ids.begin(), ids.end());
    }
  }
}

void AddUnused(Mesh& mesh, Random& random)
{
  const int count = random.Integer(1, 5);
  for (int i = 0; i < count; ++i)
  {
    mesh.AddPoint(random.Chance(0.2) ? Eigen::Vector3d::Constant(NotANumber) : random.Vector());
  }
}

void DoublePolygons(Mesh& mesh, Random& random)
{
  Ids ids = AnyPolygon(mesh, random);
  if (random.Chance(0.5))
  {
    std::reverse(ids.begin(), ids.end());
  }
  mesh.Polys.push_back(ids);
}

void AddDegenerate(Mesh& mesh, Random& random)
{
  const vtkIdType a = AnyPoint(mesh, random);
  mesh.Polys.push_back({ a, a, AnyPoint(mesh, random) });
}

void AddNotFinite(Mesh& mesh, Random& random)
{
  mesh.Points[static_cast<std::size_t>(AnyPoint(mesh, random))][random.Integer(0, 2)] =
    random.Chance(0.5) ? NotANumber : std::numeric_limits<double>::infinity();
}

/// A point moves onto, or nearly onto, another one of the same polygon.
void CollapseEdge(Mesh& mesh, Random& random)
{
  const Ids& ids = AnyPolygon(mesh, random);
  if (ids.size() >= 2 && ids[0] < mesh.NumberOfPoints() && ids[1] < mesh.NumberOfPoints())
  {
    const double part = random.Chance(0.5) ? 0.0 : random.Log(1e-9, 1e-2);
    mesh.Points[static_cast<std::size_t>(ids[0])] =
      part * At(mesh, ids[0]) + (1.0 - part) * At(mesh, ids[1]);
  }
}

void AddHoles(Mesh& mesh, Random& random)
{
  const int count = std::min(random.Integer(1, 8), static_cast<int>(mesh.Polys.size()) - 1);
  for (int i = 0; i < count; ++i)
  {
    mesh.Polys.erase(
      mesh.Polys.begin() + random.Integer(0, static_cast<int>(mesh.Polys.size()) - 1));
  }
}

void AddMissingPoint(Mesh& mesh, Random& random)
{
  mesh.Polys.push_back({ 0, 1, mesh.NumberOfPoints() + random.Integer(0, 1000000) });
}

/// The surface a second time, turned over: a plate without thickness.
void DoubleSided(Mesh& mesh, Random&)
{
  Mesh back = mesh;
  for (Ids& ids : back.Polys)
  {
    std::reverse(ids.begin(), ids.end());
  }
  back.Verts.clear();
  back.Lines.clear();
  back.Strips.clear();
  Append(mesh, back);
}

/// All points move towards a plane: to a part of their distance, or onto it.
void Flatten(Mesh& mesh, Random& random)
{
  const Eigen::Vector3d normal = random.Direction();
  const double part = random.Chance(0.3) ? 1.0 : 1.0 - random.Log(1e-9, 1e-1);
  for (Eigen::Vector3d& point : mesh.Points)
  {
    point -= part * normal.dot(point) * normal;
  }
}
}

std::vector<std::size_t> Triangles(const Mesh& mesh)
{
  std::vector<std::size_t> triangles;
  for (std::size_t i = 0; i < mesh.Polys.size(); ++i)
  {
    const Ids& ids = mesh.Polys[i];
    if (ids.size() == 3 && std::set<vtkIdType>(ids.begin(), ids.end()).size() == 3 &&
      *std::max_element(ids.begin(), ids.end()) < mesh.NumberOfPoints())
    {
      triangles.push_back(i);
    }
  }
  return triangles;
}

void AddCap(Mesh& mesh, std::size_t cell, double height)
{
  const Ids t = mesh.Polys[cell];
  const Eigen::Vector3d a = At(mesh, t[0]);
  const Eigen::Vector3d b = At(mesh, t[1]);
  const Eigen::Vector3d inward = At(mesh, t[2]) - 0.5 * (a + b);
  const double length = inward.norm() > 0.0 ? (b - a).norm() / inward.norm() : 0.0;
  const vtkIdType middle = mesh.AddPoint(0.5 * (a + b) + height * length * inward);
  mesh.Polys[cell] = { t[0], t[1], middle };
  mesh.Polys.push_back({ t[1], t[2], middle });
  mesh.Polys.push_back({ t[2], t[0], middle });
}

void AddDefects(Mesh& mesh, Random& random)
{
  // Those that all filters must live with come first, and more often.
  static const std::vector<void (*)(Mesh&, Random&)> harmless = { AddCaps, AddNeedles, AddTinyPart,
    AddUnused, CollapseEdge, AddHoles, Flatten, DoubleSided };
  static const std::vector<void (*)(Mesh&, Random&)> others = { SplitSeam, MakeSoup, AddFin, Pinch,
    TurnOver, DoublePolygons, AddDegenerate, AddNotFinite, AddMissingPoint };
  const int count = random.Integer(1, 3);
  for (int i = 0; i < count && !mesh.Polys.empty(); ++i)
  {
    random.Pick(random.Chance(0.7) ? harmless : others)(mesh, random);
  }
}
}
