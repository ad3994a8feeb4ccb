// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SimilarityDeformer.h"

#include "Algebra/Rotation.h"
#include "Differential/Laplacian.h"
#include "Measure/Measures.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// A determinant below this part of |W|^3 flattens: far above rounding, far
/// below any scale that features survive.
constexpr double FlatDeterminant = 1e-12;

double Product(double a, double b)
{
  return a * b;
}
double Product(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return a.dot(b);
}

/// Adds row `column` of left^T right to `sum`; `leftColumns` is left by columns.
template <typename Value>
void AddProductRow(const SparseRows<Value>& leftColumns, const SparseRows<Value>& right, int column,
  RowSum<double>& sum)
{
  for (const auto* left = leftColumns.Begin(column); left != leftColumns.End(column); ++left)
  {
    for (const auto* entry = right.Begin(left->Column); entry != right.End(left->Column); ++entry)
    {
      sum.Add(entry->Column, Product(left->Coefficient, entry->Coefficient));
    }
  }
}

/// residuals^T residuals + gradients^T differences, symmetric, of `size`
/// columns. Entries between columns that are both beyond `numberOfFree` are
/// left out: no solve reads them.
SparseMatrix NormalMatrix(int size, int numberOfFree, const SparseRows<double>& residuals,
  const SparseRows<Eigen::Vector3d>& gradients, const SparseRows<Eigen::Vector3d>& differences,
  const ExecutionContext& context)
{
  const SparseRows<double> residualColumns = residuals.Transposed(size);
  const SparseRows<Eigen::Vector3d> gradientColumns = gradients.Transposed(size);
  const SparseRows<double> rows = MakeRows<double>(size, context,
    [&](int begin, int end, SparseRows<double>& part)
    {
      RowSum<double> sum(size);
      for (int row = begin; row < end; ++row)
      {
        sum.Clear();
        AddProductRow(residualColumns, residuals, row, sum);
        AddProductRow(gradientColumns, differences, row, sum);
        std::sort(sum.Columns().begin(), sum.Columns().end());
        for (const int column : sum.Columns())
        {
          if (row < numberOfFree || column < numberOfFree)
          {
            part.Add(column, sum.At(column));
          }
        }
        part.FinishRow();
      }
    });
  SparseMatrix matrix(size, size);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(rows.Entries.size()));
  std::copy(rows.Offsets.begin(), rows.Offsets.end(), matrix.outerIndexPtr());
  for (std::size_t i = 0; i < rows.Entries.size(); ++i)
  {
    matrix.innerIndexPtr()[i] = rows.Entries[i].Column;
    matrix.valuePtr()[i] = rows.Entries[i].Coefficient;
  }
  return matrix;
}
}

SimilarityDeformer::SimilarityDeformer(HandleProblem problem, const Options& options,
  SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
  , ConstrainsTransforms(options.ConstrainTransforms)
  , Backend(backend)
  , MovingHandles(MovingHandleOfVertices(this->Problem))
  , EdgeWeights(
      cartan::EdgeWeights(*this->Problem.Mesh, *this->Problem.Rest, this->Problem.Weights, context))
  , GradientSolver(backend)
  , PositionSolver(backend)
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const Points& rest = *this->Problem.Rest;
  const GradientConstraints constraints = this->ReadConstraints(options);
  this->RequireDeterminedSurface(constraints);

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
  this->EdgeLengths = this->EdgeLengths.cwiseMax(1e-6 * this->EdgeLengths.mean());
  this->RowScales.setZero(mesh.NumberOfVertices());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const double unit = this->EdgeLengths[v] * weightSums[v];
    this->RowScales[v] = unit > 0.0 ? 1.0 / unit : 0.0;
  }

  this->Gradients = std::make_unique<RingGradients>(
    mesh, rest, constraints, std::max(1, options.CoherenceRings), context.Part(0.0, 0.3));
  this->FactorizeGradients(context.Part(0.3, 1.0));

  this->Transforms = Identities(mesh.NumberOfVertices());
  this->Scales.setOnes(mesh.NumberOfVertices());
}

