// SPDX-License-Identifier: BSD-3-Clause
#include "SteeringLaws.h"

#include "Messages.h"

#include "vtkLandmarkHandles.h"
#include "vtkRotationInvariantDeformation.h"

#include <algorithm>
#include <sstream>

namespace fuzz
{
namespace
{
constexpr double Tolerance = 1e-4;

/// What single precision leaves of a length, and the tolerance.
double Allowed(const Case& of, const Outcome& outcome)
{
  const double rounding =
    of.Surface.IsFloat ? 2e-6 * outcome.Fields[0].Values.cwiseAbs().maxCoeff() : 0.0;
  return Tolerance * Size(of.Surface.Points) + rounding;
}

std::optional<Finding> FindingOf(
  const std::string& name, const Case& changed, const std::string& what, double by)
{
  std::ostringstream text;
  text << what << ": differ by " << by;
  return Finding{ name, text.str(), {}, changed, {} };
}

/// The largest distance of points in triangles that `where` takes.
template <typename Expected, typename Where>
double Miss(const Case& of, const Outcome& outcome, const Expected& expected, const Where& where)
{
  double worst = 0.0;
  const std::vector<vtkIdType> components = Components(of.Surface);
  std::vector<int> counts(components.size(), 0);
  for (const vtkIdType component : components)
  {
    ++counts[static_cast<std::size_t>(component)];
  }
  for (std::size_t i = 0; i < components.size(); ++i)
  {
    const Eigen::Vector3d there =
      outcome.Fields[0].Values.row(static_cast<Eigen::Index>(i)).transpose();
    if (counts[static_cast<std::size_t>(components[i])] > 2 && where(components[i]))
    {
      worst = std::max(worst, (there - expected(i)).norm());
    }
  }
  return worst;
}

std::optional<Finding> CheckCarried(const Case& original, const Outcome&, Random& random)
{
  Case changed = original;
  const Motion motion{ 1.0, random.Rotation(), Size(original.Surface.Points) * random.Vector() };
  const bool isOnSurface = original.Others[0] == original.Surface.Points && random.Chance(0.5);
  if (!isOnSurface)
  {
    std::transform(
      changed.Others[0].begin(), changed.Others[0].end(), changed.Others[1].begin(), motion);
  }
  const Outcome outcome = Run(changed);
  const std::string unsound = DescribeUnsound(changed, outcome);
  if (!unsound.empty())
  {
    return Finding{ "carried", unsound, {}, changed, {} };
  }
  if (!outcome.IsQuiet())
  {
    return {};
  }
  const double miss = Miss(
    changed, outcome,
    [&](std::size_t i) -> Eigen::Vector3d
    { return isOnSurface ? changed.Others[1][i] : motion(changed.Surface.Points[i]); },
    [](vtkIdType) { return true; });
  return miss > Allowed(changed, outcome)
    ? FindingOf("carried", changed, "Points", miss / Size(changed.Surface.Points))
    : std::nullopt;
}

/// Which landmark of the second set has the name, or else the number, of one of the first.
std::size_t PartnerOf(const Case& of, std::size_t i)
{
  if (of.CloudNames.empty())
  {
    return i;
  }
  const Ids& names = of.CloudNames[1];
  return static_cast<std::size_t>(
    std::find(names.begin(), names.end(), of.CloudNames[0][i]) - names.begin());
}

std::optional<Finding> CheckLandmarks(const Case& original, const Outcome& first, Random&)
{
  if (!first.IsQuiet() || !first.Table)
  {
    return {};
  }
  const double accuracy = std::max(0.0, original.Get("Accuracy", 0.0));
  vtkNew<vtkRotationInvariantDeformation> deformation;
  const auto messages = Observe(deformation);
  deformation->SetInputData(first.Surface);
  deformation->SetTargetPositionArrayName("TargetPosition");
  deformation->SetConstraintWeightArrayName(accuracy > 0.0 ? "ConstraintWeight" : "");
  deformation->Update();
  const Field* points = first.Find("PointId", Field::OfTable);
  const double size = Size(original.Surface.Points);
  for (std::size_t i = 0; points && i < original.Clouds[0].size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(points->Values(static_cast<Eigen::Index>(i), 0));
    const std::size_t partner = PartnerOf(original, i);
    const Eigen::Vector3d target = original.Surface.Points[static_cast<std::size_t>(id)] +
      original.Clouds[1][partner] - original.Clouds[0][i];
    const Field* targets = first.Find("TargetPosition", Field::OfPoints);
    const double off = (targets->Values.row(id).transpose() - target).norm();
    if (off > Allowed(original, first))
    {
      return FindingOf("landmarks", original, "TargetPosition", off / size);
    }
    if (messages->Errors.empty() && messages->Warnings.empty())
    {
      const Eigen::Vector3d there(deformation->GetOutput()->GetPoint(id));
      const double miss = (there - target).norm();
      if (miss > accuracy + Allowed(original, first))
      {
        return FindingOf("landmarks", original, "Points", miss / size);
      }
    }
  }
  return {};
}

std::optional<Finding> CheckDrawn(const Case& original, const Outcome&, Random& random)
{
  const auto ids = std::find_if(original.Settings.begin(), original.Settings.end(),
    [](const Setting& setting) { return setting.Name == "PointIds"; });
  if (ids == original.Settings.end() || ids->Values.size() < 2)
  {
    return {};
  }
  Case changed = original;
  changed.Settings = { *ids };
  std::copy_if(original.Settings.begin(), original.Settings.end(),
    std::back_inserter(changed.Settings),
    [](const Setting& setting) { return setting.Name == "Method"; });
  Array& handles = *std::find_if(changed.Surface.Arrays.begin(), changed.Surface.Arrays.end(),
    [](const Array& array) { return array.Name == "Handle"; });
  handles.Values.setZero();
  // Less than half of the way from end to end: the curve starts at the nearer one.
  const auto end = [&](double id) { return changed.Surface.Points[static_cast<std::size_t>(id)]; };
  const double length = (end(ids->Values.back()) - end(ids->Values[0])).norm();
  const Eigen::Vector3d shift = 0.4 * length * random.Unit() * random.Direction();
  changed.Clouds = { {} };
  for (const double id : ids->Values)
  {
    changed.Clouds[0].push_back(changed.Surface.Points[static_cast<std::size_t>(id)] + shift);
  }
  if (changed.Surface.IsFloat)
  {
    RoundToFloat(changed.Clouds[0]);
  }
  const Outcome outcome = Run(changed);
  const std::string unsound = DescribeUnsound(changed, outcome);
  if (!unsound.empty())
  {
    return Finding{ "drawn", unsound, {}, changed, {} };
  }
  if (!outcome.IsQuiet())
  {
    return {};
  }
  const std::vector<vtkIdType> components = Components(changed.Surface);
  const vtkIdType component = components[static_cast<std::size_t>(ids->Values[0])];
  const double miss = Miss(
    changed, outcome,
    [&](std::size_t i) -> Eigen::Vector3d { return changed.Surface.Points[i] + shift; },
    [&](vtkIdType other) { return other == component; });
  return miss > Allowed(changed, outcome)
    ? FindingOf("drawn", changed, "Points", miss / Size(changed.Surface.Points))
    : std::nullopt;
}
}

std::vector<Invariant> SteeringLaws()
{
  const auto is = [](const char* filter)
  { return [filter](const Case& of) { return of.Filter == filter; }; };
  return {
    { "carried", is("CarryAlong"), CheckCarried },
    { "landmarks", is("LandmarkHandles"), CheckLandmarks },
    { "drawn", is("CurveDeformation"), CheckDrawn },
  };
}
}
