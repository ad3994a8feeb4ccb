// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Deformation/HandleProblem.h"
#include "Differential/PieceSystem.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace cartan
{
enum class Hold
{
  AllHandles, ///< every handle is held
  PinnedOnly  ///< moving handles are unknown, only pinned ones are held
};

/// From where on Automatic solves systems of a HandleLaplacian by conjugate gradients.
FactorLimits LaplacianLimits();

/// Which vertices are unknown when handles are held: those not held that a
/// moving handle reaches through vertices not held. Softly held ones are
/// unknown. #V.
std::vector<char> UnknownVertices(const HandleProblem& problem, Hold hold);

/// w^2 where an unknown vertex is held softly, else 0: #V.
Eigen::VectorXd SquaredSoftWeights(
  const HandleProblem& problem, const std::vector<char>& isUnknown, Hold hold);

/// Throws Error(SingularSystem) where rounding leaves nothing of soft anchors, because
/// all that hold a part have weights near 0: then a common translation, which every
/// such system follows, does not come out. Unknowns without a vertex (-1 in
/// Anchors::Vertices) are 0 in it.
void RequireTranslations(const AnchoredSystem& system, const Anchors& anchors);

/// The same for any system, of which `interpolate` finds the values between the anchors';
/// `pieces` may be nothing.
void RequireTranslations(const std::function<void(Field&)>& interpolate, const Anchors& anchors,
  const DistributedRows* pieces);

/// Index of each vertex's handle in HandleProblem::Moving, -1 for pinned and
/// free vertices: #V.
std::vector<int> MovingHandleOfVertices(const HandleProblem& problem);

/// Whether methods keep a field per handle: whether the problem has no more
/// handles than HandleProblem::StoredHandles, moving or pinned. So pinning a handle
/// does not change the way that a result is found.
bool StoresHandleFields(const HandleProblem& problem);

/// Where a handle's vertex is to go; handle -1 is pinned.
Eigen::Vector3d HandleTarget(
  const HandleProblem& problem, const HandleTargets& targets, int vertex, int handle);

/// The linear map that such a vertex is to go through; the identity for -1.
Eigen::Matrix3d HandleTransform(const HandleTargets& targets, int vertex, int handle);

/// The rest positions with all vertices of moving handles where they are to go,
/// also those that are held softly or not at all: #V x 3. `moving` is
/// MovingHandleOfVertices.
Points HandlePositions(
  const HandleProblem& problem, const HandleTargets& targets, const std::vector<int>& moving);

/// The Laplacian system on the free vertices that moving handles can reach, the
/// held ones eliminated. It is factorized once and serves everything that is
/// harmonic or nearly so: frames, angles and positions.
///
/// Its *local* numbering has the unknown vertices first, then the held vertices
/// next to them. Free vertices that no moving handle reaches through free
/// vertices are not in it and cost nothing.
///
/// Where the mesh is a piece, the unknowns are those of the piece, ghosts too, all functions
/// that solve are collective, and what they return is right at ghosts. Right-hand sides
/// need be right at owned vertices only.
class HandleLaplacian
{
public:
  /// `edgeWeights` (#D) must be symmetric. Throws Error(SingularSystem) when an
  /// unknown vertex reaches no held one.
  HandleLaplacian(const HandleProblem& problem,
    const std::shared_ptr<const Eigen::VectorXd>& edgeWeights, Hold hold, SolverBackend backend,
    const ExecutionContext& context);

  int NumberOfUnknowns() const { return this->UnknownCount; }
  int NumberOfLocals() const { return static_cast<int>(this->Vertices.size()); }

  /// The mesh's vertex of a local one, and the index of its handle in
  /// HandleProblem::Moving; -1 for pinned and free vertices.
  int Vertex(int local) const { return this->Vertices[local]; }

  /// The number of unknowns, which are in the order of their vertices, before a vertex.
  int NumberOfUnknownsBefore(int vertex) const
  {
    const auto end = this->Vertices.begin() + this->UnknownCount;
    return static_cast<int>(
      std::lower_bound(this->Vertices.begin(), end, vertex) - this->Vertices.begin());
  }
  int MovingHandle(int local) const { return this->MovingHandles[local]; }

  /// What holds the locals: the unknowns softly with w^2 / 2, because L stands for
  /// both directions of each edge, all others hard.
  Anchors GetAnchors() const;

  /// w^2 of a softly held unknown, 0 elsewhere.
  double SquaredSoftWeight(int local) const { return this->SquaredSoftWeights[local]; }

  /// The part of the one-ring of an unknown local vertex: its edges to local
  /// vertices, which are all.
  struct Edge
  {
    int Neighbor; ///< local
    double Weight;
  };
  const Edge* EdgesBegin(int unknown) const
  {
    return this->Edges.data() + this->EdgeOffsets[unknown];
  }
  const Edge* EdgesEnd(int unknown) const
  {
    return this->Edges.data() + this->EdgeOffsets[unknown + 1];
  }

  /// A triangle with an unknown corner: its corners in local vertices, and what
  /// it adds to the weight of the edge opposite to each (CornerWeights).
  struct Triangle
  {
    Eigen::Vector3i Corners;
    Eigen::Vector3d Weights;
    int Id; ///< the mesh's triangle
  };

  /// All triangles around the unknowns, with HandleProblem::Weights.
  std::vector<Triangle> Triangles(const HandleProblem& problem) const;

  /// The functions that are 1 on one handle of HandleProblem::Moving and 0 on
  /// all others and the pinned ones, harmonic elsewhere: #locals x #Moving.
  Field HarmonicFields(const ExecutionContext& context = {}) const;

  /// The functions, harmonic at unknown vertices, with the given values where
  /// moving handles hold and zero where pinned ones do: #locals x components.
  /// `target` writes the values of a local vertex.
  Field Spread(int components, const std::function<void(int local, double* values)>& target,
    const ExecutionContext& context = {}) const;

  /// Solves L x = b: `rightHandSide` has a row per unknown and already contains
  /// what held neighbors and soft targets add. Returns #unknowns x k, valid until
  /// the next solve.
  Eigen::Map<const Eigen::MatrixXd> Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context = {}) const
  {
    return this->OnPieces ? this->OnPieces->Solve(rightHandSide, context)
                          : this->System.SolveFree(rightHandSide, context);
  }

  /// The surface of which the mesh is a piece; nothing where it is the whole.
  const DistributedRows* GetPieces() const { return this->Pieces.get(); }

  /// The largest value that a rank has, entry by entry; collective where there are pieces.
  void MaximumOverPieces(Eigen::Ref<Eigen::VectorXd> values) const
  {
    if (this->Pieces)
    {
      this->Pieces->Max(values);
    }
  }

  int NumberOfMovingHandles() const { return this->MovingCount; }

  int GetNumberOfFactorizations() const
  {
    return this->OnPieces ? 1 : this->System.GetNumberOfFactorizations();
  }
  SolverBackend GetBackend() const
  {
    return this->OnPieces ? SolverBackend::ConjugateGradients : this->System.GetBackend();
  }

  /// See SymmetricSolver; on pieces alone.
  int GetNumberOfSteps() const { return this->OnPieces ? this->OnPieces->GetNumberOfSteps() : 0; }

  std::size_t GetBytes() const
  {
    return this->System.GetBytes() + (this->OnPieces ? this->OnPieces->GetBytes() : 0) +
      TotalBytes(this->Vertices, this->MovingHandles, this->SquaredSoftWeights, this->EdgeOffsets,
        this->Edges);
  }

private:
  void FactorizeOnPieces(
    const HandleProblem& problem, const Eigen::VectorXd& edgeWeights, const Anchors& anchors);
  void RequireHeld(const HandleProblem& problem, const Eigen::VectorXd& edgeWeights,
    const std::vector<int>& unknowns) const;
  void Interpolate(Field& values, const ExecutionContext& context) const;

  std::vector<int> Vertices;
  std::vector<int> MovingHandles;
  std::vector<double> SquaredSoftWeights;
  int UnknownCount = 0;
  int MovingCount = 0;
  std::vector<int> EdgeOffsets;
  std::vector<Edge> Edges;
  AnchoredSystem System;
  /// In its place where the mesh is a piece.
  std::unique_ptr<PieceSystem> OnPieces;
  std::shared_ptr<const DistributedRows> Pieces;
};
}
