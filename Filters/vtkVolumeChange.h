// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkVolumeChange
 * @brief measures changes of volume, area, edge lengths and shape
 *
 * Compares a surface with a reference of the same points and cells, such as the
 * surface before it was deformed. Rigid motions of either surface do not change
 * the results.
 *
 * Input 0: the surface. Input 1: the reference.
 *
 * Output 0: the surface with these arrays of doubles. They replace arrays of
 * the same name.
 * - `AreaRatio` (points): the area of the triangles around the point divided by
 *   their area in the reference.
 * - `AreaRatio` (cells): the cell's area divided by its area in the reference;
 *   1 for lines and vertices.
 * - `EdgeLengthRatio` (points): the mean of length / reference length over the
 *   point's edges.
 * - `LocalVolume` (points): the part of the enclosed volume that lies under
 *   the point, in cubed length units. The local volumes of a closed component
 *   sum to its volume. They are prisms between the surface and a smoothed,
 *   almost collapsed copy of it, its core, which turns with the surface.
 *   Negative where the surface faces its own core.
 * - `LocalVolumeRatio` (points): local volume divided by that of the reference.
 * - `ShapeDistanceDensity` (points): see `ShapeDistance`, in 1 / squared length
 *   units.
 * - `Stretch1` >= `Stretch2` (points and cells): the principal stretches, new length / old
 *   length in the directions of most and least stretch; and
 *   `StretchDirection1`, `StretchDirection2`: where these directions are on the surface, unit
 *   vectors, zero where both stretches are the same. Of a cell that was triangulated: those of its
 *   largest triangle.
 * - with StrainMeasure two arrays of its name (points and cells), such as
 *   `GreenLagrangeStrain1` >= `GreenLagrangeStrain2`: the principal strains.
 * - with ComputeRates `StretchRate1` >= `StretchRate2` (points and cells), in 1 / time: the
 *   principal rates of stretching, the logarithms of the stretches from the time step before
 *   to the one after, over the time between the two.
 * `AreaRatio` is the active point scalars, by which viewers color the surface.
 * Field data, one double each, as in the table: `RelativeVolumeChange`, `RelativeAreaChange`,
 * `EdgeLengthRMS`, `EdgeLengthMax`, `ShapeDistance`; with 2 to 16 components
 * `RelativeVolumeChange of component 0`, ...
 *
 * Ratios are 1 where nothing has changed and at points in no triangle. They are
 * NaN where the reference has zero area or length or no positive local volume.
 * LocalVolume and its ratio are NaN in open components, which enclose no
 * volume.
 *
 * Output 1: a vtkTable with the string column `Quantity`, the double columns
 * `Reference`, `Current` and `RelativeChange` = (Current - Reference) /
 * Reference, and the string column `Note`, which gives the reason if a number
 * is NaN. Its rows:
 * - `Volume`: the volume enclosed by all components together; cavities count
 *   negative. NaN unless all components are closed. Negative when the surface
 *   is oriented inward.
 * - `Area`.
 * - `EdgeLengthRMS`: Current and RelativeChange are the root mean square over
 *   all edges of (new length / old length - 1); Reference is 0.
 * - `EdgeLengthMax`: the same with the largest absolute value.
 * - `ShapeDistance`: Current is Dist = 1/2 int |grad R|^2 over the reference,
 *   without unit, where R is the rotation of the surface around a point from
 *   the reference to the current surface. For deformations without stretching
 *   it is the integral of the squared difference of the second fundamental
 *   forms. 0 exactly for rigid motions; RelativeChange is NaN.
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

#include "vtkSurfaceComparison.h"

#include <map>    // For the results
#include <memory> // For the time steps
#include <string> // For their names

namespace cartan
{
class NeighborSteps;
}
class vtkTable;

class VTKCARTAN_EXPORT vtkVolumeChange : public vtkSurfaceComparison
{
public:
  static vtkVolumeChange* New();
  vtkTypeMacro(vtkVolumeChange, vtkSurfaceComparison);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkVolumeChange(const vtkVolumeChange&) = delete;
  void operator=(const vtkVolumeChange&) = delete;

