// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PieceVolume.h"

#include "Kernel/Mesh/RayTree.h"

#include <algorithm>
#include <cstring>

namespace cartan
{
namespace
{
/// The whole of a surface in pieces.
struct GatheredSurface
{
  std::vector<std::int64_t> Names; ///< of the vertices, increasing
  Points Positions;
  TriangleMesh Mesh;

  int IndexOf(std::int64_t name) const
  {
    return static_cast<int>(
      std::lower_bound(this->Names.begin(), this->Names.end(), name) - this->Names.begin());
  }
};

/// Numbers of a vertex in a message: name and place.
constexpr std::size_t VertexSize = 4;

std::vector<std::int64_t> OwnVertices(const PieceSurface& piece)
{
  const TriangleMesh& mesh = *piece.TheSurface->Mesh;
  std::vector<std::int64_t> vertices;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (piece.Rows->IsOwned(v) && mesh.IsUsed(v))
    {
      const double* place = piece.TheSurface->Positions->row(v).data();
      vertices.push_back(piece.Rows->GetName(v));
      vertices.resize(vertices.size() + 3);
      std::memcpy(&vertices[vertices.size() - 3], place, 3 * sizeof(double));
    }
  }
  return vertices;
}

/// A triangle is told by the rank that owns the corner with the lowest name.
std::vector<std::int64_t> OwnTriangles(const PieceSurface& piece)
{
  std::vector<std::int64_t> triangles;
  const cartan::Triangles& corners = piece.TheSurface->Mesh->GetTriangles();
  for (Eigen::Index t = 0; t < corners.rows(); ++t)
  {
    int lowest = corners(t, 0);
    for (int c = 1; c < 3; ++c)
    {
      const int v = corners(t, c);
      lowest = piece.Rows->GetName(v) < piece.Rows->GetName(lowest) ? v : lowest;
    }
    for (int c = 0; c < 3 && piece.Rows->IsOwned(lowest); ++c)
    {
      triangles.push_back(piece.Rows->GetName(corners(t, c)));
    }
  }
  return triangles;
}

GatheredSurface GatherPieces(const PieceSurface& piece)
{
  const std::vector<std::int64_t> vertices = piece.Rows->Gather(OwnVertices(piece));
  const std::vector<std::int64_t> corners = piece.Rows->Gather(OwnTriangles(piece));
  GatheredSurface whole;
  for (std::size_t at = 0; at < vertices.size(); at += VertexSize)
  {
    whole.Names.push_back(vertices[at]);
  }
  std::sort(whole.Names.begin(), whole.Names.end());
  whole.Positions.resize(static_cast<Eigen::Index>(whole.Names.size()), 3);
  for (std::size_t at = 0; at < vertices.size(); at += VertexSize)
  {
    std::memcpy(whole.Positions.row(whole.IndexOf(vertices[at])).data(), &vertices[at + 1],
      3 * sizeof(double));
  }
  Triangles triangles(static_cast<Eigen::Index>(corners.size() / 3), 3);
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    triangles.data()[i] = whole.IndexOf(corners[i]);
  }
  whole.Mesh = TriangleMesh(static_cast<int>(whole.Names.size()), std::move(triangles));
  return whole;
}
}

std::unique_ptr<VolumeModel> MeasurePieceVolume(
  const PieceSurface& piece, const ExecutionContext& context)
{
  const GatheredSurface whole = GatherPieces(piece);
  const RayTree tree(whole.Mesh.GetTriangles(), whole.Positions, context.Part(0.0, 0.3));
  const VolumeModel model = MeasureVolumeModel(
    whole.Mesh, whole.Positions,
    [&tree](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
    { return tree.FirstHit(from, direction); },
    context.Part(0.3, 1.0));
  auto here = std::make_unique<VolumeModel>();
  here->Warning = model.Warning;
  if (model.IsEmpty())
  {
    return here;
  }
  const TriangleMesh& mesh = *piece.TheSurface->Mesh;
  // One row at least: where the whole encloses a volume, no piece's model is empty.
  const int count = std::max(mesh.NumberOfVertices(), 1);
  here->LocalDepth.setZero(count);
  here->IsMeasured.assign(static_cast<std::size_t>(count), 0);
  here->Offsets.setZero(count, 3);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      const int w = whole.IndexOf(piece.Rows->GetName(v));
      here->LocalDepth[v] = model.LocalDepth[w];
      here->IsMeasured[v] = model.IsMeasured[w];
      here->Offsets.row(v) = model.Offsets.row(w);
    }
  }
  return here;
}
}
