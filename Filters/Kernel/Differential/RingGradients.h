// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SparseRows.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// What is known of each vertex before deformation gradients are set up: #V each.
struct GradientConstraints
{
  std::vector<char> IsUnknown; ///< its position is solved for
  std::vector<char> IsGiven;   ///< its gradient is not made from positions but given
};

/// The deformation gradients of Fu, Au, Tai, Effective Derivation of Similarity
/// Transformations for Implicit Laplacian Mesh Editing, 2007, sections 3.1 and
/// 3.3. With v_0 the mean of the neighbors of i, V_i = [v_k - v_0] and
/// V~_i = [v~_k - v~_0], k = i and its neighbors,
///
///   M_i = V~_i V_i^T (V_i V_i^T)^-1                                   (Eq. 4)
///
/// is linear in the deformed positions v~. Where V_i V_i^T is singular, because
/// i and its neighbors are in one plane of normal n_i, the positions say what
/// becomes of the plane alone, and the image q_i of the normal is an unknown of
/// its own:
///
///   M_i = V~_i V_i^T (V_i V_i^T)^+ + q_i n_i^T.
///
/// (Eq. 8 of the paper displaces such vertices along their normals, one after
/// the other, which leaves flat surfaces and breaks mirror symmetries.) Corners
/// with two neighbors and rings in a line take the mean of the neighbors'
/// gradients.
///
/// Gradients are rows over *columns*, numbered
///
///   - positions of unknown vertices, increasing,
///   - positions of held vertices that occur,
///   - the images q_i of the normals of flat rings,
///   - three for each vertex of given gradient W: its columns W e_1, W e_2, W e_3,
///
/// which all have three values (x, y, z), so that M_i = sum_c y_c m_ic^T with
/// y_c in R^3 the values of column c and m_ic in R^3 its coefficients.
class RingGradients
{
public:
  /// The condition number of V_i V_i^T, in space or in the plane, that makes a
  /// vertex degenerate (section 3.3).
  static constexpr double DegenerateCondition = 2.0e5;

  /// `rest` is #V x 3. Throws Error(BadInput) when a part of the surface is so
  /// degenerate that none of its vertices has a gradient.
  RingGradients(const TriangleMesh& mesh, const Points& rest,
    const GradientConstraints& constraints, int coherenceRings, const ExecutionContext& context);

  int NumberOfUnknowns() const { return this->UnknownCount; }
  int NumberOfPositions() const { return static_cast<int>(this->Vertices.size()); }
  int NumberOfColumns() const
  {
    return this->NumberOfPositions() + this->NumberOfNormals() +
      3 * static_cast<int>(this->Givens.size());
  }
  /// The vertices whose ring is flat.
  int NumberOfNormals() const { return static_cast<int>(this->Normals.size()); }
  /// The first column of given gradients.
  int FirstGiven() const { return this->NumberOfPositions() + this->NumberOfNormals(); }
  /// Whether a column is solved for.
  bool IsUnknownColumn(int column) const
  {
    return column < this->UnknownCount ||
      (column >= this->NumberOfPositions() && column < this->FirstGiven());
  }

  /// The values of the columns at rest: #columns x 3, positions, normals and
  /// unit vectors. All gradients of them are the identity.
  const Field& RestValues() const { return this->ValuesAtRest; }

  /// The mesh's vertex of a position's column, and the column of a vertex's
  /// position; -1 where it does not occur.
  int Vertex(int position) const { return this->Vertices[position]; }
  int PositionColumn(int vertex) const { return this->PositionColumns[vertex]; }
  /// The vertices of given gradient, in the order of their columns.
  const std::vector<int>& GivenVertices() const { return this->Givens; }

  /// The vertices whose one-ring has an unknown vertex: unknowns, in the order
  /// of their columns, then held neighbors.
  const std::vector<int>& ActiveVertices() const { return this->Active; }

  /// Whether the gradient of a vertex is made from positions (or borrowed from
  /// neighbors) and changes with the unknowns.
  bool IsVariable(int vertex) const
  {
    return this->RowOfVertex[vertex] >= 0 && !this->IsGivenRow[this->RowOfVertex[vertex]];
  }

  /// A row per vertex with a gradient, given ones too, and the row of a vertex;
  /// -1 where none is needed.
  const SparseRows<Eigen::Vector3d>& Rows() const { return this->Gradients; }
  int Row(int vertex) const { return this->RowOfVertex[vertex]; }

  /// For each row the rows within CoherenceRings edges, but for pairs of given
  /// gradients.
  const std::vector<std::vector<int>>& CoherentRows() const { return this->Coherent; }

  /// M of a row for the columns' values: #columns x 3.
  Eigen::Matrix3d Evaluate(int row, const Field& values) const
  {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (const auto* entry = this->Gradients.Begin(row); entry != this->Gradients.End(row); ++entry)
    {
      gradient += Eigen::Map<const Eigen::Vector3d>(values.row(entry->Column).data()) *
        entry->Coefficient.transpose();
    }
    return gradient;
  }

  std::size_t GetBytes() const
  {
    return TotalBytes(this->ValuesAtRest, this->Vertices, this->PositionColumns, this->Normals,
      this->Givens, this->Active, this->RowOfVertex, this->VertexOfRow, this->IsGivenRow,
      this->Gradients, this->Coherent);
  }

private:
  using Row3 = std::vector<SparseRows<Eigen::Vector3d>::Entry>;

  void NumberPositions(const TriangleMesh& mesh, const GradientConstraints& constraints);
  void BuildRows(const TriangleMesh& mesh, const Points& rest,
    const GradientConstraints& constraints, const ExecutionContext& context);
  /// Empty where the positions of the ring make no gradient; `normal` is written
  /// where the ring is flat.
  Row3 RowOfRing(
    const TriangleMesh& mesh, const Points& rest, int v, Eigen::Vector3d& normal) const;
  void BorrowRows(
    const TriangleMesh& mesh, const GradientConstraints& constraints, std::vector<int> borrowing);
  Row3 MeanRow(const std::vector<int>& lenders) const;
  void FindRestValues(const Points& rest);
  void FindCoherentRows(
    const TriangleMesh& mesh, const GradientConstraints& constraints, int rings);
  int AddGivenRow(int vertex);
  void AddRow(int vertex, bool isGiven, const Row3& row);

  Field ValuesAtRest;
  int UnknownCount = 0;
  std::vector<int> Vertices;
  std::vector<int> PositionColumns; // #V
  std::vector<Eigen::Vector3d> Normals;
  std::vector<int> Givens;
  std::vector<int> Active;
  std::vector<int> RowOfVertex; // #V
  std::vector<int> VertexOfRow;
  std::vector<char> IsGivenRow;
  SparseRows<Eigen::Vector3d> Gradients;
  std::vector<std::vector<int>> Coherent;
};
}
