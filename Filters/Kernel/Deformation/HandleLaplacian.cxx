// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/HandleLaplacian.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

namespace cartan
{
namespace
{
/// The soft weight of a held vertex; infinity without soft weights.
double HoldWeight(const HandleProblem& problem, int vertex)
{
  return problem.SoftWeights.size() ? problem.SoftWeights[vertex]
                                    : std::numeric_limits<double>::infinity();
}

/// Marks the unknown vertices that a moving handle reaches through unknown ones.
std::vector<char> ReachedUnknowns(
  const HandleProblem& problem, const std::vector<char>& isHeld, const std::vector<int>& moving)
{
  const TriangleMesh& mesh = *problem.Mesh;
  std::vector<char> seeds(isHeld.size(), 0);
  std::vector<char> mayEnter(isHeld.size(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    mayEnter[v] = !isHeld[v];
    if (moving[v] < 0 || !mesh.IsUsed(v))
    {
      continue;
    }
    seeds[v] = 1;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      seeds[mesh.Neighbor(d)] = 1;
    }
  }
  return FloodPieces(mesh, problem.Pieces.get(), seeds, mayEnter);
}

std::vector<char> HeldVertices(
  const HandleProblem& problem, Hold hold, const std::vector<int>& moving)
{
  std::vector<char> isHeld(problem.Handle.size(), 0);
  for (std::size_t v = 0; v < isHeld.size(); ++v)
  {
    isHeld[v] = problem.Handle[v] > 0 && std::isinf(HoldWeight(problem, static_cast<int>(v))) &&
      (hold == Hold::AllHandles || moving[v] < 0);
  }
  return isHeld;
}
}

std::vector<int> MovingHandleOfVertices(const HandleProblem& problem)
{
  std::vector<int> moving(problem.Handle.size(), -1);
  for (std::size_t v = 0; v < moving.size(); ++v)
  {
    const auto found =
      std::lower_bound(problem.Moving.begin(), problem.Moving.end(), problem.Handle[v]);
    if (problem.Handle[v] > 0 && found != problem.Moving.end() && *found == problem.Handle[v])
    {
      moving[v] = static_cast<int>(found - problem.Moving.begin());
    }
  }
  return moving;
}

std::vector<char> UnknownVertices(const HandleProblem& problem, Hold hold)
{
  const std::vector<int> moving = MovingHandleOfVertices(problem);
  return ReachedUnknowns(problem, HeldVertices(problem, hold, moving), moving);
}

Eigen::VectorXd SquaredSoftWeights(
  const HandleProblem& problem, const std::vector<char>& isUnknown, Hold hold)
{
  const std::vector<int> moving = MovingHandleOfVertices(problem);
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(isUnknown.size()));
  for (std::size_t v = 0; v < isUnknown.size(); ++v)
  {
    const double weight = HoldWeight(problem, static_cast<int>(v));
    if (isUnknown[v] && problem.Handle[v] > 0 && std::isfinite(weight) &&
      (hold == Hold::AllHandles || moving[v] < 0))
    {
      squared[static_cast<Eigen::Index>(v)] = weight * weight;
    }
  }
  return squared;
}

FactorLimits LaplacianLimits()
{
  FactorLimits limits;
  // Here a factorization takes as long as conjugate gradients take to begin, and 1.1 KB
  // per unknown, three times as much and growing. Below, each of its solves, a tenth as
  // long, makes up for that.
  limits.DirectUnknowns = 4000000;
  return limits;
}

void RequireTranslations(const AnchoredSystem& system, const Anchors& anchors)
{
  RequireTranslations([&system](Field& values) { system.Interpolate(values); }, anchors, nullptr);
}

void RequireTranslations(const std::function<void(Field&)>& interpolate, const Anchors& anchors,
  const DistributedRows* pieces)
{
  Eigen::VectorXd stiffest = Eigen::VectorXd::Zero(1);
  if (anchors.Stiffness.size() > 0)
  {
    stiffest[0] = anchors.Stiffness.maxCoeff();
  }
  if (pieces)
  {
    pieces->Max(stiffest);
  }
  if (stiffest[0] == 0.0)
  {
    return;
  }
  Field translation = Field::Ones(static_cast<Eigen::Index>(anchors.Vertices.size()), 1);
  for (std::size_t i = 0; i < anchors.Vertices.size(); ++i)
  {
    translation(static_cast<Eigen::Index>(i), 0) = anchors.Vertices[i] < 0 ? 0.0 : 1.0;
  }
  interpolate(translation);
  IdSample lost;
  for (std::size_t i = 0; i < anchors.Vertices.size(); ++i)
  {
    const int v = anchors.Vertices[i];
    // Of the way of the handles: less is not seen.
    const double error = std::abs(translation(static_cast<Eigen::Index>(i), 0) - 1.0);
    if (v >= 0 && !(error < 1e-4) && (!pieces || pieces->IsOwned(v)))
    {
      lost.Add(pieces ? pieces->GetName(v) : v);
    }
  }
  if (!lost.IsEmpty())
  {
    throw Error(ErrorCode::SingularSystem,
      "The system is singular up to rounding: " + lost.Describe("point", "points") +
        " in parts that next to nothing holds. Raise constraint weights near 0.");
  }
}

