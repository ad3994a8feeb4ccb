// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSurfaceMorph
 * @brief interpolates between surfaces of the same connectivity (key frames)
 *
 * Key frames are two or more surfaces with the same points and cells: each
 * added with AddInputConnection() or AddInputData(), with parameters evenly
 * spaced from 0 to 1; or the time steps of one input, so that the filter is a
 * temporal interpolator. Local shape is interpolated instead of coordinates,
 * linearly between two key frames and by monotone cubics through more, so that
 * turning parts do not shrink.
 *
 * The output is the surface at one parameter. It has time steps: over [0, 1],
 * or over those of the input, StepsBetweenKeyFrames for each pair of key
 * frames. A requested time gives the surface at that time (if FollowTime is
 * on); without a request, Parameter determines it.
 *
 * Each component is placed by a rigid interpolation of the key frames; see
 * Placement. At the parameter of a key frame the output is that key frame, with its
 * arrays. In between, floating-point arrays of points and cells are interpolated,
 * normals turn with the surface, and other arrays are those of the nearest key
 * frame. An array that is missing in one of the key frames around is left out, with
 * a warning.
 *
 * At most four key frames are used at a time, two before and two after the
 * parameter. What is computed from them is kept until their contents change.
 *
 * Errors, each with an empty output: fewer than two key frames; key frames that
 * differ in their number of points or their cells, or are not manifold, not
 * consistently oriented or not finite; weights of another number or sum; times that do not
 * increase; a composite input; what the methods refuse, see Method.
 *
 * References: Lipman, Sorkine, Levin, Cohen-Or, Linear Rotation-invariant
 * Coordinates for Meshes, 2005, section 4.1; Bose, O'Rourke, Shu, Wuhrer,
 * Isometric Morphing of Triangular Meshes, 2008; Sheffer, Kraevoy, Pyramid
 * Coordinates for Morphing and Deformation, 2004; Sorkine, Differential
 * Representations for Mesh Processing, 2006, section 4.4.
 *
 * @sa vtkVolumeChange vtkCurvatureError vtkMarkHandle
 */
#ifndef vtkSurfaceMorph_h
#define vtkSurfaceMorph_h

#include "vtkSurfaceFilter.h"

#include <memory>  // For the private state
#include <string>  // For the array's name
#include <utility> // For a range of key frames
#include <vector>  // For weights

namespace cartan
{
class ExecutionContext;
class SurfaceMorph;
struct KeyFrames;
}

