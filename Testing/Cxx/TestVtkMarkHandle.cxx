// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMarkHandle.h"

#include <gtest/gtest.h>

#include "vtkBox.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkExtractSelection.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPlane.h"
#include "vtkPlaneSource.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkSelectionSource.h"
#include "vtkSelector.h"
#include "vtkSignedCharArray.h"
#include "vtkSphere.h"
#include "vtkSphereSource.h"
#include "vtkStringArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkTransform.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <sstream>
#include <string>

namespace
{
using Ids = std::set<vtkIdType>;

// The unit square in the plane z = 0 with 11 x 11 points; the id of (i, j) is
// 11 j + i. The two triangles of a quad share the diagonal from (i, j) to
// (i + 1, j + 1).
vtkSmartPointer<vtkPolyData> MakeSquare()
{
  vtkNew<vtkPlaneSource> source;
  source->SetOrigin(0.0, 0.0, 0.0);
  source->SetPoint1(1.0, 0.0, 0.0);
  source->SetPoint2(0.0, 1.0, 0.0);
  source->SetResolution(10, 10);
  source->Update();
  auto square = vtkSmartPointer<vtkPolyData>::New();
  square->SetPoints(source->GetOutput()->GetPoints());
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType j = 0; j < 10; ++j)
  {
    for (vtkIdType i = 0; i < 10; ++i)
    {
      const vtkIdType a = 11 * j + i;
      triangles->InsertNextCell({ a, a + 1, a + 12 });
      triangles->InsertNextCell({ a, a + 12, a + 11 });
    }
  }
  square->SetPolys(triangles);
  return square;
}

vtkSmartPointer<vtkPolyData> MakePoints(
  std::initializer_list<std::initializer_list<double>> coordinates)
{
  auto cloud = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const auto& point : coordinates)
  {
    points->InsertNextPoint(point.begin());
  }
  cloud->SetPoints(points);
  return cloud;
}

vtkSmartPointer<vtkSphere> MakeSphere(double x, double y, double radius)
{
  auto sphere = vtkSmartPointer<vtkSphere>::New();
  sphere->SetCenter(x, y, 0.0);
  sphere->SetRadius(radius);
  return sphere;
}

vtkSmartPointer<vtkSelectionNode> MakeNode(int fieldType, std::initializer_list<vtkIdType> ids)
{
  auto node = vtkSmartPointer<vtkSelectionNode>::New();
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(fieldType);
  vtkNew<vtkIdTypeArray> list;
  for (const vtkIdType id : ids)
  {
    list->InsertNextValue(id);
  }
  node->SetSelectionList(list);
  return node;
}

vtkSmartPointer<vtkSelection> MakeSelection(vtkSelectionNode* node)
{
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}

Ids Marked(vtkPolyData* surface, int id, const char* name = "Handle")
{
  Ids ids;
  auto* handles = vtkIntArray::SafeDownCast(surface->GetPointData()->GetArray(name));
  EXPECT_NE(handles, nullptr);
  if (handles)
  {
    EXPECT_EQ(handles->GetNumberOfTuples(), surface->GetNumberOfPoints());
    EXPECT_EQ(handles->GetNumberOfComponents(), 1);
    for (vtkIdType i = 0; i < handles->GetNumberOfTuples(); ++i)
    {
      if (handles->GetValue(i) == id)
      {
        ids.insert(i);
      }
    }
  }
  return ids;
}

