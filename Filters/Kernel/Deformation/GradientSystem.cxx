// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/GradientSystem.h"

#include "Base/FloodFill.h"
#include "Base/FreedMemory.h"
#include "Deformation/HeldPoints.h"
#include "Differential/Laplacian.h"
#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cartan
{
namespace
{
/// (h sum_j |w_ij|)^2 / m of a regular ring of cotangent weights, 12 h^2 over
/// sqrt(3) / 2 h^2: with it the rows of regular meshes have the same scale with
/// all weights.
constexpr double RegularMassFactor = 13.856406460551018;

/// A connected part of the unknown vertices, with what its gradients see of the handles.
struct UnknownPart
{
  std::vector<int> Vertices;
  std::vector<int> Held; ///< whose positions are given
  bool IsTransformHeld = false;
};

UnknownPart GatherPart(const TriangleMesh& mesh, const GradientConstraints& constraints,
  const Eigen::VectorXd& softPositions, int seed, std::vector<char>& isVisited)
{
  UnknownPart part;
  const auto seeHeld = [&](int v)
  {
    part.Held.push_back(v);
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      if (!constraints.IsUnknown[mesh.Neighbor(d)])
      {
        part.Held.push_back(mesh.Neighbor(d));
      }
    }
  };
  part.Vertices = FloodFill(
    { seed },
    [&](int v)
    {
      part.IsTransformHeld = part.IsTransformHeld || constraints.IsGiven[v];
      if (!constraints.IsUnknown[v])
      {
        seeHeld(v);
      }
      return constraints.IsUnknown[v] && !std::exchange(isVisited[v], 1);
    },
    [&](int v, const auto& reach)
    {
      if (softPositions[v] > 0.0)
      {
        part.Held.push_back(v);
      }
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        reach(mesh.Neighbor(d));
      }
    });
  return part;
}

/// A third of the area of the triangles around each vertex: #V. A triangle
/// without area counts as EdgeWeights counts it, equilateral.
Eigen::VectorXd VertexMasses(const TriangleMesh& mesh, const Points& rest)
{
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto corners = mesh.GetTriangles().row(t);
    const Eigen::Vector3d a = rest.row(corners[0]);
    const Eigen::Vector3d b = rest.row(corners[1]);
    const Eigen::Vector3d c = rest.row(corners[2]);
    const double longest = LongestEdgeSquared(a, b, c);
    const double twiceArea = (b - a).cross(c - a).norm();
    const double area =
      HasArea(twiceArea, longest) ? 0.5 * twiceArea : std::sqrt(3.0) / 4.0 * longest;
    for (int k = 0; k < 3; ++k)
    {
      masses[corners[k]] += area / 3.0;
    }
  }
  return masses;
}

/// Where a field per handle is kept, motions are blends of them.
FactorLimits GradientLimits(const HandleProblem& problem)
{
  FactorLimits limits;
  limits.Use = StoresHandleFields(problem) ? FactorUse::FewSolves : FactorUse::ManySolves;
  return limits;
}
}

GradientSystem::GradientSystem(const HandleProblem& problem, int coherenceRings,
  bool constrainTransforms, SolverBackend backend, const ExecutionContext& context)
  : MovingHandles(MovingHandleOfVertices(problem))
  , EdgeWeights(cartan::EdgeWeights(*problem.Mesh, *problem.Rest, problem.Weights, context))
  , Backend(RequireDirect(backend, "Similarity deformation"))
  , System(this->Backend, GradientLimits(problem))
  , StoresFields(StoresHandleFields(problem))
{
  const GradientConstraints constraints = this->ReadConstraints(problem, constrainTransforms);
  this->RequireDeterminedSurface(problem, constraints);
  this->FindScales(problem);
  this->Gradients = std::make_unique<RingGradients>(
    *problem.Mesh, *problem.Rest, constraints, std::max(1, coherenceRings), context.Part(0.0, 0.3));
  this->Factorize(*problem.Mesh, context.Part(0.3, 1.0));
}