std::size_t SimilarityDeformer::GetBytes() const
{
  return this->Problem.GetBytes() + this->Gradients->GetBytes() + this->GradientSolver.GetBytes() +
    this->PositionSolver.GetBytes() + (this->Edges ? this->Edges->GetBytes() : 0) +
    TotalBytes(this->MovingHandles, this->SoftPositions, this->EdgeWeights, this->RowScales,
      this->EdgeLengths, this->GradientStiffness, this->Values, this->DragFields,
      this->PositionColumns, this->Transforms, this->Scales);
}

GradientConstraints SimilarityDeformer::ReadConstraints(const Options& options)
{
  if (!this->Problem.ConstrainPositions && !options.ConstrainTransforms)
  {
    throw Error(ErrorCode::BadInput,
      "Moving handles hold neither positions nor transforms, so nothing moves: switch "
      "ConstrainHandlePositions or ConstrainHandleTransforms on.");
  }
  const TriangleMesh& mesh = *this->Problem.Mesh;
  GradientConstraints constraints;
  const Hold hold = this->Problem.ConstrainPositions ? Hold::AllHandles : Hold::PinnedOnly;
  constraints.IsUnknown = UnknownVertices(this->Problem, hold);
  this->SoftPositions = SquaredSoftWeights(this->Problem, constraints.IsUnknown, hold);
  constraints.IsGiven.assign(mesh.NumberOfVertices(), 0);
  constraints.IsUntouched.assign(mesh.NumberOfVertices(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const bool isMoving = this->MovingHandles[v] >= 0;
    const bool isHeld = !this->Problem.SoftWeights.size() || this->Problem.SoftWeights[v] > 0.0;
    if (mesh.IsUsed(v) && this->Problem.Handle[v] > 0 && isHeld)
    {
      constraints.IsUntouched[v] = 1;
      constraints.IsGiven[v] = options.ConstrainTransforms || !isMoving;
    }
  }
  return constraints;
}

void SimilarityDeformer::RequireDeterminedSurface(const GradientConstraints& constraints) const
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const Points& rest = *this->Problem.Rest;
  IdSample unheld;
  IdSample unturned;
  std::vector<char> isVisited(mesh.NumberOfVertices(), 0);
  std::vector<int> part;
  for (int seed = 0; seed < mesh.NumberOfVertices(); ++seed)
  {
    if (!constraints.IsUnknown[seed] || isVisited[seed])
    {
      continue;
    }
    // A part of unknown vertices, with what its gradients see of the handles.
    bool isTransformHeld = false;
    std::vector<int> held;
    part.assign(1, seed);
    isVisited[seed] = 1;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      const int v = part[i];
      isTransformHeld = isTransformHeld || constraints.IsGiven[v];
      if (this->SoftPositions[v] > 0.0)
      {
        held.push_back(v);
      }
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        const int w = mesh.Neighbor(d);
        if (isVisited[w])
        {
          continue;
        }
        if (constraints.IsUnknown[w])
        {
          isVisited[w] = 1;
          part.push_back(w);
          continue;
        }
        isTransformHeld = isTransformHeld || constraints.IsGiven[w];
        held.push_back(w);
        for (int e = mesh.RingBegin(w); e < mesh.RingEnd(w); ++e)
        {
          if (!constraints.IsUnknown[mesh.Neighbor(e)])
          {
            held.push_back(mesh.Neighbor(e));
          }
        }
      }
    }
    if (held.empty())
    {
      for (const int v : part)
      {
        unheld.Add(v);
      }
      continue;
    }
    if (!isTransformHeld)
    {
      // An affine map that keeps the held positions costs nothing, so they must
      // leave only the identity.
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const int v : held)
      {
        mean += rest.row(v).transpose() / static_cast<double>(held.size());
      }
      Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
      for (const int v : held)
      {
        const Eigen::Vector3d difference = rest.row(v).transpose() - mean;
        moments += difference * difference.transpose();
      }
      const Eigen::Vector3d eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly)
          .eigenvalues();
      if (!(eigenvalues[0] > 1e-10 * eigenvalues[2]))
      {
        for (const int v : part)
        {
          unturned.Add(v);
        }
      }
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