// A filter on the square that keeps what it has to say.
struct Marker
{
  Marker()
  {
    this->Filter->AddObserver(vtkCommand::ErrorEvent, this->Messages);
    this->Filter->AddObserver(vtkCommand::WarningEvent, this->Messages);
    this->Filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this->ExecutiveMessages);
    this->Filter->SetInputData(this->Input);
  }
  Ids Run(int id = 1)
  {
    this->Filter->Update();
    EXPECT_EQ(this->Messages->GetErrorMessage(), "");
    EXPECT_EQ(this->Messages->GetWarningMessage(), "");
    return Marked(this->Filter->GetOutput(), id);
  }
  void ExpectError(const std::string& part)
  {
    this->Messages->Clear();
    this->Filter->Update();
    const std::string message = this->Messages->GetErrorMessage();
    EXPECT_NE(message.find(part), std::string::npos) << "the message is: " << message;
    EXPECT_EQ(message.find("ERROR:", 1), std::string::npos) << "more than one: " << message;
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetNumberOfMarkedPoints(), 0);
  }
  void ExpectWarning(const std::string& part)
  {
    this->Messages->Clear();
    this->Filter->Update();
    EXPECT_EQ(this->Messages->GetErrorMessage(), "");
    const std::string message = this->Messages->GetWarningMessage();
    EXPECT_NE(message.find(part), std::string::npos) << "the message is: " << message;
  }

  vtkSmartPointer<vtkPolyData> Input = MakeSquare();
  vtkNew<vtkMarkHandle> Filter;
  vtkNew<vtkTest::ErrorObserver> Messages;
  vtkNew<vtkTest::ErrorObserver> ExecutiveMessages;
};

// Stands for ParaView's extractor: knows queries, and selects the first point.
class FirstPointSelector : public vtkSelector
{
public:
  static FirstPointSelector* New();
  vtkTypeMacro(FirstPointSelector, vtkSelector);

protected:
  bool ComputeSelectedElements(vtkDataObject*, vtkSignedCharArray* inside) override
  {
    inside->FillValue(0);
    inside->SetValue(0, 1);
    return true;
  }
};
vtkStandardNewMacro(FirstPointSelector);

class QueryExtractor : public vtkExtractSelection
{
public:
  static QueryExtractor* New();
  vtkTypeMacro(QueryExtractor, vtkExtractSelection);

protected:
  vtkSmartPointer<vtkSelector> NewSelectionOperator(
    vtkSelectionNode::SelectionContent type) override
  {
    if (type == vtkSelectionNode::QUERY)
    {
      return vtkSmartPointer<FirstPointSelector>::New();
    }
    return this->Superclass::NewSelectionOperator(type);
  }
};
vtkStandardNewMacro(QueryExtractor);
}

TEST(MarkHandle, MarksWhereTheFunctionIsNotPositive)
{
  Marker marker;
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(0.2, 0.0, 0.0);
  plane->SetNormal(1.0, 0.0, 0.0);
  vtkNew<vtkBox> box;
  box->SetBounds(-0.05, 0.25, -0.05, 0.15, -1.0, 1.0);

  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.11));
  EXPECT_EQ(marker.Run(), (Ids{ 0, 1, 11 }));
  EXPECT_EQ(marker.Filter->GetNumberOfMarkedPoints(), 3);
  marker.Filter->SetRegion(box);
  EXPECT_EQ(marker.Run(), (Ids{ 0, 1, 2, 11, 12, 13 }));
  plane->SetOrigin(0.25, 0.0, 0.0);
  marker.Filter->SetRegion(plane);
  EXPECT_EQ(marker.Run().size(), 33u);
  marker.Filter->InsideOutOn();
  EXPECT_EQ(marker.Run().size(), 88u);
}

TEST(MarkHandle, FollowsTheFunctionAndItsTransform)
{
  Marker marker;
  auto sphere = MakeSphere(0.0, 0.0, 0.01);
  marker.Filter->SetRegion(sphere);
  EXPECT_EQ(marker.Run(), (Ids{ 0 }));
  sphere->SetCenter(0.1, 0.0, 0.0);
  EXPECT_EQ(marker.Run(), (Ids{ 1 }));
  vtkNew<vtkTransform> transform;
  sphere->SetTransform(transform);
  transform->Translate(-0.1, -0.1, 0.0);
  EXPECT_EQ(marker.Run(), (Ids{ 13 }));
  transform->Translate(-0.1, 0.0, 0.0);
  EXPECT_EQ(marker.Run(), (Ids{ 14 }));
}

TEST(MarkHandle, MarksSelectedPointsAndThePointsOfSelectedCells)
{
  Marker marker;
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 5, 60 })));
  EXPECT_EQ(marker.Run(), (Ids{ 5, 60 }));
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::CELL, { 1 })));
  EXPECT_EQ(marker.Run(), (Ids{ 0, 11, 12 }));

  auto all = MakeNode(vtkSelectionNode::POINT, { 5 });
  all->GetProperties()->Set(vtkSelectionNode::INVERSE(), 1);
  marker.Filter->SetSelectionData(MakeSelection(all));
  EXPECT_EQ(marker.Run().size(), 120u);
}

