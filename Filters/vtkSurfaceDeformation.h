// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSurfaceDeformation
 * @brief base of the filters that deform a surface by moving handles
 *
 * A *handle* is a set of points that the user holds. The integer point array
 * `Handle` (see HandleArrayName and vtkMarkHandle) says which points: 0 is
 * free, k >= 1 belongs to handle k. Each handle follows its vtkHandleMotion; a
 * handle without one keeps its place, and that is how a part is pinned. The
 * free points between follow by the method of the concrete class. Free points
 * that no moving handle reaches through free points stay where they are and
 * cost nothing.
 *
 * Triangles are used as they are, other polygons are triangulated inside; the
 * output keeps the input's cells, its precision, all its attributes and its
 * points in no triangle. Point and cell normals, if present, are updated.
 *
 * What depends only on the surface, the weights and the set of handle points is
 * computed once and kept, for each block of a composite input too: moving a
 * handle that moved before factorizes nothing. A motion that is present counts
 * as moving even while it is the identity, so the first drag is as fast as the
 * next.
 *
 * Arrays on request: `FrameChange` (GenerateFrameChange), `RotationVector`
 * (GenerateRotationVector).
 *
 * Errors, each with an empty output: no triangles, points that are not finite,
 * edges or points that are not manifold, inconsistent orientation (the message
 * says how many and which); no handle array, or one that is not made of whole
 * numbers >= 0; a motion for a handle that no point has, or that is no map;
 * arrays of the wrong size or with NaN; a connected part that no handle holds.
 *
 * @sa vtkMarkHandle vtkHandleMotion vtkRotationInvariantDeformation
 */
#ifndef vtkSurfaceDeformation_h
#define vtkSurfaceDeformation_h

#include "vtkCartanModule.h" // For the export macro

#include "vtkPolyDataAlgorithm.h"

#include <memory> // For the private state
#include <string> // For array names

class vtkHandleMotion;
class vtkPolyData;

namespace cartan
{
class ExecutionContext;
class SurfaceDeformer;
enum class SolverBackend;
struct DeformedSurface;
struct HandleProblem;
}

