// SPDX-License-Identifier: BSD-3-Clause
// What the filters advise about handles, their motions, and the arrays that say both.
#include "Advice.h"

#include "vtkMarkHandle.h"
#include "vtkPoissonDeformation.h"
#include "vtkRotationInvariantDeformation.h"

#include "vtkIdTypeArray.h"
#include "vtkPlane.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"

#include <cmath>

using vtktest::Advice;
using vtktest::Advised;
using vtktest::MarkedBar;
using vtktest::Turn;

namespace
{
/// The bar with its upper end turned about the x axis.
struct Bend : Advised<vtkRotationInvariantDeformation>
{
  Bend()
  {
    (*this)->SetInputData(this->Bar);
    (*this)->SetHandleMotion(2, this->Motion);
  }
  /// Quiet, and each handle is where it belongs.
  void Bends() { vtktest::ExpectEnds(this->Works(), MarkedBar(), this->Motion); }

  vtkSmartPointer<vtkPolyData> Bar = MarkedBar();
  vtkSmartPointer<vtkHandleMotion> Motion = Turn(30.0);
};

vtkSmartPointer<vtkDataArray> Doubles(const char* name, int components, double value)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(MarkedBar()->GetNumberOfPoints());
  array->Fill(value);
  return array;
}

/// The surface with the points above, or below, a height marked.
vtkSmartPointer<vtkPolyData> Marked(vtkPolyData* surface, int id, double height, bool isAbove)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(0.0, 0.0, height);
  plane->SetNormal(0.0, 0.0, isAbove ? -1.0 : 1.0);
  Advised<vtkMarkHandle> mark;
  mark->SetInputData(surface);
  mark->SetHandleId(id);
  mark->SetRegion(plane);
  return mark.Works();
}
}

TEST(AdviceOnHandles, AMissingArrayIsMarkedOrNamed)
{
  Bend bend;
  const auto other = vtktest::CopyOf(bend.Bar);
  other->GetPointData()->GetArray("Handle")->SetName("Ends");
  bend->SetInputData(other);
  bend.Refuses({ "no point array \"Handle\"",
    Advice("mark some with vtkMarkHandle (Mark Handle), or set HandleArrayName.") });
  bend->SetHandleArrayName("Ends");
  bend.Bends();

  bend->SetHandleArrayName("Handle");
  bend->SetInputData(Marked(Marked(other, 1, 0.6, false), 2, 3.4, true));
  bend.Bends();
}

TEST(AdviceOnHandles, IdsAreWholeNumbersFromZero)
{
  Bend bend;
  const vtkSmartPointer<vtkDataArray> handles = bend.Bar->GetPointData()->GetArray("Handle");
  const std::string advice = Advice("0 is free, k >= 1 belongs to handle k.");
  const auto wrong = Doubles("Handle", 1, 0.0);
  wrong->SetTuple1(5, 0.5);
  wrong->SetTuple1(7, -1.0);
  bend.Bar->GetPointData()->AddArray(wrong);
  const std::string message =
    bend.Refuses({ "\"Handle\" has 2 values (ids 5, 7)", "not whole numbers", advice });
  for (const vtkIdType v : vtktest::IdsAfter(message, "2 values (ids "))
  {
    wrong->SetTuple1(v, 0.0); // is free
  }
  for (vtkIdType v = 0; v < wrong->GetNumberOfTuples(); ++v)
  {
    wrong->SetTuple1(v, handles->GetTuple1(v)); // belongs to handle k
  }
  wrong->Modified();
  bend.Bends();
}

