// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFrameDeformation
 * @brief base of the deformations that change frames first, then positions
 *
 * What the methods share that find how each point's frame changes and then put
 * the surface together from the changed frames: the weights of the position
 * system and the preservation of volume.
 *
 * Volume is preserved in components that are closed and oriented outwards, and
 * in cavities inside of them, whose walls are oriented inwards; others get a
 * warning and no correction. The thickness of the body is measured
 * once per surface, with rays, and kept between motions.
 *
 * Arrays on request:
 * - `LocalDepth`, `LocalVolume`, `VolumeScale` (GenerateVolumeArrays): point
 *   arrays of one double each: how thick the body at rest is under the point
 *   (length units, 0 where unknown), how much of the deformed body's volume
 *   belongs to it (cubed length units, see vtkVolumeChange), and the factor of
 *   its frame by FRAME_SCALING (1 with any other correction).
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

#include "vtkSurfaceDeformation.h"

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
   * NEUTRAL_OFFSET bends the surface about the middle of the body under it: the
   * outside of a bend stretches, the inside shrinks. It costs next to nothing
   * and keeps most of the volume. FRAME_SCALING is the paper's correction by
   * curvature: frames are scaled and the surface is put together twice; it does
   * nothing for flat sides. NO_CORRECTION keeps lengths instead. Default: the
   * concrete class's.
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
   * displacement of free points that disturbs the shape least. One more solve.
   * Default: off.
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
   * The weights of the position system. LIKE_FRAMES: LaplacianWeights serves
   * both systems, with one factorization. The others are as in
   * LaplacianWeights; the 2007 paper spreads angles with cotangent weights and
   * puts the surface together with uniform ones. Default: LIKE_FRAMES.
   */
  void SetPositionWeights(int weights);
  vtkGetMacro(PositionWeights, int);
  void SetPositionWeightsToLikeFrames() { this->SetPositionWeights(LIKE_FRAMES); }
  void SetPositionWeightsToUniform() { this->SetPositionWeights(UNIFORM_POSITIONS); }
  void SetPositionWeightsToCotangent() { this->SetPositionWeights(COTANGENT_POSITIONS); }
  void SetPositionWeightsToMeanValue() { this->SetPositionWeights(MEAN_VALUE_POSITIONS); }
  ///@}

  ///@{
  /**
   * Adds `LocalDepth`, `LocalVolume` and `VolumeScale`, zero, NaN and one in
   * components that enclose no volume. Default: off.
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

protected:
  vtkFrameDeformation();
  ~vtkFrameDeformation() override;

  std::unique_ptr<cartan::SurfaceDeformer> NewDeformer(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) final;

  /**
   * The deformer for a problem that is complete.
   */
  virtual std::unique_ptr<cartan::SurfaceDeformer> NewFrameDeformer(
    const cartan::HandleProblem& problem, cartan::SolverBackend backend,
    const cartan::ExecutionContext& context) = 0;

  /**
   * Call it from overrides.
   */
  void ConfigureDeformer(
    cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context) override;

  bool NeedsTransforms() const override { return this->GenerateShapeDistance; }
  void DecorateOutput(const cartan::HandleProblem& problem, cartan::SurfaceDeformer& deformer,
    const cartan::DeformedSurface& result, vtkPolyData* output,
    const cartan::ExecutionContext& context) override;

private:
  class VolumeModels;

  std::unique_ptr<VolumeModels> Models;
  int VolumeCorrection = NO_CORRECTION;
  bool CloseVolume = false;
  int PositionWeights = LIKE_FRAMES;
  bool GenerateVolumeArrays = false;
  bool GenerateShapeDistance = false;
};

#endif
