// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSurfaceComparison
 * @brief base of the measures that compare a surface with a reference
 *
 * Input port 0: the surface as it is. Input port 1: the reference, a surface with
 * the same points and cells in the same order, such as the surface before it was
 * deformed. What is measured of the reference is kept while it stays the same.
 *
 * Errors besides those of vtkSurfaceFilter: numbers of points, or cells, that
 * differ (the message says which).
 */
#ifndef vtkSurfaceComparison_h
#define vtkSurfaceComparison_h

#include "vtkSurfaceFilter.h"

namespace cartan
{
struct SurfacePair;
}
class vtkPolyData;

class VTKCARTAN_EXPORT vtkSurfaceComparison : public vtkSurfaceFilter
{
public:
  vtkTypeMacro(vtkSurfaceComparison, vtkSurfaceFilter);

  vtkSurfaceComparison(const vtkSurfaceComparison&) = delete;
  void operator=(const vtkSurfaceComparison&) = delete;

  ///@{
  /**
   * The surface to compare with, input port 1.
   */
  void SetReferenceConnection(vtkAlgorithmOutput* reference);
  void SetReferenceData(vtkPolyData* reference);
  ///@}

protected:
  vtkSurfaceComparison();
  ~vtkSurfaceComparison() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void Execute(cartan::FilterRun& run) final;

  /**
   * Adds what is measured to the output, which is a shallow copy of the input
   * already. Throws cartan::Error.
   */
  virtual void Compare(const cartan::SurfacePair& pair, cartan::FilterRun& run) = 0;

  /**
   * The same without a reference, where NeedsReference() is false.
   */
  virtual void Measure(cartan::FilterRun& run);

  /**
   * Whether there must be a reference. Default: yes.
   */
  virtual bool NeedsReference() const { return true; }
};

#endif