SparseRows<double> SimilarityDeformer::LaplacianRows() const
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
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

void SimilarityDeformer::FactorizeGradients(const ExecutionContext& context)
{
  const RingGradients& gradients = *this->Gradients;
  const SparseRows<Eigen::Vector3d>& rows = gradients.Rows();
  const int size = gradients.NumberOfColumns();

  // s_i (D - M_i delta_i): the row of D less the coefficients of M_i delta_i.
  const SparseRows<double> laplacians = this->LaplacianRows();
  SparseRows<double> residuals;
  for (std::size_t a = 0; a < gradients.ActiveVertices().size(); ++a)
  {
    const int v = gradients.ActiveVertices()[a];
    Eigen::Vector3d delta = Eigen::Vector3d::Zero();
    const int active = static_cast<int>(a);
    for (const auto* entry = laplacians.Begin(active); entry != laplacians.End(active); ++entry)
    {
      delta += entry->Coefficient *
        gradients.DisplacedRest().row(gradients.Vertex(entry->Column)).transpose();
      residuals.Add(entry->Column, entry->Coefficient);
    }
    const int row = gradients.Row(v);
    for (const auto* entry = rows.Begin(row); entry != rows.End(row); ++entry)
    {
      residuals.Add(entry->Column, -entry->Coefficient.dot(delta));
    }
    residuals.FinishRow();
  }

  // sum_i sum_j |M_i - M_j|^2 = sum_i M_i . 2 sum_j (M_i - M_j), as each pair
  // occurs in both orders.
  const SparseRows<Eigen::Vector3d> differences = MakeRows<Eigen::Vector3d>(rows.Count(), context,
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
  context.Report(0.1);

  const SparseMatrix matrix =
    NormalMatrix(size, gradients.NumberOfUnknowns(), residuals, rows, differences, context);
  context.Report(0.3);
  std::vector<char> isFixed(size, 1);
  std::fill(isFixed.begin(), isFixed.begin() + gradients.NumberOfUnknowns(), 0);
  std::vector<int> vertices(size, -1);
  this->GradientStiffness.setZero(size);
  for (int column = 0; column < gradients.NumberOfPositions(); ++column)
  {
    const int v = gradients.Vertex(column);
    vertices[column] = v;
    this->GradientStiffness[column] =
      this->SoftPositions[v] / (this->EdgeLengths[v] * this->EdgeLengths[v]);
  }
  this->GradientSolver.Factorize(
    matrix, isFixed, this->GradientStiffness, vertices, context.Part(0.3, 1.0));
  this->Values.setZero(size, 3);
}

void SimilarityDeformer::FactorizePositions(const ExecutionContext& context)
{
  const RingGradients& gradients = *this->Gradients;
  const int size = gradients.NumberOfPositions();
  const SparseRows<double> laplacians = this->LaplacianRows();
  const SparseMatrix matrix =
    NormalMatrix(size, gradients.NumberOfUnknowns(), laplacians, {}, {}, context);
  std::vector<char> isFixed(size, 1);
  std::fill(isFixed.begin(), isFixed.begin() + gradients.NumberOfUnknowns(), 0);
  std::vector<int> vertices(size);
  for (int column = 0; column < size; ++column)
  {
    vertices[column] = gradients.Vertex(column);
  }
  this->PositionSolver.Factorize(
    matrix, isFixed, this->GradientStiffness.head(size), vertices, context);
  this->PositionColumns = laplacians.Transposed(size);
  this->ArePositionsFactorized = true;
}

void SimilarityDeformer::Prepare(const ExecutionContext& context)
{
  const bool needsEdges = this->Reconstruction == SimilarityReconstruction::EdgeForm ||
    (this->Reconstruction == SimilarityReconstruction::LeastSquares && this->Refits > 0);
  if (this->Reconstruction == SimilarityReconstruction::LeastSquares &&
    !this->ArePositionsFactorized)
  {
    this->FactorizePositions(context);
  }
  if (needsEdges && !this->Edges)
  {
    this->Edges =
      std::make_unique<EdgeForm>(this->Problem, this->Transforms, this->Backend, context);
  }
}

int SimilarityDeformer::GetNumberOfFactorizations() const
{
  return this->GradientSolver.GetNumberOfFactorizations() +
    this->PositionSolver.GetNumberOfFactorizations() +
    (this->Edges ? this->Edges->GetNumberOfFactorizations() : 0);
}

void SimilarityDeformer::SolveGradients(const HandleTargets& targets)
{
  const RingGradients& gradients = *this->Gradients;
  Field rightHandSide = Field::Zero(gradients.NumberOfColumns(), 3);
  for (int column = 0; column < gradients.NumberOfUnknowns(); ++column)
  {
    if (this->GradientStiffness[column] > 0.0)
    {
      const int v = gradients.Vertex(column);
      rightHandSide.row(column) = this->GradientStiffness[column] *
        HandleTarget(this->Problem, targets, v, this->MovingHandles[v]).transpose();
    }
  }
  this->GradientSolver.Solve(rightHandSide, this->Values);
}

void SimilarityDeformer::ComputeDragFields()
{
  const RingGradients& gradients = *this->Gradients;
  const int numberOfMoving = static_cast<int>(this->Problem.Moving.size());
  // Handle k in its rest place and all others at the origin, then handle k all
  // in one place.
  Field rightHandSide = Field::Zero(gradients.NumberOfColumns(), 4 * numberOfMoving);
  Field fields = rightHandSide;
  for (int column = 0; column < gradients.NumberOfPositions(); ++column)
  {
    const int v = gradients.Vertex(column);
    const int handle = this->MovingHandles[v];
    if (handle < 0)
    {
      continue;
    }
    Eigen::RowVector4d target;
    target << this->Problem.Rest->row(v), 1.0;
    fields.block<1, 4>(column, 4 * handle) = target;
    rightHandSide.block<1, 4>(column, 4 * handle) = this->GradientStiffness[column] * target;
  }
  int column = gradients.NumberOfPositions();
  for (const int v : gradients.GivenVertices())
  {
    if (this->MovingHandles[v] >= 0)
    {
      fields.block<3, 3>(column, 4 * this->MovingHandles[v]).setIdentity();
    }
    column += 3;
  }
  this->GradientSolver.Solve(rightHandSide, fields);
  this->DragFields = fields.topRows(gradients.NumberOfUnknowns());
}

void SimilarityDeformer::BlendDragFields(
  const HandleTargets& targets, const ExecutionContext& context)
{
  const RingGradients& gradients = *this->Gradients;
  context.For(gradients.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int column = begin; column < end; ++column)
      {
        // The motions' identities together leave the rest shape.
        Eigen::Vector3d position =
          gradients.DisplacedRest().row(gradients.Vertex(column)).transpose();
        for (std::size_t k = 0; k < targets.Motions.size(); ++k)
        {
          const double* phi = this->DragFields.row(column).data() + 4 * k;
          const Eigen::Map<const Eigen::Vector3d> along(phi);
          position +=
            targets.Motions[k].Linear * along - along + phi[3] * targets.Motions[k].Translation;
        }
        this->Values.row(column) = position.transpose();
      }
    });
}

