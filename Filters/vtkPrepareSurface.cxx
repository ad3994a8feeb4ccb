// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPrepareSurface.h"

#include "Bridge/FilterRun.h"
#include "Bridge/PreparedSurface.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/Polygons.h"

#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkPrepareSurface);

static_assert(cartan::LargestHole == 500, "MaximumHoleEdges has this limit");

void vtkPrepareSurface::Execute(cartan::FilterRun& run)
{
  cartan::TriangleSoup soup =
    cartan::ReadTriangles(run.Input(), "input", run.Context().Part(0.0, 0.1));
  if (this->DropDoubledTriangles)
  {
    cartan::SplitDoubledPolygonsAlike(soup.Faces, soup.CellIds);
  }
  cartan::RepairOptions options;
  options.MergesPoints = this->MergePoints;
  options.MergesInnerPoints = this->MergeInnerPoints;
  options.MergeTolerance = this->Tolerance *
    (this->ToleranceIsAbsolute ? 1.0 : cartan::BoundingDiagonal(soup.Positions, soup.Faces));
  options.DropsDoubled = this->DropDoubledTriangles;
  options.Orients = this->OrientConsistently;
  options.CutsNonManifold = this->CutNonManifold;
  options.OrientsOutwards = this->OrientOutwards;
  options.AlternatesNested = this->AlternateNested;
  options.SmallestComponent = this->MinimumComponentArea;
  options.Holes.MaximumEdges = this->MaximumHoleEdges;
  if (this->MaximumHoleLength > 0.0)
  {
    options.Holes.MaximumLength = this->MaximumHoleLength;
  }
  options.FlipsEdges = this->FlipEdges;
  options.Flips.MaximumAngle = this->FlipAngle * cartan::Pi / 180.0;

  cartan::RepairedSurface repaired =
    cartan::RepairSurface(soup.Positions, soup.Faces, options, run.Context().Part(0.1, 0.9));
  repaired.Counts.CollapsedTriangles += static_cast<int>(soup.Repeated.GetCount());
  cartan::WritePreparedSurface(
    run.Input(), soup, repaired, this->AverageMergedArrays, this->JoinCopies, run.Output());
  this->Report = repaired.Counts.Describe();
}

void vtkPrepareSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MergePoints: " << this->MergePoints << "\n";
  os << indent << "MergeInnerPoints: " << this->MergeInnerPoints << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "ToleranceIsAbsolute: " << this->ToleranceIsAbsolute << "\n";
  os << indent << "AverageMergedArrays: " << this->AverageMergedArrays << "\n";
  os << indent << "DropDoubledTriangles: " << this->DropDoubledTriangles << "\n";
  os << indent << "OrientConsistently: " << this->OrientConsistently << "\n";
  os << indent << "CutNonManifold: " << this->CutNonManifold << "\n";
  os << indent << "JoinCopies: " << this->JoinCopies << "\n";
  os << indent << "OrientOutwards: " << this->OrientOutwards << "\n";
  os << indent << "AlternateNested: " << this->AlternateNested << "\n";
  os << indent << "MinimumComponentArea: " << this->MinimumComponentArea << "\n";
  os << indent << "MaximumHoleEdges: " << this->MaximumHoleEdges << "\n";
  os << indent << "MaximumHoleLength: " << this->MaximumHoleLength << "\n";
  os << indent << "FlipEdges: " << this->FlipEdges << "\n";
  os << indent << "FlipAngle: " << this->FlipAngle << "\n";
  os << indent << "Report: " << this->Report << "\n";
}
