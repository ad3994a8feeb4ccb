// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkCurvatureError
 * @brief curvatures of a surface, and their differences from a reference
 *
 * Computes the curvatures at each point by fitting a cubic to the points
 * around it, and, if there is a reference of the same points and cells (such
 * as the surface before it was deformed), the differences from the reference's.
 *
 * Input 0: a surface. Input 1, optional: the reference. Without it, the filter
 * computes curvatures that, unlike those of vtkCurvatures, are accurate on open
 * boundaries (a flat plane has zero everywhere), at the poles of spheres and on
 * irregular meshes.
 *
 * Output: the surface with these point arrays of doubles. They replace arrays
 * of the same name.
 * - `MeanCurvature`: H, half the sum of the two principal curvatures, in 1 /
 *   length units. A sphere of radius R that is oriented outward has +1 / R.
 * - `GaussianCurvature`: K, their product, in 1 / squared length units.
 * - `MaximumCurvature`, `MinimumCurvature`: the principal curvatures k1 >= k2,
 *   in 1 / length units.
 * - `MaximumCurvatureDirection`, `MinimumCurvatureDirection` (3 components,
 *   only with ComputeDirections): unit tangent vectors. Their sign is
 *   arbitrary, and where k1 = k2 the directions are too.
 * - `CurvatureIsDetermined` (unsigned char): 0 where the points around lie in
 *   fewer than three rows in some direction, as on the side of a
 *   vtkCylinderSource, and leave the curvature open. There it is estimated from
 *   the normals of the triangles, with edges between two rows taken as straight.
 *   0 also where the curvature may be off by more than 5 % of the larger principal
 *   one, because the triangles are large for how the surface bends there, at
 *   sharp edges, or because larger triangles were split into coplanar ones, as
 *   vtkLinearSubdivisionFilter does. Warnings give the number and the first ids. 1
 *   elsewhere.
 * - `MeanCurvatureError`, `GaussianCurvatureError` (with a reference): the
 *   surface's curvature minus the reference's.
 * The active point scalars, by which viewers color the surface, are
 * `MeanCurvatureError` with a reference and `MeanCurvature` without.
 *
 * Field data, one double each, with a reference: `MeanCurvatureErrorRMS`,
 * `MeanCurvatureErrorMax` (largest absolute value), `GaussianCurvatureErrorRMS`,
 * `GaussianCurvatureErrorMax`. The root mean square weights every point with
 * its mixed Voronoi area in the reference.
 *
 * Polygons are triangulated for the fit (the surface keeps them). All values
 * are 0 at points in no triangle, and at points without a normal because the
 * normals of their triangles cancel out.
 *
 * Errors, each with an empty output: no triangles, points that are not finite,
 * triangles that are not manifold or inconsistently oriented, a reference of
 * other points or cells.
 *
 * @warning At a crease the curvature is infinite and the value of any method
 * depends on the size of the triangles.
 *
 * Reference for the definition of the errors' areas: Meyer, Desbrun,
 * Schroeder, Barr, Discrete Differential-Geometry Operators for Triangulated
 * 2-Manifolds, Visualization and Mathematics III, 2003. For fitting: Cazals,
 * Pouget, Estimating Differential Quantities Using Polynomial Fitting of
 * Osculating Jets, Computer Aided Geometric Design 22(2), 2005.
 *
 * @sa vtkVolumeChange vtkCurvatures
 */
#ifndef vtkCurvatureError_h
#define vtkCurvatureError_h

#include "vtkSurfaceComparison.h"

#include <limits> // For the results before Update

class VTKCARTAN_EXPORT vtkCurvatureError : public vtkSurfaceComparison
{
public:
  static vtkCurvatureError* New();
  vtkTypeMacro(vtkCurvatureError, vtkSurfaceComparison);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkCurvatureError(const vtkCurvatureError&) = delete;
  void operator=(const vtkCurvatureError&) = delete;

  ///@{
  /**
   * Whether to add the principal directions. Off by default.
   */
  vtkSetMacro(ComputeDirections, bool);
  vtkGetMacro(ComputeDirections, bool);
  vtkBooleanMacro(ComputeDirections, bool);
  ///@}

  ///@{
  /**
   * The field data's numbers, valid after Update(). NaN without a reference.
   */
  vtkGetMacro(MeanCurvatureErrorRMS, double);
  vtkGetMacro(MeanCurvatureErrorMax, double);
  vtkGetMacro(GaussianCurvatureErrorRMS, double);
  vtkGetMacro(GaussianCurvatureErrorMax, double);
  ///@}

protected:
  vtkCurvatureError() = default;
  ~vtkCurvatureError() override = default;

  void Compare(const cartan::SurfacePair& pair, cartan::FilterRun& run) override;
  void Measure(cartan::FilterRun& run) override;
  bool NeedsReference() const override { return false; }
  void ForgetResults() override;

private:
  bool ComputeDirections = false;
  double MeanCurvatureErrorRMS = std::numeric_limits<double>::quiet_NaN();
  double MeanCurvatureErrorMax = std::numeric_limits<double>::quiet_NaN();
  double GaussianCurvatureErrorRMS = std::numeric_limits<double>::quiet_NaN();
  double GaussianCurvatureErrorMax = std::numeric_limits<double>::quiet_NaN();
};

#endif