void SimilarityDeformer::ReadTargets(const HandleTargets& targets)
{
  const RingGradients& gradients = *this->Gradients;
  for (int column = gradients.NumberOfUnknowns(); column < gradients.NumberOfPositions(); ++column)
  {
    const int v = gradients.Vertex(column);
    this->Values.row(column) =
      HandleTarget(this->Problem, targets, v, this->MovingHandles[v]).transpose();
  }
  int column = gradients.NumberOfPositions();
  for (const int v : gradients.GivenVertices())
  {
    this->Values.middleRows<3>(column) =
      HandleTransform(targets, v, this->MovingHandles[v]).transpose();
    column += 3;
  }
}

void SimilarityDeformer::SetTransform(int vertex, const Eigen::Matrix3d& gradient)
{
  this->Scales[vertex] = gradient.norm() / std::sqrt(3.0);
  MatrixAt(this->Transforms, vertex) =
    (this->ScaleFeatures ? this->Scales[vertex] : 1.0) * ProjectOnRotations(gradient);
}

void SimilarityDeformer::ComputeTransforms(
  const HandleTargets& targets, const ExecutionContext& context)
{
  const RingGradients& gradients = *this->Gradients;
  this->ReadTargets(targets);
  if (targets.IsPerVertex())
  {
    this->SolveGradients(targets);
  }
  else
  {
    if (this->DragFields.rows() == 0)
    {
      this->ComputeDragFields();
    }
    this->BlendDragFields(targets, context);
  }
  context.Report(0.6);

  const int numberOfVertices = this->Problem.Mesh->NumberOfVertices();
  context.For(numberOfVertices,
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        if (gradients.IsVariable(v))
        {
          this->SetTransform(v, gradients.Evaluate(gradients.Row(v), this->Values));
        }
        else if (this->MovingHandles[v] >= 0)
        {
          this->SetTransform(v, HandleTransform(targets, v, this->MovingHandles[v]));
        }
      }
    });
}

