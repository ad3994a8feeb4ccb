// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfacePair.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Measure/EdgeLengths.h"
#include "Kernel/Measure/ShapeDistance.h"

#include <map>
#include <string>
#include <vector>

class vtkPolyData;
class vtkTable;

namespace cartan
{
/// What holds for all surfaces that are compared with a reference.
struct ReferenceMeasures
{
  ReferenceMeasures(const SurfacePair& pair, const ExecutionContext& context);

  std::size_t GetBytes() const
  {
    return TotalBytes(this->Components, this->Enclosing, this->Areas) + this->Parts.GetBytes() +
      this->Shape.GetBytes();
  }

  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const DistributedRows> Pieces;
  SurfaceComponents Parts;
  std::vector<ComponentVolume> Components;
  /// Of pieces: which component is inside another has to be found out, and is not.
  bool MayEnclose;
  std::vector<int> Enclosing; ///< the component around each one, -1 if there is none
  Eigen::VectorXd Areas;      ///< of triangles: #T
  ShapeDistances Shape;
};

/// The changes of volume, area, edge lengths and shape that vtkVolumeChange reports.
struct SurfaceChanges
{
  SurfaceChanges(
    const SurfacePair& pair, const ReferenceMeasures& reference, const ExecutionContext& context);

  /// Adds AreaRatio, EdgeLengthRatio and ShapeDistanceDensity; the first becomes active.
  void AddArrays(vtkPolyData* output, const ExecutionContext& context) const;

  /// Fills the table of vtkVolumeChange, and returns its numbers by name.
  std::map<std::string, double> FillTable(vtkTable* output) const;

  const SurfacePair& Pair;
  const ReferenceMeasures& Reference;
  std::vector<ComponentVolume> Components; ///< of the current surface
  EdgeLengthChange Edges;
  ShapeDistance Distance;
};
}
