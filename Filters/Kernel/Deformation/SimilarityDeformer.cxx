// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SimilarityDeformer.h"

#include "Algebra/ClosestRotations.h"
#include "Deformation/JoinedVertices.h"
#include "Differential/Laplacian.h"
#include "Differential/RotationFit.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// The Frobenius norm, also of what is very far away, whose squares are infinite.
double StableNorm(const Eigen::Matrix3d& matrix)
{
  const double norm = matrix.norm();
  return std::isinf(norm) ? 1e160 * (1e-160 * matrix).norm() : norm;
}

/// A determinant below this part of |W|^3 flattens: far above rounding, far
/// below any scale that features survive.
constexpr double FlatDeterminant = 1e-12;
}

void SimilarityDeformer::EdgeForm::DeformBy(Matrices& transforms, const HandleTargets& targets,
  DeformedSurface& result, const ExecutionContext& context)
{
  struct Loan
  {
    Matrices& Theirs;
    Matrices& Ours;
    Loan(Matrices& theirs, Matrices& ours)
      : Theirs(theirs)
      , Ours(ours)
    {
      this->Theirs.swap(this->Ours);
    }
    ~Loan() { this->Theirs.swap(this->Ours); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
  };
  const Loan loan(transforms, this->Transforms);
  this->DeformRelative(targets, false, result, context);
}

SimilarityDeformer::SimilarityDeformer(HandleProblem problem, const Options& options,
  SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
  , Backend(backend)
  , System(this->Problem, options.CoherenceRings, options.ConstrainTransforms, backend, context)
  , PositionSystem(backend)
  , Transforms(Identities(this->Problem.Mesh->NumberOfVertices()))
  , Scales(Eigen::VectorXd::Ones(this->Problem.Mesh->NumberOfVertices()))
{
}

std::size_t SimilarityDeformer::GetBytes() const
{
  return this->GetBaseBytes() + this->System.GetBytes() + this->PositionSystem.GetBytes() +
    (this->Edges ? this->Edges->GetBytes() : 0) +
    TotalBytes(this->PositionColumns, this->Transforms, this->Scales);
}

void SimilarityDeformer::FactorizePositions(const ExecutionContext& context)
{
  const RingGradients& gradients = this->System.GetGradients();
  const int size = gradients.NumberOfPositions();
  const SparseRows<double> laplacians = this->System.LaplacianRows(*this->Problem.Mesh);
  SparseMatrix matrix =
    NormalMatrix(size, gradients.NumberOfUnknowns(), laplacians, {}, {}, context);
  Anchors anchors = Anchors::After(gradients.NumberOfUnknowns(), size);
  anchors.Stiffness = this->System.GetStiffness().head(size);
  for (int column = 0; column < size; ++column)
  {
    anchors.Vertices.push_back(gradients.Vertex(column));
  }
  this->PositionSystem.Factorize(std::move(matrix), anchors, context);
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
    this->FactorizePositions(context.Part(0.0, needsEdges && !this->Edges ? 0.5 : 1.0));
  }
  if (needsEdges && !this->Edges)
  {
    this->Edges = std::make_unique<EdgeForm>(this->Problem, this->Backend, context.Part(0.5, 1.0));
  }
  context.Report(1.0);
}

int SimilarityDeformer::GetNumberOfFactorizations() const
{
  return this->System.GetNumberOfFactorizations() +
    this->PositionSystem.GetNumberOfFactorizations() +
    (this->Edges ? this->Edges->GetNumberOfFactorizations() : 0);
}

void SimilarityDeformer::ComputeTransforms(
  const HandleTargets& targets, const ExecutionContext& context)
{
  const RingGradients& gradients = this->System.GetGradients();
  this->System.Solve(this->Problem, targets, context.Part(0.0, 0.6));
  context.Report(0.6);

  const std::vector<int>& moving = this->System.GetMovingHandles();
  const auto readGradient = [&](int v, Eigen::Map<Eigen::Matrix3d> gradient)
  {
    const bool isVariable = gradients.IsVariable(v);
    if (!isVariable && moving[v] < 0)
    {
      return false;
    }
    gradient = isVariable ? this->System.Gradient(v) : HandleTransform(targets, v, moving[v]);
    this->Scales[v] = StableNorm(gradient) / std::sqrt(3.0);
    return true;
  };
  const auto writeTransform = [&](int v, const Eigen::Map<Eigen::Matrix3d>& rotation)
  { MatrixAt(this->Transforms, v) = (this->ScaleFeatures ? this->Scales[v] : 1.0) * rotation; };
  context.For(this->Problem.Mesh->NumberOfVertices(),
    [&](int begin, int end) { ForClosestRotations(begin, end, readGradient, writeTransform); });
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
        if (!this->System.GetGradients().IsVariable(v))
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
        const double size = StableNorm(transform);
        // F R^-1 F: from R to the fit F and as far again.
        const Eigen::Matrix3d rotation = goesBeyond && size > 0.0
          ? Eigen::Matrix3d(std::sqrt(3.0) / size * fit * transform.transpose() * fit)
          : fit;
        // Squares of what is very far away are infinite; the transform has that scale then.
        this->Scales[v] = !std::isfinite(after) ? StableNorm(transform) / std::sqrt(3.0)
          : before > 0.0                        ? std::sqrt(after / before)
                                                : 1.0;
        transform = (this->ScaleFeatures ? this->Scales[v] : 1.0) * rotation;
      }
    });
}

