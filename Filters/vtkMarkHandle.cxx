// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMarkHandle.h"

#include "Kernel/Mesh/GeodesicDistance.h"
#include "KernelBridge.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkExtractSelection.h"
#include "vtkIdList.h"
#include "vtkImplicitFunction.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

vtkStandardNewMacro(vtkMarkHandle);

namespace
{
// What vtkExtractSelection calls its result.
constexpr const char* InsidednessName = "vtkInsidedness";

// Whether a point is in the region, per point.
using PointMask = std::vector<unsigned char>;

// Catches what the extractor and its executive would print, so that the user
// sees one message, from this filter.
class MessageCatcher : public vtkCommand
{
public:
  static MessageCatcher* New() { return new MessageCatcher; }

  void Execute(vtkObject*, unsigned long, void* message) override
  {
    if (!this->First.empty() || !message)
    {
      return;
    }
    // "ERROR: In file, line\nvtkClass (0x...): what we want\n\n"
    std::string text = static_cast<const char*>(message);
    const std::size_t start = text.find("): ");
    text = start == std::string::npos ? text : text.substr(start + 3);
    this->First = text.substr(0, text.find_last_not_of(" \n") + 1);
  }

  std::string First;
};

// Why vtkExtractSelection could not evaluate a node, or nothing. It takes these
// for granted and crashes where they do not hold. A subclass may know more
// kinds of nodes, ParaView's does.
std::string DescribeProblem(vtkSelectionNode* node, vtkExtractSelection* kind)
{
  const int content = node->GetContentType();
  const bool isPlain = !kind || std::strcmp(kind->GetClassName(), "vtkExtractSelection") == 0;
  if (content < 0 ||
    (isPlain && (content == vtkSelectionNode::QUERY || content == vtkSelectionNode::USER)))
  {
    return "it is a query, or of a kind that vtkExtractSelection does not know. Select by ids, "
           "values, thresholds, locations or a frustum, or set ParaView's vtkPVExtractSelection "
           "with SetSelectionExtractor.";
  }
  const int field = node->GetFieldType();
  if (field != vtkSelectionNode::POINT && field != vtkSelectionNode::CELL)
  {
    return "it selects neither points nor cells.";
  }
  vtkAbstractArray* list = node->GetSelectionList();
  if (content == vtkSelectionNode::FRUSTUM && (!list || list->GetNumberOfValues() < 32))
  {
    return "its frustum is not given by 8 corners of 4 coordinates.";
  }
  if (content == vtkSelectionNode::BLOCKS && !list)
  {
    return "it selects blocks, but has no list of them.";
  }
  return {};
}

// The data with arrays that say which points or cells are selected; a block in
// which nothing is selected may be missing. Nothing of `input` or `selection`
// changes: vtkExtractSelection removes other ranks' nodes from what it is given.
vtkSmartPointer<vtkDataObject> EvaluateSelection(
  vtkDataObject* input, vtkSelection* selection, vtkExtractSelection* kind, vtkAlgorithm* filter)
{
  const std::string refusal = "The selection cannot be evaluated: ";
  vtkNew<vtkSelection> nodes;
  nodes->ShallowCopy(selection);
  for (unsigned int i = 0; i < nodes->GetNumberOfNodes(); ++i)
  {
    const std::string problem = DescribeProblem(nodes->GetNode(i), kind);
    if (!problem.empty())
    {
      throw cartan::Error(cartan::ErrorCode::BadInput, refusal + problem);
    }
  }
  auto extractor =
    kind ? vtk::TakeSmartPointer(kind->NewInstance()) : vtkSmartPointer<vtkExtractSelection>::New();
  vtkNew<MessageCatcher> catcher;
  for (const unsigned long event : { vtkCommand::ErrorEvent, vtkCommand::WarningEvent })
  {
    extractor->AddObserver(event, catcher);
    extractor->GetExecutive()->AddObserver(event, catcher);
  }
  extractor->PreserveTopologyOn();
  extractor->SetInputDataObject(0, input);
  extractor->SetInputDataObject(1, nodes);
  vtkInformation* request = filter->GetOutputInformation(0);
  const int piece = request->Get(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER());
  const int pieces = request->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES());
  extractor->UpdatePiece(std::max(piece, 0), std::max(pieces, 1), 0);
  if (!catcher->First.empty())
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      refusal + catcher->First + " Select either points or cells, and name arrays that exist.");
  }
  return extractor->GetOutputDataObject(0);
}

// The selection's verdict among the attributes of `evaluated`, or null. An
// array that `input` had before is not it.
vtkDataArray* FindInsidedness(
  vtkDataSetAttributes* evaluated, vtkDataSetAttributes* input, vtkIdType numberOfTuples)
{
  vtkDataArray* array = evaluated->GetArray(InsidednessName);
  const bool isNew = array && array != input->GetArray(InsidednessName);
  return isNew && array->GetNumberOfTuples() == numberOfTuples ? array : nullptr;
}

