// SPDX-License-Identifier: BSD-3-Clause
#include "LaplacianLaws.h"

#include "vtkLaplacianSpectrum.h"

#include <sstream>

namespace fuzz
{
namespace
{
constexpr double Tolerance = 1e-4;

std::optional<Finding> FindingOf(
  const std::string& name, const Case& changed, const std::string& what, double by)
{
  std::ostringstream text;
  text << what << ": differ by " << by;
  return Finding{ name, text.str(), {}, changed, {} };
}

Outcome RunWith(const Case& of, const std::string& name, double value, Case& changed)
{
  changed = of;
  Setting setting;
  setting.Name = name;
  setting.Values = { value };
  setting.Apply = [](vtkAlgorithm* filter, const std::vector<double>& v)
  { vtkLaplacianSpectrum::SafeDownCast(filter)->SetApproximation(static_cast<int>(v[0])); };
  changed.Settings.push_back(setting);
  return Run(changed);
}

/// What single precision leaves of a length.
double RoundingOf(const Case& of, const Outcome& outcome)
{
  return of.Surface.IsFloat ? 1e-6 * outcome.Fields[0].Values.cwiseAbs().maxCoeff() : 0.0;
}

/// The first modes and the others add up to the surface, but for its center.
std::optional<Finding> CheckBands(const Case& original, const Outcome&, Random&)
{
  Case changed;
  const Outcome high = RunWith(original, "Approximation", vtkLaplacianSpectrum::HIGH_PASS, changed);
  const Outcome low = RunWith(original, "Approximation", vtkLaplacianSpectrum::LOW_PASS, changed);
  const std::string unsound = DescribeUnsound(changed, low);
  if (!unsound.empty())
  {
    return Finding{ "bands", unsound, {}, changed, {} };
  }
  if (!low.IsQuiet() || !high.IsQuiet())
  {
    return {};
  }
  const std::vector<vtkIdType> components = Components(original.Surface);
  Eigen::RowVector3d center;
  bool isFirst = true;
  double worst = 0.0;
  for (std::size_t i = 0; i < components.size(); ++i)
  {
    // Points in no triangle stay where they are in both.
    if (std::count(components.begin(), components.end(), components[i]) > 2)
    {
      const auto row = static_cast<Eigen::Index>(i);
      const Eigen::RowVector3d rest = low.Fields[0].Values.row(row) +
        high.Fields[0].Values.row(row) - original.Surface.Points[i].transpose();
      center = isFirst ? rest : center;
      isFirst = false;
      worst = std::max(worst, (rest - center).norm());
    }
  }
  const double size = Size(original.Surface.Points);
  return worst > Tolerance * size + RoundingOf(original, low)
    ? FindingOf("bands", changed, "Points", worst / size)
    : std::nullopt;
}

/// The surface passes through its anchors.
std::optional<Finding> CheckAnchors(const Case& original, const Outcome& first, Random&)
{
  const Field* anchors = first.Find("Anchor", Field::OfPoints);
  const Field* errors = first.Find("ApproximationError", Field::OfPoints);
  if (!first.IsQuiet() || !anchors || !errors)
  {
    return {};
  }
  const double size = Size(original.Surface.Points);
  const double worst =
    (anchors->Values.array() > 0.0).select(errors->Values, 0.0).maxCoeff() / size;
  return worst > Tolerance ? FindingOf("anchors", original, "ApproximationError", worst)
                           : std::nullopt;
}

/// The error that is asked for is met, in parts of the diagonal.
std::optional<Finding> CheckDecoded(const Case& original, const Outcome& first, Random&)
{
  const double asked = original.Get("MaximumError", 0.0);
  const Field* error = first.Find("VisualErrorRMS", Field::OfSurface);
  if (!first.IsQuiet() || !error || !(asked > 0.0))
  {
    return {};
  }
  const double size = Size(original.Surface.Points);
  const double found = error->Values(0, 0) / size;
  return found > asked + Tolerance ? FindingOf("decoded", original, "VisualErrorRMS", found - asked)
                                   : std::nullopt;
}
}

std::vector<Invariant> LaplacianLaws()
{
  const auto is = [](const char* filter)
  { return [filter](const Case& of) { return of.Filter == filter; }; };
  return {
    { "bands", is("LaplacianSpectrum"), CheckBands },
    { "anchors", is("LeastSquaresMesh"), CheckAnchors },
    { "decoded", is("HighPassQuantization"), CheckDecoded },
  };
}
}
