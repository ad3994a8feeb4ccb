// SPDX-License-Identifier: BSD-3-Clause
#include "Fields.h"

#include "ComponentFields.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

namespace fuzz
{
namespace
{
Eigen::MatrixXd ToMatrix(vtkDataArray* array)
{
  Eigen::MatrixXd values(array->GetNumberOfTuples(), array->GetNumberOfComponents());
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    for (int c = 0; c < values.cols(); ++c)
    {
      values(i, c) = array->GetComponent(i, c);
    }
  }
  return values;
}

/// How the filters' arrays behave; those that are not here are numbers without unit.
Field Describe(const std::string& name)
{
  static const std::map<std::string, std::pair<Kind, double>> known = {
    { "Points", { Kind::Point, 1 } },
    { "Normals", { Kind::Vector, 0 } },
    { "RotationVector", { Kind::Vector, 0 } },
    { "PyramidEnergy", { Kind::Scalar, 2 } },
    { "RigidityEnergy", { Kind::Scalar, 2 } },
    { "LocalDepth", { Kind::Scalar, 1 } },
    { "LocalVolume", { Kind::Scalar, 3 } },
    { "ShapeDistanceDensity", { Kind::Scalar, -2 } },
    { "MeanCurvature", { Kind::Scalar, -1 } },
    { "MaximumCurvature", { Kind::Scalar, -1 } },
    { "MinimumCurvature", { Kind::Scalar, -1 } },
    { "MeanCurvatureError", { Kind::Scalar, -1 } },
    { "MeanCurvatureErrorRMS", { Kind::Scalar, -1 } },
    { "MeanCurvatureErrorMax", { Kind::Scalar, -1 } },
    { "GaussianCurvature", { Kind::Scalar, -2 } },
    { "GaussianCurvatureError", { Kind::Scalar, -2 } },
    { "GaussianCurvatureErrorRMS", { Kind::Scalar, -2 } },
    { "GaussianCurvatureErrorMax", { Kind::Scalar, -2 } },
    { "FrameTangent1", { Kind::Vector, 0 } },
    { "FrameTangent2", { Kind::Vector, 0 } },
    { "FrameNormal", { Kind::Vector, 0 } },
    { "DifferentialCoordinates", { Kind::Vector, 1 } },
    { "ApproximationError", { Kind::Scalar, 1 } },
    { "RootMeanSquareError", { Kind::Scalar, 1 } },
    { "MaximumError", { Kind::Scalar, 1 } },
    { "VisualError", { Kind::Scalar, 1 } },
    { "VisualErrorRMS", { Kind::Scalar, 1 } },
    { "VisualErrorMax", { Kind::Scalar, 1 } },
    { "Length", { Kind::Scalar, 1 } },
    { "Height", { Kind::Scalar, 1 } },
    { "Area", { Kind::Scalar, 2 } },
    { "Normal", { Kind::Vector, 0 } },
    { "Center", { Kind::Point, 1 } },
    { "Coating", { Kind::Vector, 1 } },
    { "CorrespondenceDistance", { Kind::Scalar, 1 } },
    { "SurfaceDistance", { Kind::Scalar, 1 } },
    { "TargetPosition", { Kind::Point, 1 } },
    { "Distance", { Kind::Scalar, 1 } },
    { "Displacement", { Kind::Vector, 1 } },
    { "Accuracy", { Kind::Scalar, 1 } },
  };
  Field field;
  field.Name = name;
  const auto found = known.find(name);
  if (found != known.end())
  {
    std::tie(field.Type, field.Power) = found->second;
  }
  return field;
}

/// Sums of uniform and cotangent weights are lengths, mean value weights have the unit
/// 1 / length; an area divides them, or the sum of the weights.
double PowerOfCoordinates(const Case& of)
{
  const double normalization = of.Get("Normalization", 2.0);
  const double ofSum = of.Get("LaplacianWeights", 1.0) >= 2.0 ? 0.0 : 1.0;
  return normalization <= 0.0 ? 1.0 : normalization >= 2.0 ? ofSum - 2.0 : ofSum;
}

/// Whether the first n modes span a space: the next one has another frequency.
bool IsSpace(const Eigen::MatrixXd& eigenvalues, double n)
{
  const auto count = static_cast<Eigen::Index>(n);
  const Eigen::Index all = eigenvalues.rows();
  return count <= 0 ||
    (count < all && eigenvalues(count) - eigenvalues(count - 1) > 1e-6 * eigenvalues(all - 1));
}

/// Modes of one frequency are any basis of their space, and so are their coefficients and
/// a sum of some of them.
void MarkArbitrary(const Case& of, std::vector<Field>& fields)
{
  static const std::set<std::string> ofModes = { "Modes", "X", "Y", "Z", "Energy" };
  const auto eigenvalues = std::find_if(
    fields.begin(), fields.end(), [](const Field& field) { return field.Name == "Eigenvalue"; });
  if (eigenvalues == fields.end() || eigenvalues->Values.rows() == 0)
  {
    return;
  }
  const double approximation = of.Get("Approximation", 1.0);
  const double asked = of.Get("ApproximationModes", 0.0);
  const auto all = static_cast<double>(eigenvalues->Values.rows());
  const double last = asked <= 0.0 || asked > all ? all : asked;
  const bool isWhole = approximation <= 0.0 ||
    (IsSpace(eigenvalues->Values, last) &&
      (approximation != 2.0 ||
        IsSpace(eigenvalues->Values, std::min(of.Get("FirstMode", 1.0), last))));
  eigenvalues->Power = of.Get("Operator", 0.0) >= 1.0 ? -2.0 : 0.0;
  for (Field& field : fields)
  {
    field.IsArbitrary = ofModes.count(field.Name) > 0 ||
      (!isWhole && (field.Name == "Points" || field.Name == "Normals"));
  }
}

bool SameArray(vtkAbstractArray* a, vtkAbstractArray* b)
{
  auto* x = vtkDataArray::SafeDownCast(a);
  auto* y = vtkDataArray::SafeDownCast(b);
  if (!x || !y)
  {
    return a && b && a->GetNumberOfValues() == b->GetNumberOfValues();
  }
  return x->GetDataType() == y->GetDataType() &&
    x->GetNumberOfComponents() == y->GetNumberOfComponents() &&
    x->GetNumberOfTuples() == y->GetNumberOfTuples() &&
    (x->GetNumberOfValues() == 0 ||
      std::memcmp(x->GetVoidPointer(0), y->GetVoidPointer(0),
        static_cast<std::size_t>(x->GetNumberOfValues()) * x->GetDataTypeSize()) == 0);
}

void Collect(
  vtkFieldData* data, vtkFieldData* input, Field::Place where, std::vector<Field>& fields)
{
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = data->GetArray(i);
    const std::string name = array && array->GetName() ? array->GetName() : "";
    if (array && !(input && SameArray(array, input->GetAbstractArray(name.c_str()))))
    {
      fields.push_back(Describe(name));
      fields.back().Where = where;
      fields.back().Values = ToMatrix(array);
    }
  }
}

