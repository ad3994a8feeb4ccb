// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/SurfaceWriter.h"

#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/Polygons.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
/// From the kernel to the output, block by block: the input's own coordinates where nothing
/// moved (to the origin and back would cost them their last bit).
template <typename Array>
class CoordinateWriter
{
public:
  using Real = typename Array::ValueType;

  CoordinateWriter(const Surface& surface, vtkDataArray* input, Array* output)
    : TheSurface(surface)
    , Input(input)
    , To(output->GetPointer(0))
  {
    auto* same = Array::FastDownCast(input);
    this->From = same ? same->GetPointer(0) : nullptr;
  }

  /// Whether the vertices [begin, end), three numbers each in `positions`, are finite and have
  /// moved by no more than `farthest` along each axis.
  bool Write(int begin, int end, const double* positions, double farthest) const
  {
    const TriangleMesh& mesh = *this->TheSurface.Mesh;
    const double* rest = this->TheSurface.Positions->data() + 3 * static_cast<std::size_t>(begin);
    const double* origin = this->TheSurface.Origin.data();
    // Without branches for each coordinate, which would cost as much as writing.
    bool isGood = true;
    for (int v = begin; v < end; ++v, positions += 3, rest += 3)
    {
      Real* point = this->To + 3 * static_cast<std::size_t>(v);
      const double x = positions[0] - rest[0];
      const double y = positions[1] - rest[1];
      const double z = positions[2] - rest[2];
      const bool isStill = (x == 0.0) & (y == 0.0) & (z == 0.0);
      if (isStill || !mesh.IsUsed(v))
      {
        this->CopyInput(v, point);
        continue;
      }
      point[0] = static_cast<Real>(positions[0] + origin[0]);
      point[1] = static_cast<Real>(positions[1] + origin[1]);
      point[2] = static_cast<Real>(positions[2] + origin[2]);
      // x - x is 0 unless x is infinite or NaN.
      isGood &= (point[0] - point[0]) + (point[1] - point[1]) + (point[2] - point[2]) == Real(0);
      isGood &= std::abs(x) <= farthest;
      isGood &= std::abs(y) <= farthest;
      isGood &= std::abs(z) <= farthest;
    }
    return isGood;
  }

private:
  void CopyInput(int v, Real* point) const
  {
    for (int c = 0; c < 3; ++c)
    {
      point[c] = this->From ? this->From[3 * static_cast<std::size_t>(v) + c]
                            : static_cast<Real>(this->Input->GetComponent(v, c));
    }
  }

  const Surface& TheSurface;
  vtkDataArray* Input;
  const Real* From;
  Real* To;
};

/// Whether all coordinates are as CoordinateWriter wants them.
template <typename Array>
bool WriteBlocks(const Surface& surface, const PositionRows& rows, double farthest,
  vtkDataArray* input, Array* output, const ExecutionContext& context)
{
  const CoordinateWriter<Array> writer(surface, input, output);
  // A piece's surface has vertices of other ranks, too.
  const int count = static_cast<int>(output->GetNumberOfTuples());
  std::atomic<bool> isGood{ true };
  // Over blocks: what a thread does between two of them counts as one step.
  context.For(count / PositionBlock + 1,
    [&](int firstBlock, int endBlock)
    {
      double buffer[3 * PositionBlock];
      for (int block = firstBlock; block < endBlock; ++block)
      {
        const int begin = block * PositionBlock;
        const int end = std::min(begin + PositionBlock, count);
        rows(begin, end, buffer);
        if (!writer.Write(begin, end, buffer, farthest))
        {
          isGood = false;
        }
      }
    });
  return isGood;
}

