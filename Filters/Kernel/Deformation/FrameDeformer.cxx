// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/FrameDeformer.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// Adds (s A - I) d. `transform` is a row of Matrices; numbers of their own stay in
/// registers, where Eigen's 3 x 3 matrices and vectors go through memory.
inline void AddTurned(const double* transform, double scale, const double* d, double* sum)
{
  for (int c = 0; c < 3; ++c)
  {
    sum[c] +=
      scale * (transform[c] * d[0] + transform[3 + c] * d[1] + transform[6 + c] * d[2]) - d[c];
  }
}
}

FrameDeformer::FrameDeformer(
  HandleProblem problem, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const auto symmetricWeights = [&](LaplacianWeights weights)
  {
    Eigen::VectorXd symmetric =
      SymmetricPart(mesh, cartan::EdgeWeights(mesh, *this->Problem.Rest, weights, context));
    if (this->Problem.ClampWeights)
    {
      symmetric = symmetric.cwiseMax(0.0).eval();
    }
    return std::make_shared<const Eigen::VectorXd>(std::move(symmetric));
  };
  const bool sameWeights = this->Problem.PositionWeights == this->Problem.Weights;
  const bool isShared = this->Problem.ConstrainPositions && sameWeights;
  const auto frameWeights = symmetricWeights(this->Problem.Weights);
  context.Report(0.1);
  this->FrameSystem = std::make_shared<HandleLaplacian>(this->Problem, frameWeights,
    Hold::AllHandles, backend, context.Part(0.1, isShared ? 1.0 : 0.5));
  this->EdgeWeights = sameWeights ? frameWeights : symmetricWeights(this->Problem.PositionWeights);
  this->PositionSystem = isShared
    ? this->FrameSystem
    : std::make_shared<HandleLaplacian>(this->Problem, this->EdgeWeights,
        this->Problem.ConstrainPositions ? Hold::AllHandles : Hold::PinnedOnly, backend,
        context.Part(0.5, 1.0));
  this->CountFreeVertices();
  const std::vector<int> moving = MovingHandleOfVertices(this->Problem);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (moving[v] >= 0 && mesh.IsUsed(v))
    {
      this->HandleVertices.push_back({ v, moving[v] });
    }
  }
}

/// Of pieces, those of all.
void FrameDeformer::CountFreeVertices()
{
  const HandleLaplacian& system = *this->FrameSystem;
  this->FreeVertices = system.NumberOfUnknowns();
  if (this->Problem.Pieces)
  {
    Eigen::VectorXd count = Eigen::VectorXd::Zero(1);
    for (int i = 0; i < system.NumberOfUnknowns(); ++i)
    {
      count[0] += this->Problem.Pieces->IsOwned(system.Vertex(i)) ? 1.0 : 0.0;
    }
    this->Problem.Pieces->Sum(count);
    this->FreeVertices = static_cast<int>(count[0]);
  }
}

int FrameDeformer::GetNumberOfFactorizations() const
{
  return this->FrameSystem->GetNumberOfFactorizations() +
    (this->PositionSystem == this->FrameSystem ? 0
                                               : this->PositionSystem->GetNumberOfFactorizations());
}

std::size_t FrameDeformer::GetBytes() const
{
  return this->GetBaseBytes() + this->FrameSystem->GetBytes() +
    (this->PositionSystem == this->FrameSystem ? 0 : this->PositionSystem->GetBytes()) +
    (this->Model ? this->Model->GetBytes() : 0) +
    TotalBytes(*this->EdgeWeights, this->JoinedOffsets, this->RestHeights, this->HandleVertices,
      this->Transforms, this->TriangleIds, this->TriangleTransforms, this->TriangleWeights) +
    (this->Table ? this->Table->GetBytes() : 0);
}

