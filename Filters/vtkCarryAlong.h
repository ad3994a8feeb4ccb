// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkCarryAlong
 * @brief makes points, curves, surfaces and volume meshes follow a surface
 *
 * Input 0: what follows, any vtkPointSet: points, curves, a finer surface, a volume mesh.
 * Input 1: the surface at rest. Input 2: the same surface, deformed, morphed or at another
 * time, with the same points and cells in the same order.
 *
 * Each point is bound to the places of the surface near it, with weights that change
 * smoothly from point to point, and moves with them: x' = c' + R (x - c), where c is the
 * weighted mean of the places, c' of where they are now, and R the mean of the rotations
 * there. So a point on the surface goes exactly to its point, rigid motions are followed
 * exactly, and a surface that bends with radius r carries a point at the distance d up to an
 * error of d^2 / r. What is bound is kept: each motion or time step is a sum.
 *
 * Output 0: input 0 with moved points in its precision, and the point array
 * `SurfaceDistance` (double, length units): from the point to the surface at rest. Point
 * normals turn along, cell normals are left out; with TurnVectors floating-point point
 * arrays of three components turn along.
 *
 * Errors, each with an empty output: a missing input; points of what follows that are not
 * finite; surfaces of different points or cells; see vtkSurfaceFilter. A warning tells which
 * tetrahedra change the sign of their volume.
 *
 * @sa vtkSurfaceDeformation vtkSurfaceMorph vtkCoatingTransfer
 */
#ifndef vtkCarryAlong_h
#define vtkCarryAlong_h

#include "vtkSurfaceFilter.h"

class vtkPointSet;

class VTKCARTAN_EXPORT vtkCarryAlong : public vtkSurfaceFilter
{
public:
  static vtkCarryAlong* New();
  vtkTypeMacro(vtkCarryAlong, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkCarryAlong(const vtkCarryAlong&) = delete;
  void operator=(const vtkCarryAlong&) = delete;

  ///@{
  /**
   * The surface at rest, input 1, and as it is now, input 2.
   */
  void SetRestConnection(vtkAlgorithmOutput* rest) { this->SetInputConnection(1, rest); }
  void SetRestData(vtkPolyData* rest);
  void SetDeformedConnection(vtkAlgorithmOutput* deformed)
  {
    this->SetInputConnection(2, deformed);
  }
  void SetDeformedData(vtkPolyData* deformed);
  ///@}

  ///@{
  /**
   * Whether floating-point point arrays of three components turn along, such as fiber
   * directions. Default: off.
   */
  vtkSetMacro(TurnVectors, bool);
  vtkGetMacro(TurnVectors, bool);
  vtkBooleanMacro(TurnVectors, bool);
  ///@}

  /**
   * Output 0 of any class, valid after Update().
   */
  vtkPointSet* GetCarried();

  ///@{
  /**
   * Valid after Update(): the largest distance from a point to the surface at rest, in length
   * units, and how many tetrahedra changed the sign of their volume.
   */
  vtkGetMacro(LargestDistance, double);
  vtkGetMacro(NumberOfInvertedCells, vtkIdType);
  ///@}

  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkCarryAlong();
  ~vtkCarryAlong() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }

private:
  bool TurnVectors = false;
  double LargestDistance = 0.0;
  vtkIdType NumberOfInvertedCells = 0;
};

#endif