/// Points for the output in the precision of the input, and whether they are as
/// CoordinateWriter wants them.
bool FillPoints(const Surface& surface, const PositionRows& rows, double farthest,
  vtkPolyData* input, vtkPoints* points, const ExecutionContext& context)
{
  if (input->GetNumberOfPoints() == 0)
  {
    return true;
  }
  const bool isFloat = input->GetPoints()->GetDataType() == VTK_FLOAT;
  points->SetDataType(isFloat ? VTK_FLOAT : VTK_DOUBLE);
  points->SetNumberOfPoints(input->GetNumberOfPoints());
  vtkDataArray* from = input->GetPoints()->GetData();
  return isFloat ? WriteBlocks(surface, rows, farthest, from,
                     vtkFloatArray::FastDownCast(points->GetData()), context)
                 : WriteBlocks(surface, rows, farthest, from,
                     vtkDoubleArray::FastDownCast(points->GetData()), context);
}

[[noreturn]] void ThrowNotFinite(const Surface& surface, vtkDataArray* coordinates)
{
  IdSample bad;
  for (int v = 0; v < static_cast<int>(coordinates->GetNumberOfTuples()); ++v)
  {
    double point[3];
    coordinates->GetTuple(v, point);
    if (surface.Mesh->IsUsed(v) && !Eigen::Map<const Eigen::Vector3d>(point).allFinite())
    {
      bad.Add(v);
    }
  }
  throw Error(ErrorCode::BadInput,
    "The result has " + bad.Describe("point", "points") + " outside the range of " +
      (coordinates->GetDataType() == VTK_FLOAT ? "single precision: give the points as double, or "
                                               : "double precision: ") +
      "use smaller motions.");
}

/// n turned as `before` turns into `after`, both unit vectors, by the shortest way.
Eigen::Vector3d Turned(
  const Eigen::Vector3d& n, const Eigen::Vector3d& before, const Eigen::Vector3d& after)
{
  const double along = before.dot(n);
  const double cosine = before.dot(after);
  if (cosine < -1.0 + 1e-12)
  {
    return n - along * before + along * after; // opposite: no shortest way, across stays
  }
  const Eigen::Vector3d middle = before + after;
  return n - (middle.dot(n) / (1.0 + cosine)) * middle + 2.0 * along * after;
}

/// New normals after a motion: `before` and `after` are the computed ones, zero
/// where there is none; the old ones stay where these are equal. Without `before`
/// the new ones are those computed.
vtkSmartPointer<vtkDataArray> NewNormals(
  vtkDataArray* old, const Points* before, const Points& after)
{
  vtkSmartPointer<vtkDataArray> normals;
  normals.TakeReference(
    vtkDataArray::CreateDataArray(old->GetDataType() == VTK_DOUBLE ? VTK_DOUBLE : VTK_FLOAT));
  normals->SetName(old->GetName());
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(old->GetNumberOfTuples());
  for (vtkIdType i = 0; i < old->GetNumberOfTuples(); ++i)
  {
    Eigen::Vector3d normal;
    old->GetTuple(i, normal.data());
    const bool hasNew = !after.row(i).isZero(0.0);
    if (hasNew && (!before || normal.isZero(0.0)))
    {
      normal = after.row(i);
    }
    else if (before && hasNew && !before->row(i).isZero(0.0) && before->row(i) != after.row(i))
    {
      normal = Turned(normal, before->row(i), after.row(i));
    }
    normals->SetTuple(i, normal.data());
  }
  return normals;
}

/// Replaces the normals of points or cells. Returns a warning where their number
/// is not that of the points or cells: such an array is left out.
template <typename Compute>
std::string UpdateNormals(vtkDataSetAttributes* attributes, vtkIdType count,
  const std::string& what, const Points* rest, const Points& positions, const Compute& compute)
{
  vtkSmartPointer<vtkDataArray> old = attributes->GetNormals();
  if (!old)
  {
    return {};
  }
  const std::string name = old->GetName() ? old->GetName() : "";
  if (old->GetNumberOfTuples() != count || old->GetNumberOfComponents() != 3)
  {
    attributes->SetActiveAttribute(-1, vtkDataSetAttributes::NORMALS);
    attributes->RemoveArray(name.c_str());
    return "The normals \"" + name + "\" have " + std::to_string(old->GetNumberOfTuples()) +
      " tuples for " + std::to_string(count) + " " + what +
      " and are left out: compute them anew (Surface Normals, Splitting off).";
  }
  const Points after = compute(positions);
  if (rest)
  {
    const Points before = compute(*rest);
    attributes->SetNormals(NewNormals(old, &before, after));
  }
  else
  {
    attributes->SetNormals(NewNormals(old, nullptr, after));
  }
  return {};
}

