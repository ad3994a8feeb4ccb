// SPDX-License-Identifier: BSD-3-Clause
#include "pqPointIdsWidget.h"

#include "pqStartingValues.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

pqPointIdsWidget::pqPointIdsWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Count(new QLabel(this))
  , Clear(new QPushButton(tr("Clear"), this))
{
  auto* copy = new QPushButton(tr("Copy Active Selection"), this);
  copy->setObjectName("CopySelection");
  copy->setToolTip(tr("Takes the points that are selected in the view or with Find Data; "
                      "the points of selected cells count as selected."));
  this->Count->setObjectName("Count");
  this->Clear->setObjectName("Clear");
  auto* layout = new QHBoxLayout(this);
  layout->setMargin(0);
  layout->addWidget(this->Count, 1);
  layout->addWidget(copy);
  layout->addWidget(this->Clear);

  QObject::connect(copy, &QPushButton::clicked, this, &pqPointIdsWidget::copySelection);
  QObject::connect(this->Clear, &QPushButton::clicked, this, [this] { this->setIds({}); });
  this->setIds({});
  this->addPropertyLink(this, "ids", SIGNAL(idsChanged()), property);
  this->setChangeAvailableAsChangeFinished(true);
}

void pqPointIdsWidget::setIds(const QList<QVariant>& ids)
{
  this->Count->setText(ids.isEmpty() ? tr("none") : tr("%n points", nullptr, ids.size()));
  this->Clear->setEnabled(!ids.isEmpty());
  if (ids != this->Ids)
  {
    this->Ids = ids;
    Q_EMIT this->idsChanged();
  }
}

void pqPointIdsWidget::copySelection()
{
  QList<QVariant> ids;
  for (const vtkIdType id : SelectedPointIds(this->proxy()))
  {
    ids.push_back(static_cast<qlonglong>(id));
  }
  this->setIds(ids);
}