GradientConstraints GradientSystem::ReadConstraints(
  const HandleProblem& problem, bool constrainTransforms)
{
  if (!problem.ConstrainPositions && !constrainTransforms)
  {
    throw Error(ErrorCode::BadInput,
      "Moving handles hold neither positions nor transforms, so nothing moves: switch "
      "ConstrainHandlePositions or ConstrainHandleTransforms on.");
  }
  const TriangleMesh& mesh = *problem.Mesh;
  GradientConstraints constraints;
  const Hold hold = problem.ConstrainPositions ? Hold::AllHandles : Hold::PinnedOnly;
  constraints.IsUnknown = UnknownVertices(problem, hold);
  this->SoftPositions = SquaredSoftWeights(problem, constraints.IsUnknown, hold);
  constraints.IsGiven.assign(mesh.NumberOfVertices(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const bool isMoving = this->MovingHandles[v] >= 0;
    const bool isHeld = !problem.SoftWeights.size() || problem.SoftWeights[v] > 0.0;
    if (mesh.IsUsed(v) && problem.Handle[v] > 0 && isHeld)
    {
      constraints.IsGiven[v] = constrainTransforms || !isMoving;
    }
  }
  return constraints;
}

void GradientSystem::RequireDeterminedSurface(
  const HandleProblem& problem, const GradientConstraints& constraints) const
{
  const TriangleMesh& mesh = *problem.Mesh;
  IdSample unheld;
  IdSample unturned;
  std::vector<char> isVisited(mesh.NumberOfVertices(), 0);
  for (int seed = 0; seed < mesh.NumberOfVertices(); ++seed)
  {
    if (!constraints.IsUnknown[seed] || isVisited[seed])
    {
      continue;
    }
    const UnknownPart part = GatherPart(mesh, constraints, this->SoftPositions, seed, isVisited);
    IdSample* const lack = part.Held.empty()                         ? &unheld
      : part.IsTransformHeld || SpansSpace(*problem.Rest, part.Held) ? nullptr
                                                                     : &unturned;
    for (std::size_t i = 0; lack && i < part.Vertices.size(); ++i)
    {
      lack->Add(part.Vertices[i]);
    }
  }
  if (!unheld.IsEmpty())
  {
    throw Error(ErrorCode::SingularSystem,
      "The system is singular: " + unheld.Describe("point", "points") +
        " in connected parts where no position is held. Pin a handle there, or switch "
        "ConstrainHandlePositions on.");
  }
  if (!unturned.IsEmpty())
  {
    throw Error(ErrorCode::SingularSystem,
      "The system is singular: " + unturned.Describe("point", "points") +
        " in connected parts where only positions in one plane are held, about which the surface "
        "could shear. Pin a handle there, hold points outside of the plane too, or switch "
        "ConstrainHandleTransforms on.");
  }
}

void GradientSystem::FindScales(const HandleProblem& problem)
{
  const TriangleMesh& mesh = *problem.Mesh;
  const Points& rest = *problem.Rest;
  this->EdgeLengths.setZero(mesh.NumberOfVertices());
  Eigen::VectorXd weightSums = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      this->EdgeLengths[v] += (rest.row(v) - rest.row(mesh.Neighbor(d))).norm() / mesh.Valence(v);
      weightSums[v] += std::abs(this->EdgeWeights[d]);
    }
  }
  // A vertex in one place with all its neighbors has no scale of its own.
  this->EdgeLengths =
    (this->EdgeLengths.array() > 0.0).select(this->EdgeLengths, this->EdgeLengths.mean()).eval();
  this->RowScales.setZero(mesh.NumberOfVertices());
  const bool isIntegrated = problem.Weights == LaplacianWeights::Cotangent;
  const Eigen::VectorXd masses = isIntegrated ? VertexMasses(mesh, rest) : Eigen::VectorXd();
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const double unit = isIntegrated ? std::sqrt(RegularMassFactor * masses[v])
                                     : this->EdgeLengths[v] * weightSums[v];
    this->RowScales[v] = unit > 0.0 ? 1.0 / unit : 0.0;
  }
}

SparseRows<double> GradientSystem::LaplacianRows(const TriangleMesh& mesh) const
{
  SparseRows<double> rows;
  for (const int v : this->Gradients->ActiveVertices())
  {
    double sum = 0.0;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const double weight = this->RowScales[v] * this->EdgeWeights[d];
      rows.Add(this->Gradients->PositionColumn(mesh.Neighbor(d)), weight);
      sum += weight;
    }
    rows.Add(this->Gradients->PositionColumn(v), -sum);
    rows.FinishRow();
  }
  return rows;
}

