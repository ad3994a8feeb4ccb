// SPDX-License-Identifier: BSD-3-Clause
#include "Laws.h"

#include "Copies.h"
#include "Defects.h"
#include "Messages.h"

#include "vtkCurvatureError.h"
#include "vtkNew.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace fuzz
{
namespace
{
std::string Relative(const std::string& what, double difference, std::size_t where)
{
  std::ostringstream text;
  text << what << ": differ by " << difference << " at " << where;
  return text.str();
}

/// What single precision rounds off the points of a result, as part of the size.
double RoundingOf(const Case& of, const Outcome& outcome)
{
  return of.Surface.IsFloat
    ? 1e-6 * outcome.Fields[0].Values.cwiseAbs().maxCoeff() / Size(of.Surface.Points)
    : 0.0;
}

/// The result against points that are known.
std::string ComparePoints(
  const Case& of, const Outcome& outcome, const std::vector<Eigen::Vector3d>& expected)
{
  const double size = Size(of.Surface.Points);
  const double tolerance = 1e-4 + RoundingOf(of, outcome);
  const Eigen::MatrixXd& points = outcome.Fields[0].Values;
  double worst = 0.0;
  std::size_t where = 0;
  const std::vector<vtkIdType> components = Components(of.Surface);
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    // Points in no triangle stay where they are.
    const vtkIdType component = components[i];
    const bool isAlone = std::count(components.begin(), components.end(), component) < 3;
    const double distance =
      (points.row(static_cast<Eigen::Index>(i)).transpose() - expected[i]).norm() / size;
    if (!isAlone && distance > worst)
    {
      worst = distance;
      where = i;
    }
  }
  return worst > tolerance ? Relative("Points", worst, where) : "";
}

/// Lengths of the sides of polygons, and of triangles of strips.
std::string CompareEdges(
  const Case& of, const Outcome& outcome, const std::vector<Eigen::Vector3d>& before)
{
  const double size = Size(before);
  const double tolerance = 1e-4 + RoundingOf(of, outcome);
  const Eigen::MatrixXd& points = outcome.Fields[0].Values;
  for (const Ids& ids : of.Surface.Polys)
  {
    for (std::size_t c = 0; c < ids.size(); ++c)
    {
      const vtkIdType a = ids[c];
      const vtkIdType b = ids[(c + 1) % ids.size()];
      const double length = (points.row(a) - points.row(b)).norm();
      const double expected =
        (before[static_cast<std::size_t>(a)] - before[static_cast<std::size_t>(b)]).norm();
      if (!(std::abs(length - expected) <= tolerance * size))
      {
        return Relative("Edges", (length - expected) / size, static_cast<std::size_t>(a));
      }
    }
  }
  return {};
}

std::optional<Finding> FindingOf(
  const std::string& name, const Case& changed, const std::string& text)
{
  if (text.empty())
  {
    return {};
  }
  return Finding{ name, text, {}, changed, {} };
}

/// Without the arrays that move points one by one.
void DropConstraintArrays(Mesh& mesh)
{
  const std::set<std::string> names = { "TargetPosition", "RotationVector", "Transform" };
  mesh.Arrays.erase(std::remove_if(mesh.Arrays.begin(), mesh.Arrays.end(),
                      [&](const Array& array) { return names.count(array.Name) > 0; }),
    mesh.Arrays.end());
}

/// Methods that are exact for rigid motions, as their pages say.
bool IsExactForRigid(const Case& of)
{
  if (of.Filter == "SurfaceMorph")
  {
    return of.Get("Method", 0.0) < 3.0; // what is larger counts as linear
  }
  if (!of.IsDeformation() || of.Get("ConstrainHandlePositions", 1.0) == 0.0)
  {
    return false;
  }
  // The first guess is the rest shape; rotations are left out, or linearized.
  const bool iterates =
    of.Filter == "AsRigidAsPossibleDeformation" || of.Filter == "PyramidDeformation";
  return !(iterates && of.Get("InitialGuess", 3.0) <= 0.0) &&
    !(of.Filter == "LaplacianDeformation" && of.Get("Rotations", 1.0) != 1.0);
}

std::optional<Finding> CheckRigidMorph(const Case& original, Random& random)
{
  Case changed = original;
  const double size = Size(original.Surface.Points);
  for (std::vector<Eigen::Vector3d>& points : changed.Others)
  {
    Motion motion{ 1.0, random.Rotation(), size * random.Vector() };
    std::transform(
      original.Surface.Points.begin(), original.Surface.Points.end(), points.begin(), motion);
  }
  const Outcome outcome = Run(changed);
  std::string text = DescribeUnsound(changed, outcome);
  if (text.empty() && outcome.IsQuiet())
  {
    text = CompareEdges(changed, outcome, changed.Surface.Points);
  }
  return FindingOf("common", changed, text);
}

std::optional<Finding> CheckCommon(const Case& original, const Outcome&, Random& random)
{
  if (original.Filter == "SurfaceMorph")
  {
    return CheckRigidMorph(original, random);
  }
  Case changed = original;
  DropConstraintArrays(changed.Surface);
  HandleMotion common;
  common.Axis = random.Direction();
  common.Angle = random.Chance(0.1) ? 0.0 : random.Real(-400.0, 400.0);
  common.Center =
    original.Surface.Points[0].allFinite() ? original.Surface.Points[0] : Eigen::Vector3d::Zero();
  if (random.Chance(0.8))
  {
    common.Translation = Size(original.Surface.Points) * random.Vector();
  }
  std::set<int> ids;
  for (Eigen::Index i = 0; i < changed.Surface.NumberOfPoints(); ++i)
  {
    ids.insert(static_cast<int>(changed.Surface.Find("Handle")->Values(i, 0)));
  }
  ids.erase(0);
  changed.Motions.clear();
  for (const int id : ids)
  {
    common.Id = id;
    changed.Motions.push_back(common);
  }
  const Outcome outcome = Run(changed);
  std::string text = DescribeUnsound(changed, outcome);
  if (text.empty() && outcome.IsQuiet() && !ids.empty())
  {
    const Eigen::AngleAxisd turn(common.Angle * 3.14159265358979323846 / 180.0, common.Axis);
    const std::vector<vtkIdType> components = Components(changed.Surface);
    const Eigen::MatrixXd& handles = changed.Surface.Find("Handle")->Values;
    std::set<vtkIdType> moving;
    for (std::size_t i = 0; i < components.size(); ++i)
    {
      if (handles(static_cast<Eigen::Index>(i), 0) > 0.0)
      {
        moving.insert(components[i]);
      }
    }
    // What no handle can reach stays where it is.
    std::vector<Eigen::Vector3d> expected = changed.Surface.Points;
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
      if (moving.count(components[i]) > 0)
      {
        expected[i] = turn * (expected[i] - common.Center) + common.Center + common.Translation;
      }
    }
    text = ComparePoints(changed, outcome, expected);
  }
  return FindingOf("common", changed, text);
}

