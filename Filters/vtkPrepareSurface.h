// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPrepareSurface
 * @brief makes a surface fit for deformation: joined, manifold, oriented
 *
 * Surfaces from files are often not what they look like. Their triangles have
 * points of their own (STL), seams have two rows of points (split normals,
 * texture coordinates), neighbors face different sides, three triangles share an
 * edge. The other filters of Cartan refuse such a surface, or would open it
 * along its seams. This one repairs it, in this order:
 *
 * 1. merges points of borders in the same place (MergePoints, Tolerance),
 * 2. drops triangles that use a point twice, and of triangles on the same three
 *    points all but one (DropDoubledTriangles),
 * 3. turns triangles over so that neighbors agree (OrientConsistently),
 * 4. cuts where the surface is not manifold (CutNonManifold): each point gets one
 *    copy per group of triangles that are connected across edges of exactly two
 *    triangles. Bodies that touch along an edge are separated and stay closed.
 *    A one-sided surface, such as a Moebius strip, is cut along a path,
 * 5. orients closed components outward, walls of cavities inward
 *    (OrientOutwards, AlternateNested),
 * 6. removes small components (MinimumComponentArea; off),
 * 7. fills holes (MaximumHoleEdges, MaximumHoleLength; off),
 * 8. flips edges (FlipEdges; off), which improves long and thin triangles.
 *
 * A sound surface passes unchanged.
 *
 * Input: a surface. Triangles, other polygons and strips are repaired; vertices
 * and lines follow their points.
 *
 * Output: the surface. Polygons of which nothing but point ids and direction
 * changed stay polygons, others and strips become triangles. Points keep their
 * coordinates (merged ones those of the first) and precision. Points and cells
 * keep their arrays; filled holes have 0. In addition:
 * - point array `OriginalPointIds` (vtkIdType): the input's point; of merged ones
 *   the first.
 * - point array `CopyOf` (vtkIdType): the first of the copies that a cut made of
 *   one point; the point itself where there is no cut.
 * - point array `JoinedPoints` (vtkIdType), unless JoinCopies is off: the same for points
 *   with copies, -1 for others, and what the input has there. Deformations hold points
 *   of equal value >= 0 together that are in the same place.
 * - cell array `OriginalCellIds` (vtkIdType): the input's cell, -1 in filled holes.
 * - field array `PreparedPointIds` (vtkIdType), a value per point of the input:
 *   the point it has become, -1 if its component was removed.
 * - field arrays (vtkIdType, one value each) that count what was done:
 *   `MergedPoints`, `CollapsedTriangles`, `DoubledTriangles`, `TurnedTriangles`,
 *   `OneSidedEdges`, `NonManifoldEdges`, `CutPoints`, `CopiedPoints`,
 *   `ReversedComponents`, `RemovedComponents`, `FilledHoles`, `OpenHoles` (0 unless
 *   holes are filled), `FillTriangles`, `FlippedEdges`; and as text
 *   `PreparationReport` (vtkStringArray).
 *
 * vtkRestoreSurface carries results back to the surface as it was.
 *
 * Errors, each with an empty output: no triangles, used points that are not
 * finite, cells that use points that do not exist, a tolerance by which all
 * triangles vanish.
 *
 * References for the methods: Liepa, Filling Holes in Meshes, Symposium on
 * Geometry Processing 2003; Lawson, Software for C1 Surface Interpolation, 1977
 * (flips); Van Oosterom, Strackee, The Solid Angle of a Plane Triangle, 1983
 * (which component encloses which).
 *
 * @sa vtkRestoreSurface vtkCleanPolyData vtkFillHolesFilter
 */
#ifndef vtkPrepareSurface_h
#define vtkPrepareSurface_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceFilter.h"

#include <string> // For Report

