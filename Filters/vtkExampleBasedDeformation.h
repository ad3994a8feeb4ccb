// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkExampleBasedDeformation
 * @brief moves handles, and the surface as its example poses show
 *
 * Example poses of a surface tell how it moves: limbs bend at their joints, a cloth
 * folds. This filter finds the pose between and beyond the examples that reaches the
 * handles best, and the surface that has the handles in place and is nearest to it. The
 * shapes of triangles are interpolated linearly, their rotations by axes and angles, so
 * that half of a bend by 90 degrees is one by 45.
 *
 * Input 0: the surface at rest with handles (see vtkSurfaceDeformation). Input 1: the
 * examples, a connection for each, or time steps of one (ExamplesOverTime), with the points
 * and cells of input 0. Where they lie and how they are turned does not matter. Output: the
 * surface, with the field data array `ExampleWeights`, a double for each example: all 0 is the rest
 * pose, a single 1 that example.
 *
 * Only the positions of handles count. With ConstrainHandlePositions off there is an
 * error; others: no example, or one of other points or cells; with ExamplesOverTime, several
 * connections, or times that do not increase. An example counts where it
 * differs from the rest pose by turns below 180 degrees from triangle to triangle.
 *
 * References: Sumner, Zwicker, Gotsman, Popovic, Mesh-based Inverse Kinematics, ACM
 * SIGGRAPH 2005. Sorkine, Differential Representations for Mesh Processing, Computer
 * Graphics Forum 25(4), 2006, section 4.4.
 *
 * @sa vtkSurfaceMorph vtkMarkHandle vtkHandleMotion
 */
#ifndef vtkExampleBasedDeformation_h
#define vtkExampleBasedDeformation_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceDeformation.h"

class vtkAlgorithmOutput;
class vtkDoubleArray;

class VTKCARTAN_EXPORT vtkExampleBasedDeformation : public vtkSurfaceDeformation
{
public:
  static vtkExampleBasedDeformation* New();
  vtkTypeMacro(vtkExampleBasedDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkExampleBasedDeformation(const vtkExampleBasedDeformation&) = delete;
  void operator=(const vtkExampleBasedDeformation&) = delete;

  ///@{
  /**
   * The examples on port 1. A simulation's time steps are examples with ExamplesOverTime.
   */
  void AddExampleData(vtkPolyData* example);
  void AddExampleConnection(vtkAlgorithmOutput* example) { this->AddInputConnection(1, example); }
  void RemoveAllExamples() { this->SetInputConnection(1, nullptr); }
  ///@}

  ///@{
  /**
   * Whether the time steps of the one surface on port 1 are the examples, instead of the
   * surfaces there at the time of the update. Steps are read once, until the input changes.
   * Default: off.
   */
  vtkSetMacro(ExamplesOverTime, bool);
  vtkGetMacro(ExamplesOverTime, bool);
  vtkBooleanMacro(ExamplesOverTime, bool);
  ///@}

  ///@{
  /**
   * Whether the search for weights starts from those of the last motion: faster while a
   * handle is dragged, but where several poses fit alike the result depends on the path.
   * Off: it starts from the rest pose or the example that fits best. Default: off.
   */
  vtkSetMacro(WarmStart, bool);
  vtkGetMacro(WarmStart, bool);
  vtkBooleanMacro(WarmStart, bool);
  ///@}

  ///@{
  /**
   * Between the pose of the examples, 0, and the result of RigidMethod, 1: positions are
   * blended. Default: 0.
   */
  vtkSetNumberMacro(Rigidness, 0.0, 1.0);
  vtkGetMacro(Rigidness, double);
  ///@}

  enum RigidMethodType
  {
    ROTATION_INVARIANT = 0,
    SHAPE_PRESERVING = 1,
    SIMILARITY = 2,
    LAPLACIAN = 3,
    MULTIRESOLUTION = 4,
    POISSON = 5,
    AS_RIGID_AS_POSSIBLE = 6,
    PYRAMID = 7
  };

  ///@{
  /**
   * The method that Rigidness leads to, with the defaults of its filter, but without volume
   * correction, and for what the examples need: targets of points turn nothing, motions do. It
   * is prepared when it is first needed. Default: SHAPE_PRESERVING.
   */
  vtkSetClampMacro(RigidMethod, int, ROTATION_INVARIANT, PYRAMID);
  vtkGetMacro(RigidMethod, int);
  void SetRigidMethodToRotationInvariant() { this->SetRigidMethod(ROTATION_INVARIANT); }
  void SetRigidMethodToShapePreserving() { this->SetRigidMethod(SHAPE_PRESERVING); }
  void SetRigidMethodToSimilarity() { this->SetRigidMethod(SIMILARITY); }
  void SetRigidMethodToLaplacian() { this->SetRigidMethod(LAPLACIAN); }
  void SetRigidMethodToMultiresolution() { this->SetRigidMethod(MULTIRESOLUTION); }
  void SetRigidMethodToPoisson() { this->SetRigidMethod(POISSON); }
  void SetRigidMethodToAsRigidAsPossible() { this->SetRigidMethod(AS_RIGID_AS_POSSIBLE); }
  void SetRigidMethodToPyramid() { this->SetRigidMethod(PYRAMID); }
  ///@}

  ///@{
  /**
   * The maximum number of iterations, >= 0; 0 takes the start. Default: 30.
   */
  vtkSetClampMacro(MaximumIterations, int, 0, 100000);
  vtkGetMacro(MaximumIterations, int);
  ///@}

  ///@{
  /**
   * Iterations stop when no weight changes by more than this, >= 0. Default: 1e-6.
   */
  vtkSetNumberMacro(Tolerance, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  /**
   * The weights of the examples of the last update.
   */
  vtkDoubleArray* GetExampleWeights();

  ///@{
  /**
   * Of the last update: the distance of the surface from the span of the examples, as
   * a part of the surface's own size, both in the norm of edges (0: it is in the span);
   * the number of iterations; and whether they ended below the tolerance.
   */
  vtkGetMacro(SpanDistance, double);
  vtkGetMacro(NumberOfIterations, int);
  vtkGetMacro(Converged, bool);
  ///@}

protected:
  vtkExampleBasedDeformation();
  ~vtkExampleBasedDeformation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void FollowFirstRank(
    vtkInformation* request, vtkInformationVector** inputVector, bool hasEnded) override;
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void AddSettings(cartan::ContentKey& settings) const override;
  double ProgressBeforeMotion() const override { return 0.5; }

private:
  class Internals;

  bool CollectExamples(cartan::FilterRun& run);

  std::unique_ptr<Internals> Own;
  bool ExamplesOverTime = false;
  bool WarmStart = false;
  double Rigidness = 0.0;
  int RigidMethod = SHAPE_PRESERVING;
  int MaximumIterations = 30;
  double Tolerance = 1e-6;
  double SpanDistance = 0.0;
  int NumberOfIterations = 0;
  bool Converged = false;
};

#endif
