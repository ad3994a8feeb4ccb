// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkDifferentialReconstruction
 * @brief reconstructs a surface from differential coordinates and a few anchors
 *
 * The input has the connectivity and the array of vtkDifferentialCoordinates, which
 * anything may have changed: the surface is the one whose differential coordinates fit
 * the array best in the least-squares sense. Scaled coordinates exaggerate or remove
 * detail, smoothed ones smooth the surface, coordinates of another surface of the same
 * cells bring its detail.
 *
 * Differential coordinates do not say where the surface is. *Anchors* do: the points
 * whose value in the `Handle` array (see vtkMarkHandle) is not 0, at least one of each
 * connected component. They are held where they are in the input, or where
 * AnchorPositionArrayName says.
 *
 * LaplacianWeights and Normalization must be those that the coordinates were made
 * with; the field data array that vtkDifferentialCoordinates adds is compared. With
 * cotangent and mean value weights, the weights are those of the input's points: they
 * must be where they were when the coordinates were computed. Uniform weights do not
 * look at points at all.
 *
 * The output has the input's cells, precision and attributes; normals, if present,
 * turn with the surface. Points in no triangle keep their place. One factorization
 * serves as long as cells, weights and the set of anchors stay the same.
 *
 * BlendWeightArrayName and OtherDifferentialCoordinatesArrayName blend the coordinates
 * of two surfaces of the same cells by a weight per point: local morphing (Alexa,
 * Differential Coordinates for Local Mesh Morphing and Deformation, 2003).
 *
 * Errors, each with an empty output: no anchor in a component; an array that is missing,
 * of another size or not finite; other weights or normalization than the coordinates
 * were made with; a weight that is negative. A warning names points that rounding leaves
 * open by more than 1e-5 of the size, as caps of 1e-8 of their edge do with cotangent
 * weights, also because coordinates of another surface hang on the last digits of a cap's
 * corners.
 *
 * Reference: Sorkine, Differential Representations for Mesh Processing, Computer
 * Graphics Forum 25(4), 2006, section 2.2.
 *
 * @sa vtkDifferentialCoordinates vtkMarkHandle
 */
#ifndef vtkDifferentialReconstruction_h
#define vtkDifferentialReconstruction_h

#include "vtkDifferentialFilter.h"
#include "vtkSetNumberMacro.h" // For properties

class VTKCARTAN_EXPORT vtkDifferentialReconstruction : public vtkDifferentialFilter
{
public:
  static vtkDifferentialReconstruction* New();
  vtkTypeMacro(vtkDifferentialReconstruction, vtkDifferentialFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkDifferentialReconstruction(const vtkDifferentialReconstruction&) = delete;
  void operator=(const vtkDifferentialReconstruction&) = delete;

  ///@{
  /**
   * The point array of whole numbers >= 0 whose points other than 0 are the anchors.
   * Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * A point array with 3 components, the positions of the anchors in length units; read
   * at anchors only. Empty (the default): where they are in the input.
   */
  void SetAnchorPositionArrayName(const std::string& name)
  {
    this->SetMember(this->AnchorPositionArrayName, name);
  }
  std::string GetAnchorPositionArrayName() const { return this->AnchorPositionArrayName; }
  ///@}

  enum AnchorModeType
  {
    SOFT = 0,
    HARD = 1,
    SUBSTITUTED = 2
  };

  ///@{
  /**
   * How anchors are held. SOFT: near their positions, by ConstraintWeight. HARD:
   * exactly, while their own differential coordinates still count. SUBSTITUTED:
   * exactly, and their differential coordinates are left out, which spreads noise two
   * to three times as far. All give the same surface where the coordinates fit.
   * Default: HARD.
   */
  vtkSetClampMacro(AnchorMode, int, SOFT, SUBSTITUTED);
  vtkGetMacro(AnchorMode, int);
  void SetAnchorModeToSoft() { this->SetAnchorMode(SOFT); }
  void SetAnchorModeToHard() { this->SetAnchorMode(HARD); }
  void SetAnchorModeToSubstituted() { this->SetAnchorMode(SUBSTITUTED); }
  ///@}

  ///@{
  /**
   * The weight w > 0 of a soft anchor: adds w^2 times its squared distance to the sum of
   * squared residuals. Has no effect in the other modes. Default: 1.
   */
  vtkSetNumberMacro(ConstraintWeight, 1e-6, 1e6);
  vtkGetMacro(ConstraintWeight, double);
  ///@}

  ///@{
  /**
   * A point array of one number >= 0 per point that multiplies ConstraintWeight at
   * soft anchors; 0 makes a point none. Empty by default.
   */
  void SetConstraintWeightArrayName(const std::string& name)
  {
    this->SetMember(this->ConstraintWeightArrayName, name);
  }
  std::string GetConstraintWeightArrayName() const { return this->ConstraintWeightArrayName; }
  ///@}

  ///@{
  /**
   * A second array of differential coordinates, and the point array of a weight w per
   * point, usually in [0, 1], that blends both: (1 - w) first + w second. Both names or
   * none must be set. Empty by default.
   */
  void SetOtherDifferentialCoordinatesArrayName(const std::string& name)
  {
    this->SetMember(this->OtherDifferentialCoordinatesArrayName, name);
  }
  std::string GetOtherDifferentialCoordinatesArrayName() const
  {
    return this->OtherDifferentialCoordinatesArrayName;
  }
  void SetBlendWeightArrayName(const std::string& name)
  {
    this->SetMember(this->BlendWeightArrayName, name);
  }
  std::string GetBlendWeightArrayName() const { return this->BlendWeightArrayName; }
  ///@}

  /**
   * How many factorizations the last update took: 0 when the kept one served.
   */
  vtkGetMacro(NumberOfFactorizations, int);

protected:
  vtkDifferentialReconstruction() = default;
  ~vtkDifferentialReconstruction() override = default;

  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override { this->NumberOfFactorizations = 0; }

private:
  std::string HandleArrayName = "Handle";
  std::string AnchorPositionArrayName;
  std::string ConstraintWeightArrayName;
  std::string OtherDifferentialCoordinatesArrayName;
  std::string BlendWeightArrayName;
  double ConstraintWeight = 1.0;
  int AnchorMode = HARD;
  int NumberOfFactorizations = 0;
};

#endif
