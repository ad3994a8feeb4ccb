// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkCoatingTransfer
 * @brief puts the details of one surface onto another
 *
 * The *coating* of the source (input 1) is the difference between it and its smooth base:
 * input 2 with the same points and cells, or, where nothing is connected, the source
 * smoothed by Smoothing. Each point of the target (input 0) moves by the coating at its
 * place on the base, turned as its neighborhood there is turned, and scaled with its size
 * (ScaleDetails).
 *
 * Output: the target with moved points in its precision, normals turned along, and the
 * point arrays
 * - `Coating` (3 doubles, length units): by how much the point moved,
 * - `CorrespondenceDistance` (double, length units of the source, or without unit for texture
 *   coordinates): from the point, aligned, to its place on the base,
 * - with TransferArrays the numeric point arrays of the source that the target does not
 *   have, as doubles: interpolated at the places; those of three components turn along.
 * Points in no triangle keep their place and get zeros.
 *
 * Output 1: the smooth base that was used, with the source's points, cells and arrays.
 *
 * Errors, each with an empty output: POINT_ID with different numbers of points; LAPLACIANS
 * without POINT_ID or with other triangles; KEYS with
 * fewer than three points of equal keys, or all on one line; missing texture coordinates; a smooth
 * source of other cells; a region array that is missing; see vtkSurfaceFilter. A warning tells when
 * the source has no detail, and when places are farther than a tenth of the source's size on
 * average.
 *
 * References: Sorkine, Cohen-Or, Lipman, Alexa, Roessl, Seidel, Laplacian Surface Editing,
 * Symposium on Geometry Processing 2004, section 4; Sorkine, Differential Representations for
 * Mesh Processing, Computer Graphics Forum 25(4), 2006, section 4.4.
 *
 * @sa vtkMeshMerge vtkDifferentialReconstruction
 */
#ifndef vtkCoatingTransfer_h
#define vtkCoatingTransfer_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceFilter.h"

#include <string> // For array names