void AddSelected(vtkPolyData* evaluated, vtkPolyData* input, PointMask& mask)
{
  if (vtkDataArray* points = FindInsidedness(
        evaluated->GetPointData(), input->GetPointData(), input->GetNumberOfPoints()))
  {
    for (vtkIdType i = 0; i < points->GetNumberOfTuples(); ++i)
    {
      mask[i] |= points->GetComponent(i, 0) != 0.0;
    }
  }
  if (vtkDataArray* cells =
        FindInsidedness(evaluated->GetCellData(), input->GetCellData(), input->GetNumberOfCells()))
  {
    vtkNew<vtkIdList> corners;
    for (vtkIdType cell = 0; cell < cells->GetNumberOfTuples(); ++cell)
    {
      if (cells->GetComponent(cell, 0) != 0.0)
      {
        evaluated->GetCellPoints(cell, corners);
        for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
        {
          const vtkIdType corner = corners->GetId(i);
          if (corner >= 0 && corner < input->GetNumberOfPoints()) // broken cells have others
          {
            mask[corner] = 1;
          }
        }
      }
    }
  }
}

// Points without a comparable value (NaN coordinates) are on neither side.
void AddInside(vtkPolyData* input, vtkImplicitFunction* function, bool insideOut, PointMask& mask)
{
  vtkNew<vtkDoubleArray> values;
  values->SetNumberOfTuples(input->GetNumberOfPoints());
  function->FunctionValue(input->GetPoints()->GetData(), values);
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    const double value = values->GetValue(i);
    mask[i] |= insideOut ? value > 0.0 : value <= 0.0;
  }
}

std::vector<int> PointsIn(const PointMask& mask)
{
  std::vector<int> points;
  for (std::size_t i = 0; i < mask.size(); ++i)
  {
    if (mask[i])
    {
      points.push_back(static_cast<int>(i));
    }
  }
  return points;
}

// Adds the vertices that at most `rings` edges lead to from `front`.
void GrowByRings(
  const cartan::TriangleMesh& mesh, std::vector<int> front, int rings, PointMask& mask)
{
  PointMask isReached(mask.size(), 0);
  for (const int v : front)
  {
    isReached[v] = 1;
  }
  for (int ring = 0; ring < rings && !front.empty(); ++ring)
  {
    std::vector<int> next;
    for (const int v : front)
    {
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        const int w = mesh.Neighbor(d);
        if (!isReached[w])
        {
          isReached[w] = 1;
          next.push_back(w);
        }
      }
    }
    for (const int v : next)
    {
      mask[v] = 1;
    }
    front.swap(next);
  }
}

void GrowByDistance(const cartan::Surface& surface, const std::vector<int>& seeds, double distance,
  PointMask& mask, const cartan::ExecutionContext& context)
{
  const Eigen::VectorXd distances =
    cartan::GeodesicDistance(surface.Mesh, surface.Positions, seeds, distance, context);
  for (Eigen::Index v = 0; v < distances.size(); ++v)
  {
    mask[v] |= distances[v] <= distance;
  }
}

// Returns what is odd about the surface that the region grows over.
std::string Grow(vtkPolyData* input, int rings, double distance, PointMask& mask,
  const cartan::ExecutionContext& context)
{
  if ((rings == 0 && distance == 0.0) || std::count(mask.begin(), mask.end(), 1) == 0)
  {
    return {};
  }
  const cartan::Surface surface = cartan::ReadSurface(input);
  context.Report(0.3);
  const std::vector<int> seeds = PointsIn(mask);
  GrowByRings(surface.Mesh, seeds, rings, mask);
  if (distance > 0.0)
  {
    GrowByDistance(surface, seeds, distance, mask, context.Part(0.3, 1.0));
  }
  return surface.Warning;
}

// A new array with the handle ids that `input` has already; all free if it has
// no such array.
vtkSmartPointer<vtkIntArray> CopyHandles(vtkPolyData* input, const std::string& name)
{
  const vtkIdType count = input->GetNumberOfPoints();
  auto handles = vtkSmartPointer<vtkIntArray>::New();
  handles->SetName(name.c_str());
  handles->SetNumberOfTuples(count);
  handles->FillValue(0);
  vtkAbstractArray* existing = input->GetPointData()->GetAbstractArray(name.c_str());
  if (!existing)
  {
    return handles;
  }

  const std::string what = "The point array \"" + name + "\" of the input ";
  const std::string remedy = "; remove it or choose another HandleArrayName.";
  auto* ids = vtkDataArray::SafeDownCast(existing);
  if (!ids || ids->GetNumberOfComponents() != 1)
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      what + "is no list of handle ids: it has " +
        (ids ? std::to_string(ids->GetNumberOfComponents()) + " components instead of 1"
             : std::string("no numbers")) +
        remedy);
  }
  if (ids->GetNumberOfTuples() != count)
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      what + "has " + std::to_string(ids->GetNumberOfTuples()) + " values for " +
        std::to_string(count) + " points" + remedy);
  }
  cartan::IdSample bad;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double id = ids->GetComponent(i, 0);
    if (id >= 0.0 && id <= std::numeric_limits<int>::max() && id == std::floor(id))
    {
      handles->SetValue(i, static_cast<int>(id));
    }
    else
    {
      bad.Add(i);
    }
  }
  if (!bad.IsEmpty())
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      what + "is no list of handle ids: at " + bad.Describe("point", "points") +
        " it is no whole number >= 0" + remedy);
  }
  return handles;
}

