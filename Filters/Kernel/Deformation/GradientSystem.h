// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Deformation/HandleLaplacian.h"
#include "Differential/RingGradients.h"

namespace cartan
{
/// The first system of SimilarityDeformer: positions v~ and, linear in them, a
/// deformation gradient M_i at each vertex that minimize
///
///   sum_i |s_i (D(v~)_i - M_i delta_i)|^2 + sum_i sum_{j in rings of i} |M_i - M_j|_F^2
///
/// (Fu, Au, Tai, Effective Derivation of Similarity Transformations for Implicit
/// Laplacian Mesh Editing, 2007, Eqs. 5 to 7; see SimilarityDeformer for s_i and
/// for what handles add). Its unknowns are the columns of RingGradients.
class GradientSystem
{
public:
  /// Factorizes, and computes the fields if they are stored. Throws what SimilarityDeformer's
  /// constructor throws.
  GradientSystem(const HandleProblem& problem, int coherenceRings, bool constrainTransforms,
    SolverBackend backend, const ExecutionContext& context);

  const RingGradients& GetGradients() const { return *this->Gradients; }

  /// Index of each vertex's handle in HandleProblem::Moving or -1: #V.
  const std::vector<int>& GetMovingHandles() const { return this->MovingHandles; }

  /// w_ij of D (#D), s_i (#V), and what holds columns softly (#columns).
  const Eigen::VectorXd& GetEdgeWeights() const { return this->EdgeWeights; }
  const Eigen::VectorXd& GetRowScales() const { return this->RowScales; }
  const Eigen::VectorXd& GetStiffness() const { return this->Stiffness; }

  /// s_i D(.)_i over the columns of positions: a row per active vertex.
  SparseRows<double> LaplacianRows(const TriangleMesh& mesh) const;

  /// Finds the values of all columns for the problem that the system was made
  /// for. Without targets vertex by vertex, and where fields are stored
  /// (StoresHandleFields), this is a sum over the handles.
  void Solve(
    const HandleProblem& problem, const HandleTargets& targets, const ExecutionContext& context);

  /// Of the last solution: #columns x 3, and M of a vertex that has one.
  const Field& GetValues() const { return this->Values; }
  Eigen::Matrix3d Gradient(int vertex) const
  {
    return this->Gradients->Evaluate(this->Gradients->Row(vertex), this->Values);
  }

  /// Writes the unknown vertices' positions.
  void WritePositions(Points& positions) const;

  int GetNumberOfFactorizations() const
  {
    return this->ReleasedFactorizations + this->System.GetNumberOfFactorizations();
  }
  std::size_t GetBytes() const
  {
    return this->Gradients->GetBytes() + this->System.GetBytes() +
      TotalBytes(this->MovingHandles, this->SoftPositions, this->EdgeWeights, this->RowScales,
        this->EdgeLengths, this->Stiffness, this->Unknowns, this->Values, this->DragFields);
  }

private:
  GradientConstraints ReadConstraints(const HandleProblem& problem, bool constrainTransforms);
  void RequireDeterminedSurface(
    const HandleProblem& problem, const GradientConstraints& constraints) const;
  void FindScales(const HandleProblem& problem);
  SparseRows<double> ResidualRows(const TriangleMesh& mesh) const;
  SparseRows<Eigen::Vector3d> DifferenceRows(const ExecutionContext& context) const;
  void Factorize(const TriangleMesh& mesh, const ExecutionContext& context);
  void ReadTargets(const HandleProblem& problem, const HandleTargets& targets);
  void SolveColumns();
  void ComputeDragFields(const HandleProblem& problem);
  void BlendDragFields(const HandleTargets& targets, const ExecutionContext& context);

  std::vector<int> MovingHandles;
  Eigen::VectorXd SoftPositions; // #V, w^2 of softly held positions
  Eigen::VectorXd EdgeWeights;
  Eigen::VectorXd RowScales;
  Eigen::VectorXd EdgeLengths; // #V, h_i
  std::unique_ptr<RingGradients> Gradients;
  SolverBackend Backend;
  AnchoredSystem System;
  bool IsFactorized = false;
  int ReleasedFactorizations = 0;
  Eigen::VectorXd Stiffness;
  std::vector<int> Unknowns; // the columns that are solved for
  Field Values;
  bool StoresFields;
  // #unknown columns x 4 #Moving, the phi_k and h_k of SimilarityDeformer.
  Field DragFields;
};
}
