// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSurfaceDeformation
 * @brief base of the filters that deform a surface by moving handles
 *
 * A *handle* is a set of points that the user fixes or moves. In the integer
 * point array `Handle` (see HandleArrayName and vtkMarkHandle), 0 is a free
 * point and k >= 1 a point of handle k. Each handle follows its
 * vtkHandleMotion; a handle without one is pinned. The method of the concrete
 * class computes the free points. Free points that are separated from all
 * moving handles by pinned points stay in place and cost no time.
 *
 * Polygons with more than three corners are triangulated internally; the output
 * keeps the input's cells, its precision, all its attributes and its points in
 * no triangle. Point and cell normals, if present, are updated.
 *
 * What depends only on the surface, the weights and the set of handle points is
 * computed once and kept, for each block of a composite input too: moving a
 * handle again needs no factorization. A handle with a motion counts as moving
 * even if the motion is the identity, so the first drag is as fast as the next.
 *
 * Arrays on request: `FrameChange` (GenerateFrameChange), `RotationVector`
 * (GenerateRotationVector).
 *
 * Errors, each with an empty output: no triangles, points that are not finite,
 * edges or points that are not manifold, inconsistent orientation (the message
 * says how many and which); no handle array, or one that is not made of whole
 * numbers >= 0; a motion for a handle without points, or an invalid motion;
 * arrays of the wrong size or with NaN; a component without a handle.
 *
 * @sa vtkMarkHandle vtkHandleMotion vtkRotationInvariantDeformation
 */
#ifndef vtkSurfaceDeformation_h
#define vtkSurfaceDeformation_h

#include "vtkSurfaceFilter.h"

#include <memory> // For the private state
#include <string> // For array names
#include <vector> // For handle ids

class vtkDoubleArray;
class vtkHandleMotion;
class vtkPolyData;

namespace cartan
{
class ContentKey;
class ExecutionContext;
enum class ErrorCode;
enum class SolverBackend;
struct DeformationInput;
struct DeformationMethod;
struct HandleArrays;
struct HandleProblem;
struct HandleTargets;
struct Handles;
struct Preparation;
struct Surface;
}