TEST(MarkHandle, TakesASelectionFromAPipeline)
{
  Marker marker;
  vtkNew<vtkDoubleArray> height;
  height->SetName("Height");
  for (vtkIdType i = 0; i < 121; ++i)
  {
    height->InsertNextValue(static_cast<double>(i));
  }
  marker.Input->GetPointData()->AddArray(height);
  vtkNew<vtkSelectionSource> source;
  source->SetContentType(vtkSelectionNode::THRESHOLDS);
  source->SetFieldType(vtkSelectionNode::POINT);
  source->SetArrayName("Height");
  source->AddThreshold(10.0, 12.0);
  marker.Filter->SetSelectionConnection(source->GetOutputPort());
  EXPECT_EQ(marker.Run(), (Ids{ 10, 11, 12 }));
  source->AddThreshold(40.0, 40.5);
  EXPECT_EQ(marker.Run(), (Ids{ 10, 11, 12, 40 }));

  source->SetContentType(vtkSelectionNode::FRUSTUM);
  // The eight corners of the frustum, a box about (0.5, 0.5).
  double corners[32];
  int next = 0;
  for (const double x : { 0.45, 0.55 })
  {
    for (const double y : { 0.45, 0.65 })
    {
      for (const double z : { 1.0, -1.0 })
      {
        corners[next++] = x;
        corners[next++] = y;
        corners[next++] = z;
        corners[next++] = 1.0;
      }
    }
  }
  source->SetFrustum(corners);
  EXPECT_EQ(marker.Run(), (Ids{ 60, 71 }));
}

TEST(MarkHandle, LeavesTheSelectionAlone)
{
  Marker marker;
  auto node = MakeNode(vtkSelectionNode::POINT, { 5 });
  node->GetProperties()->Set(vtkSelectionNode::PROCESS_ID(), 7);
  auto selection = MakeSelection(node);
  marker.Filter->SetSelectionData(selection);
  marker.ExpectWarning("the region has no points");
  EXPECT_EQ(selection->GetNumberOfNodes(), 1u);
}

TEST(MarkHandle, IsNotMisledByAnOldInsidednessArray)
{
  Marker marker;
  vtkNew<vtkSignedCharArray> old;
  old->SetName("vtkInsidedness");
  old->SetNumberOfTuples(121);
  old->FillValue(1);
  marker.Input->GetPointData()->AddArray(old);
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 5 })));
  EXPECT_EQ(marker.Run(), (Ids{ 5 }));
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::CELL, { 1 })));
  EXPECT_EQ(marker.Run(), (Ids{ 0, 11, 12 }));
  EXPECT_EQ(marker.Filter->GetOutput()->GetPointData()->GetArray("vtkInsidedness"), old);
}

TEST(MarkHandle, ChoosesItsSource)
{
  Marker marker;
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.01));
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 7 })));
  EXPECT_EQ(marker.Run(), (Ids{ 0, 7 }));
  marker.Filter->SetRegionSourceToFunction();
  EXPECT_EQ(marker.Run(), (Ids{ 0 }));
  marker.Filter->SetRegionSourceToSelection();
  EXPECT_EQ(marker.Run(), (Ids{ 7 }));
  marker.Filter->SetRegionSourceToAllPoints();
  EXPECT_EQ(marker.Run().size(), 121u);
}

TEST(MarkHandle, GrowsByRings)
{
  Marker marker;
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 60 })));
  marker.Filter->SetGrowRings(1);
  EXPECT_EQ(marker.Run(), (Ids{ 60, 48, 49, 59, 61, 71, 72 }));
  marker.Filter->SetGrowRings(2);
  EXPECT_EQ(marker.Run().size(), 19u);
  marker.Filter->SetGrowRings(VTK_INT_MAX);
  EXPECT_EQ(marker.Run().size(), 121u);
}

