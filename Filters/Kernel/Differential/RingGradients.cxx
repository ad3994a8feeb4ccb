// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/RingGradients.h"

#include "Mesh/GrowByRings.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>

namespace cartan
{
namespace
{
Eigen::Vector3d MeanOfNeighbors(const TriangleMesh& mesh, const Points& points, int v)
{
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    sum += points.row(mesh.Neighbor(d));
  }
  return sum.transpose() / mesh.Valence(v);
}

/// V_i V_i^T.
Eigen::Matrix3d RingMoments(const TriangleMesh& mesh, const Points& points, int v)
{
  const Eigen::Vector3d mean = MeanOfNeighbors(mesh, points, v);
  const Eigen::Vector3d own = points.row(v).transpose() - mean;
  Eigen::Matrix3d moments = own * own.transpose();
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const Eigen::Vector3d other = points.row(mesh.Neighbor(d)).transpose() - mean;
    moments += other * other.transpose();
  }
  return moments;
}

enum class RingShape
{
  Spatial,
  Flat,    ///< in a plane
  Singular ///< in a line or a point
};

RingShape ShapeOf(const Eigen::Matrix3d& moments)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d least = RingGradients::DegenerateCondition * solver.eigenvalues();
  const double largest = solver.eigenvalues()[2];
  return least[0] > largest ? RingShape::Spatial
    : least[1] > largest    ? RingShape::Flat
                            : RingShape::Singular;
}

/// The pseudo-inverse of the moments of a flat ring, whose normal is written.
Eigen::Matrix3d InverseInPlane(const Eigen::Matrix3d& moments, Eigen::Vector3d& normal)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments);
  normal = solver.eigenvectors().col(0);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int axis = 1; axis < 3; ++axis)
  {
    const Eigen::Vector3d direction = solver.eigenvectors().col(axis);
    inverse += direction * direction.transpose() / solver.eigenvalues()[axis];
  }
  return inverse;
}
}

RingGradients::RingGradients(const TriangleMesh& mesh, const Points& rest,
  const GradientConstraints& constraints, int coherenceRings, const ExecutionContext& context)
  : PositionColumns(mesh.NumberOfVertices(), -1)
  , RowOfVertex(mesh.NumberOfVertices(), -1)
{
  this->NumberPositions(mesh, constraints);
  context.Report(0.3);
  this->BuildRows(mesh, rest, constraints, context);
  context.Report(0.6);
  this->FindCoherentRows(mesh, constraints, coherenceRings);
  this->FindRestValues(rest);
  context.Report(1.0);
}

void RingGradients::NumberPositions(
  const TriangleMesh& mesh, const GradientConstraints& constraints)
{
  const auto addPosition = [this](int v)
  {
    if (this->PositionColumns[v] < 0)
    {
      this->PositionColumns[v] = static_cast<int>(this->Vertices.size());
      this->Vertices.push_back(v);
    }
  };
  std::vector<int> heldNeighbors;
  std::vector<char> isFound(mesh.NumberOfVertices(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!constraints.IsUnknown[v])
    {
      continue;
    }
    addPosition(v);
    this->Active.push_back(v);
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int neighbor = mesh.Neighbor(d);
      if (!constraints.IsUnknown[neighbor] && !isFound[neighbor])
      {
        isFound[neighbor] = 1;
        heldNeighbors.push_back(neighbor);
      }
    }
  }
  this->UnknownCount = static_cast<int>(this->Vertices.size());
  this->Active.insert(this->Active.end(), heldNeighbors.begin(), heldNeighbors.end());
  for (const int v : heldNeighbors)
  {
    addPosition(v);
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      addPosition(mesh.Neighbor(d));
    }
  }
}

void RingGradients::AddRow(int vertex, bool isGiven, const Row3& row)
{
  this->RowOfVertex[vertex] = this->Gradients.Count();
  this->VertexOfRow.push_back(vertex);
  this->IsGivenRow.push_back(isGiven);
  this->Gradients.Entries.insert(this->Gradients.Entries.end(), row.begin(), row.end());
  this->Gradients.FinishRow();
}

int RingGradients::AddGivenRow(int vertex)
{
  if (this->RowOfVertex[vertex] < 0)
  {
    const int column = this->NumberOfColumns();
    this->Givens.push_back(vertex);
    this->AddRow(vertex, true,
      { { column, Eigen::Vector3d::UnitX() }, { column + 1, Eigen::Vector3d::UnitY() },
        { column + 2, Eigen::Vector3d::UnitZ() } });
  }
  return this->RowOfVertex[vertex];
}

/// With u_k = v_k - v_0 and the sum over k of V~_i V_i^T written out, a
/// neighbor k has (V_i V_i^T)^-1 (u_k - u_i / |N|) and i itself
/// (V_i V_i^T)^-1 u_i, because the u_k of the neighbors sum to zero and the
/// deformed mean is moved by every neighbor.
RingGradients::Row3 RingGradients::RowOfRing(
  const TriangleMesh& mesh, const Points& rest, int v, Eigen::Vector3d& normal) const
{
  Row3 row;
  const Eigen::Matrix3d moments = RingMoments(mesh, rest, v);
  const RingShape shape = ShapeOf(moments);
  if (shape == RingShape::Singular || mesh.Valence(v) < 3)
  {
    return row;
  }
  const Eigen::Matrix3d inverse =
    shape == RingShape::Flat ? InverseInPlane(moments, normal) : Eigen::Matrix3d(moments.inverse());
  const Eigen::Vector3d mean = MeanOfNeighbors(mesh, rest, v);
  const Eigen::Vector3d own = inverse * (rest.row(v).transpose() - mean);
  row.push_back({ this->PositionColumns[v], own });
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const int w = mesh.Neighbor(d);
    row.push_back({ this->PositionColumns[w],
      inverse * (rest.row(w).transpose() - mean) - own / mesh.Valence(v) });
  }
  return row;
}

