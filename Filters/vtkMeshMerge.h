// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkMeshMerge
 * @brief sews a part onto a surface at their open boundaries
 *
 * Input 0, the *target*, keeps its place. Input 1, the *source*, is deformed so that its
 * boundary loops lie on the target's, with its details kept, turned and scaled; then both
 * are sewn together without a gap.
 *
 * *Which loops*: points with equal numbers >= 1 in the array `BoundaryKey` of both inputs
 * belong together; each on a boundary, once. Several per loop say how it is laid on the
 * other, several loops may have some; loops without stay open. Without any key, one loop
 * each needs nothing, and equal numbers of loops are paired by where they lie, with a
 * warning that says which. Between keys equal parts of the lengths correspond.
 *
 * Output 0: one oriented manifold of triangles, in the target's precision, with the point
 * and cell arrays that both inputs have with equal names, types and components (the
 * target's where both have the point, interpolated where a transition cuts its edges), and
 * - `MergeOrigin` (int, points and cells): 0 target, 1 source, 2 a point on the seam,
 * - `OriginalPointIds`, `OriginalCellIds` (vtkIdType): in the target, and where that has
 *   none in the source,
 * - `Normals`, anew, when an input has normals,
 * - `SourcePart` (double, points) with a TransitionWidth: 0 where details are the target's,
 *   1 where they are the source's; whole numbers and texts do not fade, they change at 1/2,
 * - field data `SeamAngleMean`, `SeamAngleMaximum` (double, degrees): between the normals
 *   of triangles on both sides of the seam.
 * Points in no triangle, vertices and lines are left out.
 *
 * Output 1: what was matched, as lines with the cell arrays `Pair` (int, from 1) and
 * `Kind` (int): 0 the target's loop, 1 the source's loop where it came from, 2 from a point of
 * the source's loop to its place on the target's, 3 the same for a key.
 *
 * As long as the source, its loops and what is held stay the same, nothing is factorized
 * again: a moved key costs two solves. The target's side of a transition is kept as well.
 *
 * Errors, each with empty outputs: an input without boundary; keys that are not on a
 * boundary, on one input only, twice on one, join a loop to several or cross; different numbers
 * of loops without keys; a part of the source that is neither sewn on nor held; boundaries
 * without a direction; a transition wider than the surface, or with held points; a seam that would
 * be no manifold; DEPENDENT with nothing held; motions without
 * DEPENDENT or of handles without points; features on one line, or with held points; see
 * vtkSurfaceFilter.
 *
 * References: Fu, Au, Tai, Effective Derivation of Similarity Transformations for Implicit
 * Laplacian Mesh Editing, Computer Graphics Forum 26(1), 2007, section 5; Sorkine et al.,
 * Laplacian Surface Editing, Symposium on Geometry Processing 2004, section 5 (the blend).
 *
 * @sa vtkBoundaryLoops vtkMarkHandle vtkSimilarityDeformation
 */
#ifndef vtkMeshMerge_h
#define vtkMeshMerge_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceFilter.h"

#include <memory> // For the motions
#include <string> // For array names
#include <vector> // For loops

namespace cartan
{
struct FittedSource;
struct LoopKey;
struct LoopPair;
struct MergeInput;
struct PairedLoops;
}
class vtkHandleMotion;

class VTKCARTAN_EXPORT vtkMeshMerge : public vtkSurfaceFilter
{
public:
  static vtkMeshMerge* New();
  vtkTypeMacro(vtkMeshMerge, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkMeshMerge(const vtkMeshMerge&) = delete;
  void operator=(const vtkMeshMerge&) = delete;

  ///@{
  /**
   * The source, input 1.
   */
  void SetSourceConnection(vtkAlgorithmOutput* source) { this->SetInputConnection(1, source); }
  void SetSourceData(vtkPolyData* source);
  ///@}

  enum ConfigurationType
  {
    INDEPENDENT = 0,
    DEPENDENT = 1
  };

  ///@{
  /**
   * INDEPENDENT: the result is the same wherever the source is, however large and turned.
   * DEPENDENT: the source's place counts. Its handles (HandleArrayName) keep theirs, and
   * with BendWidth only what is near the seam moves. Default: INDEPENDENT.
   */
  vtkSetClampMacro(Configuration, int, INDEPENDENT, DEPENDENT);
  vtkGetMacro(Configuration, int);
  void SetConfigurationToIndependent() { this->SetConfiguration(INDEPENDENT); }
  void SetConfigurationToDependent() { this->SetConfiguration(DEPENDENT); }
  ///@}

  ///@{
  /**
   * How far from its loops, over the surface, the source moves with DEPENDENT, in length
   * units, >= 0. 0: everywhere but at handles. Default: 0.
   */
  vtkSetNumberMacro(BendWidth, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(BendWidth, double);
  ///@}

  ///@{
  /**
   * How wide the bands along the loops are, over the surface, that overlap: the target's
   * is cut off, the source's takes its place, and details and point arrays fade across it
   * from the target's into the source's. In length units of the target, and of the source
   * as it is in the result; >= 0. 0: none, the surfaces touch at their loops. Default: 0.
   */
  vtkSetNumberMacro(TransitionWidth, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TransitionWidth, double);
  ///@}

  ///@{
  /**
   * With a TransitionWidth, the width of the source's band where that is another one, >= 0.
   * 0: the same. Default: 0.
   */
  vtkSetNumberMacro(SourceTransitionWidth, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SourceTransitionWidth, double);
  ///@}

  ///@{
  /**
   * Whether the seam and so many rings of points around it, on both sides, are made smooth
   * by the FairingMethod. 0: not, and the target keeps its place everywhere. Default: 0.
   */
  vtkSetClampMacro(SeamFairing, int, 0, 100);
  vtkGetMacro(SeamFairing, int);
  ///@}

  enum FairingMethodType
  {
    THIN_PLATE = 0,
    DELTA_BLEND = 1
  };

  ///@{
  /**
   * What the seam and its SeamFairing rings become. THIN_PLATE: as smooth as possible, their
   * details are lost. DELTA_BLEND: Laplacian coordinates of both sides blend, so that details
   * are lost next to the seam alone, and curved surfaces go on curved. Default: THIN_PLATE.
   */
  vtkSetClampMacro(FairingMethod, int, THIN_PLATE, DELTA_BLEND);
  vtkGetMacro(FairingMethod, int);
  void SetFairingMethodToThinPlate() { this->SetFairingMethod(THIN_PLATE); }
  void SetFairingMethodToDeltaBlend() { this->SetFairingMethod(DELTA_BLEND); }
  ///@}

  ///@{
  /**
   * The point array of keys, on both inputs: whole numbers, 0 is no key. Default:
   * "BoundaryKey".
   */
  void SetBoundaryKeyArrayName(const std::string& name)
  {
    this->SetMember(this->BoundaryKeyArrayName, name);
  }
  std::string GetBoundaryKeyArrayName() const { return this->BoundaryKeyArrayName; }
  ///@}

  ///@{
  /**
   * The source's point array whose points other than 0 are held with DEPENDENT: they keep
   * their place, or go with the motion of their handle. Default: "Handle".
   */
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * The source's point array of fixed features: points with equal numbers >= 1 move as one
   * similarity, that which takes them closest to where they would come without. With both
   * configurations. Default: "Feature".
   */
  void SetFeatureArrayName(const std::string& name)
  {
    this->SetMember(this->FeatureArrayName, name);
  }
  std::string GetFeatureArrayName() const { return this->FeatureArrayName; }
  ///@}

  ///@{
  /**
   * With DEPENDENT, the motion of handle `id` >= 1 from its place in the input: the source is
   * dragged there and stays sewn. The filter keeps a reference: changing the object
   * modifies this filter. Setting nullptr removes it. A motion factorizes nothing but when
   * other handles begin to move.
   */
  void SetHandleMotion(int id, vtkHandleMotion* motion);
  vtkHandleMotion* GetHandleMotion(int id) const;
  void RemoveAllHandleMotions();
  ///@}

  ///@{
  /**
   * The same for user interfaces: a table of further motions, see vtkSurfaceDeformation.
   */
  void SetNumberOfMotionRows(int count);
  int GetNumberOfMotionRows() const;
  void SetMotionRow(int row, double id, double scaleX, double scaleY, double scaleZ, double angle,
    double axisX, double axisY, double axisZ, double centerX, double centerY, double centerZ,
    double translationX, double translationY, double translationZ);
  ///@}

  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * Valid after Update(): the pairs of loops that were sewn together, and the angles between the
   * normals on both sides of the seam, in degrees.
   */
  vtkGetMacro(NumberOfPairs, int);
  vtkGetMacro(SeamAngleMean, double);
  vtkGetMacro(SeamAngleMaximum, double);
  ///@}

  /**
   * How many matrices the source's systems, which are kept, have factorized.
   */
  vtkGetMacro(NumberOfFactorizations, int);

  /**
   * Output 1, valid after Update().
   */
  vtkPolyData* GetCorrespondences();

protected:
  vtkMeshMerge();
  ~vtkMeshMerge() override;

  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }

private:
  struct Sides;
  struct Sewn;
  struct Holds;
  class Internals;
  Sides ReadSides(cartan::FilterRun& run) const;
  void HoldHandles(const Sides& sides, Holds& holds) const;
  Holds FindHolds(
    const Sides& sides, const std::vector<cartan::LoopPair>& pairs, cartan::FilterRun& run) const;
  std::vector<int> ReadFeatures(const Sides& sides, const Holds& holds) const;
  cartan::FittedSource Fit(const Sides& sides, const cartan::MergeInput& target,
    const std::vector<cartan::LoopPair>& pairs,
    const std::vector<std::vector<cartan::LoopKey>>& keys, Holds& holds, cartan::FilterRun& run);
  Sewn Sew(const Sides& sides, const cartan::PairedLoops& paired, cartan::FilterRun& run);
  void WriteOutputs(const Sides& sides, const cartan::PairedLoops& paired, const Sewn& sewn,
    cartan::FilterRun& run);

  std::string BoundaryKeyArrayName = "BoundaryKey";
  std::string HandleArrayName = "Handle";
  std::string FeatureArrayName = "Feature";
  int Configuration = INDEPENDENT;
  double BendWidth = 0.0;
  double TransitionWidth = 0.0;
  double SourceTransitionWidth = 0.0;
  int SeamFairing = 0;
  int FairingMethod = THIN_PLATE;
  int NumberOfPairs = 0;
  int NumberOfFactorizations = 0;
  double SeamAngleMean = 0.0;
  double SeamAngleMaximum = 0.0;
  std::unique_ptr<Internals> State;
};

#endif
