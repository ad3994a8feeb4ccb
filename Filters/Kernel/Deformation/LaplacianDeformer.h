// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/PolyharmonicSystem.h"

#include <memory>

namespace cartan
{
enum class LaplacianRotations
{
  None,      ///< differential coordinates keep their direction
  Estimated, ///< rotated as the result of the previous round turned (Lipman et al. 2004)
  Implicit   ///< similarities linear in the unknown positions (Sorkine et al. 2004)
};

/// Laplacian editing (Sorkine, Differential Representations for Mesh Processing,
/// 2006, sections 2 and 4.3): positions whose differential coordinates M^-1 L x
/// fit the rotated rest ones, T_i d_i, best over all vertices.
///
/// Estimated: T_i is the rotation that fits the two-ring of i in the last result
/// best; each round is one back-substitution (Lipman et al., Differential
/// Coordinates for Interactive Mesh Editing, 2004).
///
/// Implicit: T_i = s I + [h]x fits the one-ring of i best, linear in the unknown
/// positions, so that one system over 3 #V unknowns finds both (Sorkine et al.,
/// Laplacian Surface Editing, 2004, Eq. 7 of the survey). Its linearized
/// rotations change the size; a second solve takes the rotation of each T_i and
/// leaves its scale. Without targets vertex by vertex, and up to four moving handles, the (s, h)
/// are sums over fields of the handles instead, so that a motion solves for positions alone.
///
/// All solves are for displacements from the rest, so that rounding is in parts of
/// the motion and none leaves every point exactly where it is.
class LaplacianDeformer : public SurfaceDeformer
{
public:
  LaplacianDeformer(HandleProblem problem, LaplacianRotations rotations,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  /// The rounds of estimation, >= 1; 5 is past any visible change.
  void SetRounds(int rounds) { this->Rounds = rounds; }

  /// Also names the vertices that the last round of estimation has moved far, if it
  /// has moved them at least half as far as the round before.
  std::string GetWarning() const override
  {
    const std::string ofSystem = this->System.GetWarning();
    return ofSystem + (ofSystem.empty() || this->Unsettled.empty() ? "" : " ") + this->Unsettled;
  }

  int GetNumberOfFactorizations() const override
  {
    return this->System.GetNumberOfFactorizations() +
      this->ImplicitSystem.GetNumberOfFactorizations();
  }
  int GetNumberOfFreeVertices() const override { return this->System.NumberOfUnknowns(); }
  std::size_t GetBytes() const override
  {
    return this->GetBaseBytes() + this->System.GetBytes() + this->ImplicitSystem.GetBytes() +
      TotalBytes(this->MovingHandles, this->Differential, this->Rings, this->TwoRings,
        this->TwoRingOffsets, this->TwoRingMeans, this->HandleFields, this->SimilarityFields,
        this->HandleCenters, this->Transforms, this->Fits);
  }

protected:
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

private:
  /// The vertices whose differential coordinates the unknowns change: these and
  /// their neighbors, which are the first locals of the system.
  int NumberOfRows() const { return this->System.NumberWithin(1); }

  void FindHandleCenters();
  void FindTwoRings();
  void FindRings();
  void PrepareImplicit(const ExecutionContext& context);
  SparseMatrix ImplicitEquations();
  void EstimateRotations(const Points& displacements, const ExecutionContext& context);
  Field SolveSimilarities(Field unknowns) const;
  void ComputeSimilarityFields();
  /// Writes Transforms; `displacements` (#V x 3) has those of handles.
  void FindImplicitRotations(
    const HandleTargets& targets, const Points& displacements, const ExecutionContext& context);
  /// Writes the displacements of the unknowns that differential coordinates as they are have,
  /// without a solve; false where there are no fields for that.
  bool SumHandleFields(
    const HandleTargets& targets, Points& displacements, const ExecutionContext& context);
  void ComputeHandleFields();
  void SolveRotated(
    const Points& targetsOfLocals, Points& displacements, const ExecutionContext& context) const;
  /// `moves` (#locals) is how far the last round has moved them, `before` the
  /// farthest move of the round before.
  void WarnIfUnsettled(const Eigen::VectorXd& moves, double before);

  LaplacianRotations Rotations;
  PolyharmonicSystem System;
  AnchoredSystem ImplicitSystem;
  int Rounds = 5;
  std::string Unsettled;          ///< of the last motion
  std::vector<int> MovingHandles; ///< #V, index in HandleProblem::Moving or -1
  Points Differential;            ///< #rows x 3, of the rest
  Matrices Transforms;            ///< #rows x 9
  /// Implicit: each row and its neighbors, by local number.
  std::vector<std::vector<int>> Rings;
  /// Estimated: the vertices within two edges of each row, itself first, one row after
  /// the other; where each begins, #rows + 1.
  std::vector<int> TwoRings;
  std::vector<std::size_t> TwoRingOffsets;
  Points TwoRingMeans; ///< of their rest positions, #rows x 3
  /// Of each moving handle k: g_k, 3 numbers, and h_k (SumHandleFields); #unknowns x 4 #Moving,
  /// empty until first needed.
  Field HandleFields;
  /// Implicit, in their place: (s - 1, h) of each number of a motion (ComputeSimilarityFields);
  /// #rows x 48 #Moving.
  Field SimilarityFields;
  std::vector<Eigen::Vector3d> HandleCenters;
  /// Implicit: (s, h) of each row as a linear function of the positions of its
  /// ring, 4 x 3 k.
  std::vector<Eigen::MatrixXd> Fits;
};
}
