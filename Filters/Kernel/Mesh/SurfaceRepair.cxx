// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SurfaceRepair.h"

#include "Base/DisjointSets.h"
#include "Mesh/CoincidentPoints.h"
#include "Mesh/DoubledTriangles.h"
#include "Mesh/EdgeTable.h"
#include "Mesh/Geometry.h"
#include "Mesh/NonManifoldCut.h"
#include "Mesh/Orientation.h"
#include "Mesh/TriangleMesh.h"

#include <algorithm>
#include <numeric>

namespace cartan
{
namespace
{
std::vector<char> UsedVertices(Eigen::Index numberOfVertices, const Triangles& triangles)
{
  std::vector<char> isUsed(numberOfVertices, 0);
  for (Eigen::Index corner = 0; corner < triangles.size(); ++corner)
  {
    isUsed[triangles.data()[corner]] = 1;
  }
  return isUsed;
}

void RequireUsable(const Points& points, const Triangles& triangles)
{
  MeshReport report;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    if (triangles.row(t).minCoeff() < 0 || triangles.row(t).maxCoeff() >= points.rows())
    {
      report.OutOfRange.Add(t);
    }
  }
  if (report.IsUsable())
  {
    const std::vector<char> isUsed = UsedVertices(points.rows(), triangles);
    for (Eigen::Index v = 0; v < points.rows(); ++v)
    {
      if (isUsed[v] && !points.row(v).allFinite())
      {
        report.NonFinite.Add(v);
      }
    }
  }
  if (!report.IsUsable())
  {
    throw Error(ErrorCode::BadInput, "The surface has " + report.DescribeErrors());
  }
}

/// Which points may be merged: those on edges of one triangle, or of more than
/// two, and the ends of edges that the tolerance collapses.
std::vector<char> FindSeams(const Points& points, const Triangles& triangles, double tolerance)
{
  std::vector<char> isSeam(points.rows(), 0);
  Triangles faces(triangles.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    const auto corners = triangles.row(t);
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
    {
      faces.row(count++) = corners;
    }
  }
  faces.conservativeResize(count, 3);
  const EdgeTable edges(static_cast<int>(points.rows()), faces);
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    const int a = SideFrom(faces, *edges.Begin(edge));
    const int b = SideTo(faces, *edges.Begin(edge));
    if (edges.NumberOfSides(edge) != 2 || (points.row(a) - points.row(b)).norm() <= tolerance)
    {
      isSeam[a] = isSeam[b] = 1;
    }
  }
  return isSeam;
}

/// The surface on its way through the steps. Until the cut a vertex is an input
/// point, the first of those merged; after it, those and their copies.
class Repair
{
public:
  Repair(const Points& points, const Triangles& triangles, const RepairOptions& options)
    : Input(points)
    , InputFaces(triangles)
    , Options(options)
    , IsUsed(UsedVertices(points.rows(), triangles))
    , Merged(points.rows())
    , Faces(triangles)
    , TriangleIds(triangles.rows())
  {
    std::iota(this->Merged.begin(), this->Merged.end(), 0);
    std::iota(this->TriangleIds.begin(), this->TriangleIds.end(), 0);
  }

  void Merge(const ExecutionContext& context)
  {
    if (this->Options.MergesPoints)
    {
      const double tolerance = this->Options.MergeTolerance;
      this->Merged = FindCoincidentPoints(this->Input,
        this->Options.MergesInnerPoints ? this->IsUsed
                                        : FindSeams(this->Input, this->Faces, tolerance),
        tolerance, context);
      for (int corner = 0; corner < this->Faces.size(); ++corner)
      {
        int& v = this->Faces.data()[corner];
        v = this->Merged[v];
      }
    }
    for (std::size_t v = 0; v < this->Merged.size(); ++v)
    {
      this->Counts.MergedPoints += this->Merged[v] != static_cast<int>(v);
    }
  }

  void DropCollapsedAndDoubled()
  {
    std::vector<char> drop(this->Faces.rows());
    for (Eigen::Index t = 0; t < this->Faces.rows(); ++t)
    {
      const auto corners = this->Faces.row(t);
      drop[t] = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    }
    this->Counts.CollapsedTriangles = this->Drop(drop);
    if (this->Options.DropsDoubled)
    {
      this->Counts.DoubledTriangles =
        this->Drop(FindDoubledTriangles(static_cast<int>(this->Input.rows()), this->Faces));
    }
  }

