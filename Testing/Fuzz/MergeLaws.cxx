// SPDX-License-Identifier: BSD-3-Clause
#include "MergeLaws.h"

#include "Messages.h"

#include "vtkCoatingTransfer.h"
#include "vtkCurvatureError.h"
#include "vtkMeshMerge.h"
#include "vtkNew.h"

#include <algorithm>
#include <sstream>

namespace fuzz
{
namespace
{
constexpr double Tolerance = 1e-4;

std::optional<Finding> FindingOf(
  const std::string& name, const Case& changed, const std::string& text)
{
  return text.empty() ? std::nullopt
                      : std::make_optional<Finding>(Finding{ name, text, {}, changed, {} });
}

std::string Relative(const std::string& what, double difference)
{
  std::ostringstream text;
  text << what << ": differ by " << difference;
  return text.str();
}

/// Half the sum of x_i x x_(i+1), seen from a point of the surface.
Eigen::Vector3d AreaVector(const Mesh& mesh, const Ids& ids, const Eigen::Vector3d& center)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const Eigen::Vector3d a = mesh.Points[static_cast<std::size_t>(ids[i])] - center;
    const auto next = static_cast<std::size_t>(ids[(i + 1) % ids.size()]);
    sum += 0.5 * a.cross(mesh.Points[next] - center);
  }
  return sum;
}

std::optional<Finding> CheckStokes(const Case& original, const Outcome& first, Random&)
{
  const Mesh& mesh = original.Surface;
  const Field* areas = first.Find("Area", Field::OfCells);
  const Field* normals = first.Find("Normal", Field::OfCells);
  if (!first.IsQuiet() || !areas || !normals || mesh.Polys.empty())
  {
    return {};
  }
  const Eigen::Vector3d center = mesh.Points[static_cast<std::size_t>(mesh.Polys[0][0])];
  Eigen::Vector3d sum = normals->Values.transpose() * areas->Values;
  for (const Ids& ids : mesh.Polys)
  {
    sum += AreaVector(mesh, ids, center);
  }
  for (const Ids& ids : mesh.Strips)
  {
    for (std::size_t i = 2; i < ids.size(); ++i)
    {
      const double sign = i % 2 == 0 ? 1.0 : -1.0;
      sum += sign * AreaVector(mesh, { ids[i - 2], ids[i - 1], ids[i] }, center);
    }
  }
  const double size = Size(mesh.Points);
  const double error = sum.norm() / (size * size);
  return FindingOf("stokes", original, error > Tolerance ? Relative("Area", error) : "");
}

/// Where the source's place does not count.
bool IsIndependent(const Case& of)
{
  return (of.Filter == "MeshMerge" && of.Get("Configuration", 0.0) <= 0.0) ||
    (of.Filter == "CoatingTransfer" && of.Get("Correspondence", 2.0) <= 1.0 &&
      of.Get("ScaleDetails", 1.0) != 0.0);
}

std::optional<Finding> CheckIndependent(const Case& original, const Outcome& first, Random& random)
{
  Case exact = original;
  exact.Surface.IsFloat = false;
  Case changed = exact;
  const double size = Size(original.Surface.Points);
  const Motion motion{ random.Log(0.2, 5.0), random.Rotation(), size * random.Vector() };
  for (std::vector<Eigen::Vector3d>& points : changed.Others)
  {
    std::transform(points.begin(), points.end(), points.begin(), motion);
  }
  Relation relation;
  relation.IsOfPointsOnly = true;
  return CheckChanged(
    "independent", exact, original.Surface.IsFloat ? Run(exact) : first, changed, relation);
}

std::optional<Finding> CheckSewn(const Case& original, const Outcome& first, Random&)
{
  if (!first.Errors.empty())
  {
    return {};
  }
  vtkNew<vtkCurvatureError> filter;
  const auto messages = Observe(filter);
  filter->SetInputData(first.Surface);
  filter->Update();
  if (!messages->Errors.empty())
  {
    return FindingOf("sewn", original, "refused: " + messages->Errors[0]);
  }
  const Field* origins = first.Find("MergeOrigin", Field::OfPoints);
  const Field* ids = first.Find("OriginalPointIds", Field::OfPoints);
  const bool isKept = original.Get("SeamFairing", 0.0) <= 0.0;
  for (Eigen::Index i = 0; isKept && origins && ids && i < ids->Values.rows(); ++i)
  {
    const auto id = static_cast<std::size_t>(ids->Values(i, 0));
    if (origins->Values(i, 0) == 0.0 &&
      first.Fields[0].Values.row(i) != original.Surface.Points[id].transpose())
    {
      return FindingOf("sewn", original, "Points: the target moves at " + std::to_string(id));
    }
  }
  return {};
}

std::optional<Finding> CheckStrength(const Case& original, const Outcome& first, Random&)
{
  Case changed = original;
  Setting setting;
  setting.Name = "Strength";
  setting.Values = { 2.0 * original.Get("Strength", 1.0) };
  setting.Apply = [](vtkAlgorithm* filter, const std::vector<double>& v)
  { vtkCoatingTransfer::SafeDownCast(filter)->SetStrength(v[0]); };
  changed.Settings.push_back(setting);
  const Outcome second = Run(changed);
  const Field* one = first.Find("Coating", Field::OfPoints);
  const Field* two = second.Find("Coating", Field::OfPoints);
  if (!first.IsQuiet() || !second.IsQuiet() || !one || !two || one->Values.rows() == 0)
  {
    return {};
  }
  const double size = std::max(Size(original.Surface.Points), one->Values.cwiseAbs().maxCoeff());
  const double error = (two->Values - 2.0 * one->Values).cwiseAbs().maxCoeff() / size;
  return FindingOf("strength", changed, error <= Tolerance ? "" : Relative("Coating", error));
}
}

std::vector<Invariant> MergeLaws()
{
  const auto is = [](const char* filter)
  { return [filter](const Case& of) { return of.Filter == filter; }; };
  return {
    { "stokes", is("BoundaryLoops"), CheckStokes },
    { "independent", IsIndependent, CheckIndependent },
    { "sewn", is("MeshMerge"), CheckSewn },
    { "strength", is("CoatingTransfer"), CheckStrength },
  };
}
}
