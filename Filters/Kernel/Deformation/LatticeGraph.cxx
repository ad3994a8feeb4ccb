// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/LatticeGraph.h"

#include "Base/FloodFill.h"
#include "Deformation/BodyRays.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace cartan
{
namespace
{
/// Lattice points nearer to the surface than this part of the spacing are left out:
/// their edges would be short and heavy.
constexpr double NearestPart = 0.287;

/// How far a vertex sees lattice points, in spacings: past the next two layers.
constexpr double SightPart = 1.63;

/// How far apart sides of a thin part may be to be joined, in spacings.
constexpr double ThinPart = 3.0;

/// The outer layer against the inside: enough to keep the skin from folding, while what
/// is outside hardly resists bending.
constexpr double OuterShare = 0.1;

/// A lattice has a box around it that may be as much larger than what is in it.
constexpr double MostBoxPoints = 1e8;

double MeanEdgeLength(const TriangleMesh& mesh, const Points& points)
{
  double sum = 0.0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    sum += (points.row(mesh.Neighbor(d)) - points.row(mesh.Origin(d))).norm();
  }
  return sum / mesh.NumberOfDirectedEdges();
}

/// The graph of a closed surface while it is made.
class LatticeGraph
{
public:
  LatticeGraph(const TriangleMesh& mesh, const Points& points, const LatticeOptions& options,
    const ExecutionContext& context)
    : Mesh(mesh)
    , Rest(points)
    , Body(mesh, points, context.Part(0.0, 0.2))
    , Areas(MixedVoronoiAreas(mesh, points))
  {
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (mesh.IsUsed(v))
      {
        this->Box.extend(Eigen::Vector3d(points.row(v).transpose()));
        ++this->UsedCount;
      }
    }
    this->ChooseSpacing(options);
    this->FillInside(context.Part(0.2, 0.8));
    this->AddLatticeEdges();
    this->AddSurfaceEdges(options.Weights);
    this->JoinSurface();
    this->DropLoose();
    if (options.OuterLayer)
    {
      this->AddOuterLayer();
    }
    context.Report(1.0);
  }

  VolumeGraph Take()
  {
    Points nodes(this->Mesh.NumberOfVertices() + static_cast<Eigen::Index>(this->Added.size()), 3);
    nodes.topRows(this->Mesh.NumberOfVertices()) = this->Rest;
    for (std::size_t i = 0; i < this->Added.size(); ++i)
    {
      nodes.row(this->Mesh.NumberOfVertices() + static_cast<Eigen::Index>(i)) =
        this->Added[i].transpose();
    }
    return ToGraph(std::move(nodes), this->Edges);
  }

private:
  /// The spacing at which the box has MostBoxPoints, however many layers lie in its short
  /// sides.
  double LeastSpacingOfBox() const
  {
    Eigen::Vector3d sides = this->Box.sizes();
    std::sort(sides.data(), sides.data() + 3);
    return std::max({ sides[2] / MostBoxPoints, std::sqrt(sides[2] * sides[1] / MostBoxPoints),
      std::cbrt(sides.prod() / MostBoxPoints) });
  }

  void ChooseSpacing(const LatticeOptions& options)
  {
    const double volume = this->Body.GetVolume();
    const double fitting =
      1.1 * std::max(std::cbrt(volume / options.MostPoints), this->LeastSpacingOfBox());
    this->Spacing = options.Spacing > 0.0 ? options.Spacing
                                          : std::max({ MeanEdgeLength(this->Mesh, this->Rest),
                                              std::cbrt(0.5 * volume / this->UsedCount), fitting });
    // At least one layer in each direction.
    const Eigen::Vector3d cells = (this->Box.sizes() / this->Spacing).cwiseMax(1.0);
    const double inside = volume / std::pow(this->Spacing, 3);
    if (!(inside <= options.MostPoints) || !(cells.prod() <= MostBoxPoints))
    {
      std::ostringstream text;
      text << "A lattice of spacing " << this->Spacing << " has about " << inside
           << " points inside of the surface, in a box of " << cells.prod() << "; at most "
           << options.MostPoints << " and " << MostBoxPoints
           << " fit in memory. Set LatticeSpacing to " << fitting << " or more, or to 0.";
      throw Error(ErrorCode::TooLarge, text.str());
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      // Rounding of the box adds no layer.
      this->Counts[axis] = std::max(1, static_cast<int>(std::ceil(cells[axis] - 1e-6)));
    }
    this->First = this->Box.center() -
      0.5 * this->Spacing * (this->Counts.cast<double>() - Eigen::Vector3d::Ones());
  }

  Eigen::Vector3d Place(const Eigen::Vector3i& at) const
  {
    return this->First + this->Spacing * at.cast<double>();
  }

  std::size_t Cell(const Eigen::Vector3i& at) const
  {
    return (static_cast<std::size_t>(at[2]) * this->Counts[1] + at[1]) * this->Counts[0] + at[0];
  }

  void FillInside(const ExecutionContext& context)
  {
    std::vector<char> isInside(
      static_cast<std::size_t>(this->Counts[0]) * this->Counts[1] * this->Counts[2], 0);
    for (int layer = 0; layer < this->Counts[2]; ++layer)
    {
      context.For(this->Counts[1],
        [&](int begin, int end)
        {
          for (int row = begin; row < end; ++row)
          {
            for (int i = 0; i < this->Counts[0]; ++i)
            {
              const Eigen::Vector3i at(i, row, layer);
              isInside[this->Cell(at)] =
                this->Body.IsInside(this->Place(at), NearestPart * this->Spacing);
            }
          }
        });
      context.Report((layer + 1.0) / this->Counts[2]);
    }
    this->NodeOf.assign(isInside.size(), -1);
    Eigen::Vector3i at;
    for (at[2] = 0; at[2] < this->Counts[2]; ++at[2])
    {
      for (at[1] = 0; at[1] < this->Counts[1]; ++at[1])
      {
        for (at[0] = 0; at[0] < this->Counts[0]; ++at[0])
        {
          if (isInside[this->Cell(at)])
          {
            this->NodeOf[this->Cell(at)] =
              this->Mesh.NumberOfVertices() + static_cast<int>(this->Added.size());
            this->Added.push_back(this->Place(at));
            this->Cells.push_back(at);
          }
        }
      }
    }
  }

  int NodeAt(const Eigen::Vector3i& at) const
  {
    const bool isIn = (at.array() >= 0).all() && (at.array() < this->Counts.array()).all();
    return isIn ? this->NodeOf[this->Cell(at)] : -1;
  }

  const Eigen::Vector3d& AddedAt(int node) const
  {
    return this->Added[node - this->Mesh.NumberOfVertices()];
  }

  void AddLatticeEdges()
  {
    for (std::size_t i = 0; i < this->Added.size(); ++i)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        const int next = this->NodeAt(this->Cells[i] + Eigen::Vector3i::Unit(axis));
        if (next >= 0 && this->Body.Sees(this->Added[i], this->AddedAt(next)))
        {
          this->Edges.push_back({ this->Mesh.NumberOfVertices() + static_cast<int>(i), next, 2.0 });
        }
      }
    }
  }

  void AddSurfaceEdges(LaplacianWeights weights)
  {
    this->EdgeWeights =
      SymmetricPart(this->Mesh, cartan::EdgeWeights(this->Mesh, this->Rest, weights));
    if (weights == LaplacianWeights::MeanValue)
    {
      // They have the unit 1 / length, those of the lattice have none.
      this->EdgeWeights *= MeanEdgeLength(this->Mesh, this->Rest);
    }
    for (int d = 0; d < this->Mesh.NumberOfDirectedEdges(); ++d)
    {
      if (this->Mesh.Origin(d) < this->Mesh.Neighbor(d))
      {
        this->Edges.push_back(
          { this->Mesh.Origin(d), this->Mesh.Neighbor(d), this->EdgeWeights[d] });
      }
    }
  }

  std::vector<int> SeenLatticePoints(int v) const
  {
    const Eigen::Vector3d place = this->Rest.row(v);
    const Eigen::Vector3d normal = this->Body.GetNormals().row(v);
    const double sight = SightPart * this->Spacing;
    const Eigen::Vector3i low =
      ((place - this->First).array() / this->Spacing - SightPart).ceil().cast<int>();
    std::vector<int> seen;
    Eigen::Vector3i at;
    for (at[2] = low[2]; at[2] < low[2] + 4; ++at[2])
    {
      for (at[1] = low[1]; at[1] < low[1] + 4; ++at[1])
      {
        for (at[0] = low[0]; at[0] < low[0] + 4; ++at[0])
        {
          const int node = this->NodeAt(at);
          if (node < 0)
          {
            continue;
          }
          const Eigen::Vector3d way = place - this->AddedAt(node);
          if (way.norm() <= sight && way.dot(normal) > 0.0 &&
            this->Body.Sees(this->AddedAt(node), place))
          {
            seen.push_back(node);
          }
        }
      }
    }
    return seen;
  }

  void JoinSurface()
  {
    for (int v = 0; v < this->Mesh.NumberOfVertices(); ++v)
    {
      if (!this->Mesh.IsUsed(v))
      {
        continue;
      }
      const std::vector<int> seen = this->SeenLatticePoints(v);
      for (const int node : seen)
      {
        const double distance = (this->AddedAt(node) - this->Rest.row(v).transpose()).norm();
        this->Edges.push_back({ v, node,
          4.0 * this->Areas[v] / (static_cast<double>(seen.size()) * distance * this->Spacing) });
      }
      if (seen.empty())
      {
        this->JoinAcross(v);
      }
    }
  }

  /// From a vertex straight inward to the corners of the triangle there, each with its
  /// barycentric coordinate.
  void JoinAcross(int v)
  {
    const Eigen::Vector3d inward = -this->Body.GetNormals().row(v).transpose();
    if (inward.isZero())
    {
      return;
    }
    // The triangles around the vertex are behind the start.
    const Eigen::Vector3d start = this->Rest.row(v).transpose() + 1e-6 * this->Spacing * inward;
    const RayHit hit = this->Body.FirstHit(start, inward);
    if (!this->Body.Leaves(hit, inward) || hit.Distance > ThinPart * this->Spacing)
    {
      return;
    }
    const Eigen::RowVector3i corners = this->Mesh.GetTriangles().row(hit.Triangle);
    const Eigen::Vector3d foot = start + hit.Distance * inward;
    const Eigen::Vector3d normal = this->Body.GetAreaVectors().row(hit.Triangle);
    for (int c = 0; c < 3; ++c)
    {
      const Eigen::Vector3d a = this->Rest.row(corners[(c + 1) % 3]).transpose() - foot;
      const Eigen::Vector3d b = this->Rest.row(corners[(c + 2) % 3]).transpose() - foot;
      const double share = std::abs(a.cross(b).dot(normal)) / normal.squaredNorm();
      const double distance = (this->Rest.row(corners[c]) - this->Rest.row(v)).norm();
      if (corners[c] != v && share > 0.0 && distance > 0.0)
      {
        this->Edges.push_back(
          { v, corners[c], 4.0 * share * this->Areas[v] / (distance * this->Spacing) });
      }
    }
  }

  /// Leaves out lattice points that no edges join to the surface.
  void DropLoose()
  {
    const int vertices = this->Mesh.NumberOfVertices();
    const int size = vertices + static_cast<int>(this->Added.size());
    std::vector<std::vector<int>> neighbors(size);
    for (const GraphEdge& edge : this->Edges)
    {
      neighbors[edge.From].push_back(edge.To);
      neighbors[edge.To].push_back(edge.From);
    }
    std::vector<int> seeds(vertices);
    std::iota(seeds.begin(), seeds.end(), 0);
    std::vector<int> names(size, -1);
    FloodFill(
      seeds, [&](int i) { return names[i] < 0 && (names[i] = 0, true); },
      [&](int i, const auto& reach)
      { std::for_each(neighbors[i].begin(), neighbors[i].end(), reach); });
    int count = 0;
    for (int i = 0; i < size; ++i)
    {
      names[i] = names[i] < 0 ? -1 : count++;
      if (i >= vertices && names[i] >= 0)
      {
        this->Added[names[i] - vertices] = this->Added[i - vertices];
      }
    }
    this->Added.resize(count - vertices);
    std::vector<GraphEdge> kept;
    for (const GraphEdge& edge : this->Edges)
    {
      if (names[edge.From] >= 0)
      {
        kept.push_back({ names[edge.From], names[edge.To], edge.Weight });
      }
    }
    this->Edges.swap(kept);
  }

  void AddOuterLayer()
  {
    std::vector<int> outer(this->Mesh.NumberOfVertices(), -1);
    std::vector<double> heights(outer.size(), 0.0);
    for (int v = 0; v < this->Mesh.NumberOfVertices(); ++v)
    {
      const Eigen::Vector3d normal = this->Body.GetNormals().row(v);
      if (!this->Mesh.IsUsed(v) || normal.isZero())
      {
        continue;
      }
      const Eigen::Vector3d place = this->Rest.row(v);
      const RayHit hit = this->Body.FirstHit(place + 1e-6 * this->Spacing * normal, normal);
      heights[v] = hit.Triangle < 0 ? this->Spacing : std::min(this->Spacing, 0.5 * hit.Distance);
      if (heights[v] < 1e-3 * this->Spacing)
      {
        continue;
      }
      outer[v] = this->Mesh.NumberOfVertices() + static_cast<int>(this->Added.size());
      this->Added.emplace_back(place + heights[v] * normal);
      this->Edges.push_back(
        { v, outer[v], OuterShare * 2.0 * this->Areas[v] / (heights[v] * this->Spacing) });
    }
    for (int d = 0; d < this->Mesh.NumberOfDirectedEdges(); ++d)
    {
      const int v = this->Mesh.Origin(d);
      const int w = this->Mesh.Neighbor(d);
      const double weight = OuterShare * std::max(0.0, this->EdgeWeights[d]) / this->Spacing;
      if (outer[v] < 0 || outer[w] < 0 || weight == 0.0)
      {
        continue;
      }
      this->Edges.push_back({ outer[v], w, weight * heights[v] });
      if (v < w)
      {
        this->Edges.push_back({ outer[v], outer[w], weight * (heights[v] + heights[w]) });
      }
    }
  }

  const TriangleMesh& Mesh;
  const Points& Rest;
  BodyRays Body;
  Eigen::VectorXd Areas;
  Eigen::AlignedBox3d Box;
  int UsedCount = 0;
  double Spacing = 0.0;
  Eigen::Vector3i Counts = Eigen::Vector3i::Zero();
  Eigen::Vector3d First = Eigen::Vector3d::Zero();
  std::vector<int> NodeOf; ///< of each cell of the box, or -1
  std::vector<Eigen::Vector3i> Cells;
  std::vector<Eigen::Vector3d> Added; ///< the nodes after the vertices
  Eigen::VectorXd EdgeWeights;        ///< #D
  std::vector<GraphEdge> Edges;
};
}

VolumeGraph MakeLatticeGraph(const TriangleMesh& mesh, const Points& points,
  const LatticeOptions& options, const ExecutionContext& context)
{
  return LatticeGraph(mesh, points, options, context).Take();
}
}
