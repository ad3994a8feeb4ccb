// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/FrameDeformer.h"
#include "Deformation/GradientSystem.h"

namespace cartan
{
/// How the surface is reconstructed once each vertex's transform is known.
enum class SimilarityReconstruction
{
  /// Not at all: positions as the first solve finds them, sheared.
  Affine,
  /// Laplacian coordinates transformed and fitted in the least-squares sense,
  /// Eqs. 9 and 10: smooth at the borders of handles.
  LeastSquares,
  /// Edges transformed by the mean of their ends' transforms, as FrameDeformer
  /// does: keeps lengths and volumes better, and turns on flat parts, where
  /// Laplacian coordinates vanish and carry no rotation.
  EdgeForm
};

/// Editing by implicit similarities (Fu, Au, Tai, Effective Derivation of
/// Similarity Transformations for Implicit Laplacian Mesh Editing, Computer
/// Graphics Forum 26(1), 2007). The surface is solved for twice. First with a
/// deformation gradient M_i at each vertex that is linear in the unknown
/// positions (see RingGradients), by minimizing
///
///   sum_i |s_i (D(v~)_i - M_i delta_i)|^2 + sum_i sum_{j in rings of i} |M_i - M_j|_F^2
///
/// (Eqs. 5 to 7) with D(v)_i = sum_j w_ij (v_j - v_i), delta = D(v). The paper
/// has s_i = 1 and normalized weights, which makes the result depend on the
/// length unit. Here all residuals are numbers without unit, and large and small
/// triangles of a graded mesh count alike. With cotangent weights D is integrated
/// over the area m_i around i, and s_i^2 = c / m_i makes the first sum that over
/// the surface of the squared pointwise residual: two vertices next to each other
/// count as one in their place, c as for other weights on regular meshes. Else
/// s_i = 1 / (h_i sum_j |w_ij|) with h_i the mean length of the edges at i. M_c = W_c is put in
/// where a handle gives W_c, however softly it holds positions: their weights w add w^2 |v~_c -
/// u_c|^2 / h_c^2 to the sum (and what FrameDeformer says with EdgeForm); w = 0 holds nothing.
///
/// The minimum is linear in each handle's motion: v~ = v + sum_k [(A_k - I) phi_k
/// + h_k t_k], with four numbers per vertex and handle, so that a drag solves
/// nothing here. (Targets that differ from vertex to vertex are solved for, and
/// motions of many handles, see HandleProblem::StoredHandles.)
///
/// Then shear is removed: R_i is the rotation closest to M_i, s_i^2 the mean of
/// its squared singular values (section 4), T_i = R_i or s_i R_i, and the
/// surface is reconstructed from T (SimilarityReconstruction). A similarity of
/// all handles together is reproduced exactly with T_i = s_i R_i.
///
/// Refits fit rotations F to the result (FitRotations, with the weights of the
/// edges) and reconstruct the surface from edges again. One that starts from a
/// result of rotations R in edge form goes beyond F, to F R^-1 F: successive
/// over-relaxation by the factor 2, the largest that cannot diverge, since what
/// the surface makes of R lies between R and the limit. The limit is close to the
/// as-rigid-as-possible surface, whose rotations are fitted to edges alone, without
/// the normal.
///
/// Each of the two matrices is factorized once.
class SimilarityDeformer : public SurfaceDeformer
{
public:
  struct Options
  {
    /// M_i is compared with the vertices within so many edges, >= 1. One ring
    /// halves the matrix; two give slightly smoother gradients.
    int CoherenceRings = 2;
    /// Whether moving handles give their transforms W too, or positions alone.
    /// Pinned handles always give both.
    bool ConstrainTransforms = true;
  };

  /// Factorizes the first system. Throws Error(BadInput) when moving handles
  /// give neither positions nor transforms, or parts are too degenerate;
  /// Error(SingularSystem) when the handles do not determine the surface: no
  /// position is held, or no transform and only positions in one plane.
  SimilarityDeformer(HandleProblem problem, const Options& options,
    SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

  /// Default: EdgeForm.
  void SetReconstruction(SimilarityReconstruction reconstruction)
  {
    this->Reconstruction = reconstruction;
  }

  /// Factorizes the systems of the reconstruction and the re-fits unless that was done before.
  /// Deform() does so by itself.
  void Prepare(const ExecutionContext& context = {});

  /// Whether T_i = s_i R_i (Eq. 10) or R_i (Eq. 9). Default: off.
  void SetScaleFeatures(bool scale) { this->ScaleFeatures = scale; }

  /// How often rotations are fitted to the result and the surface is put
  /// together from edges again; not with Affine. Default: 0.
  void SetRefits(int refits) { this->Refits = refits; }

  /// s_i of the last motion, 1 where nothing moves, whether it was used or not: #V. Riders and
  /// joined vertices have those of what they go with.
  const Eigen::VectorXd& GetScaleFactors() const { return this->Scales; }

  int GetNumberOfFactorizations() const override;
  int GetNumberOfFreeVertices() const override
  {
    return this->System.GetGradients().NumberOfUnknowns();
  }
  std::string GetWarning() const override { return this->Warning; }
  std::size_t GetBytes() const override;

  /// The vertices that are in one plane with their neighbors.
  int GetNumberOfFlatVertices() const { return this->System.GetGradients().NumberOfNormals(); }

protected:
  void DeformRelative(const HandleTargets& targets, bool wantTransforms, DeformedSurface& result,
    const ExecutionContext& context) override;

private:
  /// Puts the surface together from transforms that are given.
  class EdgeForm : public FrameDeformer
  {
  public:
    EdgeForm(const HandleProblem& problem, SolverBackend backend, const ExecutionContext& context)
      : FrameDeformer(problem, backend, context)
    {
    }

    /// Borrows `transforms` (#V x 9), which come back as they were.
    void DeformBy(Matrices& transforms, const HandleTargets& targets, DeformedSurface& result,
      const ExecutionContext& context);

  protected:
    void ComputeTransforms(const HandleTargets&, const ExecutionContext&) override {}
  };

  void FactorizePositions(const ExecutionContext& context);
  void ComputeTransforms(const HandleTargets& targets, const ExecutionContext& context);
  void RefitTransforms(const Points& positions, bool goesBeyond, const ExecutionContext& context);
  void Reconstruct(
    const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context);
  void SolveLeastSquares(Points& positions, const ExecutionContext& context);
  void WarnOfSingularTransforms(const HandleTargets& targets);

  SolverBackend Backend;
  GradientSystem System;

  AnchoredSystem PositionSystem;
  bool ArePositionsFactorized = false;
  SparseRows<double> PositionColumns; ///< by position: active vertex, s_i D's coefficient
  std::unique_ptr<EdgeForm> Edges;

  SimilarityReconstruction Reconstruction = SimilarityReconstruction::EdgeForm;
  bool ScaleFeatures = false;
  int Refits = 0;
  Matrices Transforms;    ///< #V x 9, T
  Eigen::VectorXd Scales; ///< #V
  std::string Warning;
};
}
