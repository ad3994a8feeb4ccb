// SPDX-License-Identifier: BSD-3-Clause
#include "pqHandleBoxWidget.h"

#include "pqApplicationCore.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkSMNewWidgetRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"

#include <QPushButton>

pqHandleBoxWidget::pqHandleBoxWidget(vtkSMProxy* motion, vtkSMPropertyGroup* group, QWidget* parent)
  : Superclass(motion, group, parent, /*hideReferenceBounds=*/true)
{
  // Otherwise the box would start at the bounds of a data source.
  vtkSMPropertyHelper(this->widgetProxy(), "UseReferenceBounds").Set(1);
  this->widgetProxy()->UpdateVTKObjects();

  // The base resets to the bounds of a data source.
  if (auto* reset = this->findChild<QPushButton*>("resetBounds"))
  {
    QObject::disconnect(reset, &QPushButton::clicked, nullptr, nullptr);
    QObject::connect(reset, &QPushButton::clicked, this, &pqHandleBoxWidget::putBack);
    reset->setText(tr("Put Handle Back"));
    reset->setToolTip(tr("Moves the handle back to its place in the input."));
  }

  // Queued, because the properties learn only after the signals where the box is.
  QObject::connect(this, &pqHandleBoxWidget::startInteraction, this, &pqHandleBoxWidget::startDrag);
  QObject::connect(
    this, &pqHandleBoxWidget::interaction, this, &pqHandleBoxWidget::follow, Qt::QueuedConnection);
  QObject::connect(this, &pqHandleBoxWidget::endInteraction, this, &pqHandleBoxWidget::endDrag,
    Qt::QueuedConnection);
}

pqHandleBoxWidget::~pqHandleBoxWidget()
{
  this->closeUndoSet();
}

pqProxy* pqHandleBoxWidget::appliedFilter() const
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (unsigned int i = 0; i < this->proxy()->GetNumberOfConsumers(); ++i)
  {
    auto* filter = model->findItem<pqProxy*>(this->proxy()->GetConsumerProxy(i));
    if (filter && filter->modifiedState() != pqProxy::UNINITIALIZED)
    {
      return filter;
    }
  }
  return nullptr;
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
  this->Unmodified = filter && filter->modifiedState() == pqProxy::UNMODIFIED ? filter : nullptr;
}

void pqHandleBoxWidget::follow()
{
  if (this->appliedFilter())
  {
    this->apply();
    this->render();
  }
}

void pqHandleBoxWidget::endDrag()
{
  this->follow();
  this->closeUndoSet();
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