TEST(MarkHandle, GrowsByGeodesicDistance)
{
  Marker marker;
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 60 })));
  marker.Filter->SetGrowDistance(0.31);
  Ids disc;
  for (vtkIdType i = 0; i < 121; ++i)
  {
    double x[3];
    marker.Input->GetPoint(i, x);
    if (std::hypot(x[0] - 0.5, x[1] - 0.5) <= 0.31)
    {
      disc.insert(i);
    }
  }
  EXPECT_EQ(marker.Run(), disc);
  marker.Filter->SetGrowRings(2); // reaches (7, 7), which is farther
  disc.insert({ 60 + 22 + 2, 60 - 22 - 2 });
  EXPECT_EQ(marker.Run(), disc);
}

TEST(MarkHandle, GrowsAlongTheSurfaceOnly)
{
  // Two sheets at a distance of 0.05.
  Marker marker;
  vtkNew<vtkPolyData> sheets;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType sheet = 0; sheet < 2; ++sheet)
  {
    for (vtkIdType i = 0; i < 121; ++i)
    {
      double x[3];
      marker.Input->GetPoint(i, x);
      points->InsertNextPoint(x[0], x[1], 0.05 * sheet);
    }
    for (vtkIdType t = 0; t < 200; ++t)
    {
      vtkIdType corners[3];
      vtkIdType count = 0;
      const vtkIdType* ids = nullptr;
      marker.Input->GetPolys()->GetCellAtId(t, count, ids);
      std::transform(ids, ids + 3, corners, [sheet](vtkIdType id) { return id + 121 * sheet; });
      triangles->InsertNextCell(3, corners);
    }
  }
  sheets->SetPoints(points);
  sheets->SetPolys(triangles);
  marker.Filter->SetInputData(sheets);
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 60 })));
  marker.Filter->SetGrowDistance(10.0);
  EXPECT_EQ(marker.Run().size(), 121u);
}

TEST(MarkHandle, ChainsForSeveralHandles)
{
  Marker first;
  first.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.11));
  Marker second;
  second.Filter->SetInputConnection(first.Filter->GetOutputPort());
  second.Filter->SetRegion(MakeSphere(0.2, 0.0, 0.11));
  second.Filter->SetHandleId(2);
  EXPECT_EQ(second.Run(2), (Ids{ 1, 2, 3, 13 }));
  EXPECT_EQ(second.Run(1), (Ids{ 0, 11 }));
  EXPECT_EQ(Marked(first.Filter->GetOutput(), 1), (Ids{ 0, 1, 11 })); // still

  second.Filter->OverwriteOff();
  EXPECT_EQ(second.Run(2), (Ids{ 2, 3, 13 }));
  EXPECT_EQ(second.Run(1), (Ids{ 0, 1, 11 }));
  EXPECT_EQ(second.Filter->GetNumberOfMarkedPoints(), 3);

  second.Filter->OverwriteOn();
  second.Filter->SetHandleId(0);
  EXPECT_EQ(second.Run(1), (Ids{ 0, 11 }));
  second.Filter->SetRegionSourceToAllPoints();
  EXPECT_EQ(second.Run(0).size(), 121u);
}

TEST(MarkHandle, ExtendsArraysOfOtherTypesAndNames)
{
  Marker marker;
  vtkNew<vtkDoubleArray> existing;
  existing->SetName("Grip");
  existing->SetNumberOfTuples(121);
  existing->FillValue(0.0);
  existing->SetValue(100, 4.0);
  marker.Input->GetPointData()->SetScalars(existing);
  marker.Filter->SetHandleArrayName("Grip");
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.01));
  marker.Filter->Update();
  EXPECT_EQ(Marked(marker.Filter->GetOutput(), 1, "Grip"), (Ids{ 0 }));
  EXPECT_EQ(Marked(marker.Filter->GetOutput(), 4, "Grip"), (Ids{ 100 }));
  EXPECT_EQ(marker.Filter->GetOutput()->GetPointData()->GetArray("Handle"), nullptr);
  EXPECT_EQ(existing->GetValue(0), 0.0);
  EXPECT_EQ(marker.Input->GetPointData()->GetArray("Grip"), existing);
}