class VTKCARTAN_EXPORT vtkSurfaceDeformation : public vtkSurfaceFilter
{
public:
  vtkTypeMacro(vtkSurfaceDeformation, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSurfaceDeformation(const vtkSurfaceDeformation&) = delete;
  void operator=(const vtkSurfaceDeformation&) = delete;

  ///@{
  /**
   * The point array that says which handle a point belongs to, one whole number
   * >= 0 per point. Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * The motion of handle `id` >= 1, from its place in the input. The filter
   * keeps a reference: changing the object modifies this filter. Setting
   * nullptr removes it.
   */
  void SetHandleMotion(int id, vtkHandleMotion* motion);
  vtkHandleMotion* GetHandleMotion(int id) const;
  void RemoveHandleMotion(int id);
  void RemoveAllHandleMotions();
  ///@}

  ///@{
  /**
   * The same for user interfaces that edit one motion at a time: ActiveMotion
   * is the motion of handle ActiveHandle while both are set, in place of one
   * that was set with SetHandleMotion. Other handles keep their motions,
   * whichever is active. Default: handle 1, no motion.
   */
  void SetActiveHandle(int id);
  vtkGetMacro(ActiveHandle, int);
  void SetActiveMotion(vtkHandleMotion* motion);
  vtkHandleMotion* GetActiveMotion() const;
  ///@}

  ///@{
  /**
   * A table of further motions, a row of 14 numbers for each: handle id; scale
   * x, y, z; angle in degrees; axis x, y, z; center x, y, z; translation x, y,
   * z, as in vtkHandleMotion's axis-angle mode. Rows serve user interfaces;
   * a row's handle must have no other motion. At most 100000 rows.
   */
  void SetNumberOfMotionRows(int count);
  int GetNumberOfMotionRows() const;
  void SetMotionRow(int row, double id, double scaleX, double scaleY, double scaleZ, double angle,
    double axisX, double axisY, double axisZ, double centerX, double centerY, double centerZ,
    double translationX, double translationY, double translationZ);
  ///@}

  ///@{
  /**
   * Whether the positions of moving handles are fixed. Off: only the frames of
   * a moving handle follow its motion; positions follow from the pinned handles
   * alone, as in Lipman et al., Volume and Shape Preservation via Moving Frame
   * Manipulation, 2007. Default: on.
   */
  vtkSetMacro(ConstrainHandlePositions, bool);
  vtkGetMacro(ConstrainHandlePositions, bool);
  vtkBooleanMacro(ConstrainHandlePositions, bool);
  ///@}

  ///@{
  /**
   * Instead of one motion per handle, point arrays with a value for each of its
   * points; they are read at the points of handles that have no
   * vtkHandleMotion. Empty names (the default) are not used.
   *
   * - TargetPositionArrayName: 3 components, the target position of the point,
   *   in length units.
   * - RotationVectorArrayName: 3 components, axis times angle in radians; the
   *   length may exceed 2 pi.
   * - TransformArrayName: 9 components, a 3 x 3 matrix row by row that
   *   transforms the point's neighborhood. Cannot be combined with rotation
   *   vectors.
   *
   * A handle is pinned if all its points keep position and orientation.
   */
  void SetTargetPositionArrayName(const std::string& name)
  {
    this->SetMember(this->TargetPositionArrayName, name);
  }
  std::string GetTargetPositionArrayName() const { return this->TargetPositionArrayName; }
  void SetRotationVectorArrayName(const std::string& name)
  {
    this->SetMember(this->RotationVectorArrayName, name);
  }
  std::string GetRotationVectorArrayName() const { return this->RotationVectorArrayName; }
  void SetTransformArrayName(const std::string& name)
  {
    this->SetMember(this->TransformArrayName, name);
  }
  std::string GetTransformArrayName() const { return this->TransformArrayName; }
  ///@}

  ///@{
  /**
   * A point array of soft constraint weights w >= 0, read at handle points:
   * infinity fixes a point exactly, 0 leaves it free; other weights w add w^2
   * times the squared distance from the target to the sum of squared residuals
   * over both directions of each edge. Empty (the default): all handle points
   * are fixed exactly.
   */
  void SetConstraintWeightArrayName(const std::string& name)
  {
    this->SetMember(this->ConstraintWeightArrayName, name);
  }
  std::string GetConstraintWeightArrayName() const { return this->ConstraintWeightArrayName; }
  ///@}

  ///@{
  /**
   * On: a finite weight w adds w^2 times the *mean* squared distance along the
   * handle's curve (a line of points, or the border of a region, whose inside
   * is then free), so that with cotangent LaplacianWeights it has the same
   * effect on a coarse and on a fine mesh. Off: it adds w^2 times the squared
   * distance of every point, as in Lipman et al., Volume and Shape Preservation
   * via Moving Frame Manipulation, 2007. Default: off.
   */
  vtkSetMacro(ScaleConstraintWeights, bool);
  vtkGetMacro(ScaleConstraintWeights, bool);
  vtkBooleanMacro(ScaleConstraintWeights, bool);
  ///@}

  enum LaplacianWeightsType
  {
    UNIFORM = 0,
    COTANGENT = 1,
    MEAN_VALUE = 2
  };

  ///@{
  /**
   * The weight of each edge. UNIFORM: all edges count the same, the papers'
   * choice; misplaces the deformation where triangles differ in size.
   * COTANGENT: the finite element weights; the result depends on the surface
   * rather than on its triangulation. MEAN_VALUE: like cotangent, but never
   * negative (the symmetric part is used). Default: COTANGENT.
   */
  vtkSetClampMacro(LaplacianWeights, int, UNIFORM, MEAN_VALUE);
  vtkGetMacro(LaplacianWeights, int);
  void SetLaplacianWeightsToUniform() { this->SetLaplacianWeights(UNIFORM); }
  void SetLaplacianWeightsToCotangent() { this->SetLaplacianWeights(COTANGENT); }
  void SetLaplacianWeightsToMeanValue() { this->SetLaplacianWeights(MEAN_VALUE); }
  ///@}

  enum SolverType
  {
    AUTOMATIC_SOLVER = 0,
    EIGEN = 1,
    CHOLMOD = 2,
    CONJUGATE_GRADIENTS = 3
  };

  ///@{
  /**
   * What solves the sparse systems. EIGEN and CHOLMOD: a Cholesky factorization.
   * CONJUGATE_GRADIENTS: iterations with hypre's multigrid to a relative residual of 1e-10,
   * for methods with a Laplacian system (the others give an error); a third of the memory,
   * and slower motions. AUTOMATIC_SOLVER: CHOLMOD if Cartan was built with it, else Eigen;
   * for Laplacian systems of more than four million free points CONJUGATE_GRADIENTS if
   * Cartan was built with hypre. Default: AUTOMATIC_SOLVER.
   */
  vtkSetClampMacro(Solver, int, AUTOMATIC_SOLVER, CONJUGATE_GRADIENTS);
  vtkGetMacro(Solver, int);
  void SetSolverToAutomatic() { this->SetSolver(AUTOMATIC_SOLVER); }
  void SetSolverToEigen() { this->SetSolver(EIGEN); }
  void SetSolverToCholmod() { this->SetSolver(CHOLMOD); }
  void SetSolverToConjugateGradients() { this->SetSolver(CONJUGATE_GRADIENTS); }
  ///@}

  ///@{
  /**
   * Adds the point array `FrameChange`: the Frobenius norm of the change of each
   * point's frame, |R - I|; 0 where nothing turns, at most sqrt(8) for
   * rotations. Default: off.
   */
  vtkSetMacro(GenerateFrameChange, bool);
  vtkGetMacro(GenerateFrameChange, bool);
  vtkBooleanMacro(GenerateFrameChange, bool);
  ///@}

  ///@{
  /**
   * Adds the point array `RotationVector`: axis times angle in radians of the
   * rotation that each point's frame goes through, 3 components. Default: off.
   */
  vtkSetMacro(GenerateRotationVector, bool);
  vtkGetMacro(GenerateRotationVector, bool);
  vtkBooleanMacro(GenerateRotationVector, bool);
  ///@}

  ///@{
  /**
   * Surfaces of up to so many points are deformed twice, the second time with all
   * points moved by 1e-12 of the size and motions turned by less, and a warning says where
   * that changes the result by more than 1e-5 of the size: rounding decides there. It takes the
   * time and memory of a deformation. 0: never; nor are surfaces that stay in pieces on several
   * ranks. Default: 5000.
   */
  vtkSetClampMacro(RoundingCheckLimit, int, 0, VTK_INT_MAX);
  vtkGetMacro(RoundingCheckLimit, int);
  ///@}

  /**
   * The number of matrices that this filter has factorized since it was
   * created, without those of the check for rounding.
   */
  int GetNumberOfFactorizations() const;

  /**
   * The number of free points that the last update solved for, without those that
   * triangles carry because they are at slivers; of a composite input, those of
   * the last block.
   */
  int GetNumberOfFreePoints() const;

  ///@{
  /**
   * Wall-clock seconds of the last update: for checks and for what is kept
   * between motions (negligible if nothing changed), and for the motion itself
   * with the writing of the output.
   */
  double GetSetupTime() const;
  double GetMotionTime() const;
  ///@}

  /**
   * A box around the points of handle ActiveHandle in the input as it is now,
   * (xmin, xmax, ymin, ymax, zmin, zmax), for a widget that moves the handle: a
   * little larger than the handle, and no side shorter than a tenth of the
   * longest, so that flat handles can be grabbed too. If no point belongs to the
   * handle, or without input, the box is none: (1, -1, 1, -1, 1, -1).
   */
  double* GetActiveHandleBounds() VTK_SIZEHINT(6);

  /**
   * The same for all handles: for each, with increasing ids, its id and the six
   * numbers of its box, of at most the first 1000 handles. It needs no update, so
   * that user interfaces show handles before they move.
   */
  vtkDoubleArray* GetHandleBounds();

  /**
   * Includes the motions.
   */
  vtkMTimeType GetMTime() override;

protected:
  vtkSurfaceDeformation();
  ~vtkSurfaceDeformation() override;

  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  bool MovesAlone() const override { return true; }

  /**
   * Whether these settings serve surfaces in pieces, for methods whose SupportsPieces()
   * depends on more than that.
   */
  bool SettingsServePieces() const;

  /**
   * The method for a problem: what survives from one motion to the next. Throws
   * cartan::Error.
   */
  virtual cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) = 0;