/// Cotangent weights see the surface, not its triangles; a cap of no height changes
/// nothing then.
bool LivesWithCaps(const Case& of)
{
  const std::set<std::string> filters = { "RotationInvariantDeformation",
    "ShapePreservingDeformation", "PoissonDeformation" };
  const double positions = of.Get("PositionWeights", 0.0);
  return filters.count(of.Filter) > 0 && of.Get("LaplacianWeights", 1.0) == 1.0 &&
    (positions <= 0.0 || positions == 2.0) && of.Get("Propagation", 0.0) <= 0.0 &&
    !of.Surface.Find("ConstraintWeight");
}

std::optional<Finding> CheckCaps(const Case& original, const Outcome&, Random& random)
{
  Case before = original;
  before.Surface.IsFloat = false;
  Case changed = before;
  const double height = random.Log(1e-9, 1e-6);
  const std::vector<std::size_t> triangles = Triangles(changed.Surface);
  if (triangles.empty())
  {
    return {};
  }
  const int count = random.Integer(1, 3);
  for (int i = 0; i < count; ++i)
  {
    const std::size_t cell = random.Pick(triangles);
    const Ids t = changed.Surface.Polys[cell];
    AddCap(changed.Surface, cell, height);
    for (Array& array : changed.Surface.Arrays)
    {
      const Eigen::Index last = array.Values.rows();
      array.Values.conservativeResize(last + 1, Eigen::NoChange);
      array.Values.row(last) = 0.5 * (array.Values.row(t[0]) + array.Values.row(t[1]));
      if (array.Name == "Handle" && array.Values(t[0], 0) != array.Values(t[1], 0))
      {
        array.Values(last, 0) = 0.0;
      }
    }
  }
  const Outcome first = Run(before);
  const Outcome second = Run(changed);
  std::string text = DescribeUnsound(changed, second);
  if (text.empty() && first.IsQuiet() && second.IsQuiet())
  {
    Relation relation;
    relation.IsOfPointsOnly = true;
    text = Compare(first, second, relation, Size(original.Surface.Points)).Describe();
  }
  std::optional<Finding> finding = FindingOf("caps", changed, text);
  if (finding)
  {
    finding->Original = before;
  }
  return finding;
}

