// SPDX-License-Identifier: BSD-3-Clause
#include "pqHandleLabels.h"

#include "pqHandleMotions.h"
#include "pqRenderView.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkCoordinate.h"
#include "vtkPVRenderView.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMUncheckedPropertyHelper.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"

#include <QTimer>

#include <algorithm>
#include <cmath>
#include <string>

namespace
{
constexpr int FontSize = 14;   // points
constexpr double Reach = 1.25; // of a click, relative to the height of the digits

/// Above widgets (0.5) and the view's interaction (0).
constexpr float Priority = 0.75f;

vtkSmartPointer<vtkTextActor> NewLabel(int id)
{
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput((" " + std::to_string(id) + " ").c_str());
  actor->GetPositionCoordinate()->SetCoordinateSystemToWorld();
  vtkTextProperty* style = actor->GetTextProperty();
  style->SetFontSize(FontSize);
  style->BoldOn();
  style->SetJustificationToCentered();
  style->SetVerticalJustificationToCentered();
  style->SetBackgroundOpacity(1.0);
  style->FrameOn();
  return actor;
}

void Highlight(vtkTextProperty* style, bool isActive)
{
  const double ink = isActive ? 0.0 : 1.0;
  style->SetColor(ink, ink, ink);
  style->SetFrameColor(ink, ink, ink);
  if (isActive)
  {
    style->SetBackgroundColor(1.0, 0.85, 0.2);
  }
  else
  {
    style->SetBackgroundColor(0.25, 0.25, 0.3);
  }
}

/// Perspective would mirror what is behind the camera into the picture.
bool IsInFront(vtkCamera* camera, const std::array<double, 3>& place)
{
  const double* eye = camera->GetPosition();
  const double* ahead = camera->GetDirectionOfProjection();
  double along = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    along += ahead[i] * (place[i] - eye[i]);
  }
  return along > 0.0;
}
}

pqHandleLabels::pqHandleLabels(vtkSMProxy* filter, QObject* parent)
  : QObject(parent)
  , Filter(filter)
{
}

pqHandleLabels::~pqHandleLabels()
{
  this->setView(nullptr);
}

void pqHandleLabels::setView(pqView* view)
{
  if (view == this->View && (view != nullptr) == (this->Renderer != nullptr))
  {
    return;
  }
  this->hide();
  this->View = qobject_cast<pqRenderView*>(view);
  this->show();
}

void pqHandleLabels::setHandles(const std::vector<int>& ids)
{
  const std::size_t count = std::min(ids.size(), Most);
  const auto isLabel = [](const Label& label, int id) { return label.Id == id; };
  if (std::equal(
        this->Labels.begin(), this->Labels.end(), ids.begin(), ids.begin() + count, isLabel))
  {
    return;
  }
  this->hide();
  this->Labels.clear();
  for (std::size_t i = 0; i < count; ++i)
  {
    this->Labels.push_back({ ids[i], NewLabel(ids[i]) });
  }
  this->show();
}

void pqHandleLabels::show()
{
  auto* proxy = this->View ? vtkSMRenderViewProxy::SafeDownCast(this->View->getProxy()) : nullptr;
  auto* view = proxy ? vtkPVRenderView::SafeDownCast(proxy->GetClientSideView()) : nullptr;
  if (!view || !proxy->GetInteractor() || this->Labels.empty())
  {
    return;
  }
  this->Renderer = view->GetNonCompositedRenderer();
  this->Interactor = proxy->GetInteractor();
  for (const Label& label : this->Labels)
  {
    this->Renderer->AddActor2D(label.Actor);
  }
  this->OnTop = 0;
  this->PlaceObserver =
    this->Renderer->AddObserver(vtkCommand::StartEvent, this, &pqHandleLabels::place);
  this->PressObserver = this->Interactor->AddObserver(
    vtkCommand::LeftButtonPressEvent, this, &pqHandleLabels::press, Priority);
  this->View->render();
}

void pqHandleLabels::hide()
{
  if (this->Renderer)
  {
    for (const Label& label : this->Labels)
    {
      this->Renderer->RemoveActor2D(label.Actor);
    }
    this->Renderer->RemoveObserver(this->PlaceObserver);
    this->Renderer = nullptr;
  }
  if (this->Interactor)
  {
    this->Interactor->RemoveObserver(this->PressObserver);
    this->Interactor = nullptr;
  }
  if (this->View)
  {
    this->View->render();
  }
}

void pqHandleLabels::place()
{
  if (!this->Filter)
  {
    return;
  }
  const int active = this->active();
  const std::map<int, std::array<double, 3>> places = HandlePlaces(this->Filter, Most);
  for (const Label& label : this->Labels)
  {
    const auto found = places.find(label.Id);
    const bool isShown =
      found != places.end() && IsInFront(this->Renderer->GetActiveCamera(), found->second);
    label.Actor->SetVisibility(isShown);
    if (isShown)
    {
      const std::array<double, 3>& place = found->second;
      label.Actor->GetPositionCoordinate()->SetValue(place[0], place[1], place[2]);
    }
    Highlight(label.Actor->GetTextProperty(), label.Id == active);
    if (label.Id == active && this->OnTop != active)
    {
      this->Renderer->RemoveActor2D(label.Actor);
      this->Renderer->AddActor2D(label.Actor);
      this->OnTop = active;
    }
  }
}

bool pqHandleLabels::press(vtkObject*, unsigned long, void*)
{
  if (!this->Filter || !this->Renderer || !this->isPlainPress())
  {
    return false;
  }
  const int active = this->active();
  int hit = active;
  for (const Label& label : this->Labels)
  {
    if (this->isUnderMouse(label))
    {
      hit = label.Id;
      if (hit == active)
      {
        break;
      }
    }
  }
  if (hit == active)
  {
    return false;
  }
  // Later: another handle makes widgets anew, those that wait for this event too.
  QTimer::singleShot(0, this, [this, hit] { Q_EMIT this->clicked(hit); });
  return true;
}

bool pqHandleLabels::isPlainPress() const
{
  const int mode = vtkSMPropertyHelper(this->View->getProxy(), "InteractionMode").GetAsInt();
  const bool moves =
    mode == vtkPVRenderView::INTERACTION_MODE_3D || mode == vtkPVRenderView::INTERACTION_MODE_2D;
  return moves && !this->Interactor->GetShiftKey() && !this->Interactor->GetControlKey();
}

int pqHandleLabels::active() const
{
  return vtkSMUncheckedPropertyHelper(this->Filter, "ActiveHandle").GetAsInt();
}

bool pqHandleLabels::isUnderMouse(const Label& label) const
{
  const int* mouse = this->Interactor->GetEventPosition();
  const int* center = label.Actor->GetPositionCoordinate()->GetComputedDisplayValue(this->Renderer);
  double size[2];
  label.Actor->GetSize(this->Renderer, size);
  return label.Actor->GetVisibility() &&
    2.0 * std::abs(mouse[0] - center[0]) <= std::max(size[0], Reach * size[1]) &&
    2.0 * std::abs(mouse[1] - center[1]) <= Reach * size[1];
}
