// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkAsRigidAsPossibleDeformation
 * @brief moves handles and keeps the rest as rigid as possible
 *
 * Computes positions and a rotation for each point such that the neighborhoods
 * of all points change their shape least. The problem is nonlinear: starting
 * from the result of a linear method, iterations fit rotations and solve for
 * positions in alternation; the energy never rises. Only the positions of
 * handle points count; with the default InitialGuess the axes and angles of
 * motions count too, so that a handle may turn by more than 180 degrees.
 *
 * - SPOKES: the edges at each point. Resists stretching, but hardly bending:
 *   large motions cause creases. Negative weights count as zero.
 * - SPOKES_AND_RIMS: all edges of the triangles at each point. Converges with
 *   finer triangles to an elastic membrane, keeps negative weights.
 * - SMOOTHED_ROTATIONS: SPOKES with a penalty on differences between the
 *   rotations of neighbors, as in a thick shell: smooth bends. Bending is its
 *   weight.
 *
 * An iteration costs about as much as a motion of a linear method. Scale and
 * shear of a motion move the handle's points; the rest of the surface resists
 * them.
 *
 * With ConstrainHandlePositions off, the rotations of moving handles are fixed
 * instead.
 *
 * Ports, arrays, errors: see vtkSurfaceDeformation. `FrameChange` and
 * `RotationVector` are those of the fitted rotations. With the initial guess
 * SHAPE_PRESERVING (or PREVIOUS_RESULT, the first time) rotations of 360
 * degrees or more about different axes are an error. Arrays of the output
 * besides:
 * - `RigidityEnergy` (GenerateRigidityEnergy): point array of one double, each
 *   point's share of the energy, in squared length units; with MEAN_VALUE weights,
 *   which have the unit 1 / length, in length units.
 *
 * References: Sorkine, Alexa, As-Rigid-As-Possible Surface Modeling, Symposium
 * on Geometry Processing 2007. Chao, Pinkall, Sanan, Schroeder, A Simple
 * Geometric Model for Elastic Deformations, ACM Transactions on Graphics 29(4),
 * 2010. Levi, Gotsman, Smooth Rotation Enhanced As-Rigid-As-Possible Mesh
 * Animation, IEEE Transactions on Visualization and Computer Graphics 21(2),
 * 2015.
 *
 * @sa vtkShapePreservingDeformation vtkMarkHandle vtkHandleMotion
 */
#ifndef vtkAsRigidAsPossibleDeformation_h
#define vtkAsRigidAsPossibleDeformation_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceDeformation.h"

class VTKCARTAN_EXPORT vtkAsRigidAsPossibleDeformation : public vtkSurfaceDeformation
{
public:
  static vtkAsRigidAsPossibleDeformation* New();
  vtkTypeMacro(vtkAsRigidAsPossibleDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkAsRigidAsPossibleDeformation(const vtkAsRigidAsPossibleDeformation&) = delete;
  void operator=(const vtkAsRigidAsPossibleDeformation&) = delete;

  enum EnergyType
  {
    SPOKES = 0,
    SPOKES_AND_RIMS = 1,
    SMOOTHED_ROTATIONS = 2
  };

  ///@{
  /**
   * What is minimized. Default: SPOKES.
   */
  vtkSetClampMacro(Energy, int, SPOKES, SMOOTHED_ROTATIONS);
  vtkGetMacro(Energy, int);
  void SetEnergyToSpokes() { this->SetEnergy(SPOKES); }
  void SetEnergyToSpokesAndRims() { this->SetEnergy(SPOKES_AND_RIMS); }
  void SetEnergyToSmoothedRotations() { this->SetEnergy(SMOOTHED_ROTATIONS); }
  ///@}

  ///@{
  /**
   * SMOOTHED_ROTATIONS: the weight of the differences between rotations, times the
   * squared thickness of the body that the free points bound; that of open sheets is six
   * edges. Without unit. 0 is SPOKES; from 1 on a surface bends like a thick plate; less
   * than the default keeps lengths better, in more iterations, and lets bodies crease.
   * Default: 0.03.
   */
  vtkSetNumberMacro(Bending, 0.0, 1e6);
  vtkGetMacro(Bending, double);
  ///@}

  enum InitialGuessType
  {
    REST_SHAPE = 0,
    PREVIOUS_RESULT = 1,
    ROTATION_INVARIANT = 2,
    SHAPE_PRESERVING = 3
  };

  ///@{
  /**
   * Where the iteration starts. SHAPE_PRESERVING: as
   * vtkShapePreservingDeformation, which uses the handles' angles, full turns
   * included. ROTATION_INVARIANT: as vtkRotationInvariantDeformation, for
   * rotations below 180 degrees. REST_SHAPE: the rest shape with moved handles;
   * needs the most iterations. PREVIOUS_RESULT: the result of the last motion;
   * fast if a handle is dragged in small steps, but the result depends on the
   * path. Default: SHAPE_PRESERVING.
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
   * The maximum number of iterations; 0 returns the initial guess. Default: 10.
   */
  vtkSetClampMacro(MaximumIterations, int, 0, 100000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /**
   * Iterations stop when the energy decreases by less than this fraction.
   * Default: 1e-4.
   */
  vtkSetNumberMacro(Tolerance, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Adds the point array `RigidityEnergy`. Default: off.
   */
  vtkSetMacro(GenerateRigidityEnergy, bool);
  vtkGetMacro(GenerateRigidityEnergy, bool);
  vtkBooleanMacro(GenerateRigidityEnergy, bool);
  ///@}

  ///@{
  /**
   * Of the last update: the number of iterations; the energy of the initial
   * guess and of the result, in squared length units for weights without unit; an
   * estimate, right to a factor of ten near the end, of the part of the energy that
   * the last iteration and all after it could gain; and whether the last iteration's
   * decrease fell below the tolerance.
   */
  vtkGetMacro(NumberOfIterations, int);
  vtkGetMacro(InitialEnergy, double);
  vtkGetMacro(FinalEnergy, double);
  vtkGetMacro(Residual, double);
  vtkGetMacro(Converged, bool);
  ///@}

protected:
  vtkAsRigidAsPossibleDeformation() = default;
  ~vtkAsRigidAsPossibleDeformation() override = default;

  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void AddSettings(cartan::ContentKey& settings) const override;
  void ForgetResults() override;
  double ProgressBeforeMotion() const override { return 0.3; }

private:
  int Energy = SPOKES;
  double Bending = 0.03;
  int InitialGuess = SHAPE_PRESERVING;
  int MaximumIterations = 10;
  double Tolerance = 1e-4;
  bool GenerateRigidityEnergy = false;
  int NumberOfIterations = 0;
  double InitialEnergy = 0.0;
  double FinalEnergy = 0.0;
  double Residual = 0.0;
  bool Converged = false;
};

#endif