bool StoresHandleFields(const HandleProblem& problem)
{
  std::set<std::int64_t> handles(problem.Handle.begin(), problem.Handle.end());
  if (problem.Pieces)
  {
    const std::vector<std::int64_t> all =
      problem.Pieces->Gather(std::vector<std::int64_t>(handles.begin(), handles.end()));
    handles.insert(all.begin(), all.end());
  }
  return static_cast<int>(handles.size() - handles.count(0)) <= problem.StoredHandles;
}

Eigen::Vector3d HandleTarget(
  const HandleProblem& problem, const HandleTargets& targets, int vertex, int handle)
{
  const Eigen::Vector3d rest = problem.Rest->row(vertex);
  if (handle < 0)
  {
    return rest;
  }
  if (targets.Positions.rows())
  {
    return targets.Positions.row(targets.Row(vertex));
  }
  return targets.Motions[handle].Linear * rest + targets.Motions[handle].Translation;
}

Eigen::Matrix3d HandleTransform(const HandleTargets& targets, int vertex, int handle)
{
  if (handle < 0)
  {
    return Eigen::Matrix3d::Identity();
  }
  return targets.Transforms.rows()
    ? Eigen::Matrix3d(MatrixAt(targets.Transforms, targets.Row(vertex)))
    : targets.Motions[handle].Linear;
}

Points HandlePositions(
  const HandleProblem& problem, const HandleTargets& targets, const std::vector<int>& moving)
{
  Points positions = *problem.Rest;
  for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
  {
    if (moving[v] >= 0 && problem.Mesh->IsUsed(v))
    {
      positions.row(v) = HandleTarget(problem, targets, v, moving[v]).transpose();
    }
  }
  return positions;
}

HandleLaplacian::HandleLaplacian(const HandleProblem& problem,
  const std::shared_ptr<const Eigen::VectorXd>& edgeWeights, Hold hold, SolverBackend backend,
  const ExecutionContext& context)
  : MovingCount(static_cast<int>(problem.Moving.size()))
  , System(backend, LaplacianLimits())
{
  const TriangleMesh& mesh = *problem.Mesh;
  const int numberOfVertices = mesh.NumberOfVertices();
  const std::vector<int> moving = MovingHandleOfVertices(problem);

  const std::vector<char> isUnknown = UnknownVertices(problem, hold);
  const Eigen::VectorXd soft = cartan::SquaredSoftWeights(problem, isUnknown, hold);

  std::vector<int> local(numberOfVertices, -1);
  const auto addLocal = [&](int v)
  {
    if (local[v] < 0)
    {
      local[v] = this->NumberOfLocals();
      this->Vertices.push_back(v);
      this->MovingHandles.push_back(moving[v]);
      this->SquaredSoftWeights.push_back(soft[v]);
    }
    return local[v];
  };
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (isUnknown[v])
    {
      addLocal(v);
    }
  }
  this->UnknownCount = this->NumberOfLocals();
  this->EdgeOffsets.reserve(this->UnknownCount + 1);
  this->EdgeOffsets.push_back(0);
  for (int i = 0; i < this->UnknownCount; ++i)
  {
    const int v = this->Vertices[i];
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      this->Edges.push_back({ addLocal(mesh.Neighbor(d)), (*edgeWeights)[d] });
    }
    this->EdgeOffsets.push_back(static_cast<int>(this->Edges.size()));
  }
  context.Report(0.1);

  const Anchors anchors = this->GetAnchors();
  if (problem.Pieces)
  {
    this->FactorizeOnPieces(problem, *edgeWeights, anchors);
    return;
  }
  this->System.Factorize(
    Laplacian(mesh, *edgeWeights, this->Vertices), anchors, context.Part(0.1, 1.0));
  RequireTranslations(this->System, anchors);
}

/// The system of the unknowns alone; Interpolate() adds what held neighbors give.
void HandleLaplacian::FactorizeOnPieces(
  const HandleProblem& problem, const Eigen::VectorXd& edgeWeights, const Anchors& anchors)
{
  const DistributedRows& pieces = *problem.Pieces;
  const std::vector<int> unknowns(
    this->Vertices.begin(), this->Vertices.begin() + this->UnknownCount);
  this->RequireHeld(problem, edgeWeights, unknowns);
  SparseMatrix lower =
    Laplacian(*problem.Mesh, edgeWeights, unknowns).triangularView<Eigen::Lower>();
  for (int i = 0; i < this->UnknownCount; ++i)
  {
    if (this->SquaredSoftWeights[i] > 0.0)
    {
      lower.coeffRef(i, i) += 0.5 * this->SquaredSoftWeights[i];
    }
  }
  this->Pieces = problem.Pieces;
  this->OnPieces = std::make_unique<PieceSystem>(problem.Pieces, unknowns, lower);
  RequireTranslations([this](Field& values) { this->Interpolate(values, {}); }, anchors, &pieces);
}