/// s_i (D - M_i delta_i): the row of D less the coefficients of M_i delta_i.
SparseRows<double> GradientSystem::ResidualRows(const TriangleMesh& mesh) const
{
  const RingGradients& gradients = *this->Gradients;
  const SparseRows<Eigen::Vector3d>& rows = gradients.Rows();
  const SparseRows<double> laplacians = this->LaplacianRows(mesh);
  SparseRows<double> residuals;
  for (std::size_t a = 0; a < gradients.ActiveVertices().size(); ++a)
  {
    const int v = gradients.ActiveVertices()[a];
    Eigen::Vector3d delta = Eigen::Vector3d::Zero();
    const int active = static_cast<int>(a);
    for (const auto* entry = laplacians.Begin(active); entry != laplacians.End(active); ++entry)
    {
      delta += entry->Coefficient * gradients.RestValues().row(entry->Column).transpose();
      residuals.Add(entry->Column, entry->Coefficient);
    }
    const int row = gradients.Row(v);
    for (const auto* entry = rows.Begin(row); entry != rows.End(row); ++entry)
    {
      residuals.Add(entry->Column, -entry->Coefficient.dot(delta));
    }
    residuals.FinishRow();
  }
  return residuals;
}

/// sum_i sum_j |M_i - M_j|^2 = sum_i M_i . 2 sum_j (M_i - M_j), as pairs occur in both orders.
SparseRows<Eigen::Vector3d> GradientSystem::DifferenceRows(const ExecutionContext& context) const
{
  const RingGradients& gradients = *this->Gradients;
  const SparseRows<Eigen::Vector3d>& rows = gradients.Rows();
  const int size = gradients.NumberOfColumns();
  return MakeRows<Eigen::Vector3d>(rows.Count(), context,
    [&](int begin, int end, SparseRows<Eigen::Vector3d>& part)
    {
      RowSum<Eigen::Vector3d> sum(size);
      const auto add = [&](int row, double factor)
      {
        for (const auto* entry = rows.Begin(row); entry != rows.End(row); ++entry)
        {
          sum.Add(entry->Column, factor * entry->Coefficient);
        }
      };
      for (int row = begin; row < end; ++row)
      {
        sum.Clear();
        const std::vector<int>& coherent = gradients.CoherentRows()[row];
        add(row, 2.0 * static_cast<double>(coherent.size()));
        for (const int other : coherent)
        {
          add(other, -2.0);
        }
        for (const int column : sum.Columns())
        {
          part.Add(column, sum.At(column));
        }
        part.FinishRow();
      }
    });
}

void GradientSystem::Factorize(const TriangleMesh& mesh, const ExecutionContext& context)
{
  const RingGradients& gradients = *this->Gradients;
  const int size = gradients.NumberOfColumns();
  SparseMatrix matrix;
  {
    const SparseRows<Eigen::Vector3d> differences = this->DifferenceRows(context);
    context.Report(0.1);
    // The free columns come first unless there are normals.
    NormalMatrix(size, gradients.NumberOfNormals() ? size : gradients.NumberOfUnknowns(),
      this->ResidualRows(mesh), gradients.Rows(), differences, context)
      .swap(matrix);
  }
  context.Report(0.3);
  Anchors anchors;
  anchors.IsHard.resize(size);
  this->Unknowns.clear();
  for (int column = 0; column < size; ++column)
  {
    anchors.IsHard[column] = !gradients.IsUnknownColumn(column);
    if (gradients.IsUnknownColumn(column))
    {
      this->Unknowns.push_back(column);
    }
  }
  anchors.Vertices.assign(size, -1);
  this->Stiffness.setZero(size);
  for (int column = 0; column < gradients.NumberOfPositions(); ++column)
  {
    const int v = gradients.Vertex(column);
    anchors.Vertices[column] = v;
    this->Stiffness[column] =
      this->SoftPositions[v] / (this->EdgeLengths[v] * this->EdgeLengths[v]);
  }
  anchors.Stiffness = this->Stiffness;
  this->System.Factorize(std::move(matrix), anchors, context.Part(0.3, 1.0));
  RequireTranslations(this->System, anchors);
  this->IsFactorized = true;
}

