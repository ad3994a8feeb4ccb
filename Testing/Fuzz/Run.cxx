// SPDX-License-Identifier: BSD-3-Clause
#include "Run.h"

#include "Messages.h"
#include "Settings.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDifferentialCoordinates.h"
#include "vtkDiscreteForms.h"
#include "vtkHandleMotion.h"
#include "vtkIdList.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPrepareSurface.h"
#include "vtkSurfaceDeformation.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

namespace fuzz
{
namespace
{
vtkSmartPointer<vtkHandleMotion> ToMotion(const HandleMotion& from)
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  if (from.IsMatrix)
  {
    vtkNew<vtkMatrix4x4> matrix;
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < 4; ++j)
      {
        matrix->SetElement(i, j, from.Matrix(i, j));
      }
    }
    motion->SetMatrix(matrix);
    return motion;
  }
  motion->SetAxis(from.Axis.x(), from.Axis.y(), from.Axis.z());
  motion->SetAngle(from.Angle);
  motion->SetScale(from.Scale, from.Scale, from.Scale);
  motion->SetCenter(from.Center.x(), from.Center.y(), from.Center.z());
  motion->SetTranslation(from.Translation.x(), from.Translation.y(), from.Translation.z());
  return motion;
}

void SetDeformation(vtkSurfaceDeformation* filter, const Case& of)
{
  filter->RemoveAllHandleMotions();
  for (const HandleMotion& motion : of.Motions)
  {
    filter->SetHandleMotion(motion.Id, ToMotion(motion));
  }
  const auto nameOf = [&](const char* name) { return of.Surface.Find(name) ? name : ""; };
  filter->SetTargetPositionArrayName(nameOf("TargetPosition"));
  filter->SetRotationVectorArrayName(nameOf("RotationVector"));
  filter->SetTransformArrayName(nameOf("Transform"));
  filter->SetConstraintWeightArrayName(nameOf("ConstraintWeight"));
}

vtkSmartPointer<vtkDataObject> FormsOf(vtkPolyData* surface)
{
  vtkNew<vtkDiscreteForms> forms;
  const auto log = Observe(forms);
  forms->SetInputData(surface);
  forms->Update();
  return forms->GetFormsTable();
}

/// The surface with the differential coordinates of Others[0], or else its own.
vtkSmartPointer<vtkDataObject> WithCoordinates(
  const Case& of, const std::vector<vtkSmartPointer<vtkPolyData>>& inputs)
{
  vtkNew<vtkDifferentialCoordinates> coordinates;
  const auto log = Observe(coordinates);
  coordinates->SetInputData(inputs.back());
  coordinates->SetLaplacianWeights(static_cast<int>(of.Get("LaplacianWeights", 1.0)));
  coordinates->SetNormalization(static_cast<int>(of.Get("Normalization", 2.0)));
  coordinates->Update();
  if (!log->Errors.empty())
  {
    return inputs[0];
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->ShallowCopy(coordinates->GetOutput());
  surface->SetPoints(inputs[0]->GetPoints());
  return surface;
}

/// The prepared surface, moved as Others[0] says.
vtkSmartPointer<vtkPolyData> PreparedAndMoved(vtkPolyData* surface, const Case& of)
{
  vtkNew<vtkPrepareSurface> prepare;
  const auto log = Observe(prepare);
  prepare->SetInputData(surface);
  prepare->Update();
  auto moved = vtkSmartPointer<vtkPolyData>::New();
  moved->DeepCopy(prepare->GetOutput());
  vtkDataArray* ids = moved->GetPointData()->GetArray("OriginalPointIds");
  for (vtkIdType i = 0; ids && !of.Others.empty() && i < moved->GetNumberOfPoints(); ++i)
  {
    const auto original = static_cast<std::size_t>(ids->GetComponent(i, 0));
    moved->GetPoints()->SetPoint(i, of.Others[0][original].data());
  }
  return moved;
}

std::vector<vtkSmartPointer<vtkPolyData>> InputsOf(const Case& of)
{
  std::vector<vtkSmartPointer<vtkPolyData>> inputs = { ToPolyData(of.Surface) };
  for (const std::vector<Eigen::Vector3d>& points : of.Others)
  {
    Mesh other = of.Surface;
    other.Points = points;
    inputs.push_back(ToPolyData(other));
  }
  return inputs;
}

void Connect(
  vtkAlgorithm* filter, const Case& of, const std::vector<vtkSmartPointer<vtkPolyData>>& inputs)
{
  filter->RemoveAllInputs();
  filter->SetInputDataObject(0, inputs[0]);
  if (of.Filter == "SurfaceMorph")
  {
    for (std::size_t i = 1; i < inputs.size(); ++i)
    {
      filter->AddInputDataObject(0, inputs[i]);
    }
  }
  else if (of.Filter == "FrameReconstruction")
  {
    filter->SetInputDataObject(1, FormsOf(inputs[0]));
  }
  else if (of.Filter == "DifferentialReconstruction")
  {
    filter->SetInputDataObject(0, WithCoordinates(of, inputs));
  }
  else if (of.Filter == "RestoreSurface")
  {
    filter->SetInputDataObject(0, PreparedAndMoved(inputs[0], of));
    filter->SetInputDataObject(1, inputs[0]);
  }
  else if (inputs.size() > 1)
  {
    filter->SetInputDataObject(1, inputs[1]);
  }
  else if (filter->GetNumberOfInputPorts() > 1)
  {
    filter->SetInputConnection(1, nullptr);
  }
  if (auto* deformation = vtkSurfaceDeformation::SafeDownCast(filter))
  {
    SetDeformation(deformation, of);
  }
}

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
  return fields;
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
}

const Field* Outcome::Find(const std::string& name, Field::Place where) const
{
  const auto found = std::find_if(this->Fields.begin(), this->Fields.end(),
    [&](const Field& field) { return field.Name == name && field.Where == where; });
  return found == this->Fields.end() ? nullptr : &*found;
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

Outcome Run(const Case& of, const Case* before)
{
  vtkSmartPointer<vtkAlgorithm> filter = NewFilter(of);
  const auto log = Observe(filter);
  if (before)
  {
    Connect(filter, *before, InputsOf(*before));
    filter->Update();
    log->Errors.clear();
    log->Warnings.clear();
  }
  const auto inputs = InputsOf(of);
  const auto untouched = InputsOf(of);
  Connect(filter, of, inputs);
  filter->Update();

  Outcome outcome;
  outcome.Errors = log->Errors;
  outcome.Warnings = log->Warnings;
  for (std::size_t i = 0; i < inputs.size(); ++i)
  {
    outcome.IsInputChanged |= !DescribeDifference(inputs[i], untouched[i]).empty();
  }
  outcome.Surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  outcome.Table = filter->GetNumberOfOutputPorts() > 1
    ? vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
    : nullptr;
  outcome.Fields = FieldsOf(of, outcome, inputs[0]);
  return outcome;
}
}
