// SPDX-License-Identifier: BSD-3-Clause
#include "pqHandleBoxWidget.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqHandleMotions.h"
#include "pqPipelineSource.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMNewWidgetRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyListDomain.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"
#include "vtkSMViewProxy.h"

#include <QPushButton>

#include <utility>

namespace
{
/// The filter among whose motions this one is.
vtkSMProxy* FilterOf(vtkSMProxy* motion)
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* source : model->findItems<pqPipelineSource*>())
  {
    vtkSMProperty* property = source->getProxy()->GetProperty("Motion");
    auto* motions = property ? property->FindDomain<vtkSMProxyListDomain>() : nullptr;
    if (motions && motions->HasProxy(motion))
    {
      return source->getProxy();
    }
  }
  return nullptr;
}
}

pqHandleBoxWidget::pqHandleBoxWidget(vtkSMProxy* motion, vtkSMPropertyGroup* group, QWidget* parent)
  : Superclass(motion, group, parent, /*hideReferenceBounds=*/true)
{
  // Otherwise the box would start at the bounds of a data source.
  vtkSMPropertyHelper(this->widgetProxy(), "UseReferenceBounds").Set(1);
  this->widgetProxy()->UpdateVTKObjects();

  this->Filter = FilterOf(motion);
  if (this->Filter)
  {
    for (const auto& [name, event] : { std::make_pair("ActiveHandle", vtkCommand::ModifiedEvent),
           std::make_pair("ActiveHandle", vtkCommand::UncheckedPropertyModifiedEvent),
           std::make_pair("HandleBounds", vtkCommand::ModifiedEvent) })
    {
      pqCoreUtilities::connect(
        this->Filter->GetProperty(name), event, this, SLOT(surroundHandle()));
    }
    this->surroundHandle();
  }

  // The base resets to the bounds of a data source.
  if (auto* reset = this->findChild<QPushButton*>("resetBounds"))
  {
    QObject::disconnect(reset, &QPushButton::clicked, nullptr, nullptr);
    QObject::connect(reset, &QPushButton::clicked, this, &pqHandleBoxWidget::putBack);
    reset->setText(tr("Put Handle Back"));
    reset->setToolTip(tr("Moves the handle back to its place in the input."));
  }

  // Later, because the properties learn only after the signals where the box is; and once
  // for all moves that have come meanwhile.
  this->Follow.setSingleShot(true);
  QObject::connect(&this->Follow, &QTimer::timeout, this, &pqHandleBoxWidget::follow);
  QObject::connect(this, &pqHandleBoxWidget::startInteraction, this, &pqHandleBoxWidget::startDrag);
  QObject::connect(this, &pqHandleBoxWidget::interaction, this, [this] { this->Follow.start(0); });
  QObject::connect(this, &pqHandleBoxWidget::endInteraction, this, &pqHandleBoxWidget::endDrag,
    Qt::QueuedConnection);
}

pqHandleBoxWidget::~pqHandleBoxWidget()
{
  this->closeUndoSet();
  this->setBoxRenders(true);
}

pqProxy* pqHandleBoxWidget::appliedFilter() const
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  auto* filter = model->findItem<pqProxy*>(this->Filter);
  const bool isActive =
    filter && vtkSMPropertyHelper(this->Filter, "Motion").GetAsProxy() == this->proxy();
  return isActive && filter->modifiedState() != pqProxy::UNINITIALIZED ? filter : nullptr;
}

void pqHandleBoxWidget::surroundHandle()
{
  const int id = vtkSMUncheckedPropertyHelper(this->Filter, "ActiveHandle").GetAsInt();
  const vtkBoundingBox box = HandleBox(this->Filter, id);
  const bool hadHandle = this->HasHandle;
  this->HasHandle = box.IsValid();
  if (this->HasHandle)
  {
    // The links of the property group take the bounds to the box.
    double bounds[6];
    box.GetBounds(bounds);
    vtkSMPropertyHelper(this->proxy(), "ReferenceBounds").Set(bounds, 6);
    this->proxy()->UpdateVTKObjects();
  }
  if (this->HasHandle != hadHandle)
  {
    this->setWidgetVisible(this->HasHandle);
  }
  this->render();
}

void pqHandleBoxWidget::showEvent(QShowEvent* event)
{
  this->Superclass::showEvent(event);
  if (!this->HasHandle)
  {
    this->setWidgetVisible(false);
  }
}

void pqHandleBoxWidget::closeUndoSet()
{
  if (this->IsUndoSetOpen)
  {
    END_UNDO_SET();
    this->IsUndoSetOpen = false;
  }
}

void pqHandleBoxWidget::startDrag()
{
  this->closeUndoSet();
  BEGIN_UNDO_SET(tr("Move Handle"));
  this->IsUndoSetOpen = true;
  pqProxy* filter = this->appliedFilter();
  // The box and the surface are drawn together, once for each move.
  this->setBoxRenders(!filter);
  this->Unmodified = filter && filter->modifiedState() == pqProxy::UNMODIFIED ? filter : nullptr;
}

void pqHandleBoxWidget::setBoxRenders(bool renders)
{
  if (this->Interactor)
  {
    this->Interactor->RemoveObserver(this->RenderBlock);
    this->Interactor = nullptr;
  }
  auto* viewProxy = this->view() ? vtkSMViewProxy::SafeDownCast(this->view()->getProxy()) : nullptr;
  vtkRenderWindow* window = viewProxy ? viewProxy->GetRenderWindow() : nullptr;
  if (!renders && window && window->GetInteractor())
  {
    // The view draws when its interactor says so; this observer is asked first.
    vtkNew<vtkCallbackCommand> block;
    block->SetAbortFlagOnExecute(1);
    block->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
    this->Interactor = window->GetInteractor();
    this->RenderBlock = this->Interactor->AddObserver(vtkCommand::RenderEvent, block, 1.0f);
  }
}

void pqHandleBoxWidget::follow()
{
  if (!this->appliedFilter())
  {
    return;
  }
  this->apply();
  auto* viewProxy = this->view() ? vtkSMViewProxy::SafeDownCast(this->view()->getProxy()) : nullptr;
  if (this->IsUndoSetOpen && viewProxy)
  {
    viewProxy->Update();
    viewProxy->InteractiveRender();
  }
  else
  {
    this->render();
  }
}

void pqHandleBoxWidget::endDrag()
{
  this->Follow.stop();
  this->follow();
  this->closeUndoSet();
  this->setBoxRenders(true);
  this->render();
  if (this->appliedFilter())
  {
    // What has changed within the scope is recorded: where the drag ended.
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", this->Filter);
    for (const char* name : { "Position", "Rotation", "Scale" })
    {
      this->proxy()->GetProperty(name)->Modified();
    }
  }
  // Nothing is left to apply, but the panel has taken note of a change.
  if (this->Unmodified)
  {
    this->Unmodified->setModifiedState(pqProxy::UNMODIFIED);
  }
}

void pqHandleBoxWidget::putBack()
{
  this->startDrag();
  const double zeros[3] = { 0.0, 0.0, 0.0 };
  const double ones[3] = { 1.0, 1.0, 1.0 };
  vtkSMProxy* box = this->widgetProxy();
  vtkSMPropertyHelper(box, "Position").Set(zeros, 3);
  vtkSMPropertyHelper(box, "Rotation").Set(zeros, 3);
  vtkSMPropertyHelper(box, "Scale").Set(ones, 3);
  box->UpdateVTKObjects();
  Q_EMIT this->changeAvailable();
  Q_EMIT this->changeFinished();
  this->endDrag();
}
