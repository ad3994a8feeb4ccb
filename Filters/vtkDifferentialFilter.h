// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkDifferentialFilter
 * @brief base of the filters that make or use differential coordinates
 *
 * The differential coordinates of point i are
 *
 *   delta_i = 1 / n_i sum_j w_ij (v_i - v_j)
 *
 * with a sum over the points that edges join it to. The concrete filters share what
 * the weights w and the divisors n are, and the name of the point array.
 *
 * @sa vtkDifferentialCoordinates vtkDifferentialReconstruction
 */
#ifndef vtkDifferentialFilter_h
#define vtkDifferentialFilter_h

#include "vtkSurfaceFilter.h"

#include <string> // For the array name

class VTKCARTAN_EXPORT vtkDifferentialFilter : public vtkSurfaceFilter
{
public:
  vtkTypeMacro(vtkDifferentialFilter, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkDifferentialFilter(const vtkDifferentialFilter&) = delete;
  void operator=(const vtkDifferentialFilter&) = delete;

  enum LaplacianWeightsType
  {
    UNIFORM = 0,
    COTANGENT = 1,
    MEAN_VALUE = 2
  };

  ///@{
  /**
   * The weight of each edge. UNIFORM: 1, whatever the shape of the triangles; it needs
   * no coordinates. COTANGENT: the mean of the cotangents of the two opposite angles;
   * the coordinates are normal to the surface. MEAN_VALUE: Floater's mean value
   * coordinates, never negative; zero in planes, as cotangent ones are. Default:
   * COTANGENT.
   */
  vtkSetClampMacro(LaplacianWeights, int, UNIFORM, MEAN_VALUE);
  vtkGetMacro(LaplacianWeights, int);
  void SetLaplacianWeightsToUniform() { this->SetLaplacianWeights(UNIFORM); }
  void SetLaplacianWeightsToCotangent() { this->SetLaplacianWeights(COTANGENT); }
  void SetLaplacianWeightsToMeanValue() { this->SetLaplacianWeights(MEAN_VALUE); }
  ///@}

  enum NormalizationType
  {
    ROW = 0,
    INTEGRATED = 1,
    AREA = 2
  };

  ///@{
  /**
   * The divisor of each sum. ROW: the sum of the weights; a length, the point minus
   * the mean of its neighbors. INTEGRATED: 1; for uniform weights the matrix L_s of the
   * literature, best for compression. AREA: the mixed Voronoi area; with cotangent
   * weights twice the mean curvature normal, in 1 / length units. Default: AREA.
   */
  vtkSetClampMacro(Normalization, int, ROW, AREA);
  vtkGetMacro(Normalization, int);
  void SetNormalizationToRow() { this->SetNormalization(ROW); }
  void SetNormalizationToIntegrated() { this->SetNormalization(INTEGRATED); }
  void SetNormalizationToArea() { this->SetNormalization(AREA); }
  ///@}

  ///@{
  /**
   * The point array of the differential coordinates, three doubles per point. Default:
   * "DifferentialCoordinates".
   */
  void SetDifferentialCoordinatesArrayName(const std::string& name)
  {
    this->SetMember(this->DifferentialCoordinatesArrayName, name);
  }
  std::string GetDifferentialCoordinatesArrayName() const
  {
    return this->DifferentialCoordinatesArrayName;
  }
  ///@}

protected:
  vtkDifferentialFilter() = default;
  ~vtkDifferentialFilter() override = default;

  std::string DifferentialCoordinatesArrayName = "DifferentialCoordinates";
  int LaplacianWeights = COTANGENT;
  int Normalization = AREA;
};

#endif
