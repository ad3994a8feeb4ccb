// SPDX-License-Identifier: BSD-3-Clause
#include "Invariants.h"

#include "Copies.h"
#include "LaplacianLaws.h"
#include "Laws.h"
#include "MergeLaws.h"
#include "SteeringLaws.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

namespace fuzz
{
namespace
{
bool Always(const Case&)
{
  return true;
}

/// The forms alone determine what is reconstructed.
bool HasPlace(const Case& of)
{
  return of.Filter != "FrameReconstruction";
}

/// Tolerance and holes are measured in diagonals of the bounding box, which a rotation
/// changes; each coordinate is rounded by itself; lattices, and the boxes of far triangles that
/// carry as one, lie along the axes.
bool KnowsNoBox(const Case& of)
{
  return HasPlace(of) && of.Filter != "HighPassQuantization" &&
    of.Filter != "VolumetricDeformation" && of.Filter != "CarryAlong" &&
    !(of.Filter == "PrepareSurface" && of.Get("ToleranceIsAbsolute", 0.0) == 0.0 &&
      of.Get("Tolerance", 0.0) > 0.0);
}

/// Mean value weights have the unit 1 / length, soft constraints none. Soft anchors have
/// that of the differential coordinates beside them.
bool HasNoUnit(const Case& of)
{
  if (of.Filter == "DifferentialReconstruction")
  {
    return of.Get("AnchorMode", 1.0) > 0.0;
  }
  const bool isMeanValue = of.Get("LaplacianWeights", 1.0) >= 2.0 ||
    (of.IsDeformation() && of.Get("PositionWeights", 0.0) >= 3.0);
  return HasPlace(of) && !(of.Surface.Find("ConstraintWeight") && isMeanValue);
}

double LargestCoordinate(const Case& of)
{
  double largest = 0.0;
  for (const Eigen::Vector3d& point : of.Surface.Points)
  {
    largest = point.allFinite() ? std::max(largest, point.cwiseAbs().maxCoeff()) : largest;
  }
  return largest;
}

/// The digits of single precision that points and results have.
double PrecisionOf(const Case& of, const Outcome& outcome)
{
  if (!of.Surface.IsFloat || outcome.Fields.empty() || outcome.Fields[0].Values.size() == 0)
  {
    return 0.0;
  }
  const auto sizes = outcome.Fields[0].Values.array().abs();
  return 3e-7 * std::max(LargestCoordinate(of), sizes.isFinite().select(sizes, 0.0).maxCoeff());
}

/// How much a change of the points in the last digits of a coordinate changes a field
/// of the result: at random, which parts points in one place, or by cutting digits off,
/// which joins points in nearly one place.
Difference RoundingOf(const std::string& name, const Case& original, const Outcome& first,
  double coordinate, bool isCut, Random& random)
{
  Case changed = original;
  changed.Surface.IsFloat = false;
  const double rounding = 1e-15 * coordinate;
  const auto shake = [&](std::vector<Eigen::Vector3d>& points)
  {
    for (Eigen::Vector3d& point : points)
    {
      point = isCut ? Eigen::Vector3d(rounding * (point / rounding).array().round())
                    : Eigen::Vector3d(point + rounding * random.Vector());
    }
    KeepTogether(original.Surface, points);
  };
  shake(changed.Surface.Points);
  std::for_each(changed.Others.begin(), changed.Others.end(), shake);
  const Outcome second = Run(changed);
  Difference worst;
  for (const Field& field : first.Fields)
  {
    const Field* other = second.Find(field.Name, field.Where);
    if (field.Name == name && !other)
    {
      return { name, std::numeric_limits<double>::infinity(), 0 };
    }
    if (field.Name == name)
    {
      Relation relation;
      if (original.Surface.IsFloat)
      {
        relation.PointTolerance = PrecisionOf(original, first);
      }
      const Difference one = CompareField(field, *other, relation, Size(original.Surface.Points));
      worst = one.Size > worst.Size ? one : worst;
    }
  }
  return worst;
}

/// Where the last digits of the input decide: numbers that measure, and decisions
/// about points in the same place.
bool IsOfDigits(const Case& of)
{
  static const std::set<std::string> filters = { "PrepareSurface", "RestoreSurface", "VolumeChange",
    "CurvatureError", "DiscreteForms", "FrameReconstruction", "DifferentialCoordinates",
    "LaplacianSpectrum", "LeastSquaresMesh", "HighPassQuantization", "BoundaryLoops", "MeshMerge",
    "CoatingTransfer", "LandmarkHandles", "VolumetricDeformation", "CarryAlong" };
  // A ridge follows geodesic distances, whose front takes one of several ways of equal length, as
  // does a source curve that the filter finds.
  const bool hasWays = of.Filter == "CurveDeformation" &&
    (of.Get("RidgeHeight", 0.0) != 0.0 || of.Get("RidgeTurn", 0.0) != 0.0 ||
      of.Get("RidgeScale", 1.0) != 1.0 || of.Get("Source", 0.0) > 0.0);
  return hasWays || filters.count(of.Filter) > 0;
}

}

namespace
{
/// Which of the points that are equally far, or of equal error, becomes an anchor is open.
bool HaveOtherAnchors(const Outcome& first, const Outcome& second, const Relation& relation)
{
  const Field* one = first.Find("Anchor", Field::OfPoints);
  const Field* two = second.Find("Anchor", Field::OfPoints);
  for (Eigen::Index i = 0; one && two && i < one->Values.rows(); ++i)
  {
    const Eigen::Index other =
      relation.Order.empty() ? i : relation.Order[static_cast<std::size_t>(i)];
    if ((one->Values(i, 0) > 0.0) != (two->Values(other, 0) > 0.0))
    {
      return true;
    }
  }
  return false;
}
}

std::optional<Finding> CheckChanged(const std::string& name, const Case& original,
  const Outcome& first, const Case& changed, Relation relation)
{
  if (!first.IsQuiet())
  {
    return {};
  }
  const Outcome second = Run(changed);
  Finding finding{ name, DescribeUnsound(changed, second), original, changed, relation.Map };
  if (!finding.Text.empty())
  {
    return finding;
  }
  if (!second.IsQuiet())
  {
    return {};
  }
  // What single precision cannot hold is no difference.
  relation.PointTolerance =
    relation.Map.Scale * PrecisionOf(original, first) + PrecisionOf(changed, second);
  const Difference difference = Compare(first, second, relation, Size(original.Surface.Points));
  if (difference.IsNone() || HaveOtherAnchors(first, second, relation))
  {
    return {};
  }
  finding.Text = difference.Describe();
  const double coordinate =
    std::max(LargestCoordinate(original), LargestCoordinate(changed) / relation.Map.Scale);
  // Where the digits decide between two results, one change of them may fall on the
  // same side as the original.
  const int tries = IsOfDigits(original) ? 12 : 1;
  Random random(original.Seed);
  Difference rounding;
  for (int i = 0; i < tries && rounding.Size < 0.1 * difference.Size; ++i)
  {
    rounding = RoundingOf(difference.Field, original, first, coordinate, i == 1, random);
  }
  // Both may be infinite: other numbers of points.
  if (rounding.Size >= 0.1 * difference.Size)
  {
    if (IsOfDigits(original))
    {
      return {};
    }
    finding.Invariant = "stability";
    finding.Text += "; rounding alone, " + rounding.Describe();
  }
  return finding;
}

namespace
{
/// In double precision, before and after: single holds the digits of one place only,
/// and which diagonal cuts a quad with equal ones depends on the type's digits.
std::optional<Finding> CheckMoved(
  const std::string& name, const Case& original, const Outcome& first, const Motion& motion)
{
  Case exact = original;
  exact.Surface.IsFloat = false;
  Case changed = exact;
  Move(changed, motion);
  Relation relation;
  relation.Map = motion;
  return CheckChanged(
    name, exact, original.Surface.IsFloat ? Run(exact) : first, changed, relation);
}

std::optional<Finding> CheckRigid(const Case& original, const Outcome& first, Random& random)
{
  const double size = Size(original.Surface.Points);
  Motion motion;
  motion.Rotation = random.Rotation();
  const Eigen::Vector3d center =
    original.Surface.Points[0].allFinite() ? original.Surface.Points[0] : Eigen::Vector3d::Zero();
  motion.Translation = center - motion.Rotation * center + size * random.Vector();
  return CheckMoved("rigid", original, first, motion);
}

std::optional<Finding> CheckUnits(const Case& original, const Outcome& first, Random& random)
{
  Motion motion;
  motion.Scale = random.Chance(0.5) ? 1e3 : 1e-3;
  return CheckMoved("units", original, first, motion);
}

std::optional<Finding> CheckOffset(const Case& original, const Outcome& first, Random& random)
{
  Motion motion;
  motion.Translation = 1e3 * Size(original.Surface.Points) * random.Direction();
  return CheckMoved("offset", original, first, motion);
}

/// Polygons as fans. Which of the equal diagonals of a quad is the shorter one is a
/// matter of the digits that its type has.
void CutPolygons(Mesh& mesh)
{
  std::vector<Ids> triangles;
  for (const Ids& ids : mesh.Polys)
  {
    for (std::size_t i = 2; i < ids.size(); ++i)
    {
      triangles.push_back({ ids[0], ids[i - 1], ids[i] });
    }
  }
  mesh.Polys = std::move(triangles);
}

std::optional<Finding> CheckPrecision(const Case& original, const Outcome&, Random&)
{
  Case rounded = original;
  CutPolygons(rounded.Surface);
  rounded.Surface.IsFloat = false;
  RoundToFloat(rounded.Surface.Points);
  std::for_each(rounded.Others.begin(), rounded.Others.end(), RoundToFloat);
  std::for_each(rounded.Clouds.begin(), rounded.Clouds.end(), RoundToFloat);
  Case single = rounded;
  single.Surface.IsFloat = true;
  return CheckChanged("precision", rounded, Run(rounded), single, {});
}

std::optional<Finding> CheckThreads(const Case& original, const Outcome&, Random&)
{
  vtkSMPTools::SetBackend("STDThread");
  vtkSMPTools::Initialize(1);
  const Outcome one = Run(original);
  vtkSMPTools::Initialize(2);
  const Outcome two = Run(original);
  vtkSMPTools::SetBackend("Sequential");
  const std::string difference = DescribeDifference(one.Surface, two.Surface);
  if (difference.empty() && one.Errors == two.Errors && one.Warnings == two.Warnings)
  {
    return {};
  }
  const std::string text = difference.empty() ? "messages" : difference;
  return Finding{ "threads", text + ": differ with two threads", {}, original, {} };
}

std::optional<Finding> CheckOrder(const Case& original, const Outcome& first, Random& random)
{
  Relation relation;
  relation.Order.resize(original.Surface.Points.size());
  std::iota(relation.Order.begin(), relation.Order.end(), 0);
  random.Shuffle(relation.Order);
  Case changed = original;
  Random ofCells(random.Bits());
  Permute(changed.Surface, relation.Order, ofCells);
  for (std::vector<Eigen::Vector3d>& points : changed.Others)
  {
    const std::vector<Eigen::Vector3d> before = points;
    for (std::size_t i = 0; i < before.size(); ++i)
    {
      points[static_cast<std::size_t>(relation.Order[i])] = before[i];
    }
  }
  for (std::vector<Ids>* lists : { &changed.Tetrahedra, &changed.CloudKeys })
  {
    for (Ids& ids : *lists)
    {
      std::for_each(ids.begin(), ids.end(),
        [&](vtkIdType& id) { id = id < 0 ? id : relation.Order[static_cast<std::size_t>(id)]; });
    }
  }
  for (Setting& setting : changed.Settings)
  {
    for (double& id : setting.Values)
    {
      id = setting.IsOfIds ? static_cast<double>(relation.Order[static_cast<std::size_t>(id)]) : id;
    }
  }
  return CheckChanged("order", original, first, changed, relation);
}

/// Results that number points and cells anew do not survive another order, and some
/// solvers hold the first point.
bool KeepsOrder(const Case& of)
{
  const bool holdsFirst = of.Filter == "SurfaceMorph" && of.Get("Method", 0.0) <= 0.0 &&
    of.Get("FrameSolver", 0.0) >= 1.0;
  return HasPlace(of) && !of.NumbersAnew() && !holdsFirst;
}

std::optional<Finding> CheckHistory(const Case& original, const Outcome& first, Random& random)
{
  const Case before = MakeCase(random.Bits() % 1000000, original.Filter);
  const Outcome second = Run(original, &before);
  std::string difference = DescribeDifference(first.Surface, second.Surface);
  if (difference.empty() && (first.Errors != second.Errors || first.Warnings != second.Warnings))
  {
    difference = "messages";
  }
  if (difference.empty())
  {
    return {};
  }
  return Finding{ "history", difference + ": differ after another input", before, original, {} };
}

/// A first guess may come from the surface before, and a table from the motions before.
bool HasNoMemory(const Case& of)
{
  return of.Get("TabulateTurns", 0.0) == 0.0 && of.Get("WarmStart", 0.0) == 0.0 &&
    ((of.Filter != "AsRigidAsPossibleDeformation" && of.Filter != "PyramidDeformation") ||
      of.Get("InitialGuess", 3.0) != 1.0);
}
}

const std::vector<Invariant>& Invariants()
{
  static const std::vector<Invariant> all = []
  {
    std::vector<Invariant> invariants = {
      { "rigid", KnowsNoBox, CheckRigid },
      { "units", HasNoUnit, CheckUnits },
      { "offset", HasPlace, CheckOffset },
      { "precision", Always, CheckPrecision },
      { "threads", Always, CheckThreads },
      { "order", KeepsOrder, CheckOrder },
      { "history", HasNoMemory, CheckHistory },
    };
    for (const std::vector<Invariant>& laws :
      { Laws(), LaplacianLaws(), MergeLaws(), SteeringLaws() })
    {
      invariants.insert(invariants.end(), laws.begin(), laws.end());
    }
    return invariants;
  }();
  return all;
}
}