TEST(AdviceOnHandles, AMotionNeedsPointsOrGoes)
{
  Bend bend;
  const auto extra = Turn(10.0);
  bend->SetHandleMotion(5, extra);
  const std::string advice = Advice("Mark points for it or remove the motion.");
  bend.Refuses({ "Handle 5 has a motion", "Handles with points: 1, 2", advice });
  bend->RemoveHandleMotion(5);
  bend.Bends();
  bend->SetHandleMotion(5, extra);
  Advised<vtkMarkHandle> mark;
  vtkNew<vtkIdTypeArray> ids;
  ids->InsertNextValue(40);
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(vtkSelectionNode::POINT);
  node->SetSelectionList(ids);
  vtkNew<vtkSelection> selection;
  selection->AddNode(node);
  mark->SetSelectionData(selection);
  mark->SetInputData(bend.Bar);
  mark->SetHandleId(5);
  bend->SetInputData(mark.Works());
  const Eigen::Vector3d moved(bend.Works()->GetPoint(40));
  EXPECT_LT((moved - vtktest::MovedBy(extra, bend.Bar->GetPoint(40))).norm(), 1e-9);

  bend.Bar->GetPointData()->AddArray(Doubles("Handle", 1, 0.0));
  bend->SetInputData(bend.Bar);
  bend.Refuses({ "Handle 2 has a motion", "No point belongs to any handle", advice });
}

TEST(AdviceOnHandles, AMotionIsMadeWhole)
{
  Bend bend;
  bend.Motion->SetAxis(0.0, 0.0, 0.0);
  bend.Refuses({ "The motion of handle 2: Axis has length zero",
    Advice("give it a length or set Angle to 0.") });
  bend.Motion->SetAngle(0.0);
  bend.Bends();
  bend.Motion->SetAngle(30.0);
  bend.Motion->SetAxis(3.0, 0.0, 0.0);
  bend.Bends();

  vtkNew<vtkMatrix4x4> matrix;
  bend.Motion->GetTransform(matrix);
  bend.Motion->SetModeToMatrix();
  bend.Refuses({ "The motion of handle 2: Mode is Matrix", Advice("call SetMatrix.") });
  bend.Motion->SetMatrix(matrix);
  bend.Bends();
  matrix->SetElement(3, 1, 0.5);
  bend.Refuses({ "The motion of handle 2: The last row of Matrix is not 0 0 0 1" });
  matrix->SetElement(3, 1, 0.0);
  bend.Bends();
}

TEST(AdviceOnHandles, RowsOfTheTableNameEachHandleOnce)
{
  Bend bend;
  const auto setRow = [&](double id)
  { bend->SetMotionRow(0, id, 1, 1, 1, 30, 1, 0, 0, 0, 0, 2, 0, 0, 0); };
  setRow(2.0);
  bend.Refuses(
    { "Handle 2 has two motions", Advice("remove one, or its row from the motions' table.") });
  bend->RemoveHandleMotion(2);
  bend.Bends(); // by the row
  bend->SetHandleMotion(2, bend.Motion);
  bend->SetNumberOfMotionRows(0);
  bend.Bends();

  setRow(1.5);
  bend.Refuses({ "names handle 1.5", Advice("ids are whole numbers >= 1.") });
  bend->RemoveHandleMotion(2);
  setRow(2.0);
  bend.Bends();
}

TEST(AdviceOnHandles, OfTwoArraysOneIsChosen)
{
  Bend bend;
  bend->RemoveAllHandleMotions();
  const auto turns = Doubles("Turn", 3, 0.0);
  turns->FillComponent(0, 0.5);
  bend.Bar->GetPointData()->AddArray(turns);
  bend.Bar->GetPointData()->AddArray(Doubles("Transform", 9, 0.1));
  bend->SetRotationVectorArrayName("Turn");
  bend->SetTransformArrayName("Transform");
  bend.Refuses({ "rotation vector array and a transform array", Advice("choose one.") });
  bend->SetTransformArrayName("");
  bend.Works();
  bend->SetRotationVectorArrayName("");
  bend->SetTransformArrayName("Transform");
  bend.Works();
}

