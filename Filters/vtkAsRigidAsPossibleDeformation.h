// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkAsRigidAsPossibleDeformation
 * @brief moves handles and keeps the rest as rigid as they allow
 *
 * Gives each point a rotation, and finds the positions and rotations for which
 * the neighborhoods of all points change their shape least. This is not
 * linear: a guess by a linear method is improved in turns of fitting rotations
 * and solving for positions, none of which raises the energy. Handles count by
 * where their points go, and how they turned is seen from that; with the default
 * InitialGuess their axes and angles count too, so that a handle may turn by
 * more than 180 degrees.
 *
 * - SPOKES: the edges at each point. Stretches little, resists bending hardly
 *   at all: creases where much is asked. Negative weights count as zero.
 * - SPOKES_AND_RIMS: all edges of the triangles at each point. Converges with
 *   finer triangles to an elastic membrane, keeps negative weights.
 * - SMOOTHED_ROTATIONS: SPOKES, and the rotations of neighbors should agree,
 *   as in a thick shell: smooth bends. Bending says how much. Converges more
 *   slowly, the more so the finer the surface.
 *
 * An iteration costs about as much as a motion of a linear method. Scale and
 * shear of a handle's motion move its points and are resisted beyond.
 *
 * With ConstrainHandlePositions off, moving handles are held in rotation
 * instead.
 *
 * Ports, arrays, errors: see vtkSurfaceDeformation. `FrameChange` and
 * `RotationVector` are of the rotations that were found. With the initial guess
 * SHAPE_PRESERVING (or PREVIOUS_RESULT, the first time) rotations of 360 degrees
 * or more about different axes are an error. Arrays of the output besides:
 * - `RigidityEnergy` (GenerateRigidityEnergy): point array of one double, each
 *   point's share of the energy, in squared length units.
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
  void SetEnergy(int energy);
  vtkGetMacro(Energy, int);
  void SetEnergyToSpokes() { this->SetEnergy(SPOKES); }
  void SetEnergyToSpokesAndRims() { this->SetEnergy(SPOKES_AND_RIMS); }
  void SetEnergyToSmoothedRotations() { this->SetEnergy(SMOOTHED_ROTATIONS); }
  ///@}

  ///@{
  /**
   * SMOOTHED_ROTATIONS: the weight of the differences between rotations, times
   * the area of the free points. Without unit. 0 is SPOKES; from 0.1 on a
   * surface bends like a thick plate. Default: 0.02.
   */
  vtkSetClampMacro(Bending, double, 0.0, 1e6);
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
   * vtkShapePreservingDeformation, which takes the handles' angles as they are,
   * laps included. ROTATION_INVARIANT: as vtkRotationInvariantDeformation, for
   * rotations below 180 degrees. REST_SHAPE: only the handles moved; the most
   * iterations. PREVIOUS_RESULT: where the last motion ended; quick where a
   * handle is dragged by little at a time, but the result depends on the way.
   * Default: SHAPE_PRESERVING.
   */
  void SetInitialGuess(int guess);
  vtkGetMacro(InitialGuess, int);
  void SetInitialGuessToRestShape() { this->SetInitialGuess(REST_SHAPE); }
  void SetInitialGuessToPreviousResult() { this->SetInitialGuess(PREVIOUS_RESULT); }
  void SetInitialGuessToRotationInvariant() { this->SetInitialGuess(ROTATION_INVARIANT); }
  void SetInitialGuessToShapePreserving() { this->SetInitialGuess(SHAPE_PRESERVING); }
  ///@}

  ///@{
  /**
   * The most iterations; 0 leaves the initial guess. Default: 10.
   */
  vtkSetClampMacro(MaximumIterations, int, 0, 100000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /**
   * Iterations stop when one lowers the energy by less than this part of it.
   * Default: 1e-4.
   */
  vtkSetClampMacro(Tolerance, double, 0.0, 1.0);
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
   * guess and of the result, in squared length units for weights without unit;
   * and whether the last iteration's decrease fell below the tolerance.
   */
  vtkGetMacro(NumberOfIterations, int);
  vtkGetMacro(InitialEnergy, double);
  vtkGetMacro(FinalEnergy, double);
  vtkGetMacro(Converged, bool);
  ///@}

protected:
  vtkAsRigidAsPossibleDeformation() = default;
  ~vtkAsRigidAsPossibleDeformation() override = default;

  std::unique_ptr<cartan::SurfaceDeformer> NewDeformer(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void ConfigureDeformer(
    cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context) override;
  void DecorateOutput(const cartan::HandleProblem& problem, cartan::SurfaceDeformer& deformer,
    const cartan::DeformedSurface& result, vtkPolyData* output,
    const cartan::ExecutionContext& context) override;

private:
  int Energy = SPOKES;
  double Bending = 0.02;
  int InitialGuess = SHAPE_PRESERVING;
  int MaximumIterations = 10;
  double Tolerance = 1e-4;
  bool GenerateRigidityEnergy = false;
  int NumberOfIterations = 0;
  double InitialEnergy = 0.0;
  double FinalEnergy = 0.0;
  bool Converged = false;
};

#endif