class VTKCARTAN_EXPORT vtkCoatingTransfer : public vtkSurfaceFilter
{
public:
  static vtkCoatingTransfer* New();
  vtkTypeMacro(vtkCoatingTransfer, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkCoatingTransfer(const vtkCoatingTransfer&) = delete;
  void operator=(const vtkCoatingTransfer&) = delete;

  ///@{
  /**
   * The detailed source, input 1, and its smooth base, input 2, which may be missing.
   */
  void SetSourceConnection(vtkAlgorithmOutput* source) { this->SetInputConnection(1, source); }
  void SetSourceData(vtkPolyData* source);
  void SetSmoothSourceConnection(vtkAlgorithmOutput* base) { this->SetInputConnection(2, base); }
  void SetSmoothSourceData(vtkPolyData* base);
  ///@}

  enum CorrespondenceType
  {
    POINT_ID = 0,
    KEYS = 1,
    CLOSEST_POINT = 2,
    TEXTURE_COORDINATES = 3
  };

  ///@{
  /**
   * The place of a target's point on the source's base. POINT_ID: the point of the same
   * id. KEYS: the closest place after the similarity that takes points with equal numbers
   * >= 1 in KeyArrayName closest to each other. CLOSEST_POINT: the closest place after
   * Alignment. TEXTURE_COORDINATES: where the source has the same texture coordinates.
   * Default: CLOSEST_POINT.
   */
  vtkSetClampMacro(Correspondence, int, POINT_ID, TEXTURE_COORDINATES);
  vtkGetMacro(Correspondence, int);
  void SetCorrespondenceToPointId() { this->SetCorrespondence(POINT_ID); }
  void SetCorrespondenceToKeys() { this->SetCorrespondence(KEYS); }
  void SetCorrespondenceToClosestPoint() { this->SetCorrespondence(CLOSEST_POINT); }
  void SetCorrespondenceToTextureCoordinates() { this->SetCorrespondence(TEXTURE_COORDINATES); }
  ///@}

  enum AlignmentType
  {
    AS_THEY_LIE = 0,
    RIGID = 1,
    SIMILARITY = 2
  };

  ///@{
  /**
   * How the target is aligned with the source's base before closest places are found: not,
   * or by the rigid motion or similarity that iterated closest points find from where both
   * centers meet and, with SIMILARITY, both sizes are equal. With surfaces that are turned by more
   * than about 45 degrees to each other use KEYS. Default: SIMILARITY.
   */
  vtkSetClampMacro(Alignment, int, AS_THEY_LIE, SIMILARITY);
  vtkGetMacro(Alignment, int);
  void SetAlignmentToAsTheyLie() { this->SetAlignment(AS_THEY_LIE); }
  void SetAlignmentToRigid() { this->SetAlignment(RIGID); }
  void SetAlignmentToSimilarity() { this->SetAlignment(SIMILARITY); }
  ///@}

  enum RepresentationType
  {
    DISPLACEMENTS = 0,
    LAPLACIANS = 1
  };

  ///@{
  /**
   * What of the coating is turned and carried over. DISPLACEMENTS: how far each point is off
   * the base. LAPLACIANS: its Laplacian coordinates, as the references have it, from which the
   * surface is reconstructed; it needs POINT_ID and the source's triangles on the target.
   * Default: DISPLACEMENTS.
   */
  vtkSetClampMacro(Representation, int, DISPLACEMENTS, LAPLACIANS);
  vtkGetMacro(Representation, int);
  void SetRepresentationToDisplacements() { this->SetRepresentation(DISPLACEMENTS); }
  void SetRepresentationToLaplacians() { this->SetRepresentation(LAPLACIANS); }
  ///@}

  ///@{
  /**
   * How long the waves are, at most, that count as details and make the coating, in mean
   * edges of the source, >= 0. No effect with a smooth source. Default: 10.
   */
  vtkSetNumberMacro(Smoothing, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Smoothing, double);
  ///@}

  ///@{
  /**
   * By what the coating is multiplied. Negative values turn it inwards. Default: 1.
   */
  vtkSetMacro(Strength, double);
  vtkGetMacro(Strength, double);
  ///@}

  ///@{
  /**
   * Whether details are scaled as a component of the target is larger than its places.
   * Default: on.
   */
  vtkSetMacro(ScaleDetails, bool);
  vtkGetMacro(ScaleDetails, bool);
  vtkBooleanMacro(ScaleDetails, bool);
  ///@}

  ///@{
  /**
   * The target's point array of whole numbers whose points other than 0 get the coating.
   * Empty: all do. Default: empty.
   */
  void SetRegionArrayName(const std::string& name) { this->SetMember(this->RegionArrayName, name); }
  std::string GetRegionArrayName() const { return this->RegionArrayName; }
  ///@}

  ///@{
  /**
   * How far into the region, over the surface, the coating rises to its strength, in length
   * units, >= 0. Default: 0.
   */
  vtkSetNumberMacro(FadeWidth, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(FadeWidth, double);
  ///@}

  ///@{
  /**
   * The point array of KEYS, on the target and the source. Default: "CorrespondenceKey".
   */
  void SetKeyArrayName(const std::string& name) { this->SetMember(this->KeyArrayName, name); }
  std::string GetKeyArrayName() const { return this->KeyArrayName; }
  ///@}

  ///@{
  /**
   * Whether the output gets the source's point arrays. Default: off.
   */
  vtkSetMacro(TransferArrays, bool);
  vtkGetMacro(TransferArrays, bool);
  vtkBooleanMacro(TransferArrays, bool);
  ///@}

  /**
   * Output 1, valid after Update().
   */
  vtkPolyData* GetBase();

  ///@{
  /**
   * Valid after Update(), in length units: the mean of `CorrespondenceDistance`, and the root mean
   * square of the source's coating over its points.
   */
  vtkGetMacro(MeanDistance, double);
  vtkGetMacro(CoatingRMS, double);
  ///@}

protected:
  vtkCoatingTransfer();
  ~vtkCoatingTransfer() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }

private:
  struct Sides;
  Sides ReadSides(cartan::FilterRun& run) const;
  void FindPlaces(Sides& sides, cartan::FilterRun& run) const;
  void FindStrengths(Sides& sides, cartan::FilterRun& run) const;
  void WarnOfOddities(const Sides& sides, cartan::FilterRun& run) const;

  std::string RegionArrayName;
  std::string KeyArrayName = "CorrespondenceKey";
  int Correspondence = CLOSEST_POINT;
  int Representation = DISPLACEMENTS;
  int Alignment = SIMILARITY;
  double Smoothing = 10.0;
  double Strength = 1.0;
  double FadeWidth = 0.0;
  bool ScaleDetails = true;
  bool TransferArrays = false;
  double MeanDistance = 0.0;
  double CoatingRMS = 0.0;
};

#endif
