// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkRestoreSurface
 * @brief carries a prepared surface's new shape back to the original
 *
 * vtkPrepareSurface merges, cuts and triangulates. When the prepared surface has
 * been deformed, this filter gives the original points the same displacements,
 * so that the original cells, seams and arrays come back in the new shape.
 *
 * Input 0: the prepared surface, deformed. It has the point array
 * `OriginalPointIds`, the cell array `OriginalCellIds` and the field array
 * `PreparedPointIds` of vtkPrepareSurface, which all filters of Cartan pass on.
 * Input 1: the original, which was the input of vtkPrepareSurface.
 *
 * Output: the original with
 * - moved points: original point + (prepared point - where the prepared point was
 *   before, its own original point). Of a point that was cut into copies which
 *   parted since, the mean of their displacements, with a warning. Points that the
 *   preparation removed, and points in no triangle, keep their place,
 * - its own arrays. An array of the prepared surface replaces one of the same name
 *   if its values have changed since (where points were merged nothing is
 *   compared), and is added if there is none. Points and cells that the
 *   preparation removed keep their value, or get 0,
 * - point and cell normals, if the original has them, turned as the surface is:
 *   by the smallest rotation from the mean normal of the original triangles around
 *   a point before to the one after. Split normals stay split. Where nothing
 *   turned they are the same to the last bit.
 *
 * Errors, each with an empty output: no original, arrays missing, of another
 * length, or with ids that the other surface does not have: the surface was
 * prepared from another one, or its points were changed in number since.
 *
 * @sa vtkPrepareSurface
 */
#ifndef vtkRestoreSurface_h
#define vtkRestoreSurface_h

#include "vtkSurfaceFilter.h"

class VTKCARTAN_EXPORT vtkRestoreSurface : public vtkSurfaceFilter
{
public:
  static vtkRestoreSurface* New();
  vtkTypeMacro(vtkRestoreSurface, vtkSurfaceFilter);

  vtkRestoreSurface(const vtkRestoreSurface&) = delete;
  void operator=(const vtkRestoreSurface&) = delete;

  ///@{
  /**
   * The original surface, input port 1.
   */
  void SetOriginalConnection(vtkAlgorithmOutput* original);
  void SetOriginalData(vtkPolyData* original);
  ///@}

protected:
  vtkRestoreSurface();
  ~vtkRestoreSurface() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }
  void Execute(cartan::FilterRun& run) override;
};

#endif