PositionRows FrameDeformer::RowsRelative(
  const HandleTargets& targets, const ExecutionContext& context)
{
  this->Warning.clear();
  PositionRows sums = this->TableSums(targets, context);
  this->UsesTable = static_cast<bool>(sums);
  if (!sums && !this->PreservesVolume())
  {
    sums = this->DirectSums(targets, context);
  }
  this->Rows = nullptr;
  if (sums)
  {
    this->Rows = [this, targets, sums = std::move(sums)](int begin, int end, double* rows)
    { this->WriteRows(targets, sums, begin, end, rows); };
  }
  return this->Rows;
}

/// Sums at unknown vertices, targets at those of handles, and the rest elsewhere.
void FrameDeformer::WriteRows(
  const HandleTargets& targets, const PositionRows& sums, int begin, int end, double* rows) const
{
  const HandleLaplacian& system = *this->PositionSystem;
  const int numberOfUnknowns = system.NumberOfUnknowns();
  int unknown = system.NumberOfUnknownsBefore(begin);
  auto held = std::lower_bound(this->HandleVertices.begin(), this->HandleVertices.end(), begin,
    [](const HandleVertex& handle, int vertex) { return handle.Vertex < vertex; });
  const auto row = [&](int v) { return rows + 3 * static_cast<std::size_t>(v - begin); };
  for (int v = begin; v < end;)
  {
    // Unknowns that are next to each other, then all vertices up to the next one.
    const int first = unknown;
    int next = v;
    while (unknown < numberOfUnknowns && system.Vertex(unknown) == next && next < end)
    {
      ++unknown;
      ++next;
    }
    sums(first, unknown, row(v));
    v = next;
    next = unknown < numberOfUnknowns ? std::min(system.Vertex(unknown), end) : end;
    std::copy(this->Problem.Rest->data() + 3 * static_cast<std::size_t>(v),
      this->Problem.Rest->data() + 3 * static_cast<std::size_t>(next), row(v));
    // Softly held vertices are unknowns.
    for (; held != this->HandleVertices.end() && held->Vertex < next; ++held)
    {
      if (held->Vertex >= v)
      {
        Eigen::Map<Eigen::Vector3d>(row(held->Vertex), 3) =
          HandleTarget(this->Problem, targets, held->Vertex, held->Handle);
      }
    }
    v = next;
  }
}

void FrameDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  const int numberOfVertices = this->Problem.Mesh->NumberOfVertices();
  // Not those of an earlier motion with another correction.
  result.FrameScale.setOnes(numberOfVertices);
  this->NeedsVertices = wantTransforms || this->TriangleIds.empty() || this->NeutralOffsets();
  const bool isDirect = static_cast<bool>(this->Rows);
  if (isDirect)
  {
    result.Positions.resize(numberOfVertices, 3);
    context.For(numberOfVertices,
      [&](int begin, int end)
      { this->Rows(begin, end, result.Positions.data() + 3 * static_cast<std::size_t>(begin)); });
  }
  else
  {
    result.Positions = *this->Problem.Rest;
    // Softly held and unheld vertices among these are overwritten by the solve.
    for (const HandleVertex& held : this->HandleVertices)
    {
      result.Positions.row(held.Vertex) =
        HandleTarget(this->Problem, targets, held.Vertex, held.Handle).transpose();
    }
  }
  if (!isDirect || wantTransforms)
  {
    if (this->Transforms.rows() == 0)
    {
      this->Transforms = Identities(this->Problem.Mesh->NumberOfVertices());
    }
    this->ComputeTransforms(targets, context.Part(0.3, 0.4));
    context.Report(0.4);
  }
  if (!isDirect)
  {
    this->SolvePositions(targets, this->Transforms, result, context.Part(0.4, 0.7));
    context.Report(0.7);
  }
  if (this->PreservesVolume())
  {
    if (this->Correction == VolumeCorrection::FrameScaling)
    {
      this->ScaleFrames(targets, result, context.Part(0.7, 1.0));
    }
    if (this->Close)
    {
      this->CloseVolumes(result.Positions);
    }
  }
  if (wantTransforms)
  {
    result.Transforms = this->Transforms;
  }
  context.Report(1.0);
}