class VTKCARTAN_EXPORT vtkSurfaceDeformation : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkSurfaceDeformation, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSurfaceDeformation(const vtkSurfaceDeformation&) = delete;
  void operator=(const vtkSurfaceDeformation&) = delete;

  ///@{
  /**
   * The point array that says which handle a point belongs to, one whole number
   * >= 0 per point. Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name);
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * The motion of handle `id` >= 1, from its place in the input. The object is
   * held: changing it modifies this filter. Setting nullptr removes it.
   */
  void SetHandleMotion(int id, vtkHandleMotion* motion);
  vtkHandleMotion* GetHandleMotion(int id) const;
  void RemoveHandleMotion(int id);
  void RemoveAllHandleMotions();
  ///@}

  ///@{
  /**
   * The same for user interfaces that have one motion at hand: ActiveMotion is
   * the motion of handle ActiveHandle, for which it replaces one that was set
   * with SetHandleMotion. Default: handle 1, no motion.
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
   * a row's handle must have no other motion.
   */
  void SetNumberOfMotionRows(int count);
  int GetNumberOfMotionRows() const;
  void SetMotionRow(int row, double id, double scaleX, double scaleY, double scaleZ, double angle,
    double axisX, double axisY, double axisZ, double centerX, double centerY, double centerZ,
    double translationX, double translationY, double translationZ);
  ///@}

  ///@{
  /**
   * Whether handles are held in position. Off: the frames of a moving handle
   * follow its motion and the surface finds its place from the pinned handles
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
   * - TargetPositionArrayName: 3 components, where the point goes, in length
   *   units.
   * - RotationVectorArrayName: 3 components, axis times angle in radians; the
   *   length may exceed 2 pi.
   * - TransformArrayName: 9 components, a 3 x 3 matrix row by row that the
   *   point's neighborhood is to go through. Not together with rotation
   *   vectors.
   *
   * A handle all of whose points keep position and orientation is pinned.
   */
  void SetTargetPositionArrayName(const std::string& name);
  std::string GetTargetPositionArrayName() const { return this->TargetPositionArrayName; }
  void SetRotationVectorArrayName(const std::string& name);
  std::string GetRotationVectorArrayName() const { return this->RotationVectorArrayName; }
  void SetTransformArrayName(const std::string& name);
  std::string GetTransformArrayName() const { return this->TransformArrayName; }
  ///@}

  ///@{
  /**
   * A point array of soft constraint weights w >= 0, read at handle points:
   * infinity holds exactly, 0 does not hold, between them w^2 times the squared
   * distance from the target joins the sum of squared residuals over both
   * directions of each edge. Empty (the default): all handle points are held
   * exactly.
   */
  void SetConstraintWeightArrayName(const std::string& name);
  std::string GetConstraintWeightArrayName() const { return this->ConstraintWeightArrayName; }
  ///@}

  ///@{
  /**
   * On: a finite weight w adds w^2 times the *mean* squared distance along the
   * handle's curve (the handle itself where it is a line of points, its border
   * where it is a region, whose inside then follows freely), so that with
   * cotangent LaplacianWeights it means the same on a coarse and on a fine mesh.
   * Off: it adds that of every point, as in Lipman et al., Volume and Shape
   * Preservation via Moving Frame Manipulation, 2007. Default: off.
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
   * How much an edge counts. UNIFORM: all alike, the papers' choice; misplaces
   * the deformation where triangles differ in size. COTANGENT: the finite
   * element weights, which see the surface rather than its triangulation.
   * MEAN_VALUE: like cotangent, but never negative (the symmetric part is
   * used). Default: COTANGENT.
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
    CHOLMOD = 2
  };

  ///@{
  /**
   * The sparse Cholesky factorization. AUTOMATIC_SOLVER: CHOLMOD if Cartan was
   * built with it, else Eigen. Default: AUTOMATIC_SOLVER.
   */
  vtkSetClampMacro(Solver, int, AUTOMATIC_SOLVER, CHOLMOD);
  vtkGetMacro(Solver, int);
  void SetSolverToAutomatic() { this->SetSolver(AUTOMATIC_SOLVER); }
  void SetSolverToEigen() { this->SetSolver(EIGEN); }
  void SetSolverToCholmod() { this->SetSolver(CHOLMOD); }
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

  /**
   * How many times this filter has factorized a matrix in its life.
   */
  int GetNumberOfFactorizations() const;

  /**
   * The points that the last update solved for; of a composite input, those of
   * the last block.
   */
  int GetNumberOfFreePoints() const;

  ///@{
  /**
   * Wall-clock seconds of the last update: to check and prepare what is kept
   * between motions (next to nothing if nothing changed), and for the motion
   * itself with the writing of the output.
   */
  double GetSetupTime() const;
  double GetMotionTime() const;
  ///@}

  /**
   * A box around the points of handle ActiveHandle in the input as it is now,
   * (xmin, xmax, ymin, ymax, zmin, zmax), for a widget that moves the handle: a
   * little larger than the handle, and no side shorter than a tenth of the
   * longest, so that flat handles can be grasped too. Around all points if none
   * belongs to the handle; the unit cube without input.
   */
  double* GetActiveHandleBounds() VTK_SIZEHINT(6);

  /**
   * Includes the motions.
   */
  vtkMTimeType GetMTime() override;

protected:
  vtkSurfaceDeformation();
  ~vtkSurfaceDeformation() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  /**
   * A deformer for the problem: what survives from one motion to the next.
   * Throws cartan::Error.
   */
  virtual std::unique_ptr<cartan::SurfaceDeformer> NewDeformer(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) = 0;

  /**
   * Hands over the parameters that may change from one motion to the next.
   * Throws cartan::Error.
   */
  virtual void ConfigureDeformer(
    cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context) = 0;

  /**
   * Whether DecorateOutput needs the transforms.
   */
  virtual bool NeedsTransforms() const { return false; }

  /**
   * Adds the arrays of the concrete method. Throws cartan::Error.
   */
  virtual void DecorateOutput(const cartan::HandleProblem& problem,
    cartan::SurfaceDeformer& deformer, const cartan::DeformedSurface& result, vtkPolyData* output,
    const cartan::ExecutionContext& context);

  /**
   * For the setters of parameters that go into NewDeformer.
   */
  void ForgetDeformers();

private:
  class Internals;

  void SetName(std::string& member, const std::string& name);

  std::unique_ptr<Internals> State;
  std::string HandleArrayName = "Handle";
  std::string TargetPositionArrayName;
  std::string RotationVectorArrayName;
  std::string TransformArrayName;
  std::string ConstraintWeightArrayName;
  int ActiveHandle = 1;
  double ActiveHandleBounds[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  bool ConstrainHandlePositions = true;
  bool ScaleConstraintWeights = false;
  int LaplacianWeights = COTANGENT;
  int Solver = AUTOMATIC_SOLVER;
  bool GenerateFrameChange = false;
  bool GenerateRotationVector = false;
};

#endif