std::string DescribeCells(vtkCellArray* a, vtkCellArray* b)
{
  if (a->GetNumberOfCells() != b->GetNumberOfCells())
  {
    return "number of cells";
  }
  vtkNew<vtkIdList> idsOfA;
  vtkNew<vtkIdList> idsOfB;
  for (vtkIdType cell = 0; cell < a->GetNumberOfCells(); ++cell)
  {
    a->GetCellAtId(cell, idsOfA);
    b->GetCellAtId(cell, idsOfB);
    if (!std::equal(idsOfA->begin(), idsOfA->end(), idsOfB->begin(), idsOfB->end()))
    {
      return "cell " + std::to_string(cell);
    }
  }
  return {};
}

std::string DescribeArrays(vtkFieldData* a, vtkFieldData* b)
{
  if (a->GetNumberOfArrays() != b->GetNumberOfArrays())
  {
    return "number of arrays";
  }
  for (int i = 0; i < b->GetNumberOfArrays(); ++i)
  {
    const char* name = b->GetArrayName(i);
    if (!SameArray(a->GetAbstractArray(name), b->GetAbstractArray(i)))
    {
      return std::string("array ") + (name ? name : "(no name)");
    }
  }
  return {};
}

/// A column per anchor: in the order of the points, not in that in which equally good ones
/// were chosen.
void SortByAnchors(const Outcome& outcome, std::vector<Field>& fields)
{
  const auto functions = std::find_if(fields.begin(), fields.end(),
    [](const Field& field) { return field.Name == "BasisFunctions"; });
  vtkDataArray* anchors = outcome.Surface->GetPointData()->GetArray("Anchor");
  vtkDataArray* ids = outcome.Surface->GetPointData()->GetArray("PointId");
  if (functions == fields.end() || !anchors || !ids)
  {
    return;
  }
  std::map<double, int> columns;
  for (vtkIdType i = 0; i < anchors->GetNumberOfTuples(); ++i)
  {
    if (anchors->GetComponent(i, 0) > 0.0)
    {
      columns[ids->GetComponent(i, 0)] = static_cast<int>(anchors->GetComponent(i, 0)) - 1;
    }
  }
  const Eigen::MatrixXd values = functions->Values;
  Eigen::Index next = 0;
  for (const auto& column : columns)
  {
    functions->Values.col(next++) = values.col(column.second);
  }
}
}