std::optional<Finding> CheckKeys(const Case& original, const Outcome&, Random& random)
{
  Case changed = original;
  const bool isLast = random.Chance(0.7);
  for (Setting& setting : changed.Settings)
  {
    if (setting.Name == "Parameter")
    {
      setting.Values = { isLast ? 1.0 : 0.0 };
      const Outcome outcome = Run(changed);
      const auto& key = isLast ? changed.Others.back() : changed.Surface.Points;
      return FindingOf(
        "keys", changed, outcome.IsQuiet() ? ComparePoints(changed, outcome, key) : "");
    }
  }
  return {};
}

/// Made from the forms or differential coordinates of the surface itself.
bool IsOfOwnNumbers(const Case& of)
{
  return of.Filter == "FrameReconstruction" ||
    (of.Filter == "DifferentialReconstruction" && of.Others.empty());
}

std::optional<Finding> CheckRoundTrip(const Case& original, const Outcome& first, Random&)
{
  if (original.Filter == "DifferentialReconstruction")
  {
    return FindingOf("roundtrip", original,
      first.IsQuiet() ? ComparePoints(original, first, original.Surface.Points) : "");
  }
  return FindingOf("roundtrip", original,
    first.Errors.empty() && first.Warnings.empty()
      ? CompareEdges(original, first, original.Surface.Points)
      : "");
}

/// Unless it is told to leave the surface as it is.
bool MakesManifold(const Case& of)
{
  return of.Filter == "PrepareSurface" && of.Get("CutNonManifold", 1.0) != 0.0 &&
    of.Get("OrientConsistently", 1.0) != 0.0;
}

std::optional<Finding> CheckPrepared(const Case& original, const Outcome& first, Random&)
{
  if (!first.Errors.empty() || first.Surface->GetNumberOfPolys() == 0)
  {
    return {};
  }
  vtkNew<vtkCurvatureError> filter;
  const auto messages = Observe(filter);
  filter->SetInputData(first.Surface);
  filter->Update();
  return FindingOf(
    "prepared", original, messages->Errors.empty() ? "" : "refused: " + messages->Errors[0]);
}

std::optional<Finding> CheckRestored(const Case& original, const Outcome&, Random&)
{
  Case changed = original;
  changed.Others.clear();
  const Outcome outcome = Run(changed);
  std::string text = DescribeUnsound(changed, outcome);
  if (text.empty() && outcome.Errors.empty() && outcome.Surface->GetNumberOfPoints() > 0)
  {
    for (std::size_t i = 0; i < changed.Surface.Points.size(); ++i)
    {
      const Eigen::Vector3d& point = changed.Surface.Points[i];
      if (point.allFinite() &&
        outcome.Fields[0].Values.row(static_cast<Eigen::Index>(i)) != point.transpose())
      {
        const double by =
          (outcome.Fields[0].Values.row(static_cast<Eigen::Index>(i)) - point.transpose()).norm();
        text = Relative("Points", by / Size(changed.Surface.Points), i);
      }
    }
  }
  return FindingOf("restored", changed, text);
}

/// The copies of a point that are joined go to the same place.
std::optional<Finding> CheckJoined(const Case& original, const Outcome& first, Random&)
{
  const Ids copies = Copies(original.Surface);
  std::string text;
  for (const vtkIdType copy : copies)
  {
    if (first.Errors.empty() &&
      first.Fields[0].Values.row(copy) != first.Fields[0].Values.row(copies[0]))
    {
      text = "Points: copies part at " + std::to_string(copy);
    }
  }
  return FindingOf("joined", original, text);
}

bool Is(const Case& of, const char* filter)
{
  return of.Filter == filter;
}
}

std::vector<Invariant> Laws()
{
  return {
    { "common", IsExactForRigid, CheckCommon },
    { "caps", LivesWithCaps, CheckCaps },
    { "keys", [](const Case& of) { return Is(of, "SurfaceMorph"); }, CheckKeys },
    { "roundtrip", IsOfOwnNumbers, CheckRoundTrip },
    { "joined", [](const Case& of) { return !Copies(of.Surface).empty(); }, CheckJoined },
    { "prepared", MakesManifold, CheckPrepared },
    { "restored", [](const Case& of) { return Is(of, "RestoreSurface"); }, CheckRestored },
  };
}
}
