// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkDifferentialCoordinates
 * @brief describes each point by its difference from its neighbors
 *
 * The output is the input with two point arrays:
 * - `DifferentialCoordinates` (three doubles; name: DifferentialCoordinatesArrayName),
 *   see vtkDifferentialFilter. They point outwards where the surface is convex, turn
 *   with the surface and do not depend on where it is. Zero at points in no triangle.
 * - `DifferentialCoordinatesAreDefined` (unsigned char; the same name with
 *   "AreDefined"): 0 at points on a border, whose neighborhood is half of one and whose
 *   coordinates mean nothing by themselves, and at points in no triangle; else 1.
 *
 * The field data array `DifferentialCoordinatesOperator` (the same name with
 * "Operator"; two int: LaplacianWeights, Normalization) lets
 * vtkDifferentialReconstruction check that it is set alike.
 *
 * Edit the array (vtkArrayCalculator, Python, a smoother), and give the output to
 * vtkDifferentialReconstruction.
 *
 * The sum at a point without area around it is divided by the mean area of all points
 * (Normalization AREA); triangles without area are warned of.
 *
 * Reference: Sorkine, Differential Representations for Mesh Processing, Computer
 * Graphics Forum 25(4), 2006, section 2; cotangent weights: Desbrun et al., Implicit
 * Fairing of Irregular Meshes using Diffusion and Curvature Flow, 1999; mean value
 * weights: Floater, Mean Value Coordinates, 2003.
 *
 * @sa vtkDifferentialReconstruction vtkCurvatureError
 */
#ifndef vtkDifferentialCoordinates_h
#define vtkDifferentialCoordinates_h

#include "vtkDifferentialFilter.h"

class VTKCARTAN_EXPORT vtkDifferentialCoordinates : public vtkDifferentialFilter
{
public:
  static vtkDifferentialCoordinates* New();
  vtkTypeMacro(vtkDifferentialCoordinates, vtkDifferentialFilter);

  vtkDifferentialCoordinates(const vtkDifferentialCoordinates&) = delete;
  void operator=(const vtkDifferentialCoordinates&) = delete;

protected:
  vtkDifferentialCoordinates() = default;
  ~vtkDifferentialCoordinates() override = default;

  void Execute(cartan::FilterRun& run) override;
  bool SupportsPieces() const override { return true; }
};

#endif
