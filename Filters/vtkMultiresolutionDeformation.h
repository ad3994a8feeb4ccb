// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMultiresolutionDeformation
 * @brief deforms a smooth base and carries the details along in its frames
 *
 * Two-band multiresolution editing: a smooth base surface that solves L^k x = 0
 * between the handles, and the details as offsets in the base's local frames.
 * The base follows the handles' places, its frames turn with it, and the
 * details with them.
 *
 * The base knows nothing of the original shape between the handles, so this
 * method suits details on a simple body; details that are no heights over the
 * base come out distorted. Only the places of handles count, and
 * ConstrainHandlePositions must be on. Ports, arrays, errors: see
 * vtkSurfaceDeformation.
 *
 * References: Kobbelt et al., Interactive Multi-Resolution Modeling on Arbitrary
 * Meshes, ACM SIGGRAPH 1998. Botsch and Kobbelt, An Intuitive Framework for
 * Real-time Freeform Modeling, ACM SIGGRAPH 2004. Sorkine, Differential
 * Representations for Mesh Processing, Computer Graphics Forum 25(4), 2006,
 * section 4.2.
 *
 * @sa vtkLaplacianDeformation vtkMarkHandle vtkHandleMotion
 */
#ifndef vtkMultiresolutionDeformation_h
#define vtkMultiresolutionDeformation_h

#include "vtkSurfaceDeformation.h"

class VTKCARTAN_EXPORT vtkMultiresolutionDeformation : public vtkSurfaceDeformation
{
public:
  static vtkMultiresolutionDeformation* New();
  vtkTypeMacro(vtkMultiresolutionDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkMultiresolutionDeformation(const vtkMultiresolutionDeformation&) = delete;
  void operator=(const vtkMultiresolutionDeformation&) = delete;

  ///@{
  /**
   * The smoothness k of the base: 1 is a membrane with kinks at the handles, 2 a
   * thin plate, 3 keeps curvature continuous at the handles. Default: 2.
   */
  void SetSmoothness(int smoothness);
  vtkGetMacro(Smoothness, int);
  ///@}

protected:
  vtkMultiresolutionDeformation() = default;
  ~vtkMultiresolutionDeformation() override = default;

  std::unique_ptr<cartan::SurfaceDeformer> NewDeformer(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void ConfigureDeformer(cartan::SurfaceDeformer&, const cartan::ExecutionContext&) override {}

private:
  int Smoothness = 2;
};

#endif