/// What is left of the width of triangles where a part has shrunk to a point or a line, in parts
/// of the size.
constexpr double Crushed = 1e-10;

/// Whether rounding makes the triangles around a vertex: all have less area than `least` times
/// their longest edge.
bool IsCrushed(const TriangleMesh& mesh, const Points& points, int v, double least)
{
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    if (mesh.LeftTriangle(d) >= 0)
    {
      const Eigen::Vector3d edge = points.row(mesh.Neighbor(d)) - points.row(v);
      const Eigen::Vector3d next = points.row(mesh.Opposite(d)) - points.row(v);
      const double longest =
        std::max({ edge.squaredNorm(), next.squaredNorm(), (next - edge).squaredNorm() });
      if (0.25 * edge.cross(next).squaredNorm() > least * least * longest)
      {
        return false;
      }
    }
  }
  return true;
}

/// Vertex normals; zero too where the triangles are crushed.
Points NormalsOfVertices(
  const TriangleMesh& mesh, const Points& points, double least, const ExecutionContext& context)
{
  Points normals = VertexNormals(mesh, points, context);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (IsCrushed(mesh, points, v, least))
    {
      normals.row(v).setZero();
    }
  }
  return normals;
}

std::string UpdateAllNormals(const Surface& surface, const Points* rest, const Points& positions,
  vtkPolyData* output, const ExecutionContext& context)
{
  const vtkIdType numberOfCells = output->GetNumberOfCells();
  const double least = output->GetPointData()->GetNormals()
    ? Crushed * BoundingDiagonal(rest ? *rest : positions, surface.Mesh->GetTriangles())
    : 0.0;
  const std::string ofPoints = UpdateNormals(output->GetPointData(), output->GetNumberOfPoints(),
    "points", rest, positions,
    [&](const Points& points) { return NormalsOfVertices(*surface.Mesh, points, least, context); });
  const std::string ofCells =
    UpdateNormals(output->GetCellData(), numberOfCells, "cells", rest, positions,
      [&](const Points& points)
      {
        // The last is for triangles that only other ranks have.
        return PolygonNormals(
          points, surface.Mesh->GetTriangles(), surface.Cells->CellIds, numberOfCells + 1);
      });
  return ofPoints + (ofPoints.empty() || ofCells.empty() ? "" : " ") + ofCells;
}
}

std::string WriteSurface(const Surface& surface, const Points& positions, vtkPolyData* input,
  vtkPolyData* output, const ExecutionContext& context)
{
  output->ShallowCopy(input);
  vtkNew<vtkPoints> points;
  const PositionRows rows = [&positions](int begin, int end, double* to)
  { std::copy(positions.row(begin).data(), positions.row(begin).data() + 3 * (end - begin), to); };
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  if (!FillPoints(surface, rows, anywhere, input, points, context))
  {
    ThrowNotFinite(surface, points->GetData());
  }
  output->SetPoints(points);
  return UpdateAllNormals(surface, surface.Positions.get(), positions, output, context);
}

bool WriteSurfaceRows(const Surface& surface, const PositionRows& rows, double farthest,
  vtkPolyData* input, vtkPolyData* output, const ExecutionContext& context)
{
  output->ShallowCopy(input);
  vtkNew<vtkPoints> points;
  const bool isGood = FillPoints(surface, rows, farthest, input, points, context);
  if (isGood)
  {
    output->SetPoints(points);
  }
  return isGood;
}

void WriteReconstruction(const Surface& surface, const Points& positions, vtkPolyData* input,
  vtkPolyData* output, const ExecutionContext& context)
{
  output->ShallowCopy(input);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(positions.rows());
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
  {
    points->SetPoint(v, positions.row(v).data());
  }
  output->SetPoints(points);
  UpdateAllNormals(surface, nullptr, positions, output, context);
}
}