class VTKCARTAN_EXPORT vtkSurfaceMorph : public vtkSurfaceFilter
{
public:
  static vtkSurfaceMorph* New();
  vtkTypeMacro(vtkSurfaceMorph, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSurfaceMorph(const vtkSurfaceMorph&) = delete;
  void operator=(const vtkSurfaceMorph&) = delete;

  enum MethodType
  {
    DISCRETE_FORMS = 0,
    ISOMETRIC = 1,
    DEFORMATION_GRADIENT = 2,
    LINEAR = 3,
    PYRAMID_COORDINATES = 4
  };

  ///@{
  /**
   * What is interpolated. DISCRETE_FORMS: the one-rings of points; for any
   * number of full turns. Needs a normal at each point. ISOMETRIC: edge lengths
   * and the angles between triangles; exact, and in linear time, on surfaces
   * without interior points, such as strips. Needs edges of positive length.
   * DEFORMATION_GRADIENT: the rotation and stretch of each triangle; without
   * iteration, for less than a full turn relative to the mean of the surface.
   * Needs a triangle with area in each component. LINEAR: coordinates, for
   * comparison. PYRAMID_COORDINATES: the one-rings of points, projected on planes; the
   * surface whose one-rings are closest to them, by 50 to 500 iterations: a reference
   * that is no linear method. Needs a normal at each point. Default: DISCRETE_FORMS.
   */
  vtkSetClampMacro(Method, int, DISCRETE_FORMS, PYRAMID_COORDINATES);
  vtkGetMacro(Method, int);
  void SetMethodToDiscreteForms() { this->SetMethod(DISCRETE_FORMS); }
  void SetMethodToIsometric() { this->SetMethod(ISOMETRIC); }
  void SetMethodToDeformationGradient() { this->SetMethod(DEFORMATION_GRADIENT); }
  void SetMethodToLinear() { this->SetMethod(LINEAR); }
  void SetMethodToPyramidCoordinates() { this->SetMethod(PYRAMID_COORDINATES); }
  ///@}

  ///@{
  /**
   * The place between the first key frame, 0, and the last one, 1. Values
   * outside extrapolate as long as lengths stay positive. Used if no time is
   * requested or FollowTime is off. Default: 0.
   */
  vtkSetMacro(Parameter, double);
  vtkGetMacro(Parameter, double);
  ///@}

  ///@{
  /**
   * A point array of the first key frame with a parameter for each point, in place of
   * Parameter and time: parts of the surface arrive at different times (Alexa,
   * Differential coordinates for local mesh morphing and deformation, 2003). Edges and
   * triangles are at the mean of their points, and arrays at the mean of all. Empty:
   * none. Default: empty.
   */
  void SetParameterArrayName(const std::string& name)
  {
    this->SetMember(this->ParameterArrayName, name);
  }
  std::string GetParameterArrayName() const { return this->ParameterArrayName; }
  ///@}

  ///@{
  /**
   * Weights of all key frames, in place of Parameter and time: a blend shape of more than
   * two poses that does not shrink. They sum to 1; some may be negative, or more than 1.
   * Arrays are those of the key frame with the largest weight. None: 0 weights, the
   * default; at most 1,000,000.
   */
  void SetNumberOfWeights(int count);
  int GetNumberOfWeights() const { return static_cast<int>(this->Weights.size()); }
  void SetWeight(int keyFrame, double weight);
  double GetWeight(int keyFrame) const;
  ///@}

  ///@{
  /**
   * Whether a requested time, for example of an animation, replaces Parameter.
   * Off: the output has no time steps. Default: on.
   */
  vtkSetMacro(FollowTime, bool);
  vtkGetMacro(FollowTime, bool);
  vtkBooleanMacro(FollowTime, bool);
  ///@}

  ///@{
  /**
   * The number of time steps from one key frame to the next. Default: 10.
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
   * How the position of each component is chosen. RIGID_INTERPOLATION: centers
   * of components move on a line from one key frame to the next (on a smooth
   * path through more), and the component as a whole turns at an even rate
   * about one axis, by less than half a turn. PINNED_HANDLE: a rigid motion
   * brings the points with a value above 0 in HandleArrayName of the first key
   * frame as close as possible to their interpolated positions; if these points
   * are the same in all key frames, they stay in place. It has no effect on
   * components without such points and on LINEAR. Default: RIGID_INTERPOLATION.
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
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * Gives each component the interpolated volume of the key frames, by the
   * smoothest displacement that does so. Components that are open,
   * enclose nothing, or are turned inside out against the first key frame are not
   * changed and give a warning. Default: off.
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
   * DISCRETE_FORMS: whether the transition from a point's frame to its
   * neighbor's is interpolated as a rotation, or computed from the interpolated
   * forms, as in the 2005 paper, at somewhat larger errors in lengths. Default:
   * ROTATIONS.
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
   * DISCRETE_FORMS: how frames are found. ROTATION_AVERAGING: the rotations
   * that fit best, with one factorization for all parameters.
   * CONJUGATE_GRADIENTS, DIRECT: the 2005 paper's linear system of three
   * unknowns per point, projected on rotations; solved iteratively from the
   * result of ROTATION_AVERAGING, or factorized for each parameter. The two
   * agree, and differ little from ROTATION_AVERAGING. Default:
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
   * ISOMETRIC on surfaces with interior points: how they are reconstructed,
   * because lengths and angles do not fit together exactly. ALL_HINGES:
   * triangles are turned so that all angles fit best, and stitched. TREE: they
   * are turned along a tree through the hinges that turn least, and stitched.
   * TREE_AVERAGE: the 2008 paper's method; each point is at the mean of the
   * positions that its triangles on the tree give it. Default: ALL_HINGES.
   */
  vtkSetClampMacro(Stitching, int, ALL_HINGES, TREE_AVERAGE);
  vtkGetMacro(Stitching, int);
  void SetStitchingToAllHinges() { this->SetStitching(ALL_HINGES); }
  void SetStitchingToTree() { this->SetStitching(TREE); }
  void SetStitchingToTreeAverage() { this->SetStitching(TREE_AVERAGE); }
  ///@}

  ///@{
  /**
   * ISOMETRIC: the number of rounds after stitching that bring edges closer to
   * their lengths. Each factorizes a matrix of three unknowns per point.
   * Default: 0.
   */
  vtkSetClampMacro(LengthPolish, int, 0, 100);
  vtkGetMacro(LengthPolish, int);
  ///@}

  /**
   * The number of iterations for the last surface; 0 for methods that do not
   * iterate.
   */
  vtkGetMacro(NumberOfIterations, int);

  /**
   * The number of key frames at the last update.
   */
  vtkGetMacro(NumberOfKeyFrames, int);

  ///@{
  /**
   * Seconds that the last update took to prepare the key frames (0 if they were
   * kept) and to compute the surface.
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
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  bool AcceptsEmptyInput() const override;
  bool SupportsPieces() const override;
  void FollowFirstRank(
    vtkInformation* request, vtkInformationVector** inputVector, bool hasEnded) override;

private:
  class Internals;

  double RequestedParameter(vtkInformation* output) const;
  std::pair<int, int> Window(double t) const;

  /// Whether Parameter and time are not used.
  bool IsElsewhere() const { return !this->ParameterArrayName.empty() || !this->Weights.empty(); }
  void RequireKeyFrames(cartan::FilterRun& run) const;
  bool CollectKeyFrames(cartan::FilterRun& run, double t);
  std::unique_ptr<cartan::SurfaceMorph> NewMorph(
    const cartan::KeyFrames& keys, const cartan::ExecutionContext& context) const;

  std::unique_ptr<Internals> State;
  int Method = DISCRETE_FORMS;
  double Parameter = 0.0;
  std::string ParameterArrayName;
  std::vector<double> Weights;
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
