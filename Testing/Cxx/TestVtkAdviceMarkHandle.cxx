// SPDX-License-Identifier: BSD-3-Clause
// What Mark Handle advises.
#include "Advice.h"

#include "vtkMarkHandle.h"

#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPlane.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <utility>

using vtktest::Advice;
using vtktest::Advised;

namespace
{
/// Marks the upper end of the bar.
struct Mark : Advised<vtkMarkHandle>
{
  Mark()
  {
    this->Region->SetOrigin(0.0, 0.0, 3.4);
    this->Region->SetNormal(0.0, 0.0, -1.0);
    (*this)->SetInputData(this->Bar);
    (*this)->SetRegion(this->Region);
  }
  /// Quiet, and the end has the id.
  void Marks(int id = 1, const char* name = "Handle")
  {
    const auto marked = this->Works();
    vtkDataArray* handles = marked->GetPointData()->GetArray(name);
    ASSERT_NE(handles, nullptr);
    for (vtkIdType v = 0; v < marked->GetNumberOfPoints(); ++v)
    {
      EXPECT_EQ(handles->GetTuple1(v) == id, marked->GetPoint(v)[2] > 3.4) << v;
    }
  }

  vtkSmartPointer<vtkPolyData> Bar = vtktest::MakePolyData(shapes::Bar(2, 2, 8, { 1, 1, 4 }));
  vtkNew<vtkPlane> Region;
};

template <typename Array>
vtkSmartPointer<Array> Filled(int components, double value)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName("Handle");
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(Mark().Bar->GetNumberOfPoints());
  array->Fill(value);
  return array;
}
}

TEST(AdviceOnMarkHandle, TakesAnotherNameForWhatIsNoListOfIds)
{
  Mark mark;
  const std::string advice = Advice("remove it or choose another HandleArrayName.");
  vtkNew<vtkStringArray> words;
  words->SetName("Handle");
  words->SetNumberOfValues(mark.Bar->GetNumberOfPoints());
  const vtkSmartPointer<vtkAbstractArray> arrays[] = { words.Get(), Filled<vtkDoubleArray>(1, 0.5),
    Filled<vtkDoubleArray>(3, 0.0) };
  for (const auto& array : arrays)
  {
    mark.Bar->GetPointData()->AddArray(array);
    mark.Refuses({ "\"Handle\"", "it is not a list of handle ids", advice });
    mark->SetHandleArrayName("Ends");
    mark.Marks(1, "Ends");
    mark->SetHandleArrayName("Handle");
    mark.Bar->GetPointData()->RemoveArray("Handle");
    mark.Marks();
  }
  mark->SetHandleArrayName("");
  mark.Refuses({ "HandleArrayName is empty", Advice("give the point array a name.") });
  mark->SetHandleArrayName("Ends");
  mark.Marks(1, "Ends");
}

TEST(AdviceOnMarkHandle, TakesTheSurfaceBlocks)
{
  Mark mark;
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, vtkNew<vtkUnstructuredGrid>());
  blocks->SetBlock(1, mark.Bar);
  vtkNew<vtkMarkHandle> filter;
  filter->SetRegion(mark.Region);
  const auto log = vtktest::Observe(filter);
  filter->SetInputDataObject(blocks);
  filter->Update();
  vtktest::ExpectMessage(log->Errors,
    { "Block 1 of the input is a vtkUnstructuredGrid",
      Advice("extract the surface blocks first.") });
  log->Clear();
  vtkNew<vtkMultiBlockDataSet> surfaces;
  surfaces->SetBlock(0, mark.Bar);
  filter->SetInputDataObject(surfaces);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetNumberOfMarkedPoints(), 17);
}