/// Throws Error(SingularSystem) for unknowns that reach nothing held over edges of some weight.
void HandleLaplacian::RequireHeld(const HandleProblem& problem, const Eigen::VectorXd& edgeWeights,
  const std::vector<int>& unknowns) const
{
  std::vector<char> isUnknown(problem.Handle.size(), 0);
  std::vector<char> isHeld(problem.Handle.size(), 0);
  for (int i = 0; i < this->UnknownCount; ++i)
  {
    isUnknown[unknowns[i]] = 1;
    isHeld[unknowns[i]] = this->SquaredSoftWeights[i] > 0.0;
    for (const Edge* edge = this->EdgesBegin(i); edge != this->EdgesEnd(i); ++edge)
    {
      isHeld[unknowns[i]] |= edge->Neighbor >= this->UnknownCount && edge->Weight != 0.0;
    }
  }
  const std::vector<char> isReached = FloodPieces(*problem.Mesh, problem.Pieces.get(), isHeld,
    isUnknown, [&edgeWeights](int edge) { return edgeWeights[edge] != 0.0; });
  IdSample loose;
  for (const int v : unknowns)
  {
    if (!isReached[v] && problem.Pieces->IsOwned(v))
    {
      loose.Add(problem.Pieces->GetName(v));
    }
  }
  if (!loose.IsEmpty())
  {
    throw Error(ErrorCode::SingularSystem,
      "The system is singular: " + loose.Describe("point", "points") +
        " in connected parts have no constraint. In each part, fix at least one point.");
  }
}

void HandleLaplacian::Interpolate(Field& values, const ExecutionContext& context) const
{
  if (!this->OnPieces)
  {
    this->System.Interpolate(values, context);
    return;
  }
  Eigen::MatrixXd rightHandSide = Eigen::MatrixXd::Zero(this->UnknownCount, values.cols());
  for (int i = 0; i < this->UnknownCount; ++i)
  {
    rightHandSide.row(i) = 0.5 * this->SquaredSoftWeights[i] * values.row(i);
    for (const Edge* edge = this->EdgesBegin(i); edge != this->EdgesEnd(i); ++edge)
    {
      if (edge->Neighbor >= this->UnknownCount)
      {
        rightHandSide.row(i) += edge->Weight * values.row(edge->Neighbor);
      }
    }
  }
  values.topRows(this->UnknownCount) = this->OnPieces->Solve(rightHandSide, context);
}

Anchors HandleLaplacian::GetAnchors() const
{
  Anchors anchors = Anchors::After(this->UnknownCount, this->NumberOfLocals());
  anchors.Vertices = this->Vertices;
  const Eigen::Map<const Eigen::VectorXd> soft(
    this->SquaredSoftWeights.data(), static_cast<Eigen::Index>(this->SquaredSoftWeights.size()));
  if (!soft.isZero(0.0))
  {
    anchors.Stiffness = 0.5 * soft;
  }
  return anchors;
}

std::vector<HandleLaplacian::Triangle> HandleLaplacian::Triangles(
  const HandleProblem& problem) const
{
  const TriangleMesh& mesh = *problem.Mesh;
  const Points cornerWeights = CornerWeights(mesh, *problem.Rest, problem.Weights);
  std::vector<int> local(mesh.NumberOfVertices(), -1);
  for (int i = 0; i < this->NumberOfLocals(); ++i)
  {
    local[this->Vertices[i]] = i;
  }
  std::vector<Triangle> triangles;
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::Vector3i corners(local[mesh.GetTriangles()(t, 0)],
      local[mesh.GetTriangles()(t, 1)], local[mesh.GetTriangles()(t, 2)]);
    if (corners.minCoeff() >= 0 && corners.minCoeff() < this->UnknownCount)
    {
      triangles.push_back({ corners, cornerWeights.row(t).transpose(), t });
    }
  }
  return triangles;
}

Field HandleLaplacian::HarmonicFields(const ExecutionContext& context) const
{
  Field fields = Field::Zero(this->NumberOfLocals(), this->MovingCount);
  for (int i = 0; i < this->NumberOfLocals(); ++i)
  {
    if (this->MovingHandles[i] >= 0)
    {
      fields(i, this->MovingHandles[i]) = 1.0;
    }
  }
  this->Interpolate(fields, context);
  return fields;
}

Field HandleLaplacian::Spread(int components,
  const std::function<void(int local, double* values)>& target,
  const ExecutionContext& context) const
{
  Field fields = Field::Zero(this->NumberOfLocals(), components);
  for (int i = 0; i < this->NumberOfLocals(); ++i)
  {
    const bool isHeld = i >= this->UnknownCount || this->SquaredSoftWeights[i] > 0.0;
    if (this->MovingHandles[i] >= 0 && isHeld)
    {
      target(i, fields.row(i).data());
    }
  }
  this->Interpolate(fields, context);
  return fields;
}
}