void SimilarityDeformer::RefitTransforms(
  const Points& positions, bool goesBeyond, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const Points& rest = *this->Problem.Rest;
  const Matrices fitted =
    FitRotations(mesh, rest, positions, context, this->Edges->GetPositionWeights()->cwiseMax(0.0));
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        if (!this->Gradients->IsVariable(v))
        {
          continue;
        }
        double before = 0.0;
        double after = 0.0;
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          before += (rest.row(mesh.Neighbor(d)) - rest.row(v)).squaredNorm();
          after += (positions.row(mesh.Neighbor(d)) - positions.row(v)).squaredNorm();
        }
        auto transform = MatrixAt(this->Transforms, v);
        const Eigen::Matrix3d fit = MatrixAt(fitted, v);
        const double size = transform.norm();
        // F R^-1 F: from R to the fit F and as far again.
        const Eigen::Matrix3d rotation = goesBeyond && size > 0.0
          ? Eigen::Matrix3d(std::sqrt(3.0) / size * fit * transform.transpose() * fit)
          : fit;
        this->Scales[v] = before > 0.0 ? std::sqrt(after / before) : 1.0;
        transform = (this->ScaleFeatures ? this->Scales[v] : 1.0) * rotation;
      }
    });
}

void SimilarityDeformer::PullBack(Points& positions) const
{
  const RingGradients& gradients = *this->Gradients;
  const Points& displaced = gradients.DisplacedRest();
  const Points& rest = *this->Problem.Rest;
  for (int column = 0; column < gradients.NumberOfUnknowns(); ++column)
  {
    const int v = gradients.Vertex(column);
    // v~ = v~' + M (v - v'), section 3.3
    positions.row(v) = this->Values.row(column) +
      (rest.row(v) - displaced.row(v)) *
        gradients.Evaluate(gradients.Row(v), this->Values).transpose();
  }
}

void SimilarityDeformer::SolveLeastSquares(Points& positions, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const RingGradients& gradients = *this->Gradients;
  const Points& rest = *this->Problem.Rest;
  // s_i T_i delta_i; those of held neighbors belong to the sum too, because
  // their D sees unknown vertices.
  Points details(static_cast<Eigen::Index>(gradients.ActiveVertices().size()), 3);
  context.For(static_cast<int>(details.rows()),
    [&](int begin, int end)
    {
      for (int a = begin; a < end; ++a)
      {
        const int v = gradients.ActiveVertices()[a];
        Eigen::Vector3d delta = Eigen::Vector3d::Zero();
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          delta += this->EdgeWeights[d] * (rest.row(mesh.Neighbor(d)) - rest.row(v)).transpose();
        }
        details.row(a) = this->RowScales[v] * (MatrixAt(this->Transforms, v) * delta).transpose();
      }
    });
  const int size = gradients.NumberOfPositions();
  Field rightHandSide = Field::Zero(size, 3);
  context.For(gradients.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int column = begin; column < end; ++column)
      {
        Eigen::RowVector3d sum =
          this->GradientStiffness[column] * positions.row(gradients.Vertex(column));
        for (const auto* entry = this->PositionColumns.Begin(column);
             entry != this->PositionColumns.End(column); ++entry)
        {
          sum += entry->Coefficient * details.row(entry->Column);
        }
        rightHandSide.row(column) = sum;
      }
    });
  Field values = this->Values.topRows(size);
  this->PositionSolver.Solve(rightHandSide, values);
  for (int column = 0; column < gradients.NumberOfUnknowns(); ++column)
  {
    positions.row(gradients.Vertex(column)) = values.row(column);
  }
}