TEST(AdviceOnHandles, WeightsFreeOrFixPoints)
{
  Bend bend;
  const double infinity = std::numeric_limits<double>::infinity();
  const auto weights = Doubles("Weight", 1, infinity);
  weights->SetTuple1(0, -1.0);
  weights->SetTuple1(1, std::nan(""));
  bend.Bar->GetPointData()->AddArray(weights);
  bend->SetConstraintWeightArrayName("Weight");
  const std::string message = bend.Refuses({ "\"Weight\" has 2 handle points (ids 0, 1)",
    Advice("0 leaves a point free, infinity fixes it.") });
  for (const vtkIdType v : vtktest::IdsAfter(message, "2 handle points (ids "))
  {
    weights->SetTuple1(v, infinity);
  }
  weights->Modified();
  bend.Bends();
  const int free = bend->GetNumberOfFreePoints();
  for (vtkIdType v = 0; v < weights->GetNumberOfTuples(); ++v)
  {
    const bool isFirstOfEnd = bend.Bar->GetPoint(v)[2] == 3.5 && bend.Bar->GetPoint(v)[0] < 0.0 &&
      bend.Bar->GetPoint(v)[1] < 0.0;
    weights->SetTuple1(v, isFirstOfEnd ? 0.0 : infinity);
  }
  weights->Modified();
  bend.Works();
  EXPECT_EQ(bend->GetNumberOfFreePoints(), free + 1);
}

TEST(AdviceOnHandles, WeightsNearZeroAreRaised)
{
  for (const double weight : { 1e-7, 1e-8, 1e-20 })
  {
    Bend bend;
    bend.Bar->GetPointData()->AddArray(Doubles("Weight", 1, weight));
    bend->SetConstraintWeightArrayName("Weight");
    bend.Refuses({ Advice("Raise constraint weights near 0.") });
    bend.Bar->GetPointData()->AddArray(Doubles("Weight", 1, 1e4));
    vtktest::ExpectEnds(bend.Works(), MarkedBar(), bend.Motion, 1e-6);
  }
}

TEST(AdviceOnHandles, PoissonTakesMotionsOrAnotherMethodTakesArrays)
{
  const auto bar = MarkedBar();
  vtktest::AddArray(bar, "Turn", 3,
    [&](vtkIdType v, double* vector)
    {
      vector[0] = bar->GetPoint(v)[2] > 3.4 ? 0.5 : 0.0;
      vector[1] = vector[2] = 0.0;
    });
  Advised<vtkPoissonDeformation> poisson;
  poisson->SetInputData(bar);
  poisson->SetRotationVectorArrayName("Turn");
  poisson.Refuses(
    { "Poisson editing", Advice("give each handle a motion, or choose another method.") });
  const auto motion = Turn(30.0);
  poisson->SetHandleMotion(2, motion);
  poisson->SetHandleMotion(1, Turn(0.0));
  vtktest::ExpectEnds(poisson.Works(), bar, motion);
  Advised<vtkRotationInvariantDeformation> other;
  other->SetInputData(bar);
  other->SetRotationVectorArrayName("Turn");
  other.Works();
}

TEST(AdviceOnHandles, ResultsOutOfRangeTakeDoublePointsOrSmallerMotions)
{
  // So large that a motion out of the range is not large beside it.
  const shapes::Shape shape = shapes::Bar(2, 2, 8, { 1e37, 1e37, 4e37 });
  vtkSmartPointer<vtkPolyData> bar = vtktest::MakePolyData(shape, VTK_FLOAT);
  vtktest::MarkEnds(bar, 0.6e37, 3.4e37);
  const vtkSmartPointer<vtkPolyData> precise = vtktest::MakePolyData(shape);
  vtktest::MarkEnds(precise, 0.6e37, 3.4e37);
  Advised<vtkRotationInvariantDeformation> deform;
  const auto shift = vtkSmartPointer<vtkHandleMotion>::New();
  const auto result = [&](double y, vtkPolyData* rest)
  {
    shift->SetTranslation(0.0, y, 0.0);
    deform->SetInputData(rest);
    const auto shifted = deform.Works();
    vtktest::ExpectEnds(shifted, rest, shift, 1e-6 * y);
  };
  shift->SetTranslation(0.0, 1e39, 0.0);
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, shift);
  const std::string smaller = Advice("use smaller motions.");
  deform.Refuses(
    { "points (ids ", "single precision", Advice("give the points as double, or "), smaller });
  result(1e39, precise);
  result(1e37, bar);
  bar = vtktest::MarkedBar();
  deform->SetInputData(bar);
  shift->SetScale(1.0, 1.0, 1e308);
  deform.Refuses({ "points (ids ", "double precision", smaller });
  shift->SetScale(1.0, 1.0, 1.0);
  result(1e3, bar);
}
