// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMultiresolutionDeformation
 * @brief deforms a smooth base; details turn with the frames of the base
 *
 * Two-band multiresolution editing: a smooth base surface that solves L^k x = 0
 * between the handles, and the details as offsets in the base's local frames.
 * The base follows the positions of the handles; its frames turn, and the
 * details turn with them.
 *
 * Between the handles the base does not depend on the original shape, so this
 * method suits details on a simple body; details that are not heights over the
 * base are distorted. Only the positions of handle points count, and
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
  vtkSetClampMacro(Smoothness, int, 1, 3);
  vtkGetMacro(Smoothness, int);
  ///@}

protected:
  vtkMultiresolutionDeformation() = default;
  ~vtkMultiresolutionDeformation() override = default;

  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void AddSettings(cartan::ContentKey& settings) const override;

private:
  int Smoothness = 2;
};

#endif
