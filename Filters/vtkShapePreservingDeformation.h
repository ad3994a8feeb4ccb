// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShapePreservingDeformation
 * @brief large bends and twists in one step, shape and volume preserved
 *
 * Turns the frames of the surface by the rotation field of least energy between
 * the handles, which of all isometric deformations changes the curvatures
 * least, and puts the surface together from them.
 *
 * If all handles turn about the same axis (as their vtkHandleMotion or rotation
 * vectors say; pinned ones fit any), the angle is spread harmonically, and may
 * be of any size: 480 degrees wind the surface by one lap and a third.
 *
 * With different axes the field is found in conformal coordinates of the
 * rotation group, for rotations below 360 degrees; more is an error. One
 * iterate needs no factorization and is close to the best field;
 * MaximumIterations > 1 refines it, with a warning where that does not
 * converge.
 *
 * Scale and shear of a handle are blended linearly beneath the rotations.
 *
 * VolumeCorrection is NEUTRAL_OFFSET by default. The axis and the angle matter,
 * not only where the handles end up: a handle that is only translated stretches
 * the surface without turning it. With ConstrainHandlePositions off the ends of
 * a bend find their place by themselves.
 *
 * Ports, arrays, errors: see vtkSurfaceDeformation and vtkFrameDeformation.
 * Reference: Lipman, Cohen-Or, Gal, Levin, Volume and Shape Preservation via
 * Moving Frame Manipulation, ACM Transactions on Graphics 26(1), 2007.
 *
 * @sa vtkMarkHandle vtkHandleMotion vtkRotationInvariantDeformation
 */
#ifndef vtkShapePreservingDeformation_h
#define vtkShapePreservingDeformation_h

#include "vtkFrameDeformation.h"

class VTKCARTAN_EXPORT vtkShapePreservingDeformation : public vtkFrameDeformation
{
public:
  static vtkShapePreservingDeformation* New();
  vtkTypeMacro(vtkShapePreservingDeformation, vtkFrameDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkShapePreservingDeformation(const vtkShapePreservingDeformation&) = delete;
  void operator=(const vtkShapePreservingDeformation&) = delete;

  ///@{
  /**
   * The most iterates of the rotation field where axes differ; 1 is the linear
   * one. 3 to 10 suffice up to 120 degrees, 50 up to 270. Each costs a
   * factorization. Default: 1.
   */
  vtkSetClampMacro(MaximumIterations, int, 1, 10000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /**
   * Iterates stop when the field changes by less than this part of its largest
   * value. Default: 1e-6.
   */
  vtkSetClampMacro(Tolerance, double, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Of the last update: whether all rotations shared an axis; the number of
   * iterates (0 if so); the last relative change, 0 after a single iterate; and
   * whether the iteration converged (true where there was none).
   */
  vtkGetMacro(SharedAxis, bool);
  vtkGetMacro(NumberOfIterations, int);
  vtkGetMacro(Residual, double);
  vtkGetMacro(Converged, bool);
  ///@}

protected:
  vtkShapePreservingDeformation();
  ~vtkShapePreservingDeformation() override = default;

  std::unique_ptr<cartan::SurfaceDeformer> NewFrameDeformer(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void ConfigureDeformer(
    cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context) override;
  void DecorateOutput(const cartan::HandleProblem& problem, cartan::SurfaceDeformer& deformer,
    const cartan::DeformedSurface& result, vtkPolyData* output,
    const cartan::ExecutionContext& context) override;

private:
  int MaximumIterations = 1;
  double Tolerance = 1e-6;
  bool SharedAxis = true;
  int NumberOfIterations = 0;
  double Residual = 0.0;
  bool Converged = true;
};

#endif