  ///@{
  /**
   * Whether to compute LocalVolume and LocalVolumeRatio, the most expensive
   * part: one factorization per reference. On by default.
   */
  vtkSetMacro(ComputeLocalVolume, bool);
  vtkGetMacro(ComputeLocalVolume, bool);
  vtkBooleanMacro(ComputeLocalVolume, bool);
  ///@}

  ///@{
  /**
   * Whether to compute the principal stretches and their directions. On by default.
   */
  vtkSetMacro(ComputeStretches, bool);
  vtkGetMacro(ComputeStretches, bool);
  vtkBooleanMacro(ComputeStretches, bool);
  ///@}

  enum StrainMeasureType
  {
    NO_STRAIN = 0,
    BIOT = 1,
    GREEN_LAGRANGE = 2,
    HENCKY = 3,
    EULER_ALMANSI = 4
  };

  ///@{
  /**
   * Which strains of a stretch s are computed too. BIOT (engineering strain): s - 1.
   * GREEN_LAGRANGE: (s^2 - 1) / 2. HENCKY (true, logarithmic strain): ln s. EULER_ALMANSI:
   * (1 - s^-2) / 2. The last two are minus infinity where s is 0. Default: NO_STRAIN.
   */
  vtkSetClampMacro(StrainMeasure, int, NO_STRAIN, EULER_ALMANSI);
  vtkGetMacro(StrainMeasure, int);
  void SetStrainMeasureToNoStrain() { this->SetStrainMeasure(NO_STRAIN); }
  void SetStrainMeasureToBiot() { this->SetStrainMeasure(BIOT); }
  void SetStrainMeasureToGreenLagrange() { this->SetStrainMeasure(GREEN_LAGRANGE); }
  void SetStrainMeasureToHencky() { this->SetStrainMeasure(HENCKY); }
  void SetStrainMeasureToEulerAlmansi() { this->SetStrainMeasure(EULER_ALMANSI); }
  ///@}

  ///@{
  /**
   * Whether to compute the rates of stretching of an input with time steps. It reads the
   * steps before and after the one that is asked for, and is an error without time steps, and
   * with PrepareInput. Default: off.
   */
  vtkSetMacro(ComputeRates, bool);
  vtkGetMacro(ComputeRates, bool);
  vtkBooleanMacro(ComputeRates, bool);
  ///@}

  /**
   * Output 1, valid after Update().
   */
  vtkTable* GetChangeTable();

  ///@{
  /**
   * Numbers of the table, valid after Update(). NaN where the table has NaN.
   */
  double GetRelativeVolumeChange() const { return this->GetResult("RelativeVolumeChange"); }
  double GetRelativeAreaChange() const { return this->GetResult("RelativeAreaChange"); }
  double GetEdgeLengthRMS() const { return this->GetResult("EdgeLengthRMS"); }
  double GetEdgeLengthMax() const { return this->GetResult("EdgeLengthMax"); }
  double GetShapeDistance() const { return this->GetResult("ShapeDistance"); }
  ///@}

protected:
  vtkVolumeChange();
  ~vtkVolumeChange() override;

  bool SupportsPieces() const override { return !this->ComputeRates; }
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void UsePreparedInput(cartan::FilterRun& run) const override;
  void Compare(const cartan::SurfacePair& pair, cartan::FilterRun& run) override;
  void ForgetResults() override { this->Results.clear(); }
  void FollowFirstRank(
    vtkInformation* request, vtkInformationVector** inputVector, bool hasEnded) override;

private:
  double GetResult(const std::string& name) const;
  void AddRates(cartan::FilterRun& run) const;
  void AddStretches(const cartan::SurfacePair& pair, cartan::FilterRun& run) const;

  bool ComputeLocalVolume = true;
  bool ComputeStretches = true;
  int StrainMeasure = NO_STRAIN;
  bool ComputeRates = false;
  std::unique_ptr<cartan::NeighborSteps> Steps;
  std::map<std::string, double> Results;
};

#endif
