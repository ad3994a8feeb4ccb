// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/RigidCells.h"

#include "Base/FloodFill.h"

#include <algorithm>
#include <utility>

namespace cartan
{
namespace
{
/// The unknown vertices (`unknown` is their number, #V, else -1), breadth first, so that a cell's
/// neighbors are near it in memory: an order of vertices without that makes a step half as fast.
std::vector<int> OrderUnknowns(
  const TriangleMesh& mesh, const HandleLaplacian& system, const std::vector<int>& unknown)
{
  std::vector<char> isNumbered(mesh.NumberOfVertices(), 0);
  std::vector<int> order;
  for (int i = 0; i < system.NumberOfUnknowns(); ++i)
  {
    const std::vector<int> part = FloodFill(
      { system.Vertex(i) },
      [&](int v) { return unknown[v] >= 0 && !std::exchange(isNumbered[v], 1); },
      [&mesh](int v, const auto& reach)
      {
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          reach(mesh.Neighbor(d));
        }
      });
    order.insert(order.end(), part.begin(), part.end());
  }
  return order;
}
}

RigidCells::RigidCells(const HandleProblem& problem, const HandleLaplacian& system,
  const Eigen::VectorXd& edgeWeights, const std::vector<int>& moving)
  : ActiveCount(system.NumberOfLocals())
{
  const TriangleMesh& mesh = *problem.Mesh;
  std::vector<int> unknown(mesh.NumberOfVertices(), -1);
  for (int i = 0; i < system.NumberOfUnknowns(); ++i)
  {
    unknown[system.Vertex(i)] = i;
  }
  std::vector<int> site(mesh.NumberOfVertices(), -1);
  const auto addSite = [&](int v)
  {
    if (site[v] < 0)
    {
      site[v] = this->NumberOfSites();
      this->Vertices.push_back(v);
    }
    return site[v];
  };
  this->CellOfUnknown.resize(system.NumberOfUnknowns());
  for (const int v : OrderUnknowns(mesh, system, unknown))
  {
    this->CellOfUnknown[unknown[v]] = addSite(v);
    this->Unknowns.push_back(unknown[v]);
  }
  for (int i = system.NumberOfUnknowns(); i < system.NumberOfLocals(); ++i)
  {
    addSite(system.Vertex(i));
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (moving[v] >= 0 && mesh.IsUsed(v))
    {
      addSite(v);
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        addSite(mesh.Neighbor(d));
      }
    }
  }
  this->Count = this->NumberOfSites();
  for (int cell = 0; cell < this->Count; ++cell)
  {
    const int v = this->Vertices[cell];
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      this->Spokes.push_back({ addSite(mesh.Neighbor(d)), edgeWeights[d] });
    }
    this->SpokeOffsets.push_back(static_cast<int>(this->Spokes.size()));
  }
}

std::vector<RigidCells::Rim> RigidCells::FindRims(const HandleProblem& problem) const
{
  const TriangleMesh& mesh = *problem.Mesh;
  const Points cornerWeights = CornerWeights(mesh, *problem.Rest, problem.PositionWeights);
  const auto weightOpposite = [&](int triangle, int v)
  {
    const auto corners = mesh.GetTriangles().row(triangle);
    return cornerWeights(triangle, corners[0] == v ? 0 : corners[1] == v ? 1 : 2);
  };
  // Sites of a ring's vertices are its cell's spokes: the left one is the next.
  std::vector<Rim> rims(this->Spokes.size(), { -1, -1, 0.0, 0.0 });
  for (int cell = 0; cell < this->Count; ++cell)
  {
    const int v = this->Vertices[cell];
    // From a directed edge of v to its spoke.
    const int toSpoke = this->SpokeOffsets[cell] - mesh.RingBegin(v);
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int next = mesh.NextAround(v, d);
      if (next >= 0)
      {
        Rim& rim = rims[d + toSpoke];
        rim.Left = this->Spokes[next + toSpoke].Neighbor;
        rim.LeftWeight = weightOpposite(mesh.LeftTriangle(d), mesh.Neighbor(next));
        rim.RimWeight = weightOpposite(mesh.LeftTriangle(d), v);
        rims[next + toSpoke].Right = this->Spokes[d + toSpoke].Neighbor;
      }
    }
  }
  return rims;
}

double RigidCells::EnergyOfVanishedEdges(const Points& rest) const
{
  double energy = 0.0;
  for (int cell = 0; cell < this->Count; ++cell)
  {
    for (int s = this->SpokeOffsets[cell]; s < this->SpokeOffsets[cell + 1]; ++s)
    {
      const Spoke& spoke = this->Spokes[s];
      energy += spoke.Weight * (rest.row(cell) - rest.row(spoke.Neighbor)).squaredNorm();
    }
  }
  return energy;
}
}
