// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/SelectionReader.h"

#include "Kernel/Base/Error.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkExecutive.h"
#include "vtkExtractSelection.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace cartan
{
namespace
{
/// What vtkExtractSelection calls its result.
constexpr const char* InsidednessName = "vtkInsidedness";

/// Catches what the extractor and its executive would print, so that the user
/// sees one message, from this filter.
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
    /// "ERROR: In file, line\nvtkClass (0x...): what we want\n\n"
    std::string text = static_cast<const char*>(message);
    const std::size_t start = text.find("): ");
    text = start == std::string::npos ? text : text.substr(start + 3);
    this->First = text.substr(0, text.find_last_not_of(" \n") + 1);
  }

  std::string First;
};

/// Why vtkExtractSelection could not evaluate a node, or nothing. It takes these
/// for granted and crashes where they do not hold. A subclass may know more
/// kinds of nodes, ParaView's does.
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

/// The selection's verdict among the attributes of `evaluated`, or null. An
/// array that `input` had before is not it.
vtkDataArray* FindInsidedness(
  vtkDataSetAttributes* evaluated, vtkDataSetAttributes* input, vtkIdType numberOfTuples)
{
  vtkDataArray* array = evaluated->GetArray(InsidednessName);
  const bool isNew = array && array != input->GetArray(InsidednessName);
  return isNew && array->GetNumberOfTuples() == numberOfTuples ? array : nullptr;
}
}

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
      throw Error(ErrorCode::BadInput, refusal + problem);
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
    throw Error(ErrorCode::BadInput,
      refusal + catcher->First + " Select either points or cells, and name arrays that exist.");
  }
  return extractor->GetOutputDataObject(0);
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

bool IsOfRanks(vtkSelection* selection)
{
  for (unsigned int n = 0; n < selection->GetNumberOfNodes(); ++n)
  {
    vtkInformation* properties = selection->GetNode(n)->GetProperties();
    if (properties->Has(vtkSelectionNode::PROCESS_ID()) &&
      properties->Get(vtkSelectionNode::PROCESS_ID()) >= 0)
    {
      return true;
    }
  }
  return false;
}
}
