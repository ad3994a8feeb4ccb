// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkBoundaryLoops
 * @brief the closed curves of a surface's boundary
 *
 * Output: a closed polyline for each loop of border edges, in the order of their smallest
 * point ids, in the direction that has the surface on its left, seen from outside. Points
 * are those of the boundary, in the input's precision and with its point arrays, and
 * `OriginalPointIds` (vtkIdType). Cell arrays:
 * - `Loop` (int): from 1,
 * - `Length` (double, length units), `NumberOfPoints` (int),
 * - `Component` (int): the connected part of the surface, from 0,
 * - `Area` (double, squared length units), `Normal` (3 doubles): size and direction of the
 *   loop's area vector, half the sum of x_i x x_(i+1). The normal is that of a lid on the
 *   loop that is oriented as the surface; zero where there is none.
 * - `Center` (3 doubles): of the length.
 *
 * A closed surface has no loops: the output is empty, without a warning.
 *
 * Errors: see vtkSurfaceFilter.
 *
 * @sa vtkMeshMerge vtkPrepareSurface
 */
#ifndef vtkBoundaryLoops_h
#define vtkBoundaryLoops_h

#include "vtkSurfaceFilter.h"

class VTKCARTAN_EXPORT vtkBoundaryLoops : public vtkSurfaceFilter
{
public:
  static vtkBoundaryLoops* New();
  vtkTypeMacro(vtkBoundaryLoops, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkBoundaryLoops(const vtkBoundaryLoops&) = delete;
  void operator=(const vtkBoundaryLoops&) = delete;

  /**
   * The number of loops. Valid after Update().
   */
  vtkGetMacro(NumberOfLoops, int);

protected:
  vtkBoundaryLoops() = default;
  ~vtkBoundaryLoops() override = default;

  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override { this->NumberOfLoops = 0; }
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }

private:
  int NumberOfLoops = 0;
};

#endif