TEST(MarkHandle, TouchesNothingElse)
{
  Marker marker;
  vtkNew<vtkDoubleArray> other;
  other->SetName("Other");
  other->SetNumberOfTuples(121);
  other->FillValue(1.0);
  marker.Input->GetPointData()->AddArray(other);
  const vtkMTimeType time = marker.Input->GetMTime();
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.11));
  marker.Filter->SetGrowRings(1);
  marker.Run();
  EXPECT_EQ(marker.Input->GetMTime(), time);
  EXPECT_EQ(marker.Input->GetPointData()->GetArray("Handle"), nullptr);
  vtkPolyData* output = marker.Filter->GetOutput();
  EXPECT_EQ(output->GetPoints(), marker.Input->GetPoints());
  EXPECT_EQ(output->GetPointData()->GetArray("Other"), other);
  EXPECT_EQ(output->GetNumberOfCells(), 200);
}

TEST(MarkHandle, ExecutesOnlyWhenSomethingChanges)
{
  Marker marker;
  auto sphere = MakeSphere(0.0, 0.0, 0.11);
  marker.Filter->SetRegion(sphere);
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 5 })));
  const auto executes = [&marker]
  {
    const vtkMTimeType before = marker.Filter->GetOutput()->GetMTime();
    marker.Filter->Update();
    return marker.Filter->GetOutput()->GetMTime() > before;
  };
  EXPECT_TRUE(executes());
  EXPECT_FALSE(executes());
  sphere->SetRadius(0.2);
  EXPECT_TRUE(executes());
  EXPECT_FALSE(executes());
  marker.Filter->SetGrowRings(1);
  EXPECT_TRUE(executes());
  marker.Filter->SetGrowRings(1);
  EXPECT_FALSE(executes());
  vtkNew<vtkExtractSelection> extractor;
  marker.Filter->SetSelectionExtractor(extractor);
  EXPECT_TRUE(executes());
  EXPECT_FALSE(executes());
}

TEST(MarkHandle, UsesTheExtractorItIsGiven)
{
  Marker marker;
  vtkNew<vtkSelectionNode> query;
  query->SetContentType(vtkSelectionNode::QUERY);
  query->SetFieldType(vtkSelectionNode::POINT);
  query->SetQueryString("id == 0");
  marker.Filter->SetSelectionData(MakeSelection(query));
  marker.ExpectError("The selection cannot be evaluated: it is a query");
  marker.Messages->Clear();
  vtkNew<QueryExtractor> extractor;
  marker.Filter->SetSelectionExtractor(extractor);
  EXPECT_EQ(marker.Run(), (Ids{ 0 }));
  EXPECT_EQ(extractor->GetNumberOfInputConnections(0), 0);
}

TEST(MarkHandle, MarksPointsByTheirIds)
{
  Marker marker;
  const vtkIdType ids[] = { 40, 3, 3, 120 };
  for (int i = 0; i < 4; ++i)
  {
    marker.Filter->SetPointId(i, ids[i]);
  }
  EXPECT_EQ(marker.Run(), (Ids{ 3, 40, 120 }));
  EXPECT_EQ(marker.Filter->GetPointId(0), 40);
  EXPECT_EQ(marker.Filter->GetPointId(4), -1);
  vtkIdTypeArray* marked = marker.Filter->GetMarkedPointIds();
  ASSERT_EQ(marked->GetNumberOfTuples(), 3);
  EXPECT_EQ(marked->GetValue(2), 120);
  // They add to a function, as a selection does.
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.01));
  EXPECT_EQ(marker.Run(), (Ids{ 0, 3, 40, 120 }));
  marker.Filter->SetRegionSourceToFunction();
  EXPECT_EQ(marker.Run(), (Ids{ 0 }));
  marker.Filter->SetRegionSourceToSelection();
  EXPECT_EQ(marker.Run(), (Ids{ 3, 40, 120 }));
  marker.Filter->SetNumberOfPointIds(1);
  EXPECT_EQ(marker.Run(), (Ids{ 40 }));
  marker.Filter->SetPointId(1, 121);
  marker.ExpectError("1 of the PointIds (first: 121) name no point of the input, whose ids are 0 "
                     "to 120");
}