TEST(AdviceOnMarkHandle, SelectsByOtherMeansThanAQuery)
{
  Mark mark;
  mark->SetRegion(nullptr);
  vtkNew<vtkSelectionNode> node;
  node->SetFieldType(vtkSelectionNode::POINT);
  node->SetContentType(vtkSelectionNode::QUERY);
  node->SetQueryString("id == 0");
  vtkNew<vtkSelection> selection;
  selection->AddNode(node);
  mark->SetSelectionData(selection);
  // ParaView's extractor is not in VTK: TestVtkMarkHandle.cxx has one that stands for it.
  mark.Refuses({ "it is a query",
    Advice("Select by ids, values, thresholds, locations or a frustum, or set ParaView's "
           "vtkPVExtractSelection with SetSelectionExtractor.") });
  vtkNew<vtkIdTypeArray> ids;
  ids->InsertNextValue(3);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Height");
  vtkNew<vtkDoubleArray> bounds; // of the height
  vtkNew<vtkDoubleArray> locations;
  vtkNew<vtkDoubleArray> frustum;
  locations->SetNumberOfComponents(3);
  locations->InsertNextTuple(mark.Bar->GetPoint(3));
  frustum->SetNumberOfComponents(4);
  for (int corner = 0; corner < 8; ++corner)
  {
    frustum->InsertNextTuple4(
      corner & 4 ? 9 : -9, corner & 2 ? 9 : -9, corner & 1 ? 3.4 : 9.0, 1.0);
  }
  vtktest::AddArray(
    mark.Bar, "Height", 1, [&](vtkIdType v, double* value) { *value = mark.Bar->GetPoint(v)[2]; });
  values->InsertNextValue(4.0);
  bounds->SetName("Height");
  bounds->SetNumberOfComponents(2);
  bounds->InsertNextTuple2(3.4, 5.0);
  node->GetProperties()->Set(vtkSelectionNode::EPSILON(), 1e-6); // of the location
  const std::pair<int, vtkAbstractArray*> means[] = { { vtkSelectionNode::INDICES, ids.Get() },
    { vtkSelectionNode::VALUES, values.Get() }, { vtkSelectionNode::THRESHOLDS, bounds.Get() },
    { vtkSelectionNode::LOCATIONS, locations.Get() },
    { vtkSelectionNode::FRUSTUM, frustum.Get() } };
  const vtkIdType expected[] = { 1, 9, 17, 1, 17 };
  for (int i = 0; i < 5; ++i)
  {
    SCOPED_TRACE(i);
    node->SetContentType(means[i].first);
    node->SetSelectionList(means[i].second);
    mark.Works();
    EXPECT_EQ(mark->GetNumberOfMarkedPoints(), expected[i]);
  }
}

TEST(AdviceOnMarkHandle, SelectsEitherPointsOrCells)
{
  Mark mark;
  mark->SetRegion(nullptr);
  vtkNew<vtkIdTypeArray> ids;
  ids->InsertNextValue(3);
  vtkNew<vtkSelection> selection;
  vtkNew<vtkSelectionNode> points;
  vtkNew<vtkSelectionNode> cells;
  for (const auto& [node, type] : { std::pair(points.Get(), vtkSelectionNode::POINT),
         std::pair(cells.Get(), vtkSelectionNode::CELL) })
  {
    node->SetContentType(vtkSelectionNode::INDICES);
    node->SetFieldType(type);
    node->SetSelectionList(ids);
    selection->AddNode(node);
  }
  mark->SetSelectionData(selection);
  const std::string advice = Advice("Select either points or cells, and name arrays that exist.");
  mark.Refuses({ "The selection cannot be evaluated: ", advice });
  selection->RemoveNode(points);
  mark.Works();
  EXPECT_EQ(mark->GetNumberOfMarkedPoints(), 3);
  selection->RemoveNode(cells);
  selection->AddNode(points);
  mark.Works();
  EXPECT_EQ(mark->GetNumberOfMarkedPoints(), 1);
}

TEST(AdviceOnMarkHandle, MarksWhatItLacked)
{
  Mark mark;
  mark->SetRegion(nullptr);
  mark.Warns({ "there is neither a region function nor a selection" });
  mark->SetRegionSourceToFunction();
  mark.Warns({ "RegionSource is Function, but there is no region function" });
  mark->SetRegion(mark.Region);
  mark.Marks();
  mark->SetRegionSourceToSelection();
  mark.Warns({ "there is neither a selection on port 1 nor PointIds" });
  mark->SetRegionSourceToFunction();
  mark.Bar->GetPointData()->AddArray(Filled<vtkIntArray>(1, 7.0));
  mark->OverwriteOff();
  mark.Warns({ "no points that are free, and Overwrite is off" });
  mark->OverwriteOn();
  mark.Marks();
}

TEST(AdviceOnMarkHandle, CopiesIdsAgainOrForgetsThem)
{
  Mark mark;
  mark->SetPointId(0, 3);
  mark->SetPointId(1, 74);
  mark.Refuses({ "1 of the PointIds (first: 74) name no point of the input, whose ids are 0 to 73",
    Advice("Copy the selection again, or remove them.") });
  mark->SetPointId(1, 5);
  mark.Works();
  EXPECT_EQ(mark->GetNumberOfMarkedPoints(), 19);
  mark->SetPointId(1, 74);
  mark->SetNumberOfPointIds(0);
  mark.Marks();
}