std::vector<Field> FieldsOf(const Case& of, const Outcome& outcome, vtkPolyData* input)
{
  std::vector<Field> fields;
  vtkPolyData* output = outcome.Surface;
  fields.push_back(Describe("Points"));
  if (output->GetPoints())
  {
    fields.back().Values = ToMatrix(output->GetPoints()->GetData());
  }
  Collect(output->GetPointData(), input->GetPointData(), Field::OfPoints, fields);
  Collect(output->GetCellData(), input->GetCellData(), Field::OfCells, fields);
  Collect(output->GetFieldData(), input->GetFieldData(), Field::OfSurface, fields);
  if (outcome.Table)
  {
    Collect(outcome.Table->GetRowData(), nullptr, Field::OfTable, fields);
  }
  for (Field& field : fields)
  {
    if (field.Name == "DifferentialCoordinates")
    {
      field.Power = PowerOfCoordinates(of);
      field.IsArbitrary = of.Filter == "DifferentialReconstruction"; // its input
    }
  }
  MarkArbitrary(of, fields);
  NameByPoints(of, outcome, fields);
  SortByAnchors(outcome, fields);
  return fields;
}

std::string DescribeDifference(vtkPolyData* a, vtkPolyData* b)
{
  if (a->GetNumberOfPoints() != b->GetNumberOfPoints())
  {
    return "number of points";
  }
  if (a->GetNumberOfPoints() > 0 &&
    !SameArray(a->GetPoints()->GetData(), b->GetPoints()->GetData()))
  {
    return "points";
  }
  for (const std::string& text :
    { DescribeCells(a->GetVerts(), b->GetVerts()), DescribeCells(a->GetLines(), b->GetLines()),
      DescribeCells(a->GetPolys(), b->GetPolys()), DescribeCells(a->GetStrips(), b->GetStrips()),
      DescribeArrays(a->GetPointData(), b->GetPointData()),
      DescribeArrays(a->GetCellData(), b->GetCellData()),
      DescribeArrays(a->GetFieldData(), b->GetFieldData()) })
  {
    if (!text.empty())
    {
      return text;
    }
  }
  return {};
}
}