class VTKCARTAN_EXPORT vtkPrepareSurface : public vtkSurfaceFilter
{
public:
  static vtkPrepareSurface* New();
  vtkTypeMacro(vtkPrepareSurface, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkPrepareSurface(const vtkPrepareSurface&) = delete;
  void operator=(const vtkPrepareSurface&) = delete;

  ///@{
  /**
   * Whether to merge points in the same place. Points that have a closed fan of
   * triangles around them are left alone, unless MergeInnerPoints is on: merging
   * them would join bodies in contact, and front and back of a plate without
   * thickness. On and off by default.
   */
  vtkSetMacro(MergePoints, bool);
  vtkGetMacro(MergePoints, bool);
  vtkBooleanMacro(MergePoints, bool);
  vtkSetMacro(MergeInnerPoints, bool);
  vtkGetMacro(MergeInnerPoints, bool);
  vtkBooleanMacro(MergeInnerPoints, bool);
  ///@}

  ///@{
  /**
   * How far apart points may be that are merged: a part of the bounding box's
   * diagonal, or with ToleranceIsAbsolute a length. At least 0. With 0, the
   * default, only points of equal coordinates are merged. Each point goes to the
   * nearest of those with a smaller id that are kept, so none moves by more than the
   * tolerance; triangles with an edge shorter than that collapse.
   */
  vtkSetNumberMacro(Tolerance, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  vtkSetMacro(ToleranceIsAbsolute, bool);
  vtkGetMacro(ToleranceIsAbsolute, bool);
  vtkBooleanMacro(ToleranceIsAbsolute, bool);
  ///@}

  ///@{
  /**
   * Whether merged points get the mean of their arrays of real numbers (normals
   * of length one), instead of the first point's values. Integers are never
   * averaged. Off by default.
   */
  vtkSetMacro(AverageMergedArrays, bool);
  vtkGetMacro(AverageMergedArrays, bool);
  vtkBooleanMacro(AverageMergedArrays, bool);
  ///@}

  ///@{
  /**
   * Whether to drop all but one of the triangles on the same three points. If two
   * triangles coincide and the surface is closed without them, both are removed:
   * the wall between two bodies in contact. On by default.
   */
  vtkSetMacro(DropDoubledTriangles, bool);
  vtkGetMacro(DropDoubledTriangles, bool);
  vtkBooleanMacro(DropDoubledTriangles, bool);
  ///@}

  ///@{
  /**
   * Whether to turn triangles over so that neighbors agree. Each group of triangles
   * that are connected across edges keeps the side of most of its area. On by default.
   */
  vtkSetMacro(OrientConsistently, bool);
  vtkGetMacro(OrientConsistently, bool);
  vtkBooleanMacro(OrientConsistently, bool);
  ///@}

  ///@{
  /**
   * Whether to cut where the surface is not manifold. On by default.
   */
  vtkSetMacro(CutNonManifold, bool);
  vtkGetMacro(CutNonManifold, bool);
  vtkBooleanMacro(CutNonManifold, bool);
  ///@}

  ///@{
  /**
   * Whether deformations hold the copies of a point together, so that a limb on one
   * point or edge follows what it hangs on: as the array `JoinedPoints` says then. Off,
   * there is no such array, and copies may part. On by default.
   */
  vtkSetMacro(JoinCopies, bool);
  vtkGetMacro(JoinCopies, bool);
  vtkBooleanMacro(JoinCopies, bool);
  ///@}

  ///@{
  /**
   * Whether to turn closed components outward. With AlternateNested those inside
   * an odd number of others face inward: they are walls of cavities. Turn that
   * off when the inner ones are bodies of their own. Both on by default.
   */
  vtkSetMacro(OrientOutwards, bool);
  vtkGetMacro(OrientOutwards, bool);
  vtkBooleanMacro(OrientOutwards, bool);
  vtkSetMacro(AlternateNested, bool);
  vtkGetMacro(AlternateNested, bool);
  vtkBooleanMacro(AlternateNested, bool);
  ///@}

  ///@{
  /**
   * Components with less than this part of the surface's area are removed with
   * their points. 0 to 1; 0, the default, keeps all.
   */
  vtkSetNumberMacro(MinimumComponentArea, 0.0, 1.0);
  vtkGetMacro(MinimumComponentArea, double);
  ///@}

  ///@{
  /**
   * Holes with at most this number of edges are filled with triangles between the points
   * of their border. 0 to 500, since the time grows with the cube; 0, the
   * default, fills none. The outer border of an open surface is a hole too.
   */
  vtkSetClampMacro(MaximumHoleEdges, int, 0, 500);
  vtkGetMacro(MaximumHoleEdges, int);
  ///@}

  ///@{
  /**
   * If not 0, holes with a longer border than this, in length units, are not
   * filled. 0 by default.
   */
  vtkSetNumberMacro(MaximumHoleLength, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumHoleLength, double);
  ///@}

  ///@{
  /**
   * Whether to flip edges between nearly coplanar triangles where that makes the
   * smallest angle larger. In the plane this gives a Delaunay triangulation. Caps,
   * triangles with a point nearly on the opposite edge, are flipped away; needles
   * collapse by Tolerance. Off by default.
   */
  vtkSetMacro(FlipEdges, bool);
  vtkGetMacro(FlipEdges, bool);
  vtkBooleanMacro(FlipEdges, bool);
  ///@}

  ///@{
  /**
   * Edges with a larger angle between the normals on either side, in degrees, are
   * not flipped. 0 to 180, 10 by default.
   */
  vtkSetNumberMacro(FlipAngle, 0.0, 180.0);
  vtkGetMacro(FlipAngle, double);
  ///@}

  /**
   * What the last update did, in sentences; empty before and after an error.
   */
  const char* GetReport() const { return this->Report.c_str(); }

protected:
  vtkPrepareSurface() = default;
  ~vtkPrepareSurface() override = default;

  void UsePreparedInput(cartan::FilterRun&) const override { this->RefusePrepareInput(); }
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override { this->Report.clear(); }
  // What its arrays say of points and cells is about the joined surface.
  bool HandsBackPieces() const override { return false; }

private:
  bool MergePoints = true;
  bool MergeInnerPoints = false;
  double Tolerance = 0.0;
  bool ToleranceIsAbsolute = false;
  bool AverageMergedArrays = false;
  bool DropDoubledTriangles = true;
  bool OrientConsistently = true;
  bool CutNonManifold = true;
  bool JoinCopies = true;
  bool OrientOutwards = true;
  bool AlternateNested = true;
  double MinimumComponentArea = 0.0;
  int MaximumHoleEdges = 0;
  double MaximumHoleLength = 0.0;
  bool FlipEdges = false;
  double FlipAngle = 10.0;
  std::string Report;
};

#endif
