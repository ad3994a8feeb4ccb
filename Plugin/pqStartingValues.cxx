// SPDX-License-Identifier: BSD-3-Clause
#include "pqStartingValues.h"

#include "pqChangePipelineInputReaction.h"
#include "pqHandleMotions.h"
#include "pqOutputPort.h"
#include "pqPVApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqSelectionManager.h"
#include "pqServerManagerModel.h"
#include "vtkBoundingBox.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSmartPointer.h"

#include <QTimer>

#include <algorithm>
#include <cstring>

namespace
{
/// What Mark Handle starts with: a tenth of the surface's longest side.
constexpr double RegionShare = 0.1;

/// A region begins this much outside of the surface, relative to its size, so that the
/// points on the bounding box are inside.
constexpr double RegionMargin = 0.01;

vtkSMSourceProxy* InputOf(vtkSMProxy* filter)
{
  return vtkSMSourceProxy::SafeDownCast(vtkSMPropertyHelper(filter, "Input").GetAsProxy());
}

vtkPVDataInformation* InputData(vtkSMProxy* filter)
{
  vtkSMSourceProxy* input = InputOf(filter);
  return input ? input->GetDataInformation(vtkSMPropertyHelper(filter, "Input").GetOutputPort())
               : nullptr;
}

/// The largest id in the array of handles of the input; 0 without one.
int LargestHandle(vtkSMProxy* filter)
{
  vtkPVDataInformation* data = InputData(filter);
  vtkPVArrayInformation* handles = data
    ? data->GetPointDataInformation()->GetArrayInformation(
        vtkSMPropertyHelper(filter, "HandleArrayName").GetAsString())
    : nullptr;
  return handles ? std::max(static_cast<int>(handles->GetComponentRange(0)[1]), 0) : 0;
}

/// The handle of the nearest Mark Handle upstream; 0 if there is none.
int LastMarkedHandle(vtkSMProxy* filter)
{
  for (vtkSMProxy* source = InputOf(filter); source;
       source = source->GetProperty("Input") ? InputOf(source) : nullptr)
  {
    const int id = std::strcmp(source->GetXMLName(), "MarkHandle") == 0
      ? vtkSMPropertyHelper(source, "HandleId").GetAsInt()
      : 0;
    if (id > 0)
    {
      return id;
    }
  }
  return 0;
}

/// Handles with odd ids start at the lower end of the surface's longest side, those with
/// even ids at the upper end: one to keep, one to move.
void PlaceRegion(vtkSMProxy* box, const vtkBoundingBox& surface, int id)
{
  double low[3];
  double lengths[3];
  surface.GetMinPoint(low);
  surface.GetLengths(lengths);
  const auto longest = std::max_element(lengths, lengths + 3) - lengths;
  const bool isUpper = id % 2 == 0;
  const double margin = RegionMargin * lengths[longest];
  for (int axis = 0; axis < 3; ++axis)
  {
    const double share = axis == longest ? RegionShare : 1.0;
    low[axis] += isUpper ? (1.0 - share) * lengths[axis] : 0.0;
    low[axis] -= axis == longest && isUpper ? 0.0 : margin;
    lengths[axis] = share * lengths[axis] + (axis == longest ? margin : 2.0 * margin);
  }
  vtkSMPropertyHelper(box, "Position").Set(low, 3);
  vtkSMPropertyHelper(box, "Length").Set(lengths, 3);
  box->UpdateVTKObjects();
}

/// A Mark Handle filter that nobody sees evaluates the selection, on the server, as the
/// filter itself would.
std::vector<vtkIdType> PointsSelectedIn(vtkSMSourceProxy* source, unsigned int port)
{
  vtkSMSourceProxy* selection = source ? source->GetSelectionInput(port) : nullptr;
  if (!selection)
  {
    return {};
  }
  vtkSmartPointer<vtkSMProxy> proxy;
  proxy.TakeReference(selection->GetSessionProxyManager()->NewProxy("filters", "MarkHandle"));
  auto* marking = vtkSMSourceProxy::SafeDownCast(proxy);
  vtkSMPropertyHelper(marking, "Input").Set(source, port);
  vtkSMPropertyHelper(marking, "Selection").Set(selection, source->GetSelectionInputPort(port));
  vtkSMPropertyHelper(marking, "RegionSource").Set("Selection");
  vtkSMPropertyHelper(marking, "HandleArrayName").Set("CartanSelected");
  marking->UpdateVTKObjects();
  marking->UpdatePipeline();
  marking->UpdatePropertyInformation();
  return vtkSMPropertyHelper(marking, "MarkedPointIds").GetIdTypeArray();
}

void StartMarkHandle(vtkSMProxy* filter)
{
  const int id = LargestHandle(filter) + 1;
  vtkSMPropertyHelper(filter, "HandleId").Set(id);
  const std::vector<vtkIdType> selected = SelectedPointIds(filter);
  vtkSMProxy* box = OfferedProxy(filter, "Region", "Box");
  vtkPVDataInformation* data = InputData(filter);
  if (!selected.empty())
  {
    vtkSMPropertyHelper(filter, "PointIds")
      .Set(selected.data(), static_cast<unsigned int>(selected.size()));
  }
  else if (box && data && vtkBoundingBox(data->GetBounds()).IsValid())
  {
    PlaceRegion(box, vtkBoundingBox(data->GetBounds()), id);
    vtkSMPropertyHelper(filter, "Region").Set(box);
  }
}

void StartActiveHandle(vtkSMProxy* filter)
{
  const int marked = LastMarkedHandle(filter);
  const int id = marked > 0 ? marked : LargestHandle(filter);
  if (id > 0)
  {
    vtkSMPropertyHelper(filter, "ActiveHandle").Set(id);
  }
}

/// The motion by axis and angle, which XML chooses at first, turns about the handle's
/// center.
void StartCenter(vtkSMProxy* filter)
{
  const std::vector<double> bounds =
    vtkSMPropertyHelper(filter, "ActiveHandleBounds").GetDoubleArray();
  vtkSMProxy* turn = OfferedProxy(filter, "Motion", "Axis and Angle");
  if (turn && bounds.size() == 6 && bounds[0] <= bounds[1])
  {
    const double center[3] = { 0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3]),
      0.5 * (bounds[4] + bounds[5]) };
    vtkSMPropertyHelper(turn, "Center").Set(center, 3);
    turn->UpdateVTKObjects();
  }
}

