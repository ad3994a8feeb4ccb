// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/IsolineCut.h"

#include <array>
#include <map>
#include <utility>

namespace cartan
{
namespace
{
/// The isoline goes through a vertex that is nearer to it than this part of an edge.
constexpr double SnapPart = 0.2;

/// Values that are the level where the isoline passes close by.
Eigen::VectorXd SnappedValues(
  const TriangleMesh& mesh, const Eigen::VectorXd& values, double level, double snapPart)
{
  Eigen::VectorXd snapped = values;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int below = mesh.Origin(d);
    const int above = mesh.Neighbor(d);
    if (values[below] < level && values[above] > level)
    {
      const double part = (level - values[below]) / (values[above] - values[below]);
      if (part < snapPart || part > 1.0 - snapPart)
      {
        snapped[part < snapPart ? below : above] = level;
      }
    }
  }
  return snapped;
}

/// Cuts triangle by triangle.
class Cutter
{
public:
  Cutter(const Points& points, const Eigen::VectorXd& values, double level)
    : Values(values)
    , Level(level)
  {
    for (Eigen::Index v = 0; v < points.rows(); ++v)
    {
      this->Places.push_back(SurfacePlace::AtVertex(static_cast<int>(v)));
      this->IsOnIsoline.push_back(values[v] == level);
    }
  }

  /// The corners of the part of a triangle to keep; none where nothing of it is above.
  std::vector<int> PartAbove(const std::array<int, 3>& triangle)
  {
    std::vector<int> corners;
    bool isAbove = false;
    for (int c = 0; c < 3; ++c)
    {
      const int a = triangle[c];
      const int b = triangle[(c + 1) % 3];
      isAbove = isAbove || this->Values[a] > this->Level;
      if (this->Values[a] >= this->Level)
      {
        corners.push_back(a);
      }
      if ((this->Values[a]<this->Level&& this->Values[b]> this->Level) ||
        (this->Values[a] > this->Level && this->Values[b] < this->Level))
      {
        corners.push_back(this->Crossing(a, b));
      }
    }
    return isAbove ? corners : std::vector<int>{};
  }

  std::vector<SurfacePlace> Places;
  std::vector<char> IsOnIsoline;

private:
  int Crossing(int a, int b)
  {
    const auto [low, high] = std::minmax(a, b);
    const auto [entry, isNew] =
      this->Crossings.try_emplace({ low, high }, static_cast<int>(this->Places.size()));
    if (isNew)
    {
      const double part =
        (this->Level - this->Values[low]) / (this->Values[high] - this->Values[low]);
      this->Places.push_back({ { low, high, high }, { 1.0 - part, part, 0.0 } });
      this->IsOnIsoline.push_back(1);
    }
    return entry->second;
  }

  const Eigen::VectorXd& Values;
  double Level;
  std::map<std::pair<int, int>, int> Crossings;
};

/// False where the part that is kept would be no manifold.
bool Cut(const TriangleMesh& mesh, const Points& points, const Eigen::VectorXd& values,
  double level, CutSurface& cut)
{
  Cutter cutter(points, values, level);
  std::vector<std::array<int, 3>> faces;
  cut.OriginalFaces.clear();
  for (Eigen::Index t = 0; t < mesh.GetTriangles().rows(); ++t)
  {
    const auto triangle = mesh.GetTriangles().row(t);
    const std::vector<int> corners = cutter.PartAbove({ triangle[0], triangle[1], triangle[2] });
    for (std::size_t i = 2; i < corners.size(); ++i)
    {
      faces.push_back({ corners[0], corners[i - 1], corners[i] });
      cut.OriginalFaces.push_back(static_cast<int>(t));
    }
  }
  Triangles triangles(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    triangles.row(static_cast<Eigen::Index>(f)) << faces[f][0], faces[f][1], faces[f][2];
  }
  MeshReport report;
  cut.Mesh = std::make_shared<TriangleMesh>(
    TriangleMesh::Build(static_cast<int>(cutter.Places.size()), std::move(triangles), report));
  if (!report.IsManifold())
  {
    return false;
  }
  cut.Places = std::move(cutter.Places);
  cut.IsOnIsoline = std::move(cutter.IsOnIsoline);
  cut.Positions = std::make_shared<Points>(AtPlaces(points, cut.Places));
  return true;
}
}

CutSurface CutBelow(
  const TriangleMesh& mesh, const Points& points, const Eigen::VectorXd& values, double level)
{
  CutSurface cut;
  if (!Cut(mesh, points, SnappedValues(mesh, values, level, SnapPart), level, cut))
  {
    Cut(mesh, points, values, level, cut);
  }
  return cut;
}
}
