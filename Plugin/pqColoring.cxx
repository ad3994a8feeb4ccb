// SPDX-License-Identifier: BSD-3-Clause
#include "pqColoring.h"

#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "vtkDataObject.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSettings.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionProxy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace
{
/// Free points, and eight handles that are told apart by color-blind people too (Okabe and
/// Ito's colors).
constexpr const char* HandleColors = R"({
  "array_lookup_tables": { "Handle": { "PVLookupTable": {
    "IndexedLookup": 1,
    "Annotations": ["0", "free", "1", "1", "2", "2", "3", "3", "4", "4", "5", "5", "6", "6",
      "7", "7"],
    "IndexedColors": [0.8, 0.8, 0.8, 0.0, 0.447, 0.698, 0.902, 0.624, 0.0, 0.0, 0.62, 0.451,
      0.8, 0.475, 0.655, 0.337, 0.706, 0.914, 0.835, 0.369, 0.0, 0.941, 0.894, 0.259]
  } } } })";

/// Below the user's own settings and the site's.
constexpr double Priority = 0.0;

struct Diverging
{
  const char* Array;
  double Center;
  double Largest;     // distance from the center; 0: as given by Spread
  const char* Spread; // the property that reports the root mean square
};

constexpr std::array<Diverging, 6> DivergingArrays{ {
  { "AreaRatio", 1.0, 1.0, nullptr },
  { "EdgeLengthRatio", 1.0, 1.0, nullptr },
  { "LocalVolumeRatio", 1.0, 1.0, nullptr },
  { "ScaleFactor", 1.0, 1.0, nullptr },
  { "MeanCurvatureError", 0.0, 0.0, "MeanCurvatureErrorRMS" },
  { "GaussianCurvatureError", 0.0, 0.0, "GaussianCurvatureErrorRMS" },
} };

/// Three standard deviations: single points do not wash out the colors of the others.
constexpr double SpreadsInRange = 3.0;

/// How far the colors go on both sides of the center; 0 if all values are there.
double Reach(const Diverging& diverging, const double range[2], vtkSMProxy* filter)
{
  const double largest =
    std::max(std::abs(range[0] - diverging.Center), std::abs(range[1] - diverging.Center));
  const double limit = diverging.Spread && filter->GetProperty(diverging.Spread)
    ? SpreadsInRange * vtkSMPropertyHelper(filter, diverging.Spread).GetAsDouble()
    : diverging.Largest;
  return limit > 0.0 ? std::min(largest, limit) : largest;
}

void Center(pqOutputPort* port, pqDataRepresentation* representation)
{
  vtkSMPropertyHelper coloring(representation->getProxy(), "ColorArrayName");
  const char* name = coloring.GetInputArrayNameToProcess();
  const auto* diverging = std::find_if(DivergingArrays.begin(), DivergingArrays.end(),
    [&](const Diverging& entry) { return name && std::string(entry.Array) == name; });
  vtkSMProxy* map = vtkSMPropertyHelper(representation->getProxy(), "LookupTable").GetAsProxy();
  if (diverging == DivergingArrays.end() || !map)
  {
    return;
  }
  vtkSMPropertyHelper mode(map, "AutomaticRescaleRangeMode");
  constexpr int never = -1;
  vtkPVArrayInformation* array =
    port->getDataInformation()->GetArrayInformation(name, coloring.GetInputArrayAssociation());
  if (mode.GetAsInt() == never || !array)
  {
    return;
  }
  const double reach =
    Reach(*diverging, array->GetComponentRange(0), port->getSource()->getProxy());
  if (reach > 0.0 && std::isfinite(reach))
  {
    vtkSMTransferFunctionProxy::RescaleTransferFunction(
      map, diverging->Center - reach, diverging->Center + reach);
    mode.Set(never);
    map->UpdateVTKObjects();
    representation->renderViewEventually();
  }
}
}

void RegisterHandleColors()
{
  vtkSMSettings::GetInstance()->AddCollectionFromString(HandleColors, Priority);
}

bool ColorByHandle(pqPipelineSource* source)
{
  bool isShown = false;
  for (pqView* view : source->getViews())
  {
    for (pqDataRepresentation* representation : source->getRepresentations(view))
    {
      const std::string name =
        vtkSMPropertyHelper(source->getProxy(), "HandleArrayName").GetAsString();
      vtkSMPVRepresentationProxy::SetScalarColoring(
        representation->getProxy(), name.c_str(), vtkDataObject::POINT);
      representation->getProxy()->UpdateVTKObjects();
      representation->renderViewEventually();
      isShown = true;
    }
  }
  return isShown;
}

void CenterColors(pqPipelineSource* source)
{
  for (pqOutputPort* port : source->getOutputPorts())
  {
    for (pqDataRepresentation* representation : port->getRepresentations(nullptr))
    {
      if (representation->getProxy()->GetProperty("ColorArrayName"))
      {
        Center(port, representation);
      }
    }
  }
}