  /**
   * Throws cartan::Error for targets that the method cannot follow, before it is
   * prepared. Here: accepts all.
   */
  virtual void RequireTargets(const cartan::HandleTargets&) const {}

  /**
   * Adds all parameters that NewMethod depends on.
   */
  virtual void AddSettings(cartan::ContentKey& settings) const;

  /**
   * Whether the method's arrays need the transforms.
   */
  virtual bool NeedsTransforms() const { return false; }

  /**
   * Whether they need the positions in the precision of the computation.
   */
  virtual bool NeedsPositions() const { return false; }

  /**
   * Where the progress of an update stands when the motion itself begins, in (0.1,
   * 0.9): a method that iterates leaves most of the way to the motion. Default:
   * 0.8.
   */
  virtual double ProgressBeforeMotion() const { return 0.8; }

private:
  class Internals;

  vtkDataObject* InputIfAny();
  void Deform(cartan::FilterRun& run);
  std::string DescribeRemedy(cartan::ErrorCode code) const;
  cartan::HandleProblem MakeProblem(cartan::FilterRun& run, const cartan::DeformationInput& read,
    const cartan::Handles& handles, std::vector<int> moving);
  std::shared_ptr<cartan::Preparation> Prepare(cartan::FilterRun& run,
    const cartan::DeformationInput& read, const cartan::Handles& handles,
    const std::vector<int>& moving, cartan::ContentKey key);
  std::shared_ptr<cartan::HandleArrays> KeepHandleArrays(cartan::FilterRun& run,
    const cartan::Surface& surface, const cartan::Handles& handles, cartan::ContentKey key) const;

  std::unique_ptr<Internals> State;
  std::string HandleArrayName = "Handle";
  std::string TargetPositionArrayName;
  std::string RotationVectorArrayName;
  std::string TransformArrayName;
  std::string ConstraintWeightArrayName;
  int ActiveHandle = 1;
  double ActiveHandleBounds[6] = { 1.0, -1.0, 1.0, -1.0, 1.0, -1.0 };
  bool ConstrainHandlePositions = true;
  bool ScaleConstraintWeights = false;
  int LaplacianWeights = COTANGENT;
  int Solver = AUTOMATIC_SOLVER;
  int RoundingCheckLimit = 5000;
  bool GenerateFrameChange = false;
  bool GenerateRotationVector = false;
};

#endif
