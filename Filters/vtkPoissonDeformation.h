// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPoissonDeformation
 * @brief spreads the handles' rotations, scales and shears over the surface
 *
 * Poisson editing: the handles' linear maps are blended by weights that
 * decrease from 1 at a handle to 0 at the others; they transform the gradients
 * of the surface, and the surface that fits these best is computed. Rotations
 * are blended by their angles, so that full turns are kept; scale and shear are
 * blended linearly.
 *
 * Only the linear map of a handle acts on the surface: a handle that is only
 * translated stretches the surface without turning it. With GEODESIC weights
 * the tip of a long protrusion turns less than its base, because the tip is
 * farther away; HARMONIC weights turn it as a whole. Rotations about different
 * axes are blended by adding their rotation vectors.
 *
 * One motion per handle; per-point arrays are an error. Ports, arrays, errors:
 * see vtkSurfaceDeformation and vtkFrameDeformation. VolumeCorrection is
 * NO_CORRECTION by default.
 *
 * References: Yu et al., Mesh Editing with Poisson-Based Gradient Field
 * Manipulation, ACM SIGGRAPH 2004. Zayer et al., Harmonic Guidance for Surface
 * Deformation, Eurographics 2005. Sorkine, Differential Representations for
 * Mesh Processing, Computer Graphics Forum 25(4), 2006, section 4.3.
 *
 * @sa vtkShapePreservingDeformation vtkMarkHandle vtkHandleMotion
 */
#ifndef vtkPoissonDeformation_h
#define vtkPoissonDeformation_h

#include "vtkFrameDeformation.h"

class VTKCARTAN_EXPORT vtkPoissonDeformation : public vtkFrameDeformation
{
public:
  static vtkPoissonDeformation* New();
  vtkTypeMacro(vtkPoissonDeformation, vtkFrameDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkPoissonDeformation(const vtkPoissonDeformation&) = delete;
  void operator=(const vtkPoissonDeformation&) = delete;

  enum PropagationType
  {
    HARMONIC = 0,
    GEODESIC = 1
  };

  ///@{
  /**
   * How the handles' maps are spread. Default: HARMONIC.
   */
  vtkSetClampMacro(Propagation, int, HARMONIC, GEODESIC);
  vtkGetMacro(Propagation, int);
  void SetPropagationToHarmonic() { this->SetPropagation(HARMONIC); }
  void SetPropagationToGeodesic() { this->SetPropagation(GEODESIC); }
  ///@}

protected:
  vtkPoissonDeformation() = default;
  ~vtkPoissonDeformation() override = default;

  bool SupportsPieces() const override
  {
    return this->FrameSettingsServePieces() && this->Propagation == HARMONIC;
  }

  cartan::DeformationMethod NewFrameMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void RequireTargets(const cartan::HandleTargets& targets) const override;
  void AddSettings(cartan::ContentKey& settings) const override;

private:
  int Propagation = HARMONIC;
};

#endif
