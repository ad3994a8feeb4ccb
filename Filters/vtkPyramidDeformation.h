// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPyramidDeformation
 * @brief moves handles and keeps the pyramid coordinates of the surface
 *
 * Pyramid coordinates describe the neighborhood of each point by the lengths of its edges
 * projected on the plane normal to the mean of its triangles' normals, the angles between
 * them, and the heights over that plane: whatever the place and the turn of the surface.
 * This filter finds the positions that change them least. It is nonlinear: starting from
 * the result of a linear method, iterations lower an energy, which never rises. Only the
 * positions of handle points count, so a handle that is only shifted turns the surface
 * around it; with the default InitialGuess the axes and angles of motions count too. A
 * reference for the linear methods.
 *
 * An iteration costs about as much as a motion of a linear method.
 *
 * Ports, arrays, errors: see vtkSurfaceDeformation. `FrameChange` and `RotationVector` are
 * those of the planes. With ConstrainHandlePositions off there is an error. With the
 * initial guess SHAPE_PRESERVING (or PREVIOUS_RESULT, the first time) rotations of 360
 * degrees or more about different axes are an error. A warning tells when iterations ended
 * before the tolerance was reached. Arrays of the output besides:
 * - `PyramidEnergy` (GeneratePyramidEnergy): point array of one double, each point's
 *   share of the energy, in squared length units; with MEAN_VALUE weights, which have the
 *   unit 1 / length, in length units.
 *
 * References: Sheffer, Kraevoy, Pyramid Coordinates for Morphing and Deformation, 3D Data
 * Processing, Visualization, and Transmission 2004. Sorkine, Differential Representations
 * for Mesh Processing, Computer Graphics Forum 25(4), 2006, section 4.3.
 *
 * @sa vtkAsRigidAsPossibleDeformation vtkSurfaceMorph vtkMarkHandle vtkHandleMotion
 */
#ifndef vtkPyramidDeformation_h
#define vtkPyramidDeformation_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceDeformation.h"

class VTKCARTAN_EXPORT vtkPyramidDeformation : public vtkSurfaceDeformation
{
public:
  static vtkPyramidDeformation* New();
  vtkTypeMacro(vtkPyramidDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkPyramidDeformation(const vtkPyramidDeformation&) = delete;
  void operator=(const vtkPyramidDeformation&) = delete;

  enum InitialGuessType
  {
    REST_SHAPE = 0,
    PREVIOUS_RESULT = 1,
    ROTATION_INVARIANT = 2,
    SHAPE_PRESERVING = 3
  };

  ///@{
  /**
   * Where the iteration starts. SHAPE_PRESERVING: as vtkShapePreservingDeformation, which
   * uses the handles' angles, full turns included. ROTATION_INVARIANT: as
   * vtkRotationInvariantDeformation, for rotations below 180 degrees. REST_SHAPE: the rest
   * shape with moved handles; needs the most iterations. PREVIOUS_RESULT: the result of
   * the last motion; fast if a handle is dragged in small steps, but the result depends on
   * the path. Default: SHAPE_PRESERVING.
   */
  vtkSetClampMacro(InitialGuess, int, REST_SHAPE, SHAPE_PRESERVING);
  vtkGetMacro(InitialGuess, int);
  void SetInitialGuessToRestShape() { this->SetInitialGuess(REST_SHAPE); }
  void SetInitialGuessToPreviousResult() { this->SetInitialGuess(PREVIOUS_RESULT); }
  void SetInitialGuessToRotationInvariant() { this->SetInitialGuess(ROTATION_INVARIANT); }
  void SetInitialGuessToShapePreserving() { this->SetInitialGuess(SHAPE_PRESERVING); }
  ///@}

  ///@{
  /**
   * The maximum number of iterations, >= 0; 0 returns the initial guess. Default: 200.
   */
  vtkSetClampMacro(MaximumIterations, int, 0, 100000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /**
   * Iterations stop when the energy decreases by less than this fraction, 0 to 1.
   * Default: 1e-4.
   */
  vtkSetNumberMacro(Tolerance, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Adds the point array `PyramidEnergy`. Default: off.
   */
  vtkSetMacro(GeneratePyramidEnergy, bool);
  vtkGetMacro(GeneratePyramidEnergy, bool);
  vtkBooleanMacro(GeneratePyramidEnergy, bool);
  ///@}

  ///@{
  /**
   * Of the last update: the number of iterations; the energy of the initial guess and of
   * the result, in squared length units for weights without unit; and whether the last
   * iteration's decrease fell below the tolerance.
   */
  vtkGetMacro(NumberOfIterations, int);
  vtkGetMacro(InitialEnergy, double);
  vtkGetMacro(FinalEnergy, double);
  vtkGetMacro(Converged, bool);
  ///@}

protected:
  vtkPyramidDeformation() = default;
  ~vtkPyramidDeformation() override = default;

  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void AddSettings(cartan::ContentKey& settings) const override;
  void ForgetResults() override;
  double ProgressBeforeMotion() const override { return 0.3; }

private:
  int InitialGuess = SHAPE_PRESERVING;
  int MaximumIterations = 200;
  double Tolerance = 1e-4;
  bool GeneratePyramidEnergy = false;
  int NumberOfIterations = 0;
  double InitialEnergy = 0.0;
  double FinalEnergy = 0.0;
  bool Converged = false;
};

#endif
