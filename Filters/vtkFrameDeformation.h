// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFrameDeformation
 * @brief base of the deformations that compute frames first, then positions
 *
 * Base of the methods that first compute how each point's frame changes and
 * then reconstruct the surface from the changed frames. It has the weights of
 * the position system and the preservation of volume.
 *
 * The volume of components that are closed and oriented outward is preserved,
 * and that of cavities inside of them, whose walls are oriented inward;
 * other components get a warning and no correction. Rays measure the thickness
 * of the body once per surface; it is kept between motions.
 *
 * Arrays on request:
 * - `LocalDepth`, `LocalVolume`, `VolumeScale` (GenerateVolumeArrays): point
 *   arrays of one double each: the thickness of the body at rest under the
 *   point (length units, 0 where unknown), the part of the deformed body's
 *   volume under the point (cubed length units, see vtkVolumeChange), and the
 *   factor by which FRAME_SCALING scales its frame (1 with any other
 *   correction).
 * - `ShapeDistance` (GenerateShapeDistance): field data, one double, the
 *   distance 1/2 int |grad R|^2 between the input's and the deformed shape;
 *   `ShapeDistanceDensity`, a point array of its density, per squared length
 *   unit.
 *
 * Reference: Lipman, Cohen-Or, Gal, Levin, Volume and Shape Preservation via
 * Moving Frame Manipulation, ACM Transactions on Graphics 26(1), 2007, section
 * 4.
 *
 * @sa vtkSurfaceDeformation vtkShapePreservingDeformation
 * vtkRotationInvariantDeformation
 */
#ifndef vtkFrameDeformation_h
#define vtkFrameDeformation_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceDeformation.h"

namespace cartan
{
class FrameDeformer;
struct DeformedSurface;
struct VolumeModel;
}

class VTKCARTAN_EXPORT vtkFrameDeformation : public vtkSurfaceDeformation
{
public:
  vtkTypeMacro(vtkFrameDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkFrameDeformation(const vtkFrameDeformation&) = delete;
  void operator=(const vtkFrameDeformation&) = delete;

  enum VolumeCorrectionType
  {
    NO_CORRECTION = 0,
    FRAME_SCALING = 1,
    NEUTRAL_OFFSET = 2
  };

  ///@{
  /**
   * NEUTRAL_OFFSET bends about the middle of the body instead of about its
   * surface: the outside of a bend stretches, the inside shrinks. Its cost is
   * negligible and it keeps most of the volume. FRAME_SCALING is the paper's
   * correction by curvature: frames are scaled and the surface is reconstructed
   * twice; it has no effect on flat sides. NO_CORRECTION keeps lengths instead.
   * Default: the concrete class's.
   */
  vtkSetClampMacro(VolumeCorrection, int, NO_CORRECTION, NEUTRAL_OFFSET);
  vtkGetMacro(VolumeCorrection, int);
  void SetVolumeCorrectionToNone() { this->SetVolumeCorrection(NO_CORRECTION); }
  void SetVolumeCorrectionToFrameScaling() { this->SetVolumeCorrection(FRAME_SCALING); }
  void SetVolumeCorrectionToNeutralOffset() { this->SetVolumeCorrection(NEUTRAL_OFFSET); }
  ///@}

  ///@{
  /**
   * Whether to give each component the volume of the input exactly, by the
   * displacement of free points that changes the shape least. It needs one more
   * solve. Default: off.
   */
  vtkSetMacro(CloseVolume, bool);
  vtkGetMacro(CloseVolume, bool);
  vtkBooleanMacro(CloseVolume, bool);
  ///@}

  enum PositionWeightsType
  {
    LIKE_FRAMES = 0,
    UNIFORM_POSITIONS = 1,
    COTANGENT_POSITIONS = 2,
    MEAN_VALUE_POSITIONS = 3
  };

  ///@{
  /**
   * The weights of the position system. LIKE_FRAMES: LaplacianWeights for both
   * systems, with one factorization. The others are as in LaplacianWeights; the
   * 2007 paper spreads angles with cotangent weights and reconstructs the
   * surface with uniform ones. Default: LIKE_FRAMES.
   */
  vtkSetClampMacro(PositionWeights, int, LIKE_FRAMES, MEAN_VALUE_POSITIONS);
  vtkGetMacro(PositionWeights, int);
  void SetPositionWeightsToLikeFrames() { this->SetPositionWeights(LIKE_FRAMES); }
  void SetPositionWeightsToUniform() { this->SetPositionWeights(UNIFORM_POSITIONS); }
  void SetPositionWeightsToCotangent() { this->SetPositionWeights(COTANGENT_POSITIONS); }
  void SetPositionWeightsToMeanValue() { this->SetPositionWeights(MEAN_VALUE_POSITIONS); }
  ///@}

  ///@{
  /**
   * Adds `LocalDepth`, `LocalVolume` and `VolumeScale`, which are 0, NaN and 1
   * in components that enclose no volume. Default: off.
   */
  vtkSetMacro(GenerateVolumeArrays, bool);
  vtkGetMacro(GenerateVolumeArrays, bool);
  vtkBooleanMacro(GenerateVolumeArrays, bool);
  ///@}

  ///@{
  /**
   * Adds `ShapeDistance` and `ShapeDistanceDensity`. Default: off.
   */
  vtkSetMacro(GenerateShapeDistance, bool);
  vtkGetMacro(GenerateShapeDistance, bool);
  vtkBooleanMacro(GenerateShapeDistance, bool);
  ///@}

  ///@{
  /**
   * Whether to read turning motions from a table instead of solving for each: for
   * dragging large surfaces. Where the handles turn rigidly about one axis (any axis,
   * with any translation; the angles of several handles in a fixed ratio), the surface
   * is a sum over a few fields that depend on the angle only. The first motion makes the
   * table, at the cost of about fifteen motions and of about 150 bytes per free point, with
   * vtkRotationInvariantDeformation of twice as much; each one after it is a sum. Motions that the
   * table does not serve are solved for: those with scale or shear, with targets that differ from
   * point to point, beyond TurnRange, with FRAME_SCALING or CloseVolume.
   * vtkRotationInvariantDeformation and vtkShapePreservingDeformation have tables,
   * vtkPoissonDeformation has none. Default: off.
   */
  vtkSetMacro(TabulateTurns, bool);
  vtkGetMacro(TabulateTurns, bool);
  vtkBooleanMacro(TabulateTurns, bool);
  ///@}

  ///@{
  /**
   * The largest angle that the table is to serve, in degrees, > 0. Where the method needs
   * too many fields for it, the table is shorter (GetTabulatedRange()). Default: 180.
   */
  vtkSetNumberMacro(TurnRange, 1e-3, 3600.0);
  vtkGetMacro(TurnRange, double);
  ///@}

  ///@{
  /**
   * How far points of the table may be from the solution, as a fraction of the bounding box's
   * diagonal. Default: 1e-5.
   */
  vtkSetNumberMacro(TurnTolerance, 1e-6, 1.0);
  vtkGetMacro(TurnTolerance, double);
  ///@}

  ///@{
  /**
   * Of the table that the last update was read from: the largest angle that it serves, in
   * degrees, and its largest distance to the solution as a fraction of the diagonal,
   * measured at that angle and at half of it. Both are 0 if the last update was solved for.
   */
  vtkGetMacro(TabulatedRange, double);
  vtkGetMacro(TabulationError, double);
  ///@}

protected:
  vtkFrameDeformation() = default;
  ~vtkFrameDeformation() override = default;

  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) final;

