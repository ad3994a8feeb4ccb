// SPDX-License-Identifier: BSD-3-Clause
#include "pqActiveHandleWidget.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqDataRepresentation.h"
#include "pqHandleLabels.h"
#include "pqHandleMotions.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTimer>
#include <QVBoxLayout>

pqActiveHandleWidget::pqActiveHandleWidget(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Choice(new QComboBox(this))
  , Numbers(new QCheckBox(tr("Show Numbers"), this))
  , Message(new QLabel(this))
  , Mark(new QPushButton(tr("Mark Both Ends"), this))
  , Labels(new pqHandleLabels(proxy, this))
{
  this->Choice->setObjectName("Choice");
  this->Numbers->setObjectName("Numbers");
  this->Numbers->setChecked(true);
  this->Numbers->setToolTip(
    tr("Shows the numbers of the handles in the view. A click on one makes its handle active."));
  this->Message->setObjectName("Message");
  this->Message->setWordWrap(true);
  this->Mark->setObjectName("Mark");
  this->Mark->setToolTip(tr("Adds two Mark Handle filters before this one: handle 1 at the lower "
                            "end of the surface's longest side, handle 2 at the upper end."));
  auto* layout = new QVBoxLayout(this);
  layout->setMargin(0);
  layout->setSpacing(2);
  layout->addWidget(this->Choice);
  layout->addWidget(this->Numbers);
  layout->addWidget(this->Message);
  layout->addWidget(this->Mark);

  QObject::connect(this->Choice, qOverload<int>(&QComboBox::activated), this,
    [this](int index) { this->choose(this->Choice->itemData(index).toInt()); });
  QObject::connect(this->Numbers, &QCheckBox::toggled, this, &pqActiveHandleWidget::showLabels);
  QObject::connect(this->Labels, &pqHandleLabels::clicked, this, &pqActiveHandleWidget::choose);
  QObject::connect(this->Mark, &QPushButton::clicked, this, &pqActiveHandleWidget::markEnds);
  pqCoreUtilities::connect(
    proxy->GetProperty("HandleBounds"), vtkCommand::ModifiedEvent, this, SLOT(listHandles()));
  this->listHandles();
  this->addPropertyLink(this, "handle", SIGNAL(handleChanged()), property);
  this->setChangeAvailableAsChangeFinished(true);
}

void pqActiveHandleWidget::setHandle(int id)
{
  if (id != this->Handle)
  {
    this->Handle = id;
    this->listHandles();
    Q_EMIT this->handleChanged();
  }
}

void pqActiveHandleWidget::select()
{
  this->Superclass::select();
  this->showLabels();
}

void pqActiveHandleWidget::deselect()
{
  this->Superclass::deselect();
  this->showLabels();
}

void pqActiveHandleWidget::setView(pqView* view)
{
  this->Superclass::setView(view);
  this->showLabels();
}

void pqActiveHandleWidget::showLabels()
{
  this->Labels->setView(this->isSelected() && this->Numbers->isChecked() ? this->view() : nullptr);
}

void pqActiveHandleWidget::listHandles()
{
  const std::vector<int> ids = HandlesOf(this->proxy());
  const QSignalBlocker blocker(this->Choice);
  this->Choice->clear();
  for (const int id : ids)
  {
    this->Choice->addItem(QString::number(id), id);
  }
  if (this->Choice->findData(this->Handle) < 0)
  {
    this->Choice->addItem(tr("%1 (no points)").arg(this->Handle), this->Handle);
  }
  this->Choice->setCurrentIndex(this->Choice->findData(this->Handle));
  this->Choice->setVisible(!ids.empty());
  this->Numbers->setVisible(!ids.empty());
  this->Mark->setVisible(ids.empty());
  this->Message->setText(ids.empty()
      ? tr("The input has no handle. Mark the part that stays and the part that moves.")
      : QString());
  this->Message->setVisible(ids.empty());
  this->Labels->setHandles(ids);
}

void pqActiveHandleWidget::choose(int id)
{
  if (id == this->Handle)
  {
    return;
  }
  QString problem;
  ChangeAtOnce(
    this->proxy(), tr("Choose Handle"), [&] { problem = ActivateHandle(this->proxy(), id); });
  this->listHandles();
  this->Message->setText(problem);
  this->Message->setVisible(!problem.isEmpty());
}

void pqActiveHandleWidget::markEnds()
{
  auto* core = pqApplicationCore::instance();
  auto* filter = core->getServerManagerModel()->findItem<pqPipelineFilter*>(this->proxy());
  pqOutputPort* input = filter ? filter->getAnyInput() : nullptr;
  if (!input)
  {
    return;
  }
  BEGIN_UNDO_SET(tr("Mark Both Ends"));
  pqPipelineSource* surface = input->getSource();
  int port = input->getPortNumber();
  for (int end = 0; end < 2; ++end)
  {
    surface = core->getObjectBuilder()->createFilter("filters", "MarkHandle", surface, port);
    port = 0;
    surface->getSourceProxy()->UpdatePipeline();
    surface->setModifiedState(pqProxy::UNMODIFIED);
  }
  ChangeAtOnce(this->proxy(), tr("Mark Both Ends"),
    [&]
    {
      {
        SM_SCOPED_TRACE(PropertiesModified).arg("proxy", this->proxy());
        vtkSMPropertyHelper(this->proxy(), "Input").Set(surface->getProxy(), 0);
        this->proxy()->UpdateVTKObjects();
      }
      this->proxy()->UpdatePropertyInformation();
      ActivateHandle(this->proxy(), 2);
    });
  for (pqDataRepresentation* representation : input->getRepresentations(nullptr))
  {
    representation->setVisible(false);
  }
  END_UNDO_SET();
  pqActiveObjects::instance().setActiveSource(filter);
}