  void Orient(const ExecutionContext& context)
  {
    if (this->Options.Orients)
    {
      const ConsistentOrientation orientation =
        OrientConsistently(this->Faces, this->Input, context);
      ReverseTriangles(this->Faces, orientation.IsReversed);
      this->Counts.TurnedTriangles = static_cast<int>(
        std::count(orientation.IsReversed.begin(), orientation.IsReversed.end(), 1));
    }
  }

  /// Cuts, and finds which input point each vertex comes from.
  void Cut(const ExecutionContext& context)
  {
    const Triangles before = this->Faces;
    std::vector<int> copyOf(this->Input.rows());
    std::iota(copyOf.begin(), copyOf.end(), 0);
    if (this->Options.CutsNonManifold)
    {
      NonManifoldCut cut = CutNonManifold(this->Faces, this->Input, context);
      this->Faces = std::move(cut.Faces);
      copyOf.insert(copyOf.end(), cut.CopyOf.begin(), cut.CopyOf.end());
      this->Counts.OneSidedEdges = cut.NumberOfContradictions;
      this->Counts.NonManifoldEdges = cut.NumberOfEdges;
      this->Counts.CutPoints = cut.NumberOfPoints;
      this->Counts.CopiedPoints = static_cast<int>(cut.CopyOf.size());
    }
    this->CopyOf = std::move(copyOf);
    this->NameVertices(before);
    this->Positions.resize(static_cast<Eigen::Index>(this->CopyOf.size()), 3);
    for (std::size_t v = 0; v < this->CopyOf.size(); ++v)
    {
      this->Positions.row(static_cast<Eigen::Index>(v)) = this->Input.row(this->OriginalPoints[v]);
    }
  }

  void OrientOutwards(const ExecutionContext& context)
  {
    if (this->Options.OrientsOutwards)
    {
      const OutwardOrientation orientation = cartan::OrientOutwards(
        this->Faces, this->Positions, this->Options.AlternatesNested, context);
      ReverseTriangles(this->Faces, orientation.IsReversed);
      this->Counts.ReversedComponents = orientation.NumberOfReversedComponents;
    }
  }

  void RemoveSmallComponents();

  void FillHoles(const ExecutionContext& context)
  {
    if (this->Options.Holes.MaximumEdges < 3)
    {
      return;
    }
    const HoleFill fill =
      cartan::FillHoles(this->Faces, this->Positions, this->Options.Holes, context);
    this->Counts.FilledHoles = fill.NumberOfHoles;
    this->Counts.OpenHoles = fill.NumberOfOpen;
    this->Counts.FillTriangles = static_cast<int>(fill.Faces.rows());
    const Eigen::Index size = this->Faces.rows();
    this->Faces.conservativeResize(size + fill.Faces.rows(), 3);
    this->Faces.bottomRows(fill.Faces.rows()) = fill.Faces;
    this->TriangleIds.resize(static_cast<std::size_t>(this->Faces.rows()), -1);
  }

  void FlipEdges(const ExecutionContext& context)
  {
    if (this->Options.FlipsEdges)
    {
      this->Counts.FlippedEdges =
        cartan::FlipEdges(this->Faces, this->Positions, this->Options.Flips, context);
    }
  }

  void RequireTriangles() const
  {
    if (this->Faces.rows() == 0)
    {
      throw Error(ErrorCode::BadInput,
        "No triangle is left of the surface: its triangles use points twice once coincident "
        "points are merged. Choose a smaller tolerance.");
    }
  }

  RepairedSurface Finish();

private:
  /// Removes the marked triangles and returns how many.
  int Drop(const std::vector<char>& drop)
  {
    Eigen::Index kept = 0;
    for (Eigen::Index t = 0; t < this->Faces.rows(); ++t)
    {
      if (!drop[t])
      {
        this->Faces.row(kept) = this->Faces.row(t).eval();
        this->TriangleIds[kept] = this->TriangleIds[t];
        ++kept;
      }
    }
    const auto dropped = static_cast<int>(this->Faces.rows() - kept);
    this->Faces.conservativeResize(kept, 3);
    this->TriangleIds.resize(kept);
    return dropped;
  }

