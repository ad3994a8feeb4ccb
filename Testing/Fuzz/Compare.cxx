// SPDX-License-Identifier: BSD-3-Clause
#include "Compare.h"

#include "vtkCellData.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace fuzz
{
namespace
{
/// Documented as NaN where there is no such number, or as infinite.
bool MayBeNaN(const std::string& name)
{
  static const std::set<std::string> names = { "AreaRatio", "EdgeLengthRatio", "LocalVolume",
    "LocalVolumeRatio", "RelativeVolumeChange", "RelativeAreaChange", "Angle", "Reference",
    "Current", "RelativeChange", "Stretch1", "Stretch2", "ConstraintWeight", "Weight" };
  // "Current of Volume": a row of a table.
  return names.count(name.substr(0, name.find(" of "))) > 0;
}

/// Fields whose values depend on more than the surface, or whose sign is arbitrary.
bool IsComparable(const Field& field, const Relation& relation)
{
  // Of bodies that enclose next to nothing, rounding decides which side is outside, and
  // where a triangle has no area which edges are flipped on the way.
  if (field.Name.find("CurvatureDirection") != std::string::npos ||
    field.Name.find("StretchDirection") != std::string::npos ||
    field.Name == "ReversedComponents" || field.Name == "FlippedEdges" || field.IsArbitrary)
  {
    return false;
  }
  const bool isReordered = !relation.Order.empty();
  if (isReordered &&
    (field.Where == Field::OfCells ||
      (field.Where == Field::OfTable && field.Name != "Eigenvalue" &&
        field.Name.find(" of ") == std::string::npos)))
  {
    return false;
  }
  // Anchors are numbered in the order of points where handles are.
  if (isReordered && (field.Name.compare(0, 12, "FrameTangent") == 0 || field.Name == "Anchor"))
  {
    return false;
  }
  // Rows of different units; an energy whose unit depends on the weights.
  static const std::set<std::string> ofManyUnits = { "Reference", "Current", "PyramidEnergy",
    "RigidityEnergy" };
  if (relation.Map.Scale != 1.0 && ofManyUnits.count(field.Name.substr(0, field.Name.find(" of "))))
  {
    return false;
  }
  return !relation.IsOfPointsOnly || field.Name == "Points";
}

/// The rotation by pi has two vectors.
bool IsHalfTurn(const Field& field, const Eigen::RowVectorXd& value)
{
  return field.Name == "RotationVector" && std::abs(value.norm() - 3.14159265) < 1e-2;
}

/// The frames of points in no triangle are the coordinate axes, wherever those are.
bool IsAxis(const Field& field, const Eigen::RowVectorXd& value)
{
  return field.Name.compare(0, 5, "Frame") == 0 && value.cwiseAbs().maxCoeff() == 1.0;
}

/// The largest difference of two rows, infinite if only one is finite. A motion spreads
/// what is not finite over all components.
double Distance(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b)
{
  if (!a.allFinite() && !b.allFinite())
  {
    return 0.0;
  }
  double largest = 0.0;
  for (Eigen::Index c = 0; c < a.size(); ++c)
  {
    if (std::isfinite(a[c]) && std::isfinite(b[c]))
    {
      largest = std::max(largest, std::abs(a[c] - b[c]));
    }
    else if (std::isfinite(a[c]) != std::isfinite(b[c]))
    {
      return std::numeric_limits<double>::infinity();
    }
  }
  return largest;
}

double LargestFinite(const Eigen::MatrixXd& values)
{
  double largest = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    if (std::isfinite(values.data()[i]))
    {
      largest = std::max(largest, std::abs(values.data()[i]));
    }
  }
  return largest;
}

/// The size of a result may exceed that of the input: handles that move far away.
double ExtentOf(const Eigen::MatrixXd& points)
{
  std::vector<Eigen::Vector3d> rows;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    rows.emplace_back(points.row(i).transpose());
  }
  return Size(rows);
}

bool IsFiniteRow(const std::vector<Eigen::Vector3d>& points, Eigen::Index i)
{
  return static_cast<std::size_t>(i) >= points.size() ||
    points[static_cast<std::size_t>(i)].allFinite();
}

