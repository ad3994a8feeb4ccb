// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkCurveDeformation
 * @brief deforms a surface so that a curve on it follows a curve that was drawn
 *
 * Sketch-based editing: the *source curve* is a path on the surface, the
 * *target curve* on port 1 a line, such as a polyline or a spline. Each point of the
 * source curve goes to the place of the target that has the same part of the length,
 * between the ends and between keys; the rest of the surface follows by one of the linear
 * methods. Points of handles (HandleArrayName) and points beyond Reach are pinned.
 *
 * Without a target curve the surface is not deformed. In both cases a ridge or a ravine
 * can be raised along the source curve, to a height (RidgeHeight) or by scaling and turning
 * the differential coordinates beside it (RidgeScale, RidgeTurn).
 *
 * Input 0: the surface. Input 1, optional: the target curve, with a point array of keys
 * if there are some (KeyArrayName). Output: the deformed surface.
 *
 * Errors, each with an empty output: no path, or points that are not a line of edges; a
 * target that is empty, branches, closes (without ClosedCurve), crosses itself, or is farther
 * from the surface than 10 times its size; keys that are not on the source curve or run in
 * another order; deltas that change in all of a part; and what vtkSurfaceDeformation refuses.
 * PrepareInput is an error.
 *
 * Reference: Nealen et al., A Sketch-Based Interface for Detail-Preserving Mesh Editing,
 * ACM SIGGRAPH 2005. Sorkine, Differential Representations for Mesh Processing, Computer
 * Graphics Forum 25(4), 2006, section 4.3.
 *
 * @sa vtkMarkHandle vtkLaplacianDeformation vtkRotationInvariantDeformation
 */
#ifndef vtkCurveDeformation_h
#define vtkCurveDeformation_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceFilter.h"

#include <string> // For array names
#include <vector> // For point ids

class vtkAlgorithmOutput;
class vtkPolyData;

namespace cartan
{
class ContentKey;
struct CurveAcross;
struct HandleProblem;
struct Surface;
}

