// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/SurfaceReader.h"

#include "Bridge/PointArrays.h"
#include "Bridge/PolygonTriangles.h"
#include "Bridge/PreparedSurface.h"

#include "vtkFieldData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <limits>
#include <map>
#include <mutex>
#include <sstream>

namespace cartan
{
namespace
{
/// Objects by content, as long as somebody uses them: what makes the filters of a
/// pipeline share one mesh.
template <typename T>
class SharedObjects
{
public:
  template <typename Make>
  std::shared_ptr<const T> Get(const ContentKey& key, const Make& make)
  {
    if (const auto known = this->Find(key))
    {
      return known;
    }
    const std::shared_ptr<const T> made = make();
    const std::lock_guard<std::mutex> lock(this->Mutex);
    for (auto entry = this->Objects.begin(); entry != this->Objects.end();)
    {
      entry = entry->second.expired() ? this->Objects.erase(entry) : std::next(entry);
    }
    this->Objects[key] = made;
    return made;
  }

private:
  std::shared_ptr<const T> Find(const ContentKey& key)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const auto found = this->Objects.find(key);
    return found == this->Objects.end() ? nullptr : found->second.lock();
  }

  std::mutex Mutex;
  std::map<ContentKey, std::weak_ptr<const T>> Objects;
};

SharedObjects<Connectivity>& SharedConnectivities()
{
  static SharedObjects<Connectivity> objects;
  return objects;
}

SharedObjects<Surface>& SharedSurfaces()
{
  static SharedObjects<Surface> objects;
  return objects;
}

void RequireUsable(
  const MeshReport& report, const std::vector<long long>& cellIds, const std::string& role)
{
  if (!report.IsUsable())
  {
    throw Error(ErrorCode::BadInput, "The " + role + " has " + report.DescribeErrors(cellIds));
  }
}

std::shared_ptr<const Connectivity> MakeConnectivity(vtkPolyData* input, const std::string& role)
{
  CellTriangles triangles = CollectTriangles(input, role);
  auto cells = std::make_shared<Connectivity>();
  cells->CellIds = std::move(triangles.CellIds);
  cells->Repeated = triangles.Repeated;
  MeshReport report;
  cells->Mesh = TriangleMesh::Build(static_cast<int>(input->GetNumberOfPoints()),
    Triangles(Eigen::Map<const Triangles>(
      triangles.Corners.data(), static_cast<Eigen::Index>(cells->CellIds.size()), 3)),
    report);
  RequireUsable(report, cells->CellIds, role);
  return cells;
}

/// Where polygons have to be triangulated, their points decide how.
ContentKey KeyOfConnectivity(vtkPolyData* input)
{
  ContentKey key = KeyOfCells(input);
  key.Add(static_cast<std::uint64_t>(input->GetNumberOfPoints()));
  if (!HasOnlyTriangles(input))
  {
    key.Add(KeyOfPoints(input).GetValue());
  }
  return key;
}

std::shared_ptr<const Surface> MakeSurface(vtkPolyData* input, const ContentKey& key,
  const std::string& role, const ExecutionContext& context)
{
  auto surface = std::make_shared<Surface>();
  surface->Key = key;
  surface->Cells = SharedConnectivities().Get(
    KeyOfConnectivity(input), [&] { return MakeConnectivity(input, role); });
  const TriangleMesh& mesh = surface->Cells->Mesh;
  surface->Mesh = { surface->Cells, &mesh };
  context.Report(0.6);

  auto positions = std::make_shared<Points>(ReadPoints(input, context));
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      low = low.cwiseMin(positions->row(v).transpose());
      high = high.cwiseMax(positions->row(v).transpose());
    }
    else
    {
      positions->row(v).setZero();
    }
  }
  MeshReport report;
  CheckPositions(*positions, mesh.GetTriangles(), report);
  RequireUsable(report, surface->Cells->CellIds, role);
  surface->ZeroArea = report.ZeroArea.Renamed(surface->Cells->CellIds);
  surface->Borders = FindCoincidentBorders(mesh, *positions, context.Part(0.8, 0.9));
  surface->Origin = 0.5 * (low + high);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        if (mesh.IsUsed(v))
        {
          positions->row(v) -= surface->Origin.transpose();
        }
      }
    });
  surface->Positions = positions;
  context.Report(1.0);
  return surface;
}
}

std::size_t Connectivity::GetBytes() const
{
  return this->Mesh.GetBytes() + this->CellIds.capacity() * sizeof(long long);
}

std::size_t Surface::GetBytes() const
{
  return this->Cells->GetBytes() +
    static_cast<std::size_t>(this->Positions->size()) * sizeof(double);
}

std::string Surface::Describe(const std::string& role, vtkPolyData* readFrom) const
{
  std::string text;
  const auto add = [&](const IdSample& cells, const std::string& what)
  {
    if (!cells.IsEmpty())
    {
      text +=
        (text.empty() ? "The " : " The ") + role + " has " + cells.Describe("cell", "cells") + what;
    }
  };
  add(this->Cells->Repeated, " using a point twice; ignored.");
  add(this->ZeroArea, " without area.");
  if (!this->Borders.IsEmpty() && !readFrom->GetFieldData()->HasArray(PreparedPointIds))
  {
    std::ostringstream tolerance;
    tolerance << this->Borders.RelativeTolerance;
    text += (text.empty() ? "The " : " The ") + role + " has " +
      std::to_string(this->Borders.NumberOfEdges) + " border edges that coincide, at " +
      this->Borders.Points.Describe("point", "points") +
      ": it looks closed there and is not (split normals, texture seams, triangle soup), and " +
      "will open. Merge these points with vtkPrepareSurface (Prepare Surface), Tolerance " +
      tolerance.str() + ".";
  }
  return text;
}

std::shared_ptr<const Surface> ReadSurface(
  vtkPolyData* input, const std::string& role, const ExecutionContext& context)
{
  if (!input)
  {
    CollectTriangles(nullptr, role);
  }
  const ContentKey key = KeyOfSurface(input);
  return SharedSurfaces().Get(key, [&] { return MakeSurface(input, key, role, context); });
}

TriangleSoup ReadTriangles(
  vtkPolyData* input, const std::string& role, const ExecutionContext& context)
{
  CellTriangles cells = CollectTriangles(input, role);
  TriangleSoup soup;
  soup.CellIds = std::move(cells.CellIds);
  soup.Repeated = cells.Repeated;
  soup.Faces = Eigen::Map<const Triangles>(
    cells.Corners.data(), static_cast<Eigen::Index>(soup.CellIds.size()), 3);
  soup.Positions = ReadPoints(input, context);
  return soup;
}

std::shared_ptr<const Surface> ReadConnectivity(vtkPolyData* input, const std::string& role)
{
  if (!input)
  {
    CollectTriangles(nullptr, role);
  }
  RequireOnlyTriangles(input, role);
  auto surface = std::make_shared<Surface>();
  surface->Key = KeyOfConnectivity(input);
  surface->Cells =
    SharedConnectivities().Get(surface->Key, [&] { return MakeConnectivity(input, role); });
  surface->Mesh = { surface->Cells, &surface->Cells->Mesh };
  surface->Positions =
    std::make_shared<const Points>(Points::Zero(surface->Mesh->NumberOfVertices(), 3));
  return surface;
}
}