TEST(MarkHandle, CountsPointIdsOnThroughBlocks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, MakeSquare());
  blocks->SetBlock(2, MakeSquare());
  vtkNew<vtkMarkHandle> filter;
  filter->SetInputDataObject(blocks);
  filter->SetPointId(0, 5);
  filter->SetPointId(1, 121 + 7);
  filter->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(Marked(vtkPolyData::SafeDownCast(output->GetBlock(0)), 1), (Ids{ 5 }));
  EXPECT_EQ(Marked(vtkPolyData::SafeDownCast(output->GetBlock(2)), 1), (Ids{ 7 }));
  ASSERT_EQ(filter->GetMarkedPointIds()->GetNumberOfTuples(), 2);
  EXPECT_EQ(filter->GetMarkedPointIds()->GetValue(1), 128);
}

TEST(MarkHandle, WarnsOfAnEmptyRegion)
{
  Marker marker;
  marker.ExpectWarning("there is neither a region function nor a selection on port 1 nor PointIds");
  EXPECT_EQ(Marked(marker.Filter->GetOutput(), 0).size(), 121u);
  EXPECT_EQ(marker.Filter->GetNumberOfMarkedPoints(), 0);
  marker.Filter->SetRegionSourceToFunction();
  marker.ExpectWarning("there is no region function");
  marker.Filter->SetRegionSourceToSelection();
  marker.ExpectWarning("there is neither a selection on port 1 nor PointIds");
  vtkNew<vtkSelection> selection;
  marker.Filter->SetSelectionData(selection);
  marker.ExpectWarning("No point is marked for handle 1: the region has no points.");
  marker.Filter->SetRegionSourceToFunction();
  marker.Filter->SetRegion(MakeSphere(5.0, 0.0, 0.1));
  marker.Filter->SetGrowDistance(10.0); // from nowhere
  marker.ExpectWarning("the region has no points.");
  marker.Filter->OverwriteOff();
  marker.ExpectWarning("Overwrite is off");
}

TEST(MarkHandle, RefusesArraysThatAreNoHandles)
{
  Marker marker;
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.11));
  vtkNew<vtkIntArray> handles;
  handles->SetName("Handle");
  marker.Input->GetPointData()->AddArray(handles);

  handles->SetNumberOfTuples(120);
  handles->FillValue(0);
  marker.ExpectError("has 120 tuples of 1 components; expected 121 of 1");
  handles->SetNumberOfComponents(3);
  handles->SetNumberOfTuples(121);
  handles->FillValue(0);
  handles->Modified();
  marker.ExpectError("tuples of 3 components");
  vtkNew<vtkDoubleArray> reals;
  reals->SetName("Handle");
  reals->SetNumberOfTuples(121);
  reals->FillValue(1.0);
  reals->SetValue(3, 0.5);
  reals->SetValue(8, -1.0);
  reals->SetValue(9, std::numeric_limits<double>::quiet_NaN());
  reals->SetValue(10, 1e12);
  marker.Input->GetPointData()->AddArray(reals);
  marker.ExpectError("4 values (ids 3, 8, 9, 10) that are not whole numbers >= 0");
  vtkNew<vtkStringArray> words;
  words->SetName("Handle");
  words->SetNumberOfTuples(121);
  marker.Input->GetPointData()->RemoveArray("Handle");
  marker.Input->GetPointData()->AddArray(words);
  marker.ExpectError("has no numbers");
  EXPECT_EQ(marker.Input->GetNumberOfPoints(), 121);
  EXPECT_EQ(marker.Input->GetPointData()->GetAbstractArray("Handle"), words);

  marker.Filter->SetHandleArrayName("");
  marker.ExpectError("HandleArrayName is empty");
}

TEST(MarkHandle, RefusesSelectionsThatMixPointsAndCells)
{
  Marker marker;
  auto selection = MakeSelection(MakeNode(vtkSelectionNode::POINT, { 5 }));
  selection->AddNode(MakeNode(vtkSelectionNode::CELL, { 1 }));
  marker.Filter->SetSelectionData(selection);
  marker.ExpectError("The selection cannot be evaluated");
}