/// Nothing unless they are asked for.
const Points* FrameDeformer::NeutralOffsets() const
{
  return this->PreservesVolume() && this->Correction == VolumeCorrection::NeutralOffset
    ? (this->JoinedOffsets.rows() > 0 ? &this->JoinedOffsets : &this->Model->Offsets)
    : nullptr;
}

/// sum over the triangles t of a vertex i and its edges in them of
/// c_t,ij (R_t - I) (p_i - p_j): #V x 3. A triangle's three sums add up to zero.
Points FrameDeformer::TriangleSums(
  const Eigen::VectorXd& frameScale, const ExecutionContext& context) const
{
  const Points& rest = *this->Problem.Rest;
  const cartan::Triangles& triangles = this->Problem.Mesh->GetTriangles();
  const int count = static_cast<int>(this->TriangleIds.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> parts(count, 6);
  context.For(count,
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const int t = this->TriangleIds[i];
        const auto weights = this->TriangleWeights.row(t);
        const Eigen::Vector3d a = rest.row(triangles(t, 0));
        const Eigen::Vector3d b = rest.row(triangles(t, 1));
        const Eigen::Vector3d c = rest.row(triangles(t, 2));
        const double scale = (frameScale[triangles(t, 0)] + frameScale[triangles(t, 1)] +
                               frameScale[triangles(t, 2)]) /
          3.0;
        const double* transform = this->TriangleTransforms.row(i).data();
        Eigen::Vector3d first = Eigen::Vector3d::Zero();
        Eigen::Vector3d second = Eigen::Vector3d::Zero();
        const Eigen::Vector3d atFirst = weights[2] * (a - b) + weights[1] * (a - c);
        const Eigen::Vector3d atSecond = weights[2] * (b - a) + weights[0] * (b - c);
        AddTurned(transform, scale, atFirst.data(), first.data());
        AddTurned(transform, scale, atSecond.data(), second.data());
        parts.row(i) << first.transpose(), second.transpose();
      }
    });
  // In one order, whatever the number of threads is.
  Points sums = Points::Zero(rest.rows(), 3);
  for (int i = 0; i < count; ++i)
  {
    const int t = this->TriangleIds[i];
    sums.row(triangles(t, 0)) += parts.row(i).head<3>();
    sums.row(triangles(t, 1)) += parts.row(i).tail<3>();
    sums.row(triangles(t, 2)) -= parts.row(i).head<3>() + parts.row(i).tail<3>();
  }
  return sums;
}

/// b_i, to which held neighbors and soft constraints add, without TriangleSums. The unknowns are
/// displacements from the rest, whose edges' part, - (p_i - p_j), is in b: where
/// nothing turns and nothing held moves, b and the displacements are exactly zero,
/// however small a part is beside the whole.
///
/// Neutral offset: the target of an edge, R_mean (p_j - p_i), is what its two
/// ends make of it when each carries the middle of the body under it rigidly,
///   (R_i + R_j)/2 (p_j - p_i) + (R_j - R_i) (o_i + o_j)/2,
/// with o from the middle to the skin: the skin stretches outside of a bend
/// and shrinks inside, and the middle keeps its length. With e = p_i - p_j and
/// o = o_i + o_j the edge adds w_ij/2 [(R_i - I)(e + o) + (R_j - I)(e - o)] to b_i,
/// so that one product for each edge and one for the vertex are enough.
Eigen::Vector3d FrameDeformer::RightHandSide(int unknown, const HandleTargets& targets,
  const Matrices& transforms, const DeformedSurface& result) const
{
  const HandleLaplacian& system = *this->PositionSystem;
  const Points& rest = *this->Problem.Rest;
  const int v = system.Vertex(unknown);
  const bool isByVertex = this->TriangleIds.empty();
  Eigen::Vector3d sum = !this->NeutralOffsets()
    ? (isByVertex ? this->EdgeSum<true, false>(unknown, transforms)
                  : Eigen::Vector3d(Eigen::Vector3d::Zero()))
    : (isByVertex ? this->EdgeSum<true, true>(unknown, transforms)
                  : this->EdgeSum<false, true>(unknown, transforms));
  for (const auto* edge = system.EdgesBegin(unknown); edge != system.EdgesEnd(unknown); ++edge)
  {
    if (edge->Neighbor >= system.NumberOfUnknowns())
    {
      const int w = system.Vertex(edge->Neighbor);
      sum += edge->Weight * (result.Positions.row(w) - rest.row(w)).transpose();
    }
  }
  if (system.SquaredSoftWeight(unknown) > 0.0)
  {
    const Eigen::Vector3d point = rest.row(v);
    sum += 0.5 * system.SquaredSoftWeight(unknown) *
      (HandleTarget(this->Problem, targets, v, system.MovingHandle(unknown)) - point);
  }
  return sum;
}

