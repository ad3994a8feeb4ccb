// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkLeastSquaresMesh
 * @brief approximates a surface by its connectivity and a few anchors
 *
 * The output is the smoothest surface of the input's connectivity that passes through a
 * few of its points, the *anchors*: the sum over all points of the squared distance from
 * the mean of the neighbors is the least possible. Where triangles carry the shape, which
 * those of scans and of adaptive meshes do, few anchors give a good approximation.
 *
 * Output 0: the input with these points in the input's precision, and the point arrays
 * - `Anchor` (int): k for the k-th anchor that was chosen, from 1; else 0,
 * - `ApproximationError` (double, length units >= 0): the distance to the input's point,
 * - `BasisFunctions` (double, a component per anchor) with GenerateBasisFunctions: 1 at
 *   its anchor, 0 at the others; the surface is their sum, weighted by the anchors'
 *   positions.
 * Points in no triangle keep their place.
 *
 * Output 1: a vtkTable with a row per number of anchors: `NumberOfAnchors` (int),
 * `RootMeanSquareError`, `MaximumError` (double, length units). With HANDLE it has one row.
 *
 * With PlayAnchors the output has a time step for each number of anchors, and at time n it
 * is the surface through the first n. One factorization serves all.
 *
 * Errors, each with an empty output: fewer anchors than connected components or more than
 * points; a component without an anchor (HANDLE); more than fit into BasisMemoryLimit (the
 * message says how many fit); see vtkSurfaceFilter.
 *
 * Reference: Sorkine, Cohen-Or, Least-squares Meshes, 2004; Sorkine, Cohen-Or, Irony,
 * Toledo, Geometry-aware Bases for Shape Approximation, IEEE Transactions on
 * Visualization and Computer Graphics 11(2), 2005.
 *
 * @sa vtkLaplacianSpectrum vtkMarkHandle
 */
#ifndef vtkLeastSquaresMesh_h
#define vtkLeastSquaresMesh_h

#include "vtkSurfaceFilter.h"

#include <string> // For the array name

class vtkTable;

class VTKCARTAN_EXPORT vtkLeastSquaresMesh : public vtkSurfaceFilter
{
public:
  static vtkLeastSquaresMesh* New();
  vtkTypeMacro(vtkLeastSquaresMesh, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkLeastSquaresMesh(const vtkLeastSquaresMesh&) = delete;
  void operator=(const vtkLeastSquaresMesh&) = delete;

  enum AnchorSelectionType
  {
    FARTHEST_POINT = 0,
    GREEDY = 1,
    HANDLE = 2
  };

  ///@{
  /**
   * FARTHEST_POINT: each next anchor is the point farthest from those before it, over the
   * surface. GREEDY: where the error around a point is largest, about as good as the same number
   * of spectral modes. HANDLE: the points whose value in the handle array is not 0.
   * Default: GREEDY.
   */
  vtkSetClampMacro(AnchorSelection, int, FARTHEST_POINT, HANDLE);
  vtkGetMacro(AnchorSelection, int);
  void SetAnchorSelectionToFarthestPoint() { this->SetAnchorSelection(FARTHEST_POINT); }
  void SetAnchorSelectionToGreedy() { this->SetAnchorSelection(GREEDY); }
  void SetAnchorSelectionToHandle() { this->SetAnchorSelection(HANDLE); }
  ///@}

  ///@{
  /**
   * How many anchors are chosen, >= 1. Fewer are, when the surface is met before. No effect
   * with HANDLE. Default: 100.
   */
  vtkSetClampMacro(NumberOfAnchors, int, 1, VTK_INT_MAX);
  vtkGetMacro(NumberOfAnchors, int);
  ///@}

  ///@{
  /**
   * The array of HANDLE. Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * Whether the output has a time step for each number of anchors. Default: off.
   */
  vtkSetMacro(PlayAnchors, bool);
  vtkGetMacro(PlayAnchors, bool);
  vtkBooleanMacro(PlayAnchors, bool);
  ///@}

  ///@{
  /**
   * Whether to add the array `BasisFunctions`. Default: off.
   */
  vtkSetMacro(GenerateBasisFunctions, bool);
  vtkGetMacro(GenerateBasisFunctions, bool);
  vtkBooleanMacro(GenerateBasisFunctions, bool);
  ///@}

  ///@{
  /**
   * How much memory the functions of the anchors may take, in megabytes (10^6 bytes),
   * >= 1. Default: 4000.
   */
  vtkSetClampMacro(BasisMemoryLimit, int, 1, VTK_INT_MAX);
  vtkGetMacro(BasisMemoryLimit, int);
  ///@}

  /**
   * Output 1, valid after Update().
   */
  vtkTable* GetErrorTable();

protected:
  vtkLeastSquaresMesh();
  ~vtkLeastSquaresMesh() override = default;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void Execute(cartan::FilterRun& run) override;

private:
  std::string HandleArrayName = "Handle";
  int AnchorSelection = GREEDY;
  int NumberOfAnchors = 100;
  int BasisMemoryLimit = 4000;
  bool PlayAnchors = false;
  bool GenerateBasisFunctions = false;
};

#endif