  /// For each vertex the first input point that its corners name, and for each
  /// input point its vertex. `before` are the triangles as they were before the
  /// cut gave them other vertices.
  void NameVertices(const Triangles& before)
  {
    this->OriginalPoints = this->CopyOf;
    std::vector<char> isNamed(this->CopyOf.size(), 0);
    this->PreparedPoints.assign(this->Input.rows(), -1);
    for (Eigen::Index t = 0; t < before.rows(); ++t)
    {
      const auto input = this->InputFaces.row(this->TriangleIds[t]);
      for (int corner = 0; corner < 3; ++corner)
      {
        const int v = this->Faces(t, corner);
        int original = input[0];
        for (int k = 1; this->Merged[original] != before(t, corner); ++k)
        {
          original = input[k];
        }
        this->OriginalPoints[v] =
          isNamed[v] ? std::min(this->OriginalPoints[v], original) : original;
        isNamed[v] = 1;
        if (this->PreparedPoints[original] < 0)
        {
          this->PreparedPoints[original] = v;
        }
      }
    }
    for (std::size_t v = 0; v < this->PreparedPoints.size(); ++v)
    {
      // All triangles of this very point are gone, but not of those merged with it.
      if (this->PreparedPoints[v] < 0 && isNamed[this->Merged[v]])
      {
        this->PreparedPoints[v] = this->Merged[v];
      }
    }
    for (std::size_t v = 0; v < this->CopyOf.size(); ++v)
    {
      // Copies of points that a tolerance has merged may name points in other places.
      int& original = this->OriginalPoints[v];
      const int first = this->OriginalPoints[this->CopyOf[v]];
      original = this->Input.row(original) == this->Input.row(first) ? original : first;
    }
  }

  const Points& Input;
  const Triangles& InputFaces;
  const RepairOptions& Options;
  std::vector<char> IsUsed; // by the input's triangles
  std::vector<int> Merged;  // #V, the input point each has gone to
  Triangles Faces;
  std::vector<int> TriangleIds;
  Points Positions;
  std::vector<int> CopyOf;
  std::vector<int> OriginalPoints;
  std::vector<int> PreparedPoints;
  RepairCounts Counts;
};

void Repair::RemoveSmallComponents()
{
  if (!(this->Options.SmallestComponent > 0.0))
  {
    return;
  }
  DisjointSets components(static_cast<int>(this->Positions.rows()));
  for (Eigen::Index t = 0; t < this->Faces.rows(); ++t)
  {
    components.Join(this->Faces(t, 0), this->Faces(t, 1));
    components.Join(this->Faces(t, 1), this->Faces(t, 2));
  }
  const Eigen::VectorXd areas = TriangleAreaVectors(this->Positions, this->Faces).rowwise().norm();
  Eigen::VectorXd total = Eigen::VectorXd::Zero(this->Positions.rows());
  for (Eigen::Index t = 0; t < this->Faces.rows(); ++t)
  {
    total[components.Find(this->Faces(t, 0))] += areas[t];
  }
  const double least = this->Options.SmallestComponent * areas.sum();
  std::vector<char> drop(this->Faces.rows(), 0);
  std::vector<char> isCounted(this->Positions.rows(), 0);
  for (Eigen::Index t = 0; t < this->Faces.rows(); ++t)
  {
    const int component = components.Find(this->Faces(t, 0));
    drop[t] = total[component] < least;
    this->Counts.RemovedComponents += drop[t] && !isCounted[component];
    isCounted[component] = 1;
  }
  this->Drop(drop);
}