void StartBox(vtkSMProxy* filter)
{
  if (vtkSMProxy* box = OfferedProxy(filter, "Motion", "Box"))
  {
    vtkSMPropertyHelper(filter, "Motion").Set(box);
  }
}

/// What a measure compares with at first: the nearest Mark Handle upstream, where the
/// surface is before it moves, or else the input of the nearest deformation or morph.
vtkSMSourceProxy* NearestRest(vtkSMProxy* measure)
{
  vtkSMSourceProxy* before = nullptr;
  for (vtkSMSourceProxy* source = InputOf(measure); source && source->GetProperty("Input");
       source = InputOf(source))
  {
    if (std::strcmp(source->GetXMLName(), "MarkHandle") == 0)
    {
      return source == InputOf(measure) ? nullptr : source;
    }
    const bool moves =
      source->GetProperty("ActiveHandle") || std::strcmp(source->GetXMLName(), "SurfaceMorph") == 0;
    before = moves && !before ? InputOf(source) : before;
  }
  return before;
}

void StartReference(vtkSMProxy* filter)
{
  if (vtkSMSourceProxy* rest = NearestRest(filter))
  {
    vtkSMPropertyHelper(filter, "Reference").Set(rest, 0);
  }
}

/// Lets a trace record what `start` changes.
void StartTraced(vtkSMProxy* filter, void (*start)(vtkSMProxy*))
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", filter);
  start(filter);
  filter->UpdateVTKObjects();
}

/// Applies what has just been made, unless other filters wait for Apply as well.
void ApplyAlone()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  int waiting = 0;
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    waiting += source->modifiedState() != pqProxy::UNMODIFIED ? 1 : 0;
  }
  if (waiting == 1)
  {
    pqPVApplicationCore::instance()->applyPipeline();
  }
}
}

void SetStartingValues(pqPipelineSource* source)
{
  vtkSMProxy* filter = source->getProxy();
  if (filter->GetProperty("PointIds"))
  {
    StartTraced(filter, StartMarkHandle);
    // The view shows at once what the region catches.
    QTimer::singleShot(0, source, &ApplyAlone);
  }
  else if (filter->GetProperty("ActiveHandle"))
  {
    StartTraced(filter, StartActiveHandle);
    // The bounds of the box follow by a link. A trace would record that too, and its
    // script could not set what filters report.
    filter->UpdatePropertyInformation();
    // One by one: a trace records what changes in the motion that is chosen.
    StartTraced(filter, StartCenter);
    StartTraced(filter, StartBox);
  }
  else if (filter->GetProperty("Reference"))
  {
    StartTraced(filter, StartReference);
    const bool needsReference = std::strcmp(filter->GetXMLName(), "VolumeChange") == 0;
    if (needsReference && !vtkSMPropertyHelper(filter, "Reference").GetAsProxy())
    {
      QTimer::singleShot(0, source, &pqChangePipelineInputReaction::changeInput);
    }
  }
}

std::vector<vtkIdType> SelectedPointIds(vtkSMProxy* filter)
{
  auto* application = pqPVApplicationCore::instance();
  auto* manager = application ? application->selectionManager() : nullptr;
  pqOutputPort* active = manager ? manager->getSelectedPort() : nullptr;
  if (active && active->getSelectionInput())
  {
    return PointsSelectedIn(active->getSourceProxy(), active->getPortNumber());
  }
  return PointsSelectedIn(InputOf(filter), vtkSMPropertyHelper(filter, "Input").GetOutputPort());
}