/// What the changed frames at a vertex and its neighbors add: e without IsByVertex, and o without
/// HasOffsets, is zero.
template <bool IsByVertex, bool HasOffsets>
Eigen::Vector3d FrameDeformer::EdgeSum(int unknown, const Matrices& transforms) const
{
  const HandleLaplacian& system = *this->PositionSystem;
  const double* rest = this->Problem.Rest->data();
  const double* offsets = HasOffsets ? this->NeutralOffsets()->data() : nullptr;
  const Eigen::Index v = system.Vertex(unknown);
  double sum[3] = {};
  double own[3] = {}; // the sum of w_ij/2 (e + o)
  for (const auto* edge = system.EdgesBegin(unknown); edge != system.EdgesEnd(unknown); ++edge)
  {
    const Eigen::Index w = system.Vertex(edge->Neighbor);
    const double half = 0.5 * edge->Weight;
    double ofNeighbor[3];
    for (int c = 0; c < 3; ++c)
    {
      const double e = IsByVertex ? rest[3 * v + c] - rest[3 * w + c] : 0.0;
      const double o = HasOffsets ? offsets[3 * v + c] + offsets[3 * w + c] : 0.0;
      own[c] += half * (e + o);
      ofNeighbor[c] = half * (e - o);
    }
    AddTurned(transforms.data() + 9 * w, 1.0, ofNeighbor, sum);
  }
  AddTurned(transforms.data() + 9 * v, 1.0, own, sum);
  return { sum[0], sum[1], sum[2] };
}

void FrameDeformer::SolvePositions(const HandleTargets& targets, const Matrices& transforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  const HandleLaplacian& system = *this->PositionSystem;
  if (!this->TriangleIds.empty() && this->TriangleWeights.rows() == 0)
  {
    this->TriangleWeights = CornerWeights(
      *this->Problem.Mesh, *this->Problem.Rest, this->Problem.PositionWeights, context);
  }
  const Points ofTriangles =
    this->TriangleIds.empty() ? Points() : this->TriangleSums(result.FrameScale, context);
  Eigen::MatrixXd rightHandSide(system.NumberOfUnknowns(), 3);
  context.For(system.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        rightHandSide.row(i) = this->RightHandSide(i, targets, transforms, result);
        if (ofTriangles.rows() > 0)
        {
          rightHandSide.row(i) += ofTriangles.row(system.Vertex(i));
        }
      }
    });
  const Eigen::Map<const Eigen::MatrixXd> solution = system.Solve(rightHandSide, context);
  for (int i = 0; i < system.NumberOfUnknowns(); ++i)
  {
    const int v = system.Vertex(i);
    result.Positions.row(v) = this->Problem.Rest->row(v) + solution.row(i);
  }
}
}