void SimilarityDeformer::SolveLeastSquares(Points& positions, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const RingGradients& gradients = this->System.GetGradients();
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
          delta += this->System.GetEdgeWeights()[d] *
            (rest.row(mesh.Neighbor(d)) - rest.row(v)).transpose();
        }
        details.row(a) =
          this->System.GetRowScales()[v] * (MatrixAt(this->Transforms, v) * delta).transpose();
      }
    });
  const int size = gradients.NumberOfPositions();
  Field rightHandSide = Field::Zero(size, 3);
  context.For(gradients.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int column = begin; column < end; ++column)
      {
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (const auto* entry = this->PositionColumns.Begin(column);
             entry != this->PositionColumns.End(column); ++entry)
        {
          sum += entry->Coefficient * details.row(entry->Column);
        }
        rightHandSide.row(column) = sum;
      }
    });
  Field values(size, 3);
  for (int column = 0; column < size; ++column)
  {
    values.row(column) = positions.row(gradients.Vertex(column));
  }
  this->PositionSystem.Solve(rightHandSide, values);
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
    this->Edges->DeformBy(this->Transforms, targets, result, context);
    return;
  }
  result.Positions = HandlePositions(this->Problem, targets, this->System.GetMovingHandles());
  if (this->Reconstruction == SimilarityReconstruction::Affine)
  {
    this->System.WritePositions(result.Positions);
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
  const auto check = [&](const Eigen::Matrix3d& transform, long long id)
  {
    const double size = StableNorm(transform);
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
    for (std::size_t row = 0; row < targets.Vertices.size(); ++row)
    {
      const int v = targets.Vertices[row];
      if (this->System.GetMovingHandles()[v] >= 0)
      {
        check(MatrixAt(targets.Transforms, static_cast<Eigen::Index>(row)), v);
      }
    }
  }
  else
  {
    for (std::size_t k = 0; k < targets.Motions.size(); ++k)
    {
      check(targets.Motions[k].Linear, this->Problem.Moving[k]);
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

void SimilarityDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  this->Prepare(context.Part(0.0, 0.1));
  this->WarnOfSingularTransforms(targets);
  this->ComputeTransforms(targets, context.Part(0.1, 0.5));
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
      this->Edges->DeformBy(
        this->Transforms, targets, result, context.Part(begin, begin + 0.4 / this->Refits));
    }
  }
  FollowJoined(this->Problem.JoinedWith, this->Scales);
  MeansForRiders(this->Problem.Riders, this->Scales);
  result.FrameScale.setOnes(this->Problem.Mesh->NumberOfVertices());
  if (wantTransforms)
  {
    result.Transforms = this->Transforms;
  }
  context.Report(1.0);
}
}
