// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkDiscreteForms
 * @brief describes a surface by its neighborhoods, independent of its position
 *
 * Computes the first and second discrete form of a triangulated surface: each
 * edge that leaves a point is split into its projection on the tangent plane
 * there (first form: lengths and angles) and its height over it (second form).
 * The table alone determines the surface up to a rigid motion, see
 * vtkFrameReconstruction, and it does not change under rigid motions.
 *
 * Output 0: the input with point arrays of 3 doubles each, a right-handed
 * orthonormal frame per point:
 * - `FrameTangent1`: the direction of the first projected edge of the one-ring,
 * - `FrameTangent2` = FrameNormal x FrameTangent1,
 * - `FrameNormal`: the area-weighted mean of the adjacent triangles' normals.
 * Points in no triangle get the coordinate axes.
 *
 * Output 1: a vtkTable with a row per directed edge, grouped by `Vertex`, the
 * one-rings in counter-clockwise order (seen from outside), those of boundary
 * points from boundary edge to boundary edge:
 * - `Vertex`, `Neighbor` (vtkIdType): the points where the edge starts and
 *   ends.
 * - `Length` (double, length units >= 0): of the projected edge.
 * - `Angle` (double, radians in (-pi, pi]): from the projected edge to the next
 *   one, positive counter-clockwise; NaN where no triangle follows.
 * - `Height` (double, length units): of the neighbor over the tangent plane.
 * - `Orientation` (int): the sign of Angle's sine, +1 or -1; 0 where no triangle
 *   follows or an edge is parallel to the normal.
 *
 * An edge parallel to the normal has no projected direction and takes the
 * direction of the previous edge.
 *
 * Polygons are triangulated for the table (the surface keeps them). Errors,
 * each with empty outputs: no triangles, points that are not finite, not
 * manifold, inconsistently oriented, or a point without a normal because all
 * its triangles have zero area.
 *
 * Reference: Lipman, Sorkine, Levin, Cohen-Or, Linear Rotation-invariant
 * Coordinates for Meshes, ACM Transactions on Graphics 24(3), 2005, section 2.
 *
 * @sa vtkFrameReconstruction
 */
#ifndef vtkDiscreteForms_h
#define vtkDiscreteForms_h

#include "vtkSurfaceFilter.h"

class vtkTable;

class VTKCARTAN_EXPORT vtkDiscreteForms : public vtkSurfaceFilter
{
public:
  static vtkDiscreteForms* New();
  vtkTypeMacro(vtkDiscreteForms, vtkSurfaceFilter);

  vtkDiscreteForms(const vtkDiscreteForms&) = delete;
  void operator=(const vtkDiscreteForms&) = delete;

  /**
   * Output 1, valid after Update().
   */
  vtkTable* GetFormsTable();

protected:
  vtkDiscreteForms();
  ~vtkDiscreteForms() override = default;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }
  void Execute(cartan::FilterRun& run) override;
};

#endif
