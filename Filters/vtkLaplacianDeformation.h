// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkLaplacianDeformation
 * @brief moves handles and computes the rotations of the surface from their positions
 *
 * Laplacian editing: the surface whose differential coordinates (each point
 * relative to its neighbors) fit those of the input best, for given positions
 * of the handles. Only these positions count, not the rotation of a motion
 * itself: a handle that is only translated turns its surroundings.
 *
 * - NO_ROTATIONS: differential coordinates keep their direction. Fast, and only
 *   for small motions: details are sheared.
 * - ESTIMATED: they turn as the surface did in the previous round, Rounds
 *   times. Good up to about 120 degrees.
 * - IMPLICIT: similarities that are linear in the unknown positions, then a
 *   solve with their rotations. The system is three times as large; for
 *   rotations up to about 90 degrees.
 *
 * All three lose volume in bends: 5 % at 90 degrees and 19 % at 170 with
 * ESTIMATED on a bar six times as long as wide. For large rotations that are
 * known, use vtkShapePreservingDeformation.
 *
 * ConstrainHandlePositions must be on. Ports, arrays, errors: see
 * vtkSurfaceDeformation.
 *
 * References: Lipman et al., Differential Coordinates for Interactive Mesh
 * Editing, Shape Modeling International 2004. Sorkine et al., Laplacian Surface
 * Editing, Symposium on Geometry Processing 2004. Sorkine, Differential
 * Representations for Mesh Processing, Computer Graphics Forum 25(4), 2006,
 * section 4.3.
 *
 * @sa vtkSimilarityDeformation vtkMarkHandle vtkHandleMotion
 */
#ifndef vtkLaplacianDeformation_h
#define vtkLaplacianDeformation_h

#include "vtkSurfaceDeformation.h"

class VTKCARTAN_EXPORT vtkLaplacianDeformation : public vtkSurfaceDeformation
{
public:
  static vtkLaplacianDeformation* New();
  vtkTypeMacro(vtkLaplacianDeformation, vtkSurfaceDeformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkLaplacianDeformation(const vtkLaplacianDeformation&) = delete;
  void operator=(const vtkLaplacianDeformation&) = delete;

  enum RotationsType
  {
    NO_ROTATIONS = 0,
    ESTIMATED = 1,
    IMPLICIT = 2
  };

  ///@{
  /**
   * How differential coordinates turn. Default: ESTIMATED.
   */
  vtkSetClampMacro(Rotations, int, NO_ROTATIONS, IMPLICIT);
  vtkGetMacro(Rotations, int);
  void SetRotationsToNone() { this->SetRotations(NO_ROTATIONS); }
  void SetRotationsToEstimated() { this->SetRotations(ESTIMATED); }
  void SetRotationsToImplicit() { this->SetRotations(IMPLICIT); }
  ///@}

  ///@{
  /**
   * ESTIMATED: the number of rounds; each needs one back-substitution. Default:
   * 5.
   */
  vtkSetClampMacro(Rounds, int, 1, 1000);
  vtkGetMacro(Rounds, int);
  ///@}

protected:
  vtkLaplacianDeformation() = default;
  ~vtkLaplacianDeformation() override = default;

  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override;
  void AddSettings(cartan::ContentKey& settings) const override;

private:
  int Rotations = ESTIMATED;
  int Rounds = 5;
};

#endif
