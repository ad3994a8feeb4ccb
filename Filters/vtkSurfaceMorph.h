// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSurfaceMorph
 * @brief turns surfaces of one connectivity, as key frames, into motion
 *
 * Key frames are two or more surfaces with the same points and cells: each added
 * with AddInputConnection() or AddInputData(), at even parameters from 0 to 1; or
 * the time steps of one input, which makes this a temporal interpolator for
 * surfaces that turn. In between, local shape is interpolated instead of
 * coordinates, linearly between two key frames and by monotone cubics through
 * more, so that what turns does not shrink.
 *
 * The output is the surface at one parameter. It has time steps: over [0, 1], or
 * over those of the input, StepsBetweenKeyFrames for each pair of key frames. A
 * request for a time gives the surface then (while FollowTime is on); without
 * one, Parameter says where.
 *
 * Each component is placed where a rigid interpolation of the key frames has it,
 * so that the key frames are met exactly as given; see Placement. Floating-point
 * point data that all key frames have are interpolated, normals are computed
 * anew. Other point data, cell data, and the cells are those of the first key
 * frame, as is the precision of points.
 *
 * At most four key frames are used at a time, two before and two after: further
 * ones have no influence. What is computed from them is kept until they change,
 * by value.
 *
 * Errors, each with an empty output: fewer than two key frames; key frames that
 * differ in their points' number or their cells, or are no manifolds, not
 * consistently oriented or not finite; a composite input; what the methods
 * refuse, see Method.
 *
 * References: Lipman, Sorkine, Levin, Cohen-Or, Linear Rotation-invariant
 * Coordinates for Meshes, 2005, section 4.1; Bose, O'Rourke, Shu, Wuhrer,
 * Isometric Morphing of Triangular Meshes, 2008; Sorkine, Differential
 * Representations for Mesh Processing, 2006, section 4.4.
 *
 * @sa vtkVolumeChange vtkCurvatureError vtkMarkHandle
 */
#ifndef vtkSurfaceMorph_h
#define vtkSurfaceMorph_h

#include "vtkCartanModule.h" // For the export macro

#include "vtkPolyDataAlgorithm.h"

#include <memory>
#include <string>
#include <vector>

