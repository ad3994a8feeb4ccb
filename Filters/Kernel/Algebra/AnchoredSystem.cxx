// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/AnchoredSystem.h"

#include "Algebra/SparseProduct.h"
#include "Base/Bytes.h"

#include <algorithm>

namespace cartan
{
Anchors Anchors::Hard(std::vector<char> isHard)
{
  Anchors anchors;
  anchors.IsHard = std::move(isHard);
  return anchors;
}

Anchors Anchors::After(int free, int size)
{
  Anchors anchors;
  anchors.IsHard.assign(size, 1);
  std::fill_n(anchors.IsHard.begin(), free, 0);
  return anchors;
}

Anchors Anchors::Repeated(int count) const
{
  Anchors repeated;
  const std::size_t size = this->IsHard.size() * static_cast<std::size_t>(count);
  repeated.IsHard.resize(size);
  repeated.Vertices.resize(size);
  repeated.Stiffness.resize(this->Stiffness.size() * count);
  for (std::size_t i = 0; i < size; ++i)
  {
    const std::size_t from = i / static_cast<std::size_t>(count);
    repeated.IsHard[i] = this->IsHard[from];
    repeated.Vertices[i] = this->Vertices.empty() ? static_cast<int>(from) : this->Vertices[from];
    if (this->Stiffness.size())
    {
      repeated.Stiffness[static_cast<Eigen::Index>(i)] =
        this->Stiffness[static_cast<Eigen::Index>(from)];
    }
  }
  return repeated;
}

void AnchoredSystem::Hold(const Anchors& anchors)
{
  // Solves need not add zeros.
  this->Stiffness = anchors.Stiffness.isZero(0.0) ? Eigen::VectorXd() : anchors.Stiffness;
  this->RightHandSide = SparseMatrix();
}

void AnchoredSystem::Factorize(
  const SparseMatrix& matrix, const Anchors& anchors, const ExecutionContext& context)
{
  this->Hold(anchors);
  this->Solver.Factorize(matrix, anchors.IsHard, this->Stiffness, anchors.Vertices, context);
}

void AnchoredSystem::Factorize(
  SparseMatrix&& matrix, const Anchors& anchors, const ExecutionContext& context)
{
  this->Hold(anchors);
  this->Solver.Factorize(
    std::move(matrix), anchors.IsHard, this->Stiffness, anchors.Vertices, context);
}

void AnchoredSystem::FactorizeFit(const SparseMatrix& laplacian, const Eigen::VectorXd& inverseMass,
  const Anchors& anchors, AnchorMode mode, const ExecutionContext& context)
{
  const bool isSquare = mode == AnchorMode::Substituted;
  const SparseMatrix transposed = laplacian.transpose();
  if (isSquare && (laplacian - transposed).norm() <= 1e-14 * laplacian.norm())
  {
    this->Factorize(laplacian, anchors, context);
    const Eigen::VectorXd mass = inverseMass.cwiseInverse();
    this->RightHandSide = SparseMatrix(laplacian.rows(), laplacian.cols());
    this->RightHandSide.setIdentity();
    this->RightHandSide = (mass.asDiagonal() * this->RightHandSide).eval();
    return;
  }
  // The free unknowns' equations alone, as many as unknowns, are met exactly.
  Eigen::VectorXd counts = Eigen::VectorXd::Ones(laplacian.rows());
  for (Eigen::Index i = 0; isSquare && i < counts.size(); ++i)
  {
    counts[i] = anchors.IsHard[i] ? 0.0 : 1.0;
  }
  // A vector of its own: Eigen evaluates an expression anew for each column.
  const Eigen::VectorXd weights = inverseMass.cwiseProduct(counts);
  const SparseMatrix weighted = weights.asDiagonal() * laplacian;
  this->Factorize(CheckedProduct(transposed, weighted, "The system of the fit"), anchors, context);
  this->RightHandSide = transposed * counts.asDiagonal();
}

void AnchoredSystem::Solve(const Eigen::Ref<const Field>& rightHandSide, Eigen::Ref<Field> values,
  const ExecutionContext& context) const
{
  if (this->Stiffness.size() == 0 && this->RightHandSide.size() == 0)
  {
    this->Solver.Solve(rightHandSide, values, context);
    return;
  }
  Field complete = rightHandSide;
  if (this->RightHandSide.size() && rightHandSide.size())
  {
    complete = this->RightHandSide * rightHandSide;
  }
  if (this->Stiffness.size())
  {
    const auto pull = this->Stiffness.asDiagonal() * values;
    complete = complete.size() ? Field(complete + pull) : Field(pull);
  }
  this->Solver.Solve(complete, values, context);
}

std::size_t AnchoredSystem::GetBytes() const
{
  return this->Solver.GetBytes() + TotalBytes(this->Stiffness, this->RightHandSide);
}
}
