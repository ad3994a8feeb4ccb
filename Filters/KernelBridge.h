// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/ExecutionContext.h"
#include "Kernel/Mesh/TriangleMesh.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkCellArray;
class vtkDataArray;
class vtkPoints;
class vtkPolyData;

/// The one place where VTK data become kernel data and back. Private to the
/// filters, not installed.
namespace cartan
{
/// A vtkPolyData as the kernel sees it. Rows are point ids, so every id in a
/// kernel message is one the user knows.
struct Surface
{
  TriangleMesh Mesh;
  /// Relative to Origin, the center of the bounding box of the used points: a
  /// surface far from the world's origin keeps its digits.
  Points Positions;
  Eigen::Vector3d Origin = Eigen::Vector3d::Zero();
  /// The cell that each triangle comes from.
  std::vector<long long> CellIds;
  /// What is odd but no obstacle, in sentences; empty if nothing is.
  std::string Warning;

  /// What the surface was read from, for IsSameSurface.
  struct Source
  {
    vtkSmartPointer<vtkPoints> Points;
    vtkSmartPointer<vtkCellArray> Polygons;
    vtkSmartPointer<vtkCellArray> Strips;
    vtkMTimeType PointsTime = 0;
    vtkMTimeType PolygonsTime = 0;
    vtkMTimeType StripsTime = 0;
  };
  Source ReadFrom;
};

/// Triangles as they are, other polygons and strips triangulated, vertices and
/// lines left out, triangles that name a point twice dropped with a warning.
/// `role` names the input in messages ("input", "reference").
/// Throws Error(BadInput) when there is no triangle, a used point is not
/// finite, or the triangles are no oriented manifold.
Surface ReadSurface(vtkPolyData* input, const std::string& role = "input");

/// The triangles of a surface that need not be a manifold, nor oriented.
struct TriangleSoup
{
  Triangles Faces;                // #T x 3, point ids
  Points Positions;               // #V x 3, as they are
  std::vector<long long> CellIds; // the cell that each triangle comes from
  IdSample Repeated;              // cells with a triangle that names a point twice, left out
};

/// As ReadSurface, but accepts whatever the triangles are. Throws Error(BadInput)
/// when there is none, or a cell uses a point that does not exist.
TriangleSoup ReadTriangles(vtkPolyData* input, const std::string& role = "input");

/// The triangles alone, with all positions at the origin: for filters that do
/// not look at coordinates and so cannot triangulate. Throws Error(BadInput) as
/// ReadSurface does, and for polygons that are no triangles.
Surface ReadConnectivity(vtkPolyData* input, const std::string& role = "input");

/// Whether `input` still has the points and polygons that it had, compared by
/// value. Upstream filters that run again hand on equal data in new arrays.
bool IsSameSurface(const Surface::Source& before, vtkPolyData* input);

/// Makes `output` a shallow copy of `input` with new points in the input's
/// precision: `positions` (#V x 3, relative to origin) for used points, the
/// input's own for the others. Point and cell normals, if present, are
/// computed anew and keep their side of the surface.
void WriteSurface(const Surface& surface, const Points& positions, vtkPolyData* input,
  vtkPolyData* output, const ExecutionContext& context);

/// Adds a point array of doubles with `components` values per row of `values`.
void AddPointArray(vtkPolyData* output, const std::string& name, const double* values,
  vtkIdType numberOfTuples, int components);

/// A numeric point array of `components` numbers per point. Throws
/// Error(BadInput) when it is missing or of another size.
vtkDataArray* RequirePointArray(vtkPolyData* input, const std::string& name, int components);

/// Frames as the point arrays FrameTangent1, FrameTangent2 and FrameNormal of
/// three doubles each.
void AddFrameArrays(vtkPolyData* output, const Matrices& frames);
Matrices ReadFrameArrays(vtkPolyData* input);

/// vtkSMPTools, the algorithm's progress and its AbortExecute.
ExecutionContext MakeContext(vtkAlgorithm* algorithm);

/// Runs the body of a RequestData. Every exception ends here as one
/// vtkErrorMacro on `algorithm` with all its outputs empty and 0 returned: one
/// that left RequestData would take ParaView down. An abort empties the outputs
/// and returns 1 without a message. Refuses a surface that is spread over
/// several ranks.
int RunGuarded(vtkAlgorithm* algorithm, const std::function<void()>& body);

/// vtkWarningMacro on `algorithm` if `text` is not empty.
void Warn(vtkAlgorithm* algorithm, const std::string& text);
}