class VTKCARTAN_EXPORT vtkSurfaceMorph : public vtkPolyDataAlgorithm
{
public:
  static vtkSurfaceMorph* New();
  vtkTypeMacro(vtkSurfaceMorph, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSurfaceMorph(const vtkSurfaceMorph&) = delete;
  void operator=(const vtkSurfaceMorph&) = delete;

  enum MethodType
  {
    DISCRETE_FORMS = 0,
    ISOMETRIC = 1,
    DEFORMATION_GRADIENT = 2,
    LINEAR = 3
  };

  ///@{
  /**
   * DISCRETE_FORMS: the one-rings of points; for any number of laps. Needs a
   * normal at each point. ISOMETRIC: edge lengths and the angles between
   * triangles; exactly so, and in linear time, on surfaces without inner points,
   * such as strips. Needs edges of some length. DEFORMATION_GRADIENT: how each
   * triangle turns and stretches; without iteration, for turns of less than a
   * lap against the mean of the surface. Needs a triangle with area in each
   * component. LINEAR: coordinates, to compare with. Default: DISCRETE_FORMS.
   */
  vtkSetClampMacro(Method, int, DISCRETE_FORMS, LINEAR);
  vtkGetMacro(Method, int);
  void SetMethodToDiscreteForms() { this->SetMethod(DISCRETE_FORMS); }
  void SetMethodToIsometric() { this->SetMethod(ISOMETRIC); }
  void SetMethodToDeformationGradient() { this->SetMethod(DEFORMATION_GRADIENT); }
  void SetMethodToLinear() { this->SetMethod(LINEAR); }
  ///@}

  ///@{
  /**
   * Where between the first key frame, 0, and the last one, 1, the surface is
   * wanted. Beyond, it goes on as it does at the ends, as far as lengths stay
   * positive. Used where no time is requested or FollowTime is off. Default: 0.
   */
  vtkSetMacro(Parameter, double);
  vtkGetMacro(Parameter, double);
  ///@}

  ///@{
  /**
   * Whether a time that is requested, as by an animation, takes the place of
   * Parameter. Off: the output has no time steps. Default: on.
   */
  vtkSetMacro(FollowTime, bool);
  vtkGetMacro(FollowTime, bool);
  vtkBooleanMacro(FollowTime, bool);
  ///@}

  ///@{
  /**
   * Into how many time steps the way from one key frame to the next is divided.
   * Default: 10.
   */
  vtkSetClampMacro(StepsBetweenKeyFrames, int, 1, 100000);
  vtkGetMacro(StepsBetweenKeyFrames, int);
  ///@}

  enum PlacementType
  {
    RIGID_INTERPOLATION = 0,
    PINNED_HANDLE = 1
  };

  ///@{
  /**
   * RIGID_INTERPOLATION: centers of components move on a line from one key frame
   * to the next (on a smooth path through more), and what is left of turning goes
   * at an even rate about one axis, by less than half a turn. PINNED_HANDLE: so
   * that the points with a value above 0 in HandleArrayName of the first key
   * frame come to lie as well as they can, rigidly, where the interpolation has
   * them; if all key frames agree there, they stay. Components without such
   * points, and LINEAR, which has places of its own: as without. Default:
   * RIGID_INTERPOLATION.
   */
  vtkSetClampMacro(Placement, int, RIGID_INTERPOLATION, PINNED_HANDLE);
  vtkGetMacro(Placement, int);
  void SetPlacementToRigidInterpolation() { this->SetPlacement(RIGID_INTERPOLATION); }
  void SetPlacementToPinnedHandle() { this->SetPlacement(PINNED_HANDLE); }
  ///@}

  ///@{
  /**
   * The point array that PINNED_HANDLE reads. Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name);
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * Closes the volume of each component on that between the key frames, by the
   * smoothest displacement that does. Components that are open, enclose
   * nothing, or are turned inside out against the first one in a key frame are
   * left alone with a warning. Default: off.
   */
  vtkSetMacro(CloseVolume, bool);
  vtkGetMacro(CloseVolume, bool);
  vtkBooleanMacro(CloseVolume, bool);
  ///@}

  enum TransitionInterpolationType
  {
    ROTATIONS = 0,
    FORMS = 1
  };

  ///@{
  /**
   * DISCRETE_FORMS: whether the turn from a point's frame to its neighbor's is
   * interpolated as a rotation, or follows from the interpolated forms, as in the
   * 2005 paper, at somewhat larger errors in lengths. Default: ROTATIONS.
   */
  vtkSetClampMacro(TransitionInterpolation, int, ROTATIONS, FORMS);
  vtkGetMacro(TransitionInterpolation, int);
  void SetTransitionInterpolationToRotations() { this->SetTransitionInterpolation(ROTATIONS); }
  void SetTransitionInterpolationToForms() { this->SetTransitionInterpolation(FORMS); }
  ///@}

  enum FrameSolverType
  {
    ROTATION_AVERAGING = 0,
    CONJUGATE_GRADIENTS = 1,
    DIRECT = 2
  };

  ///@{
  /**
   * DISCRETE_FORMS: how frames are found. ROTATION_AVERAGING: the rotations that
   * fit best, with one factorization for all parameters. CONJUGATE_GRADIENTS,
   * DIRECT: the 2005 paper's linear system of three unknowns per point, projected
   * on rotations; iterated from the former, or factorized for each parameter.
   * They agree with each other, and nearly with the former. Default:
   * ROTATION_AVERAGING.
   */
  vtkSetClampMacro(FrameSolver, int, ROTATION_AVERAGING, DIRECT);
  vtkGetMacro(FrameSolver, int);
  void SetFrameSolverToRotationAveraging() { this->SetFrameSolver(ROTATION_AVERAGING); }
  void SetFrameSolverToConjugateGradients() { this->SetFrameSolver(CONJUGATE_GRADIENTS); }
  void SetFrameSolverToDirect() { this->SetFrameSolver(DIRECT); }
  ///@}

  enum StitchingType
  {
    ALL_HINGES = 0,
    TREE = 1,
    TREE_AVERAGE = 2
  };

  ///@{
  /**
   * ISOMETRIC, on surfaces with inner points, where lengths and angles do not fit
   * together exactly. ALL_HINGES: triangles turn so that all angles fit best, and
   * are then stitched. TREE: they turn as along a tree through the hinges that
   * turn least, and are then stitched. TREE_AVERAGE: the 2008 paper's; each point
   * at the mean of the places that its triangles on the tree give it. Default:
   * ALL_HINGES.
   */
  vtkSetClampMacro(Stitching, int, ALL_HINGES, TREE_AVERAGE);
  vtkGetMacro(Stitching, int);
  void SetStitchingToAllHinges() { this->SetStitching(ALL_HINGES); }
  void SetStitchingToTree() { this->SetStitching(TREE); }
  void SetStitchingToTreeAverage() { this->SetStitching(TREE_AVERAGE); }
  ///@}

  ///@{
  /**
   * ISOMETRIC: rounds that bring edges closer to their lengths after stitching.
   * Each factorizes a matrix of three unknowns per point. Default: 0.
   */
  vtkSetClampMacro(LengthPolish, int, 0, 100);
  vtkGetMacro(LengthPolish, int);
  ///@}

  /**
   * Steps that the last surface took to iterate; 0 where nothing is iterated.
   */
  vtkGetMacro(NumberOfIterations, int);

  /**
   * How many key frames there were, in all, at the last update.
   */
  vtkGetMacro(NumberOfKeyFrames, int);

  ///@{
  /**
   * Seconds that the last update took to prepare the key frames (0 if they were
   * kept) and to find the surface.
   */
  vtkGetMacro(SetupTime, double);
  vtkGetMacro(EvaluationTime, double);
  ///@}

protected:
  vtkSurfaceMorph();
  ~vtkSurfaceMorph() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  class Internals;

  double RequestedParameter(vtkInformation* output) const;
  void Prepare(const std::vector<vtkPolyData*>& keys, const std::vector<std::string>& roles,
    const std::vector<double>& parameters);
  void Morph(const std::vector<vtkPolyData*>& keys, const std::vector<std::string>& roles,
    const std::vector<double>& parameters, double t, vtkPolyData* output);

  std::unique_ptr<Internals> State;
  int Method = DISCRETE_FORMS;
  double Parameter = 0.0;
  bool FollowTime = true;
  int StepsBetweenKeyFrames = 10;
  int Placement = RIGID_INTERPOLATION;
  std::string HandleArrayName = "Handle";
  bool CloseVolume = false;
  int TransitionInterpolation = ROTATIONS;
  int FrameSolver = ROTATION_AVERAGING;
  int Stitching = ALL_HINGES;
  int LengthPolish = 0;
  int NumberOfIterations = 0;
  int NumberOfKeyFrames = 0;
  double SetupTime = 0.0;
  double EvaluationTime = 0.0;
};

#endif