  /**
   * The method for a problem that is complete: FrameMethod() of a new deformer.
   */
  virtual cartan::DeformationMethod NewFrameMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) = 0;

  /**
   * A deformer with the volume correction and the arrays of this class.
   */
  cartan::DeformationMethod FrameMethod(std::unique_ptr<cartan::FrameDeformer> deformer);

  /**
   * SettingsServePieces(), and no volumes or shape distances, which are those of the whole. Of
   * volume corrections NEUTRAL_OFFSET serves.
   */
  bool FrameSettingsServePieces() const
  {
    return this->SettingsServePieces() && this->VolumeCorrection != FRAME_SCALING &&
      !this->CloseVolume && !this->GenerateVolumeArrays && !this->GenerateShapeDistance;
  }

  void AddSettings(cartan::ContentKey& settings) const override;
  bool NeedsTransforms() const override { return this->GenerateShapeDistance; }
  bool NeedsPositions() const override { return this->GenerateVolumeArrays; }
  void ForgetResults() override;

private:
  void CorrectVolume(cartan::FrameDeformer& deformer, cartan::FilterRun& run,
    const cartan::ExecutionContext& context);
  void ConfigureTable(cartan::FrameDeformer& deformer, double diagonal) const;
  bool UsesVolumeModel() const;
  std::shared_ptr<const cartan::VolumeModel> KeepPieceModel(
    cartan::FilterRun& run, const cartan::ExecutionContext& context);
  void AddVolumeArrays(const cartan::FrameDeformer& deformer, const cartan::DeformedSurface& result,
    cartan::FilterRun& run);

  int VolumeCorrection = NO_CORRECTION;
  bool CloseVolume = false;
  int PositionWeights = LIKE_FRAMES;
  bool GenerateVolumeArrays = false;
  bool GenerateShapeDistance = false;
  bool TabulateTurns = false;
  double TurnRange = 180.0;
  double TurnTolerance = 1e-5;
  double TabulatedRange = 0.0;
  double TabulationError = 0.0;
};

#endif