void SimilarityDeformer::Reconstruct(
  const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context)
{
  if (this->Reconstruction == SimilarityReconstruction::EdgeForm)
  {
    this->Edges->Deform(targets, false, result, context);
    return;
  }
  result.Positions = HandlePositions(this->Problem, targets, this->MovingHandles);
  if (this->Reconstruction == SimilarityReconstruction::Affine)
  {
    this->PullBack(result.Positions);
  }
  else
  {
    this->SolveLeastSquares(result.Positions, context);
  }
}

void SimilarityDeformer::WarnOfSingularTransforms(const HandleTargets& targets)
{
  IdSample mirrored;
  IdSample flattened;
  const auto look = [&](const Eigen::Matrix3d& transform, long long id)
  {
    const double size = transform.norm();
    const double determinant = transform.determinant();
    if (!(std::abs(determinant) > FlatDeterminant * size * size * size))
    {
      flattened.Add(id);
    }
    else if (determinant < 0.0)
    {
      mirrored.Add(id);
    }
  };
  const bool isPerVertex = targets.Transforms.rows() > 0;
  if (isPerVertex)
  {
    for (std::size_t v = 0; v < this->MovingHandles.size(); ++v)
    {
      if (this->MovingHandles[v] >= 0)
      {
        look(MatrixAt(targets.Transforms, static_cast<Eigen::Index>(v)), static_cast<long long>(v));
      }
    }
  }
  else
  {
    for (std::size_t k = 0; k < targets.Motions.size(); ++k)
    {
      look(targets.Motions[k].Linear, this->Problem.Moving[k]);
    }
  }
  const auto describe = [&](const IdSample& sample) {
    return isPerVertex ? sample.Describe("point", "points") : sample.Describe("handle", "handles");
  };
  this->Warning.clear();
  if (!mirrored.IsEmpty())
  {
    this->Warning = "The motion of " + describe(mirrored) +
      " mirrors: rotations cannot mirror the surface's features, so they will look wrong around "
      "it. Use positive scales.";
  }
  if (!flattened.IsEmpty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ");
    this->Warning += "The motion of " + describe(flattened) +
      " flattens: it leaves no rotation for the features around it. Use scales other than 0.";
  }
}

void SimilarityDeformer::Deform(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  this->Prepare(context.Part(0.0, 0.1));
  this->WarnOfSingularTransforms(targets);
  this->ComputeTransforms(targets, context);
  context.Report(0.5);
  this->Reconstruct(targets, result, context.Part(0.5, 0.6));
  if (this->Reconstruction != SimilarityReconstruction::Affine)
  {
    for (int refit = 0; refit < this->Refits; ++refit)
    {
      const double begin = 0.6 + 0.4 * refit / this->Refits;
      const bool isFromEdges =
        refit > 0 || this->Reconstruction == SimilarityReconstruction::EdgeForm;
      this->RefitTransforms(result.Positions, isFromEdges, context);
      this->Edges->Deform(targets, false, result, context.Part(begin, begin + 0.4 / this->Refits));
    }
  }
  result.FrameScale.setOnes(this->Problem.Mesh->NumberOfVertices());
  if (wantTransforms)
  {
    result.Transforms = this->Transforms;
  }
  context.Report(1.0);
}
}