void GradientSystem::Solve(
  const HandleProblem& problem, const HandleTargets& targets, const ExecutionContext& context)
{
  this->ReadTargets(problem, targets);
  const bool areFields = this->StoresFields && !targets.IsPerVertex();
  const bool isBlended = areFields && this->DragFields.rows() > 0;
  if (!isBlended && !this->IsFactorized)
  {
    this->Factorize(*problem.Mesh, context);
  }
  if (!areFields)
  {
    return this->SolveColumns();
  }
  if (!isBlended)
  {
    this->ComputeDragFields(problem);
    // Only targets vertex by vertex need the factor again.
    this->ReleasedFactorizations = this->GetNumberOfFactorizations();
    this->System = AnchoredSystem(this->Backend, GradientLimits(problem));
    this->IsFactorized = false;
    ReturnFreedMemory();
  }
  this->BlendDragFields(targets, context);
}

void GradientSystem::ReadTargets(const HandleProblem& problem, const HandleTargets& targets)
{
  const RingGradients& gradients = *this->Gradients;
  this->Values = gradients.RestValues();
  for (int column = 0; column < gradients.NumberOfPositions(); ++column)
  {
    const int v = gradients.Vertex(column);
    if (column >= gradients.NumberOfUnknowns() || this->Stiffness[column] > 0.0)
    {
      this->Values.row(column) =
        HandleTarget(problem, targets, v, this->MovingHandles[v]).transpose();
    }
  }
  int column = gradients.FirstGiven();
  for (const int v : gradients.GivenVertices())
  {
    this->Values.middleRows<3>(column) =
      HandleTransform(targets, v, this->MovingHandles[v]).transpose();
    column += 3;
  }
}

void GradientSystem::SolveColumns()
{
  // For what changes: no motion leaves the rest shape to the bit.
  const Field& rest = this->Gradients->RestValues();
  this->Values -= rest;
  this->System.Interpolate(this->Values);
  this->Values += rest;
}

void GradientSystem::ComputeDragFields(const HandleProblem& problem)
{
  const RingGradients& gradients = *this->Gradients;
  const int numberOfMoving = static_cast<int>(problem.Moving.size());
  // Handle k in its rest place and all others at the origin, then handle k all in one place.
  Field fields = Field::Zero(gradients.NumberOfColumns(), 4 * numberOfMoving);
  for (int column = 0; column < gradients.NumberOfPositions(); ++column)
  {
    const int v = gradients.Vertex(column);
    const int handle = this->MovingHandles[v];
    if (handle < 0)
    {
      continue;
    }
    Eigen::RowVector4d target;
    target << problem.Rest->row(v), 1.0;
    fields.block<1, 4>(column, 4 * handle) = target;
  }
  int column = gradients.FirstGiven();
  for (const int v : gradients.GivenVertices())
  {
    if (this->MovingHandles[v] >= 0)
    {
      fields.block<3, 3>(column, 4 * this->MovingHandles[v]).setIdentity();
    }
    column += 3;
  }
  this->System.Interpolate(fields);
  this->DragFields = fields(this->Unknowns, Eigen::all);
}

void GradientSystem::BlendDragFields(const HandleTargets& targets, const ExecutionContext& context)
{
  context.For(static_cast<int>(this->Unknowns.size()),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        // The motions' identities together leave the rest shape.
        Eigen::Vector3d value = this->Gradients->RestValues().row(this->Unknowns[i]).transpose();
        for (std::size_t k = 0; k < targets.Motions.size(); ++k)
        {
          const double* phi = this->DragFields.row(i).data() + 4 * k;
          const Eigen::Map<const Eigen::Vector3d> along(phi);
          value +=
            targets.Motions[k].Linear * along - along + phi[3] * targets.Motions[k].Translation;
        }
        this->Values.row(this->Unknowns[i]) = value.transpose();
      }
    });
}

void GradientSystem::WritePositions(Points& positions) const
{
  for (int column = 0; column < this->Gradients->NumberOfUnknowns(); ++column)
  {
    positions.row(this->Gradients->Vertex(column)) = this->Values.row(column);
  }
}
}
