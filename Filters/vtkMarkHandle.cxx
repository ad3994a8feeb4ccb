// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMarkHandle.h"

#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/InputPreparation.h"
#include "Bridge/JoinedCopies.h"
#include "Bridge/MarkedPoints.h"
#include "Bridge/PieceRegions.h"
#include "Bridge/SelectionReader.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkExtractSelection.h"
#include "vtkIdTypeArray.h"
#include "vtkImplicitFunction.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSelection.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <vector>

vtkStandardNewMacro(vtkMarkHandle);

namespace
{
constexpr int MostMarkedIds = 100000000;

// Points without a comparable value (NaN coordinates) are on neither side.
void AddInside(
  vtkPolyData* input, vtkImplicitFunction* function, bool insideOut, cartan::PointMask& mask)
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

// Returns what is odd about the surface that the region grows over, and the
// surface, null if it was not needed.
std::shared_ptr<const cartan::Surface> Grow(vtkPolyData* input, int rings, double distance,
  cartan::PointMask& mask, const cartan::ExecutionContext& context)
{
  if ((rings == 0 && distance == 0.0) || std::count(mask.begin(), mask.end(), 1) == 0)
  {
    return nullptr;
  }
  const auto surface = cartan::ReadSurface(input, "input", context.Part(0.0, 0.3));
  cartan::GrowOverCopies(input, *surface, rings, distance, mask, context.Part(0.3, 1.0));
  return surface;
}

// The same over the prepared surface. Points that were merged or cut are marked
// together.
template <typename Growing>
std::shared_ptr<const cartan::Surface> GrowPrepared(
  vtkPolyData* input, cartan::PointMask& mask, const Growing& grow)
{
  const auto preparation = cartan::PrepareInput(input, "input", {});
  const cartan::RepairedSurface& repaired = preparation->Repaired;
  const auto become = [&](std::size_t v) { return repaired.PreparedPoints[v]; };
  cartan::PointMask prepared(repaired.OriginalPoints.size(), 0);
  for (std::size_t v = 0; v < mask.size(); ++v)
  {
    if (mask[v] && become(v) >= 0)
    {
      prepared[become(v)] = 1;
    }
  }
  for (std::size_t v = 0; v < prepared.size(); ++v)
  {
    prepared[v] |= mask[repaired.OriginalPoints[v]];
  }
  const auto surface = grow(cartan::ApplyPreparation(*preparation, input), prepared);
  for (std::size_t v = 0; v < mask.size(); ++v)
  {
    mask[v] |= become(v) >= 0 && prepared[become(v)];
  }
  for (std::size_t v = 0; v < prepared.size(); ++v)
  {
    mask[repaired.OriginalPoints[v]] |= prepared[v];
  }
  return surface;
}
}

// A polydata and its counterparts in the other data objects.
struct vtkMarkHandle::Block
{
  vtkPolyData* Input = nullptr;
  vtkPolyData* Evaluated = nullptr; // null: nothing is selected in this block
  vtkSmartPointer<vtkPolyData> Output;
  vtkIdType FirstPoint = 0; // its number, counted on from the block before
};

// Makes `output` have the structure of `input`, and pairs their blocks.
std::vector<vtkMarkHandle::Block> vtkMarkHandle::MakeBlocks(
  vtkDataObject* input, vtkDataObject* evaluated, vtkDataObject* output)
{
  if (auto* surface = vtkPolyData::SafeDownCast(input))
  {
    return { { surface, vtkPolyData::SafeDownCast(evaluated), vtkPolyData::SafeDownCast(output),
      0 } };
  }
  std::vector<Block> blocks;
  vtkIdType numberOfPoints = 0;
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
    block.FirstPoint = numberOfPoints;
    numberOfPoints += surface->GetNumberOfPoints();
    blocks.push_back(block);
  }
  return blocks;
}

vtkMarkHandle::vtkMarkHandle()
  : MarkedPointIds(vtkSmartPointer<vtkIdTypeArray>::New())
{
  this->SetNumberOfInputPorts(2);
}