TEST(MarkHandle, SelectsNothingWhereTheSelectionHasNothing)
{
  Marker marker;
  for (const auto& node :
    { MakeNode(vtkSelectionNode::POINT, {}), MakeNode(vtkSelectionNode::POINT, { 121, 100000, -1 }),
      MakeNode(vtkSelectionNode::CELL, { 200 }) })
  {
    marker.Filter->SetSelectionData(MakeSelection(node));
    marker.ExpectWarning("the region has no points");
  }
}

TEST(MarkHandle, RefusesSelectionsThatMakeNoSense)
{
  Marker marker;
  vtkNew<vtkSelectionNode> node;
  marker.Filter->SetSelectionData(MakeSelection(node));
  marker.ExpectError("The selection cannot be evaluated: it is a query, or of a kind");
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(vtkSelectionNode::ROW);
  marker.Filter->SetSelectionData(MakeSelection(node));
  marker.ExpectError("it selects neither points nor cells");
  node->SetFieldType(vtkSelectionNode::CELL);
  node->SetContentType(vtkSelectionNode::FRUSTUM);
  marker.Filter->SetSelectionData(MakeSelection(node));
  marker.ExpectError("its frustum is not given by 8 corners");
  node->SetContentType(vtkSelectionNode::BLOCKS);
  marker.Filter->SetSelectionData(MakeSelection(node));
  marker.ExpectError("it selects blocks, but has no list");
}

TEST(MarkHandle, NeedsASurfaceToGrowOnly)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Marker marker;
  auto cloud = MakePoints({ { 0, 0, 0 }, { 0.05, 0, 0 }, { nan, 0, 0 }, { 1, 0, 0 } });
  marker.Filter->SetInputData(cloud);
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.11));
  EXPECT_EQ(marker.Run(), (Ids{ 0, 1 }));
  marker.Filter->InsideOutOn();
  EXPECT_EQ(marker.Run(), (Ids{ 3 })); // NaN is on neither side
  marker.Filter->SetGrowRings(1);
  marker.ExpectError("no triangles");

  // Three triangles at an edge.
  auto fan = MakePoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 } });
  vtkNew<vtkCellArray> triangles;
  triangles->InsertNextCell({ 0, 1, 2 });
  triangles->InsertNextCell({ 1, 0, 3 });
  triangles->InsertNextCell({ 0, 1, 4 });
  fan->SetPolys(triangles);
  marker.Filter->SetInputData(fan);
  marker.ExpectError("edge");
  marker.Filter->SetGrowRings(0);
  marker.Messages->Clear();
  EXPECT_EQ(marker.Run().size(), 4u);
}

TEST(MarkHandle, TakesDegenerateInputs)
{
  Marker marker;
  marker.Filter->SetRegionSourceToAllPoints();
  marker.Filter->SetGrowRings(1);
  marker.Filter->SetGrowDistance(1.0);

  // One triangle and a point in none.
  auto triangle = MakePoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 5, 5, 5 } });
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 2 });
  triangle->SetPolys(cells);
  marker.Filter->SetInputData(triangle);
  EXPECT_EQ(marker.Run(), (Ids{ 0, 1, 2, 3 }));
  marker.Filter->SetRegionSourceToSelection();
  marker.Filter->SetSelectionData(MakeSelection(MakeNode(vtkSelectionNode::POINT, { 3 })));
  EXPECT_EQ(marker.Run(), (Ids{ 3 }));

  vtkNew<vtkPolyData> empty;
  marker.Filter->SetInputData(empty);
  marker.Filter->Update();
  EXPECT_EQ(marker.Messages->GetErrorMessage(), "");
  EXPECT_EQ(marker.Filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(MarkHandle, StopsWhenAborted)
{
  Marker marker;
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.11));
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* filter, unsigned long, void*, void*)
    { vtkAlgorithm::SafeDownCast(filter)->SetAbortExecute(1); });
  marker.Filter->AddObserver(vtkCommand::ProgressEvent, stop);
  marker.Filter->Update();
  EXPECT_EQ(marker.Messages->GetErrorMessage(), "");
  EXPECT_EQ(marker.Messages->GetWarningMessage(), "");
  EXPECT_EQ(marker.Filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(marker.Filter->GetNumberOfMarkedPoints(), 0);
}

