// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleLaplacian.h"

#include <vector>

namespace cartan
{
/// The vertices whose rotations are part of AsRigidAsPossibleDeformer's energy,
/// each with the edges to its neighbors: its *cell*.
///
/// Vertices have numbers as *sites*. The unknowns of the system come first; then
/// the held vertices next to them, which are the last cells whose rotation is
/// fitted in each step; then the other cells, those of moving handles and next to
/// them; then the neighbors of cells, which stay at rest.
struct RigidCells
{
  /// An edge of a cell from its center.
  struct Spoke
  {
    int Neighbor; ///< site
    double Weight;
  };
  /// The triangles beside a spoke.
  struct Rim
  {
    int Left; ///< the site opposite to the spoke in the triangle on its left; -1: none
    int Right;
    double LeftWeight; ///< the left triangle's part of the spoke's weight
    double RimWeight;  ///< and of the edge from Neighbor to Left
  };

  RigidCells() = default;

  /// `edgeWeights` (#D) are symmetric, `moving` is MovingHandleOfVertices.
  RigidCells(const HandleProblem& problem, const HandleLaplacian& system,
    const Eigen::VectorXd& edgeWeights, const std::vector<int>& moving);

  int NumberOfSites() const { return static_cast<int>(this->Vertices.size()); }

  /// The triangles beside each spoke, weighted by HandleProblem::PositionWeights.
  std::vector<Rim> FindRims(const HandleProblem& problem) const;

  /// sum_i sum_j w_ij |p_i - p_j|^2 over the spokes, with `rest` #sites x 3.
  double EnergyOfVanishedEdges(const Points& rest) const;

  std::size_t GetBytes() const
  {
    return TotalBytes(
      this->Vertices, this->Unknowns, this->CellOfUnknown, this->SpokeOffsets, this->Spokes);
  }

  int ActiveCount = 0;                   ///< unknowns and the held vertices next to them
  int Count = 0;                         ///< of cells
  std::vector<int> Vertices;             ///< #sites
  std::vector<int> Unknowns;             ///< #unknowns, the system's number of a cell
  std::vector<int> CellOfUnknown;        ///< #unknowns, the inverse
  std::vector<int> SpokeOffsets = { 0 }; ///< #cells + 1
  std::vector<Spoke> Spokes;
};
}