// Gives the points in `mask` the id; returns how many of them have it then.
vtkIdType Mark(vtkIntArray* handles, const PointMask& mask, int id, bool overwrite)
{
  vtkIdType count = 0;
  for (vtkIdType i = 0; i < handles->GetNumberOfTuples(); ++i)
  {
    if (mask[i])
    {
      const int current = handles->GetValue(i);
      if (overwrite || current == 0)
      {
        handles->SetValue(i, id);
      }
      count += handles->GetValue(i) == id;
    }
  }
  return count;
}

// A polydata and its counterparts in the other data objects.
struct Block
{
  vtkPolyData* Input = nullptr;
  vtkPolyData* Evaluated = nullptr; // null: nothing is selected in this block
  vtkSmartPointer<vtkPolyData> Output;
};

// Makes `output` have the structure of `input`, and pairs their blocks.
std::vector<Block> MakeBlocks(vtkDataObject* input, vtkDataObject* evaluated, vtkDataObject* output)
{
  if (auto* surface = vtkPolyData::SafeDownCast(input))
  {
    return { { surface, vtkPolyData::SafeDownCast(evaluated), vtkPolyData::SafeDownCast(output) } };
  }
  std::vector<Block> blocks;
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  auto* evaluatedComposite = vtkCompositeDataSet::SafeDownCast(evaluated);
  auto* outputComposite = vtkCompositeDataSet::SafeDownCast(output);
  outputComposite->CopyStructure(composite);
  auto iterator = vtk::TakeSmartPointer(composite->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    auto* surface = vtkPolyData::SafeDownCast(iterator->GetCurrentDataObject());
    if (!surface)
    {
      throw cartan::Error(cartan::ErrorCode::BadInput,
        "Block " + std::to_string(iterator->GetCurrentFlatIndex()) + " of the input is a " +
          iterator->GetCurrentDataObject()->GetClassName() +
          ", not a surface; extract the surface blocks first.");
    }
    Block block;
    block.Input = surface;
    block.Evaluated = evaluatedComposite
      ? vtkPolyData::SafeDownCast(evaluatedComposite->GetDataSet(iterator))
      : nullptr;
    block.Output = vtkSmartPointer<vtkPolyData>::New();
    outputComposite->SetDataSet(iterator, block.Output);
    blocks.push_back(block);
  }
  return blocks;
}
}

//------------------------------------------------------------------------------
vtkMarkHandle::vtkMarkHandle()
{
  this->SetNumberOfInputPorts(2);
}

//------------------------------------------------------------------------------
vtkMarkHandle::~vtkMarkHandle() = default;

//------------------------------------------------------------------------------
void vtkMarkHandle::SetSelectionConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

//------------------------------------------------------------------------------
void vtkMarkHandle::SetSelectionData(vtkSelection* selection)
{
  this->SetInputData(1, selection);
}