class VTKCARTAN_EXPORT vtkCurveDeformation : public vtkSurfaceFilter
{
public:
  static vtkCurveDeformation* New();
  vtkTypeMacro(vtkCurveDeformation, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkCurveDeformation(const vtkCurveDeformation&) = delete;
  void operator=(const vtkCurveDeformation&) = delete;

  ///@{
  /**
   * The target curve on port 1.
   */
  void SetTargetData(vtkPolyData* curve);
  void SetTargetConnection(vtkAlgorithmOutput* curve) { this->SetInputConnection(1, curve); }
  ///@}

  enum SourceType
  {
    SELECTED_POINTS = 0,
    SHORTEST_PATH = 1,
    FEATURE_EDGES = 2,
    SILHOUETTE = 3,
    GEODESIC = 4
  };

  ///@{
  /**
   * The source curve. SELECTED_POINTS: PointIds, in any order, that form one line of
   * edges; it starts at the end that is nearer to the target's start, without a target at the
   * one that is named first. The others go from each of PointIds to the next. GEODESIC: on the
   * shortest way across triangles; of each edge that it crosses the nearer end moves, and stays
   * as far beside the curve as it was. The others on the shortest way along edges: SHORTEST_PATH
   * along all edges, which zigzags; FEATURE_EDGES along those whose triangles are more than
   * FeatureAngle apart, and borders; SILHOUETTE along those that a viewer along ViewDirection
   * sees as outline, and borders. Points beside such edges stand for the nearest one on them.
   * Default: GEODESIC.
   */
  vtkSetClampMacro(Source, int, SELECTED_POINTS, GEODESIC);
  vtkGetMacro(Source, int);
  void SetSourceToSelectedPoints() { this->SetSource(SELECTED_POINTS); }
  void SetSourceToShortestPath() { this->SetSource(SHORTEST_PATH); }
  void SetSourceToFeatureEdges() { this->SetSource(FEATURE_EDGES); }
  void SetSourceToSilhouette() { this->SetSource(SILHOUETTE); }
  void SetSourceToGeodesic() { this->SetSource(GEODESIC); }
  ///@}

  ///@{
  /**
   * The points that the source curve is made of or passes. At most 1000000.
   */
  void SetNumberOfPointIds(int count);
  int GetNumberOfPointIds() const { return static_cast<int>(this->PointIds.size()); }
  void SetPointId(int index, vtkIdType id);
  vtkIdType GetPointId(int index) const;
  ///@}

  ///@{
  /**
   * For FEATURE_EDGES: the angle between normals in degrees, 0 to 180. Default: 30.
   */
  vtkSetNumberMacro(FeatureAngle, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * For SILHOUETTE: from the viewer to the surface, of any length but 0. Default: (0, 0,
   * -1).
   */
  vtkSetVector3Macro(ViewDirection, double);
  vtkGetVector3Macro(ViewDirection, double);
  ///@}

  ///@{
  /**
   * Whether both curves are rings. The source curve goes on from its last point to its first:
   * three PointIds or more around it; one of FEATURE_EDGES or SILHOUETTE takes the shortest
   * ring of such edges through it, the contour of a part; SELECTED_POINTS form a ring. The
   * target is a ring, or a line whose ends are joined. Its start is where the source's first
   * point is nearest, once both have one center and length, or a key; it runs the way on which
   * points move less, or as three keys tell. Default: off.
   */
  vtkSetMacro(ClosedCurve, bool);
  vtkGetMacro(ClosedCurve, bool);
  vtkBooleanMacro(ClosedCurve, bool);
  ///@}

  ///@{
  /**
   * Whether the target curve runs from its last point to its first; with ClosedCurve, the
   * other way round. Default: off.
   */
  vtkSetMacro(ReverseTarget, bool);
  vtkGetMacro(ReverseTarget, bool);
  vtkBooleanMacro(ReverseTarget, bool);
  ///@}

  ///@{
  /**
   * A point array of the target curve: the id of the point of the source curve that goes
   * to this point, negative for none. Without such an array only the ends are matched.
   * Default: "SourcePoint".
   */
  void SetKeyArrayName(const std::string& name) { this->SetMember(this->KeyArrayName, name); }
  std::string GetKeyArrayName() const { return this->KeyArrayName; }
  ///@}

  ///@{
  /**
   * The point array of handles, all of which are pinned; there need not be one. Default:
   * "Handle".
   */
  void SetHandleArrayName(const std::string& name) { this->SetMember(this->HandleArrayName, name); }
  std::string GetHandleArrayName() const { return this->HandleArrayName; }
  ///@}

  ///@{
  /**
   * Points farther from the source curve along the surface, in length units, are pinned;
   * 0: none. Default: 0.
   */
  vtkSetNumberMacro(Reach, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Reach, double);
  ///@}

  ///@{
  /**
   * How closely the curve is followed, 0 to 1: 1 exactly; f below 1 is a soft constraint of
   * weight f / (1 - f), so that .1 is a hint and .99 is followed up to the finest detail.
   * Default: 1.
   */
  vtkSetNumberMacro(Fidelity, 0.0, 1.0);
  vtkGetMacro(Fidelity, double);
  ///@}

  enum MethodType
  {
    ROTATION_INVARIANT = 0,
    SHAPE_PRESERVING = 1,
    SIMILARITY = 2,
    LAPLACIAN = 3,
    MULTIRESOLUTION = 4
  };

  ///@{
  /**
   * The method for the rest of the surface, with the defaults of its filter, but without
   * volume correction: any linear one that takes a motion per point, so not Poisson, which
   * blends one motion per handle. Default: ROTATION_INVARIANT.
   */
  vtkSetClampMacro(Method, int, ROTATION_INVARIANT, MULTIRESOLUTION);
  vtkGetMacro(Method, int);
  void SetMethodToRotationInvariant() { this->SetMethod(ROTATION_INVARIANT); }
  void SetMethodToShapePreserving() { this->SetMethod(SHAPE_PRESERVING); }
  void SetMethodToSimilarity() { this->SetMethod(SIMILARITY); }
  void SetMethodToLaplacian() { this->SetMethod(LAPLACIAN); }
  void SetMethodToMultiresolution() { this->SetMethod(MULTIRESOLUTION); }
  ///@}

  ///@{
  /**
   * Whether the surface beside the curve turns as the curve's own frames do: by the
   * rotation that fits the curve best, and after it the least one from tangent to tangent.
   * Off: as the method finds it from positions, which only SIMILARITY and LAPLACIAN do;
   * LAPLACIAN always does. Default: on.
   */
  vtkSetMacro(CurveRotations, bool);
  vtkGetMacro(CurveRotations, bool);
  vtkBooleanMacro(CurveRotations, bool);
  ///@}

  ///@{
  /**
   * The height of a ridge along the source curve in length units, along the normals of the
   * deformed surface; negative: a ravine. Default: 0.
   */
  vtkSetMacro(RidgeHeight, double);
  vtkGetMacro(RidgeHeight, double);
  ///@}

  ///@{
  /**
   * By which factor the differential coordinates of the deformed surface beside the source
   * curve grow, before RidgeHeight: above 1 a ridge where the surface is convex, a ravine where
   * it is concave; 0 flat; negative the other way. With SharpRidge those on the curve alone.
   * They vanish in flat places, which stay. Default: 1.
   */
  vtkSetNumberMacro(RidgeScale, -VTK_DOUBLE_MAX, VTK_DOUBLE_MAX);
  vtkGetMacro(RidgeScale, double);
  ///@}

  ///@{
  /**
   * By which angle they turn about the tangents of the curve, in degrees: the surface leans
   * to one side, as for suggestive contours; to the other where the curve runs the other way.
   * Default: 0.
   */
  vtkSetNumberMacro(RidgeTurn, -180.0, 180.0);
  vtkGetMacro(RidgeTurn, double);
  ///@}

  ///@{
  /**
   * How far the ridge reaches to each side along the surface, in length units. 0: five
   * times the mean length of the source curve's edges. Default: 0.
   */
  vtkSetNumberMacro(RidgeWidth, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(RidgeWidth, double);
  ///@}

  ///@{
  /**
   * Whether the ridge has a sharp crest, 1 - t at the part t of its width, instead of a
   * smooth one, (1 - t^2)^2. Default: off.
   */
  vtkSetMacro(SharpRidge, bool);
  vtkGetMacro(SharpRidge, bool);
  vtkBooleanMacro(SharpRidge, bool);
  ///@}

  /**
   * The points of the source curve, of the last update.
   */
  vtkGetMacro(NumberOfCurvePoints, int);

  /**
   * The largest distance of a point of the source curve from its place on the target, in
   * length units, without the ridge.
   */
  vtkGetMacro(LargestDistance, double);

protected:
  vtkCurveDeformation();
  ~vtkCurveDeformation() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;
  void UsePreparedInput(cartan::FilterRun& run) const override;

private:
  struct Curves;

  cartan::CurveAcross FindPath(const cartan::Surface& surface) const;
  Curves ReadCurves(cartan::FilterRun& run, const cartan::Surface& surface) const;
  cartan::HandleProblem MakeProblem(
    cartan::FilterRun& run, const cartan::Surface& surface, const std::vector<int>& path) const;
  void Deform(
    cartan::FilterRun& run, const std::shared_ptr<const cartan::Surface>& surface, Curves& curves);
  bool HasRidge() const;
  void RaiseRidge(cartan::FilterRun& run, const cartan::Surface& surface, Curves& curves) const;

  std::vector<vtkIdType> PointIds;
  std::string KeyArrayName = "SourcePoint";
  std::string HandleArrayName = "Handle";
  double ViewDirection[3] = { 0.0, 0.0, -1.0 };
  double FeatureAngle = 30.0;
  double Reach = 0.0;
  double Fidelity = 1.0;
  double RidgeHeight = 0.0;
  double RidgeWidth = 0.0;
  double RidgeScale = 1.0;
  double RidgeTurn = 0.0;
  double LargestDistance = 0.0;
  int Source = GEODESIC;
  int Method = ROTATION_INVARIANT;
  int NumberOfCurvePoints = 0;
  bool ClosedCurve = false;
  bool ReverseTarget = false;
  bool CurveRotations = true;
  bool SharpRidge = false;
};

#endif
