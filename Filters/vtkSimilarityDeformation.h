// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSimilarityDeformation
 * @brief deforms by rotations and scales computed from the positions of handles
 *
 * Each point gets a deformation gradient that is linear in the unknown
 * positions of its neighbors; the surface is solved for with gradients that
 * vary as little as possible; shear is removed from them by a polar
 * decomposition; and the surface is reconstructed from the remaining rotations
 * (and scales). Unlike methods that spread the handles' transforms, this one
 * also finds rotations where handles are only translated.
 *
 * Handles give positions and transforms; one of the two can be switched off for
 * moving handles (ConstrainHandlePositions, ConstrainHandleTransforms). Pinned
 * handles fix both; to fix the positions of a handle without its orientation,
 * give it the identity as motion.
 *
 * Soft constraints (ConstraintWeightArrayName) add w^2 times the squared
 * distance from the target, in units of the mean edge length at the point, to
 * the sums of squares; the second solve of EDGE_FORM uses them as
 * vtkSurfaceDeformation describes. The weights act on positions only;
 * transforms are fixed where w > 0.
 *
 * The output has, besides the arrays of vtkSurfaceDeformation, on request the
 * point array `ScaleFactor` (GenerateScaleFactor).
 *
 * @warning Gradients are blended linearly: a twist by more than 90 degrees is
 * uneven (20 degrees of error at 150, 33 at 170); bends are much better. A
 * translation alone gives only a part of the rotation; Refits improves this.
 *
 * Errors, besides those of vtkSurfaceDeformation: moving handles that fix
 * neither positions nor transforms; a component where only positions in one
 * plane and no transform are fixed; triangles so degenerate that no gradient
 * exists. A motion that mirrors or flattens gives a warning.
 *
 * Reference: Fu, Au, Tai, Effective Derivation of Similarity Transformations
 * for Implicit Laplacian Mesh Editing, Computer Graphics Forum 26(1), 2007.
 *
 * @sa vtkMarkHandle vtkHandleMotion vtkRotationInvariantDeformation
 */
#ifndef vtkSimilarityDeformation_h
#define vtkSimilarityDeformation_h

#include "vtkSurfaceDeformation.h"

class VTKCARTAN_EXPORT vtkSimilarityDeformation : public vtkSurfaceDeformation
{
public:
  static vtkSimilarityDeformation* New();
  vtkTypeMacro(vtkSimilarityDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSimilarityDeformation(const vtkSimilarityDeformation&) = delete;
  void operator=(const vtkSimilarityDeformation&) = delete;

  ///@{
  /**
   * Off: features keep their size (Eq. 9), for rigid motions. On: they scale
   * with the surface around them (Eq. 10), for motions with scale and for
   * handles that move closer together or apart; a similarity of all handles
   * together is reproduced exactly. Default: off.
   */
  vtkSetMacro(ScaleFeatures, bool);
  vtkGetMacro(ScaleFeatures, bool);
  vtkBooleanMacro(ScaleFeatures, bool);
  ///@}

  ///@{
  /**
   * Gradients are compared between points within this number of edges, 1 or 2.
   * With 1 the set-up is a third shorter; with 2 gradients are slightly
   * smoother. Default: 2, as in the paper.
   */
  vtkSetClampMacro(CoherenceRings, int, 1, 2);
  vtkGetMacro(CoherenceRings, int);
  ///@}

  ///@{
  /**
   * Whether moving handles fix the transforms of their motions. Off: they fix
   * only the positions of their points, and the surface can turn there.
   * Default: on.
   */
  vtkSetMacro(ConstrainHandleTransforms, bool);
  vtkGetMacro(ConstrainHandleTransforms, bool);
  vtkBooleanMacro(ConstrainHandleTransforms, bool);
  ///@}

  enum ReconstructionType
  {
    AFFINE = 0,
    LEAST_SQUARES = 1,
    EDGE_FORM = 2
  };

  ///@{
  /**
   * How the surface is reconstructed. AFFINE: the result of the first solve,
   * with shear. LEAST_SQUARES: from transformed Laplacian coordinates, the
   * paper's choice, smoother at the borders of handles. EDGE_FORM: from
   * transformed edges, better lengths and volumes in bends, and rotations of
   * flat parts. Default: EDGE_FORM.
   */
  vtkSetClampMacro(Reconstruction, int, AFFINE, EDGE_FORM);
  vtkGetMacro(Reconstruction, int);
  void SetReconstructionToAffine() { this->SetReconstruction(AFFINE); }
  void SetReconstructionToLeastSquares() { this->SetReconstruction(LEAST_SQUARES); }
  void SetReconstructionToEdgeForm() { this->SetReconstruction(EDGE_FORM); }
  ///@}

  ///@{
  /**
   * How often rotations are fitted to the result and the surface is
   * reconstructed again, from edges, 0 to 1000; each needs one
   * back-substitution. Use 3 if handles are only translated. No effect with
   * AFFINE. Default: 0.
   */
  vtkSetClampMacro(Refits, int, 0, 1000);
  vtkGetMacro(Refits, int);
  ///@}

  ///@{
  /**
   * Adds the point array `ScaleFactor`: the root mean square of the singular
   * values of the deformation gradient, 1 where nothing changes; after Refits
   * that of the edge lengths. Default: off.
   */
  vtkSetMacro(GenerateScaleFactor, bool);
  vtkGetMacro(GenerateScaleFactor, bool);
  vtkBooleanMacro(GenerateScaleFactor, bool);
  ///@}

  /**
   * Of the last update: the points that lie in one plane with their neighbors,
   * where the image of the normal is an unknown of the first solve.
   */
  vtkGetMacro(NumberOfFlatPoints, int);

protected:
  vtkSimilarityDeformation() = default;
  ~vtkSimilarityDeformation() override = default;

  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void AddSettings(cartan::ContentKey& settings) const override;
  bool NeedsTransforms() const override { return this->GenerateScaleFactor; }
  void ForgetResults() override;

private:
  bool ScaleFeatures = false;
  int CoherenceRings = 2;
  bool ConstrainHandleTransforms = true;
  int Reconstruction = EDGE_FORM;
  int Refits = 0;
  bool GenerateScaleFactor = false;
  int NumberOfFlatPoints = 0;
};

#endif