//------------------------------------------------------------------------------
void vtkMarkHandle::SetRegion(vtkImplicitFunction* region)
{
  if (this->Region != region)
  {
    this->Region = region;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkImplicitFunction* vtkMarkHandle::GetRegion()
{
  return this->Region;
}

//------------------------------------------------------------------------------
void vtkMarkHandle::SetSelectionExtractor(vtkExtractSelection* extractor)
{
  if (this->SelectionExtractor != extractor)
  {
    this->SelectionExtractor = extractor;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkExtractSelection* vtkMarkHandle::GetSelectionExtractor()
{
  return this->SelectionExtractor;
}

//------------------------------------------------------------------------------
const char* vtkMarkHandle::GetRegionSourceAsString()
{
  switch (this->RegionSource)
  {
    case FUNCTION:
      return "Function";
    case SELECTION:
      return "Selection";
    case ALL_POINTS:
      return "AllPoints";
    default:
      return "FunctionOrSelection";
  }
}

//------------------------------------------------------------------------------
vtkMTimeType vtkMarkHandle::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Region ? std::max(own, this->Region->GetMTime()) : own;
}

//------------------------------------------------------------------------------
// The executive would hand over composite data block by block, and a selection
// that names a block could not be told which one it sees. So they are taken as
// they are, and the output becomes what the input is.
int vtkMarkHandle::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkSelection");
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
    return 1;
  }
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkMarkHandle::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkMarkHandle::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->Superclass::ProcessRequest(request, inputVector, outputVector);
  }
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  if (!input)
  {
    return 0;
  }
  if (!output || output->GetDataObjectType() != input->GetDataObjectType())
  {
    auto fresh = vtk::TakeSmartPointer(input->NewInstance());
    outputVector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkMarkHandle::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkSelection* selection = vtkSelection::GetData(inputVector[1]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  this->NumberOfMarkedPoints = 0;
  return cartan::RunGuarded(this,
    [&]
    {
      if (this->HandleArrayName.empty())
      {
        throw cartan::Error(
          cartan::ErrorCode::BadInput, "HandleArrayName is empty; give the point array a name.");
      }
      const bool usesFunction = this->Region &&
        (this->RegionSource == FUNCTION || this->RegionSource == FUNCTION_OR_SELECTION);
      const bool usesSelection = selection && selection->GetNumberOfNodes() > 0 &&
        (this->RegionSource == SELECTION || this->RegionSource == FUNCTION_OR_SELECTION);

      vtkSmartPointer<vtkDataObject> evaluated;
      if (usesSelection)
      {
        evaluated = EvaluateSelection(input, selection, this->SelectionExtractor, this);
      }
      const std::vector<Block> blocks = MakeBlocks(input, evaluated, output);

      vtkIdType marked = 0;
      const cartan::ExecutionContext context = cartan::MakeContext(this);
      for (std::size_t b = 0; b < blocks.size(); ++b)
      {
        const Block& block = blocks[b];
        const cartan::ExecutionContext part =
          context.Part(static_cast<double>(b) / blocks.size(), (b + 1.0) / blocks.size());
        PointMask mask(block.Input->GetNumberOfPoints(), this->RegionSource == ALL_POINTS);
        if (usesFunction && !mask.empty())
        {
          AddInside(block.Input, this->Region, this->InsideOut, mask);
        }
        if (block.Evaluated)
        {
          AddSelected(block.Evaluated, block.Input, mask);
        }
        part.Report(0.2);
        cartan::Warn(
          this, Grow(block.Input, this->GrowRings, this->GrowDistance, mask, part.Part(0.2, 0.9)));

        auto handles = CopyHandles(block.Input, this->HandleArrayName);
        marked += Mark(handles, mask, this->HandleId, this->Overwrite);
        block.Output->ShallowCopy(block.Input);
        block.Output->GetPointData()->AddArray(handles);
        if (!block.Output->GetPointData()->GetScalars())
        {
          block.Output->GetPointData()->SetActiveScalars(this->HandleArrayName.c_str());
        }
        part.Report(1.0);
      }

      this->NumberOfMarkedPoints = marked;
      if (marked == 0)
      {
        cartan::Warn(this, this->DescribeEmptyRegion(selection != nullptr));
      }
    });
}

//------------------------------------------------------------------------------
std::string vtkMarkHandle::DescribeEmptyRegion(bool hasSelection)
{
  const std::string text = "No point is marked for handle " + std::to_string(this->HandleId) + ": ";
  if (this->RegionSource == FUNCTION && !this->Region)
  {
    return text + "RegionSource is Function, but there is no region function.";
  }
  if (this->RegionSource == SELECTION && !hasSelection)
  {
    return text + "RegionSource is Selection, but there is no selection on port 1.";
  }
  if (this->RegionSource == FUNCTION_OR_SELECTION && !this->Region && !hasSelection)
  {
    return text + "there is neither a region function nor a selection on port 1.";
  }
  return text +
    (this->Overwrite ? "the region has no points."
                     : "the region has no points that are free, and Overwrite is off.");
}

//------------------------------------------------------------------------------
void vtkMarkHandle::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "HandleId: " << this->HandleId << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "RegionSource: " << this->GetRegionSourceAsString() << "\n";
  os << indent << "InsideOut: " << this->InsideOut << "\n";
  os << indent << "GrowRings: " << this->GrowRings << "\n";
  os << indent << "GrowDistance: " << this->GrowDistance << "\n";
  os << indent << "Overwrite: " << this->Overwrite << "\n";
  os << indent << "NumberOfMarkedPoints: " << this->NumberOfMarkedPoints << "\n";
  os << indent << "SelectionExtractor: "
     << (this->SelectionExtractor ? this->SelectionExtractor->GetClassName() : "(none)") << "\n";
  os << indent << "Region: ";
  if (this->Region)
  {
    os << "\n";
    this->Region->PrintSelf(os, indent.GetNextIndent());
  }
  else
  {
    os << "(none)\n";
  }
}
