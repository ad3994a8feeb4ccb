// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSimilarityDeformation
 * @brief deforms by rotations and scales that follow from where handles go
 *
 * Each point gets a deformation gradient that is linear in the unknown
 * positions of its neighbors; the surface is solved for with gradients that
 * vary as little as possible; shear is removed from them by a polar
 * decomposition; and the surface is put together from the rotations (and
 * scales) that are left. Unlike methods that spread the handles' transforms,
 * this one also finds rotations where handles are only translated.
 *
 * Handles give positions and transforms; one of the two can be switched off for
 * moving handles (ConstrainHandlePositions, ConstrainHandleTransforms). Pinned
 * handles hold both; to hold the place of points without their orientation,
 * give them the identity as motion.
 *
 * Softly held points (ConstraintWeightArrayName): w^2 times the squared
 * distance from the target, in units of the mean edge length at the point,
 * joins the sums of squares; with EDGE_FORM the second solve takes it as
 * vtkSurfaceDeformation says. The weights act on positions alone; transforms
 * hold where w > 0.
 *
 * The output has, besides the arrays of vtkSurfaceDeformation, on request the
 * point array `ScaleFactor` (GenerateScaleFactor).
 *
 * @warning Gradients are blended linearly: a twist by more than 90 degrees is
 * spread unevenly (20 degrees of error at 150, 33 at 170); bends are far better.
 * A translation alone finds a part of the rotation; Refits adds to it.
 *
 * Errors, besides those of vtkSurfaceDeformation: moving handles that hold
 * neither positions nor transforms; a part where no transform and only
 * positions in one plane are held; triangles so degenerate that no gradient
 * exists. A motion that mirrors or flattens is followed with a warning.
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
   * handles that come closer or go apart; a similarity of all handles together
   * is reproduced exactly. Default: off.
   */
  vtkSetMacro(ScaleFeatures, bool);
  vtkGetMacro(ScaleFeatures, bool);
  vtkBooleanMacro(ScaleFeatures, bool);
  ///@}

  ///@{
  /**
   * Gradients are compared between points within so many edges, 1 or 2. One
   * makes the set-up a third shorter; two give slightly smoother gradients.
   * Default: 2, as in the paper.
   */
  void SetCoherenceRings(int rings);
  vtkGetMacro(CoherenceRings, int);
  ///@}

  ///@{
  /**
   * Whether moving handles hold the transforms of their motions. Off: only the
   * positions of their points count, and the surface turns at them as it likes.
   * Default: on.
   */
  void SetConstrainHandleTransforms(bool constrain);
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
   * How the surface is put together. AFFINE: as the first solve finds it, with
   * shear. LEAST_SQUARES: from transformed Laplacian coordinates, the paper's
   * choice, smoother at the borders of handles. EDGE_FORM: from transformed
   * edges, better lengths and volumes in bends, and rotations of flat parts.
   * Default: EDGE_FORM.
   */
  vtkSetClampMacro(Reconstruction, int, AFFINE, EDGE_FORM);
  vtkGetMacro(Reconstruction, int);
  void SetReconstructionToAffine() { this->SetReconstruction(AFFINE); }
  void SetReconstructionToLeastSquares() { this->SetReconstruction(LEAST_SQUARES); }
  void SetReconstructionToEdgeForm() { this->SetReconstruction(EDGE_FORM); }
  ///@}

  ///@{
  /**
   * How often rotations are fitted to the result and the surface is put
   * together again, from edges, 0 to 1000; each costs a back-substitution. 3
   * help much where handles are translated. Without effect with AFFINE. Default:
   * 0.
   */
  vtkSetClampMacro(Refits, int, 0, 1000);
  vtkGetMacro(Refits, int);
  ///@}

  ///@{
  /**
   * Adds the point array `ScaleFactor`: the root mean square of the singular
   * values of the deformation gradient, 1 where nothing changes; after Refits
   * that of the edges' lengths. Default: off.
   */
  vtkSetMacro(GenerateScaleFactor, bool);
  vtkGetMacro(GenerateScaleFactor, bool);
  vtkBooleanMacro(GenerateScaleFactor, bool);
  ///@}

  /**
   * Of the last update: the points that lie in one plane with their neighbors
   * and were displaced for the first solve.
   */
  vtkGetMacro(NumberOfDisplacedPoints, int);

protected:
  vtkSimilarityDeformation() = default;
  ~vtkSimilarityDeformation() override = default;

  std::unique_ptr<cartan::SurfaceDeformer> NewDeformer(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void ConfigureDeformer(
    cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context) override;
  void DecorateOutput(const cartan::HandleProblem& problem, cartan::SurfaceDeformer& deformer,
    const cartan::DeformedSurface& result, vtkPolyData* output,
    const cartan::ExecutionContext& context) override;

private:
  bool ScaleFeatures = false;
  int CoherenceRings = 2;
  bool ConstrainHandleTransforms = true;
  int Reconstruction = EDGE_FORM;
  int Refits = 0;
  bool GenerateScaleFactor = false;
  int NumberOfDisplacedPoints = 0;
};

#endif
