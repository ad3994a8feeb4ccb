// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkShapePreservingDeformation
 * @brief large bends and twists in one step, preserving shape and volume
 *
 * Turns the frames of the surface by the rotation field of least energy between
 * the handles, which of all isometric deformations changes the curvatures
 * least, and reconstructs the surface from them.
 *
 * If all handles turn about the same axis (by their vtkHandleMotion or rotation
 * vectors; pinned handles fit any axis), the angle is a harmonic field and may
 * have any size: 480 degrees wind the surface by one and a third full turns.
 *
 * With different axes the field is computed in conformal coordinates of the
 * rotation group, for rotations below 360 degrees; more is an error. One
 * iteration needs no factorization and is close to the best field;
 * MaximumIterations > 1 refines it, with a warning if that does not converge.
 *
 * Scale and shear of the handles are blended linearly and applied before the
 * rotations.
 *
 * VolumeCorrection is NEUTRAL_OFFSET by default. The axis and the angle of a
 * motion matter, not only the final positions of the handle: a handle that is
 * only translated stretches the surface without turning it. With
 * ConstrainHandlePositions off, the positions of the ends of a bend follow from
 * the method.
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
#include "vtkSetNumberMacro.h" // For properties

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
   * The maximum number of iterations for the rotation field if axes differ; 1
   * is the linear solution. 3 to 10 suffice up to 120 degrees, 50 up to 270.
   * Each after the first costs a factorization. Default: 1.
   */
  vtkSetClampMacro(MaximumIterations, int, 1, 10000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /**
   * Iterations stop when the field changes by less than this fraction of its
   * largest value. Default: 1e-6.
   */
  vtkSetNumberMacro(Tolerance, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Of the last update: whether all rotations have the same axis; the number of
   * iterations (0 if so); the last relative change, 0 after a single iteration;
   * and whether the iteration converged (true if there was none).
   */
  vtkGetMacro(SharedAxis, bool);
  vtkGetMacro(NumberOfIterations, int);
  vtkGetMacro(Residual, double);
  vtkGetMacro(Converged, bool);
  ///@}

protected:
  vtkShapePreservingDeformation();
  ~vtkShapePreservingDeformation() override = default;

  bool SupportsPieces() const override
  {
    return this->FrameSettingsServePieces() && this->MaximumIterations == 1;
  }

  cartan::DeformationMethod NewFrameMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void ForgetResults() override;

private:
  int MaximumIterations = 1;
  double Tolerance = 1e-6;
  bool SharedAxis = true;
  int NumberOfIterations = 0;
  double Residual = 0.0;
  bool Converged = true;
};

#endif
