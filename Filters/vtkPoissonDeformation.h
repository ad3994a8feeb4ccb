// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPoissonDeformation
 * @brief spreads the handles' rotations, scales and shears over the surface
 *
 * Poisson editing: each handle's linear map is blended with the identity by
 * weights that fall from 1 at the handle to 0 at the others, the gradients of
 * the surface are transformed, and the surface that fits them best is found.
 * Rotations are blended by their angle, so that laps are kept; scale and shear
 * are blended linearly.
 *
 * What a handle passes on is its linear map: one that is only translated
 * stretches the surface without turning it. With GEODESIC weights a long
 * protrusion gets less of a motion at its tip than at its base, because its tip
 * is farther away; HARMONIC ones turn it as a whole. Rotations about different
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
  void SetPropagation(int propagation);
  vtkGetMacro(Propagation, int);
  void SetPropagationToHarmonic() { this->SetPropagation(HARMONIC); }
  void SetPropagationToGeodesic() { this->SetPropagation(GEODESIC); }
  ///@}

protected:
  vtkPoissonDeformation() = default;
  ~vtkPoissonDeformation() override = default;

  std::unique_ptr<cartan::SurfaceDeformer> NewFrameDeformer(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;

private:
  int Propagation = HARMONIC;
};

#endif