vtkMarkHandle::~vtkMarkHandle() = default;

void vtkMarkHandle::SetSelectionConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkMarkHandle::SetSelectionData(vtkSelection* selection)
{
  this->SetInputData(1, selection);
}

void vtkMarkHandle::SetRegion(vtkImplicitFunction* region)
{
  if (this->Region != region)
  {
    this->Region = region;
    this->Modified();
  }
}

vtkImplicitFunction* vtkMarkHandle::GetRegion()
{
  return this->Region;
}

void vtkMarkHandle::SetSelectionExtractor(vtkExtractSelection* extractor)
{
  if (this->SelectionExtractor != extractor)
  {
    this->SelectionExtractor = extractor;
    this->Modified();
  }
}

vtkExtractSelection* vtkMarkHandle::GetSelectionExtractor()
{
  return this->SelectionExtractor;
}

void vtkMarkHandle::SetNumberOfPointIds(int count)
{
  if (count < 0 || count > MostMarkedIds)
  {
    vtkErrorMacro("There are 0 to " << MostMarkedIds << " PointIds; got " << count << ".");
    return;
  }
  if (count != this->GetNumberOfPointIds())
  {
    this->PointIds.resize(count, 0);
    this->Modified();
  }
}

void vtkMarkHandle::SetPointId(int index, vtkIdType id)
{
  if (index < 0 || index >= MostMarkedIds)
  {
    vtkErrorMacro(
      "PointIds are numbered from 0 to " << MostMarkedIds - 1 << "; got " << index << ".");
    return;
  }
  this->SetNumberOfPointIds(std::max(index + 1, this->GetNumberOfPointIds()));
  this->SetMember(this->PointIds[index], id);
}

vtkIdType vtkMarkHandle::GetPointId(int index) const
{
  return index >= 0 && index < this->GetNumberOfPointIds() ? this->PointIds[index] : -1;
}

vtkIdTypeArray* vtkMarkHandle::GetMarkedPointIds()
{
  this->MarkedPointIds->SetNumberOfTuples(0);
  for (const vtkIdType id :
    cartan::FindMarked(this->GetOutputDataObject(0), this->HandleArrayName, this->HandleId))
  {
    this->MarkedPointIds->InsertNextValue(id);
  }
  return this->MarkedPointIds;
}

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

vtkMTimeType vtkMarkHandle::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Region ? std::max(own, this->Region->GetMTime()) : own;
}

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

int vtkMarkHandle::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

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

void vtkMarkHandle::MarkBlock(
  const Block& block, cartan::FilterRun& run, const cartan::ExecutionContext& context)
{
  cartan::PointMask mask(block.Input->GetNumberOfPoints(), this->RegionSource == ALL_POINTS);
  const bool usesFunction =
    this->Region && (this->RegionSource == FUNCTION || this->RegionSource == FUNCTION_OR_SELECTION);
  if (usesFunction && !mask.empty())
  {
    AddInside(block.Input, this->Region, this->InsideOut, mask);
  }
  if (block.Evaluated)
  {
    cartan::AddSelected(block.Evaluated, block.Input, mask);
  }
  if (this->UsesSelection())
  {
    cartan::AddPointIds(this->PointIds, block.FirstPoint, mask);
  }
  context.Report(0.2);
  if (run.Pieces())
  {
    cartan::GrowOverPieces(run, this->GrowRings, mask);
    this->WriteMarks(block, mask);
    return;
  }
  const auto grow = [&](vtkPolyData* input, cartan::PointMask& grown)
  { return Grow(input, this->GrowRings, this->GrowDistance, grown, context.Part(0.2, 0.9)); };
  if (const auto surface =
        this->GetPrepareInput() ? GrowPrepared(block.Input, mask, grow) : grow(block.Input, mask))
  {
    run.Warn(surface->Describe("input", block.Input));
    run.KeepSurface(surface);
  }
  this->WriteMarks(block, mask);
  context.Report(1.0);
}

