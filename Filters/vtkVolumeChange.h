// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkVolumeChange
 * @brief what a deformation does to volume, area, edge lengths and shape
 *
 * Compares a surface with a reference of the same points and cells, such as
 * the surface before it was deformed. Nothing changes when either of them is
 * moved rigidly.
 *
 * Input 0: the surface. Input 1: the reference.
 *
 * Output 0: the surface with these arrays of doubles. They replace arrays of
 * the same name.
 * - `AreaRatio` (points): the area of the triangles around the point over
 *   their area in the reference.
 * - `AreaRatio` (cells): the cell's area over its area in the reference; 1 for
 *   lines and vertices.
 * - `EdgeLengthRatio` (points): the mean over the point's edges of their
 *   length over that in the reference.
 * - `LocalVolume` (points): the part of the enclosed volume that lies under
 *   the point, in cubed length units. The local volumes of a closed component
 *   sum to its volume. They are prisms between the surface and a smoothed,
 *   almost collapsed copy of it, its core, which turns with the surface.
 *   Negative where the surface faces its own core.
 * - `LocalVolumeRatio` (points): local volume over that of the reference.
 * - `ShapeDistanceDensity` (points): see `ShapeDistance`, in 1 / squared length
 *   units.
 * `AreaRatio` is the active point scalars, by which viewers color the surface.
 * Field data, one double each: `RelativeVolumeChange`, `ShapeDistance`.
 *
 * Ratios are 1 where nothing has changed and at points in no triangle. They
 * are NaN where there is none: the reference has zero area or length there, its
 * local volume is not positive, or (LocalVolume and its ratio) the component
 * is open and encloses nothing.
 *
 * Output 1: a vtkTable with the string column `Quantity`, the double columns
 * `Reference`, `Current` and `RelativeChange` = (Current - Reference) /
 * Reference, and the string column `Note`, which says why where a number is
 * NaN. Its rows:
 * - `Volume`: enclosed by all components together, those of cavities being
 *   negative. NaN unless all components are closed. Negative when the surface
 *   is oriented inwards.
 * - `Area`.
 * - `EdgeLengthRMS`: Current and RelativeChange are the root mean square over
 *   all edges of (new length / old length - 1); Reference is 0.
 * - `EdgeLengthMax`: the same with the largest absolute value.
 * - `ShapeDistance`: Current is Dist = 1/2 int |grad R|^2 over the reference,
 *   without unit, where R is the rotation that takes the surface around a point
 *   from the reference to its current place. For deformations without
 *   stretching it is the integral of the squared difference of the second
 *   fundamental forms. 0 exactly for rigid motions; RelativeChange is NaN.
 * - `Volume of component 0`, ...: when there are several components, numbered
 *   in the order of their first points.
 *
 * Polygons are triangulated as the reference's shape suggests. Errors, each
 * with empty outputs: no triangles, points that are not finite, triangles that
 * are not manifold or inconsistently oriented, points or cells that differ from
 * the reference's.
 *
 * Reference: Lipman, Cohen-Or, Gal, Levin, Volume and Shape Preservation via
 * Moving Frame Manipulation, ACM Transactions on Graphics 26(1), 2007.
 *
 * @sa vtkCurvatureError vtkMassProperties
 */
#ifndef vtkVolumeChange_h
#define vtkVolumeChange_h

#include "vtkCartanModule.h" // For the export macro

#include "vtkPolyDataAlgorithm.h"

#include <limits> // For the results before Update
#include <memory> // For the kept measure

class vtkTable;

class VTKCARTAN_EXPORT vtkVolumeChange : public vtkPolyDataAlgorithm
{
public:
  static vtkVolumeChange* New();
  vtkTypeMacro(vtkVolumeChange, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkVolumeChange(const vtkVolumeChange&) = delete;
  void operator=(const vtkVolumeChange&) = delete;

  ///@{
  /**
   * The surface to compare with, input port 1. Required.
   */
  void SetReferenceConnection(vtkAlgorithmOutput* reference);
  void SetReferenceData(vtkPolyData* reference);
  ///@}

  ///@{
  /**
   * Whether to compute LocalVolume and LocalVolumeRatio, the costly part: one
   * factorization per reference. On by default.
   */
  vtkSetMacro(ComputeLocalVolume, bool);
  vtkGetMacro(ComputeLocalVolume, bool);
  vtkBooleanMacro(ComputeLocalVolume, bool);
  ///@}

  /**
   * Output 1, valid after Update().
   */
  vtkTable* GetChangeTable();

  ///@{
  /**
   * Numbers of the table, valid after Update(). NaN where the table has NaN.
   */
  vtkGetMacro(RelativeVolumeChange, double);
  vtkGetMacro(RelativeAreaChange, double);
  vtkGetMacro(EdgeLengthRMS, double);
  vtkGetMacro(EdgeLengthMax, double);
  vtkGetMacro(ShapeDistance, double);
  ///@}

protected:
  vtkVolumeChange();
  ~vtkVolumeChange() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  class Internals;

  void ForgetResults();

  bool ComputeLocalVolume = true;
  double RelativeVolumeChange = std::numeric_limits<double>::quiet_NaN();
  double RelativeAreaChange = std::numeric_limits<double>::quiet_NaN();
  double EdgeLengthRMS = std::numeric_limits<double>::quiet_NaN();
  double EdgeLengthMax = std::numeric_limits<double>::quiet_NaN();
  double ShapeDistance = std::numeric_limits<double>::quiet_NaN();
  std::unique_ptr<Internals> Internal;
};

#endif