void RingGradients::BuildRows(const TriangleMesh& mesh, const Points& rest,
  const GradientConstraints& constraints, const ExecutionContext& context)
{
  std::vector<Row3> rows(this->Active.size());
  std::vector<Eigen::Vector3d> normals(this->Active.size(), Eigen::Vector3d::Zero());
  context.For(static_cast<int>(this->Active.size()),
    [&](int begin, int end)
    {
      for (int a = begin; a < end; ++a)
      {
        if (!constraints.IsGiven[this->Active[a]])
        {
          rows[a] = this->RowOfRing(mesh, rest, this->Active[a], normals[a]);
        }
      }
    });
  for (std::size_t a = 0; a < rows.size(); ++a)
  {
    if (!normals[a].isZero())
    {
      rows[a].push_back({ this->FirstGiven(), normals[a] });
      this->Normals.push_back(normals[a]);
    }
  }

  std::vector<int> borrowing;
  for (std::size_t a = 0; a < rows.size(); ++a)
  {
    const int v = this->Active[a];
    if (constraints.IsGiven[v])
    {
      this->AddGivenRow(v);
    }
    else if (!rows[a].empty())
    {
      this->AddRow(v, false, rows[a]);
    }
    else
    {
      borrowing.push_back(v);
    }
  }
  this->BorrowRows(mesh, constraints, std::move(borrowing));
}

RingGradients::Row3 RingGradients::MeanRow(const std::vector<int>& lenders) const
{
  Row3 sum;
  for (const int row : lenders)
  {
    for (const auto* entry = this->Gradients.Begin(row); entry != this->Gradients.End(row); ++entry)
    {
      sum.push_back({ entry->Column, entry->Coefficient / static_cast<double>(lenders.size()) });
    }
  }
  std::sort(
    sum.begin(), sum.end(), [](const auto& a, const auto& b) { return a.Column < b.Column; });
  Row3 merged;
  for (const auto& entry : sum)
  {
    if (!merged.empty() && merged.back().Column == entry.Column)
    {
      merged.back().Coefficient += entry.Coefficient;
    }
    else
    {
      merged.push_back(entry);
    }
  }
  return merged;
}

void RingGradients::BorrowRows(
  const TriangleMesh& mesh, const GradientConstraints& constraints, std::vector<int> borrowing)
{
  // In rounds, so that the mean is over neighbors that did not borrow in the
  // same round: the result must not depend on the order of the vertices.
  while (!borrowing.empty())
  {
    std::vector<std::pair<int, Row3>> borrowed;
    std::vector<int> left;
    for (const int v : borrowing)
    {
      std::vector<int> lenders;
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        const int w = mesh.Neighbor(d);
        if (constraints.IsGiven[w])
        {
          this->AddGivenRow(w);
        }
        if (this->RowOfVertex[w] >= 0)
        {
          lenders.push_back(this->RowOfVertex[w]);
        }
      }
      if (lenders.empty())
      {
        left.push_back(v);
        continue;
      }
      borrowed.emplace_back(v, this->MeanRow(lenders));
    }
    if (borrowed.empty())
    {
      IdSample lost;
      for (const int v : left)
      {
        lost.Add(v);
      }
      throw Error(ErrorCode::BadInput,
        "No deformation gradient is defined at " + lost.Describe("point", "points") +
          ": their triangles have no area or too few neighbors. Repair them, mark them as part "
          "of a handle, or hold the handles' transforms.");
    }
    for (const auto& [v, row] : borrowed)
    {
      this->AddRow(v, false, row);
    }
    borrowing = std::move(left);
  }
}

void RingGradients::FindRestValues(const Points& rest)
{
  this->ValuesAtRest.resize(this->NumberOfColumns(), 3);
  for (int column = 0; column < this->NumberOfPositions(); ++column)
  {
    this->ValuesAtRest.row(column) = rest.row(this->Vertices[column]);
  }
  for (int i = 0; i < this->NumberOfNormals(); ++i)
  {
    this->ValuesAtRest.row(this->NumberOfPositions() + i) = this->Normals[i].transpose();
  }
  for (int column = this->FirstGiven(); column < this->NumberOfColumns(); column += 3)
  {
    this->ValuesAtRest.middleRows<3>(column).setIdentity();
  }
}

void RingGradients::FindCoherentRows(
  const TriangleMesh& mesh, const GradientConstraints& constraints, int rings)
{
  RingGrowth growth(mesh);
  const int numberOfRows = this->Gradients.Count();
  this->Coherent.resize(numberOfRows);
  for (int row = 0; row < numberOfRows; ++row)
  {
    if (this->IsGivenRow[row])
    {
      continue;
    }
    const std::vector<int>& reached = growth.Grow({ this->VertexOfRow[row] }, rings);
    this->Coherent[row].reserve(reached.size() - 1);
    for (std::size_t i = 1; i < reached.size(); ++i)
    {
      const int w = reached[i];
      const int other = constraints.IsGiven[w] ? this->AddGivenRow(w) : this->RowOfVertex[w];
      if (other < 0)
      {
        continue;
      }
      this->Coherent[row].push_back(other);
      if (this->IsGivenRow[other])
      {
        this->Coherent.resize(this->Gradients.Count());
        this->Coherent[other].push_back(row);
      }
    }
  }
  this->Coherent.resize(this->Gradients.Count());
}
}