/// Numbers the vertices that are left, in their order.
RepairedSurface Repair::Finish()
{
  RepairedSurface result;
  const std::vector<char> isLeft = UsedVertices(this->Positions.rows(), this->Faces);
  std::vector<int> idOf(this->CopyOf.size(), -1);
  for (std::size_t v = 0; v < idOf.size(); ++v)
  {
    const bool isLoose = v < this->IsUsed.size() && !this->IsUsed[v];
    if (isLeft[v] || isLoose)
    {
      idOf[v] = static_cast<int>(result.OriginalPoints.size());
      result.OriginalPoints.push_back(this->OriginalPoints[v]);
    }
    if (isLoose)
    {
      this->PreparedPoints[v] = static_cast<int>(v);
    }
  }
  const auto size = static_cast<Eigen::Index>(result.OriginalPoints.size());
  result.Positions.resize(size, 3);
  result.CopyOf.resize(size);
  std::vector<int> firstCopy(this->Input.rows(), -1);
  for (std::size_t v = 0; v < idOf.size(); ++v)
  {
    if (idOf[v] >= 0)
    {
      result.Positions.row(idOf[v]) = this->Positions.row(static_cast<Eigen::Index>(v));
      int& first = firstCopy[this->CopyOf[v]];
      first = first < 0 ? idOf[v] : first;
      result.CopyOf[idOf[v]] = first;
    }
  }
  result.Faces = this->Faces;
  for (int corner = 0; corner < result.Faces.size(); ++corner)
  {
    int& v = result.Faces.data()[corner];
    v = idOf[v];
  }
  for (int& v : this->PreparedPoints)
  {
    v = v < 0 ? -1 : idOf[v];
  }
  result.PreparedPoints = std::move(this->PreparedPoints);
  result.OriginalTriangles = std::move(this->TriangleIds);
  result.Counts = this->Counts;
  return result;
}
}

std::vector<std::pair<std::string, int>> RepairCounts::List() const
{
  return { { "MergedPoints", this->MergedPoints },
    { "CollapsedTriangles", this->CollapsedTriangles },
    { "DoubledTriangles", this->DoubledTriangles }, { "TurnedTriangles", this->TurnedTriangles },
    { "OneSidedEdges", this->OneSidedEdges }, { "NonManifoldEdges", this->NonManifoldEdges },
    { "CutPoints", this->CutPoints }, { "CopiedPoints", this->CopiedPoints },
    { "ReversedComponents", this->ReversedComponents },
    { "RemovedComponents", this->RemovedComponents }, { "FilledHoles", this->FilledHoles },
    { "OpenHoles", this->OpenHoles }, { "FillTriangles", this->FillTriangles },
    { "FlippedEdges", this->FlippedEdges } };
}

std::string RepairCounts::Describe() const
{
  std::string text;
  const auto add = [&text](int count, const char* singular, const char* plural, const char* what)
  {
    if (count > 0)
    {
      text += (text.empty() ? "" : " ") + std::to_string(count) + " " +
        (count == 1 ? singular : plural) + " " + what + ".";
    }
  };
  add(this->MergedPoints, "point", "points", "merged with others in the same place");
  add(this->CollapsedTriangles, "triangle", "triangles", "dropped that used a point twice");
  add(this->DoubledTriangles, "triangle", "triangles", "dropped that doubled others");
  add(this->TurnedTriangles, "triangle", "triangles", "turned over to agree with the neighbors");
  add(this->OneSidedEdges, "edge", "edges", "cut because the two triangles cannot agree");
  add(this->NonManifoldEdges, "edge", "edges", "with more than two triangles cut");
  add(this->CutPoints, "point", "points", "given copies where the surface was not manifold");
  add(this->ReversedComponents, "closed component", "closed components", "turned over");
  add(this->RemovedComponents, "small component", "small components", "removed");
  add(this->FilledHoles, "hole", "holes", "filled");
  add(this->OpenHoles, "hole", "holes", "left open");
  add(this->FlippedEdges, "edge", "edges", "flipped");
  return text.empty() ? "Nothing was to repair." : text;
}

RepairedSurface RepairSurface(const Points& points, const Triangles& triangles,
  const RepairOptions& options, const ExecutionContext& context)
{
  RequireUsable(points, triangles);
  Repair repair(points, triangles, options);
  repair.Merge(context.Part(0.0, 0.2));
  repair.DropCollapsedAndDoubled();
  repair.RequireTriangles();
  repair.Orient(context.Part(0.2, 0.3));
  repair.Cut(context.Part(0.3, 0.5));
  repair.OrientOutwards(context.Part(0.5, 0.7));
  repair.RemoveSmallComponents();
  repair.FillHoles(context.Part(0.7, 0.8));
  repair.FlipEdges(context.Part(0.8, 1.0));
  context.Report(1.0);
  return repair.Finish();
}
}
