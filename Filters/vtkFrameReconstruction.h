// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkFrameReconstruction
 * @brief reconstructs a surface from its discrete forms
 *
 * Input 0 gives the connectivity: its polygons, and the positions of
 * constrained points; other coordinates are ignored. Input 1 is a forms table
 * as vtkDiscreteForms makes it, with the columns `Vertex`, `Neighbor`,
 * `Length`, `Angle`, `Height`, `Orientation`; the order of its rows does not
 * matter. It solves two linear systems: for the frames from the transitions
 * that the forms define, then for the positions from the frames.
 *
 * The output has the input's cells and attributes, points in double precision
 * (whatever the input's, whose coordinates are ignored), and the arrays
 * `FrameTangent1`, `FrameTangent2`, `FrameNormal` of the solution. Points in no
 * triangle keep their input position.
 *
 * The forms determine each component up to a rigid motion, so each needs a
 * *seed*: a point with its position and frame. SeedPoint seeds its component;
 * the first point of each other component is seeded with SeedPosition and
 * SeedFrame too, with a warning, unless it has constraints. Alternatively, the
 * points that ConstraintArrayName selects are fixed at their positions in input
 * 0, with the frames in its three frame arrays.
 *
 * The forms of a real surface reproduce it exactly. Edited or blended forms
 * need not fit together; the result then fits them best in the least-squares
 * sense.
 *
 * Errors, each with an empty output: see vtkDiscreteForms for the connectivity;
 * a table with missing columns, edges that are missing, occur twice or are not
 * edges of the surface, negative lengths or numbers that are not finite; a seed
 * in no triangle, or whose frame is not right-handed and orthonormal; missing
 * frame arrays.
 *
 * Reference: Lipman, Sorkine, Levin, Cohen-Or, Linear Rotation-invariant
 * Coordinates for Meshes, ACM Transactions on Graphics 24(3), 2005, section 3.
 *
 * @sa vtkDiscreteForms
 */
#ifndef vtkFrameReconstruction_h
#define vtkFrameReconstruction_h

#include "vtkSurfaceFilter.h"

#include <string> // For array names

class vtkTable;

class VTKCARTAN_EXPORT vtkFrameReconstruction : public vtkSurfaceFilter
{
public:
  static vtkFrameReconstruction* New();
  vtkTypeMacro(vtkFrameReconstruction, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkFrameReconstruction(const vtkFrameReconstruction&) = delete;
  void operator=(const vtkFrameReconstruction&) = delete;

  ///@{
  /**
   * The forms table, input port 1.
   */
  void SetFormsConnection(vtkAlgorithmOutput* table);
  void SetFormsData(vtkTable* table);
  ///@}

  ///@{
  /**
   * The seed's point id; -1 (the default) is the first point of the first
   * component. Not used with constraints.
   */
  vtkSetClampMacro(SeedPoint, vtkIdType, -1, VTK_ID_MAX);
  vtkGetMacro(SeedPoint, vtkIdType);
  ///@}

  ///@{
  /**
   * Where the seed is, in length units. Default: the origin.
   */
  vtkSetVector3Macro(SeedPosition, double);
  vtkGetVector3Macro(SeedPosition, double);
  ///@}

  ///@{
  /**
   * The seed's frame: its three vectors tangent 1, tangent 2, normal one after
   * the other, orthonormal and right-handed to 1e-6. Tangent 1 is the direction
   * of the first edge of the point's one-ring. Default: the coordinate axes.
   */
  void SetSeedFrame(const double frame[9]);
  void SetSeedFrame(double t1x, double t1y, double t1z, double t2x, double t2y, double t2z,
    double nx, double ny, double nz);
  vtkGetVectorMacro(SeedFrame, double, 9);
  ///@}

  ///@{
  /**
   * A point array of input 0; points where it is not 0 are fixed, with their
   * positions and frames (`FrameTangent1`, `FrameTangent2`, `FrameNormal`,
   * point arrays of input 0). Each component without such a point is seeded.
   * Empty (the default): seeds only.
   */
  void SetConstraintArrayName(const std::string& name);
  std::string GetConstraintArrayName() const { return this->ConstraintArrayName; }
  ///@}

  enum TransitionMethodType
  {
    PROCRUSTES = 0,
    ORIENTATION_BITS = 1
  };

  ///@{
  /**
   * How the transition (change of frame) along an edge is computed from the
   * forms. PROCRUSTES: the rotation that fits the two one-rings best.
   * ORIENTATION_BITS: the paper's Theorem 3.1, more sensitive to noise. Both
   * agree for the forms of a real surface. Default: PROCRUSTES.
   */
  vtkSetClampMacro(TransitionMethod, int, PROCRUSTES, ORIENTATION_BITS);
  vtkGetMacro(TransitionMethod, int);
  void SetTransitionMethodToProcrustes() { this->SetTransitionMethod(PROCRUSTES); }
  void SetTransitionMethodToOrientationBits() { this->SetTransitionMethod(ORIENTATION_BITS); }
  ///@}

  ///@{
  /**
   * Whether frames are replaced by the closest rotations before positions are
   * computed. No effect on the forms of a real surface; for other forms,
   * least-squares frames shrink with the distance from the seed. Default: on.
   */
  vtkSetMacro(ProjectFrames, bool);
  vtkGetMacro(ProjectFrames, bool);
  vtkBooleanMacro(ProjectFrames, bool);
  ///@}

protected:
  vtkFrameReconstruction();
  ~vtkFrameReconstruction() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }
  void Execute(cartan::FilterRun& run) override;

private:
  vtkIdType SeedPoint = -1;
  double SeedPosition[3] = { 0.0, 0.0, 0.0 };
  double SeedFrame[9] = { 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 };
  std::string ConstraintArrayName;
  int TransitionMethod = PROCRUSTES;
  bool ProjectFrames = true;
};

#endif