void vtkMarkHandle::WriteMarks(const Block& block, const std::vector<unsigned char>& mask)
{
  auto handles = cartan::CopyHandles(block.Input, this->HandleArrayName);
  this->NumberOfMarkedPoints += cartan::Mark(handles, mask, this->HandleId, this->Overwrite);
  block.Output->ShallowCopy(block.Input);
  block.Output->GetPointData()->AddArray(handles);
  if (!block.Output->GetPointData()->GetScalars())
  {
    block.Output->GetPointData()->SetActiveScalars(this->HandleArrayName.c_str());
  }
  cartan::ShareKeys(block.Input, block.Output);
}

// Ids and selections are of the whole, distances go over the whole.
bool vtkMarkHandle::SupportsPieces() const
{
  auto* self = const_cast<vtkMarkHandle*>(this); // what is connected is no state of this class
  const bool hasSelection = self->GetNumberOfInputConnections(1) > 0 || !this->PointIds.empty();
  return this->GrowDistance == 0.0 && !(this->UsesSelection() && hasSelection) &&
    vtkPolyData::SafeDownCast(self->GetInputDataObject(0, 0)) != nullptr;
}

void vtkMarkHandle::Execute(cartan::FilterRun& run)
{
  if (this->HandleArrayName.empty())
  {
    throw cartan::Error(
      cartan::ErrorCode::BadInput, "HandleArrayName is empty; give the point array a name.");
  }
  vtkDataObject* input = run.InputObject();
  vtkSelection* selection = vtkSelection::SafeDownCast(run.InputObject(1));
  vtkSmartPointer<vtkDataObject> evaluated;
  if (selection && selection->GetNumberOfNodes() > 0 && this->UsesSelection())
  {
    if (input != this->GetInputDataObject(0, 0) && cartan::IsOfRanks(selection))
    {
      throw cartan::Error(cartan::ErrorCode::BadInput,
        "The selection names points of the pieces on each rank, and the pieces are gathered: mark "
        "by a region function or by PointIds instead.");
    }
    evaluated = cartan::EvaluateSelection(input, selection, this->SelectionExtractor, this);
  }
  const std::vector<Block> blocks = MakeBlocks(input, evaluated, run.OutputObject());
  if (this->UsesSelection() && !blocks.empty())
  {
    cartan::RequirePointIds(
      this->PointIds, blocks.back().FirstPoint + blocks.back().Input->GetNumberOfPoints());
  }
  for (std::size_t b = 0; b < blocks.size(); ++b)
  {
    const double count = static_cast<double>(blocks.size());
    this->MarkBlock(blocks[b], run, run.Context().Part(b / count, (b + 1.0) / count));
  }
  const bool hasMarked = this->NumberOfMarkedPoints > 0;
  if (!(run.Pieces() ? run.Pieces()->Any(hasMarked) : hasMarked))
  {
    run.Warn(this->DescribeEmptyRegion(selection || !this->PointIds.empty()));
  }
}

std::string vtkMarkHandle::DescribeEmptyRegion(bool hasSelection)
{
  const std::string text = "No point is marked for handle " + std::to_string(this->HandleId) + ": ";
  if (this->RegionSource == FUNCTION && !this->Region)
  {
    return text + "RegionSource is Function, but there is no region function.";
  }
  if (this->RegionSource == SELECTION && !hasSelection)
  {
    return text +
      "RegionSource is Selection, but there is neither a selection on port 1 nor PointIds.";
  }
  if (this->RegionSource == FUNCTION_OR_SELECTION && !this->Region && !hasSelection)
  {
    return text + "there is neither a region function nor a selection on port 1 nor PointIds.";
  }
  return text +
    (this->Overwrite ? "the region has no points."
                     : "the region has no points that are free, and Overwrite is off.");
}

void vtkMarkHandle::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "HandleId: " << this->HandleId << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "RegionSource: " << this->GetRegionSourceAsString() << "\n";
  os << indent << "InsideOut: " << this->InsideOut << "\n";
  os << indent << "PointIds: " << this->PointIds.size() << "\n";
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