std::string DescribeNotFinite(const Case& of, const Outcome& outcome)
{
  const bool isPrepare = of.Filter == "PrepareSurface";
  const bool isOfInput = !of.NumbersAnew();
  for (const Field& field : outcome.Fields)
  {
    if (MayBeNaN(field.Name))
    {
      continue;
    }
    for (Eigen::Index i = 0; i < field.Values.rows(); ++i)
    {
      bool isExpected = field.Values.row(i).allFinite();
      if (field.Where == Field::OfPoints && isOfInput && !isExpected)
      {
        // What is not finite in a point that no triangle uses is passed on.
        isExpected = !IsFiniteRow(of.Surface.Points, i) ||
          std::any_of(of.Others.begin(), of.Others.end(),
            [&](const auto& points) { return !IsFiniteRow(points, i); });
      }
      if (!isExpected && !isPrepare)
      {
        return field.Name + ": not finite at " + std::to_string(i);
      }
    }
  }
  return {};
}

std::string DescribePartial(const Case& of, const Outcome& outcome)
{
  vtkPolyData* output = outcome.Surface;
  if (!outcome.Errors.empty())
  {
    if (outcome.Errors.size() > 1)
    {
      return "several errors: " + outcome.Errors[0] + " / " + outcome.Errors[1];
    }
    const bool isEmpty = output->GetNumberOfPoints() == 0 && output->GetNumberOfCells() == 0 &&
      (!outcome.Table || outcome.Table->GetNumberOfRows() == 0);
    return isEmpty ? "" : "output after an error";
  }
  if (!of.NumbersAnew())
  {
    const Mesh& mesh = of.Surface;
    // An empty surface is passed on.
    const bool isRestoredFromNothing = of.Filter == "RestoreSurface" &&
      output->GetNumberOfPoints() == 0 && output->GetNumberOfCells() == 0;
    const std::size_t cells =
      mesh.Verts.size() + mesh.Lines.size() + mesh.Polys.size() + mesh.Strips.size();
    if (!isRestoredFromNothing &&
      (output->GetNumberOfPoints() != mesh.NumberOfPoints() ||
        output->GetNumberOfCells() != static_cast<vtkIdType>(cells)))
    {
      return "partial output";
    }
  }
  for (const Field& field : outcome.Fields)
  {
    const vtkIdType count =
      field.Where == Field::OfPoints ? output->GetNumberOfPoints() : output->GetNumberOfCells();
    if (field.Where <= Field::OfCells && field.Values.rows() != count)
    {
      return field.Name + ": of wrong length";
    }
  }
  return {};
}
}

std::string Difference::Describe() const
{
  if (this->IsNone())
  {
    return {};
  }
  std::ostringstream text;
  text << this->Field << ": differs by " << this->Size << " at " << this->Row;
  return text.str();
}

Difference CompareField(
  const Field& first, const Field& second, const Relation& relation, double size)
{
  const bool isSameShape = relation.IsOfPointsOnly ||
    (first.Values.rows() == second.Values.rows() && first.Values.cols() == second.Values.cols());
  if (!isSameShape)
  {
    return { first.Name, std::numeric_limits<double>::infinity(), 0 };
  }
  const Eigen::MatrixXd expected = Moved(first.Values, first.Type, first.Power, relation.Map);
  const double unit = std::pow(size * relation.Map.Scale, first.Power);
  const bool isOfPoints = first.Name == "Points";
  const double scale = std::max(unit, isOfPoints ? ExtentOf(expected) : LargestFinite(expected));
  const bool isMapped = !relation.Order.empty() && first.Where == Field::OfPoints;
  Difference worst;
  for (Eigen::Index i = 0; i < expected.rows(); ++i)
  {
    const Eigen::Index other = isMapped ? relation.Order[static_cast<std::size_t>(i)] : i;
    double distance = Distance(expected.row(i), second.Values.row(other));
    distance = std::max(0.0, distance - (isOfPoints ? relation.PointTolerance : 0.0)) / scale;
    if (distance > worst.Size && !IsHalfTurn(first, expected.row(i)) &&
      !IsAxis(first, first.Values.row(i)))
    {
      worst = { first.Name, distance, i };
    }
  }
  return worst;
}

Difference Compare(
  const Outcome& first, const Outcome& second, const Relation& relation, double size)
{
  for (const Field& field : first.Fields)
  {
    if (!IsComparable(field, relation))
    {
      continue;
    }
    const Field* other = second.Find(field.Name, field.Where);
    if (!other)
    {
      return { field.Name, std::numeric_limits<double>::infinity(), 0 };
    }
    const Difference difference = CompareField(field, *other, relation, size);
    if (difference.Size > relation.Tolerance)
    {
      return difference;
    }
  }
  return {};
}

std::string DescribeUnsound(const Case& of, const Outcome& outcome)
{
  if (outcome.IsInputChanged)
  {
    return "input changed";
  }
  const std::string partial = DescribePartial(of, outcome);
  if (!partial.empty() || !outcome.Errors.empty())
  {
    return partial;
  }
  return DescribeNotFinite(of, outcome);
}
}