TEST(MarkHandle, MarksAllBlocksOfACompositeInput)
{
  Marker marker;
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkNew<vtkMultiBlockDataSet> inner;
  blocks->SetBlock(0, MakeSquare()); // flat index 1
  blocks->SetBlock(1, inner);        // flat index 2
  inner->SetBlock(0, nullptr);       // flat index 3
  inner->SetBlock(1, MakeSquare());  // flat index 4
  vtkNew<vtkPolyData> empty;
  inner->SetBlock(2, empty); // flat index 5
  marker.Filter->SetInputData(blocks);
  marker.Filter->SetRegion(MakeSphere(0.0, 0.0, 0.11));
  const auto output = [&marker](int place) -> vtkPolyData*
  {
    auto* result = vtkMultiBlockDataSet::SafeDownCast(marker.Filter->GetOutputDataObject(0));
    vtkDataObject* block = place == 0
      ? result->GetBlock(0)
      : vtkMultiBlockDataSet::SafeDownCast(result->GetBlock(1))->GetBlock(1);
    return vtkPolyData::SafeDownCast(block);
  };
  marker.Filter->Update();
  EXPECT_EQ(Marked(output(0), 1), (Ids{ 0, 1, 11 }));
  EXPECT_EQ(Marked(output(1), 1), (Ids{ 0, 1, 11 }));
  EXPECT_EQ(marker.Filter->GetNumberOfMarkedPoints(), 6);

  // A selection in one block, then in all.
  marker.Filter->SetRegionSourceToSelection();
  auto node = MakeNode(vtkSelectionNode::POINT, { 5 });
  marker.Filter->SetSelectionData(MakeSelection(node));
  marker.Filter->Update();
  EXPECT_EQ(marker.Filter->GetNumberOfMarkedPoints(), 2);
  node->GetProperties()->Set(vtkSelectionNode::COMPOSITE_INDEX(), 4);
  marker.Filter->SetSelectionData(MakeSelection(node));
  marker.Filter->Update();
  EXPECT_EQ(Marked(output(0), 1), (Ids{}));
  EXPECT_EQ(Marked(output(1), 1), (Ids{ 5 }));
  EXPECT_EQ(marker.Messages->GetErrorMessage(), "");
  EXPECT_EQ(marker.Messages->GetWarningMessage(), "");

  // Back to a plain input.
  marker.Filter->SetInputData(marker.Input);
  marker.Filter->SetRegionSourceToFunction();
  EXPECT_EQ(marker.Run(), (Ids{ 0, 1, 11 }));

  vtkNew<vtkImageData> image;
  image->SetDimensions(2, 2, 2);
  blocks->SetBlock(0, image);
  marker.Filter->SetInputData(blocks);
  marker.Messages->Clear();
  marker.Filter->Update();
  EXPECT_NE(marker.Messages->GetErrorMessage().find("Block 1 of the input is a vtkImageData"),
    std::string::npos);
  auto* result = vtkMultiBlockDataSet::SafeDownCast(marker.Filter->GetOutputDataObject(0));
  EXPECT_EQ(result->GetNumberOfBlocks(), 0u);
}

TEST(MarkHandle, ClampsItsParametersAndPrintsItself)
{
  vtkNew<vtkMarkHandle> filter;
  filter->SetHandleId(-3);
  EXPECT_EQ(filter->GetHandleId(), 0);
  filter->SetGrowRings(-1);
  EXPECT_EQ(filter->GetGrowRings(), 0);
  filter->SetGrowDistance(-1.0);
  EXPECT_EQ(filter->GetGrowDistance(), 0.0);
  filter->SetRegionSource(9);
  EXPECT_EQ(filter->GetRegionSource(), vtkMarkHandle::ALL_POINTS);
  filter->SetRegion(MakeSphere(0.0, 0.0, 1.0));
  std::ostringstream text;
  filter->Print(text);
  EXPECT_NE(text.str().find("RegionSource: AllPoints"), std::string::npos);
  EXPECT_NE(text.str().find("HandleArrayName: Handle"), std::string::npos);
}
