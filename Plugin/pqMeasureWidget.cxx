// SPDX-License-Identifier: BSD-3-Clause
#include "pqMeasureWidget.h"

#include "pqCoreUtilities.h"
#include "vtkCommand.h"
#include "vtkPVXMLElement.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

#include <QHBoxLayout>
#include <QLabel>

#include <cmath>

pqMeasureWidget::pqMeasureWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
  , Number(new QLabel(this))
{
  vtkPVXMLElement* hints = property->GetHints();
  vtkPVXMLElement* unit = hints ? hints->FindNestedElementByName("Unit") : nullptr;
  this->Unit = unit ? QString(unit->GetAttributeOrEmpty("name")) : QString();
  this->setProperty(property);
  this->Number->setObjectName("Number");
  this->Number->setTextInteractionFlags(Qt::TextSelectableByMouse);
  this->Number->setBackgroundRole(QPalette::Base);
  this->Number->setAutoFillBackground(true);
  this->Number->setMargin(2);
  auto* layout = new QHBoxLayout(this);
  layout->setMargin(0);
  layout->addWidget(this->Number);
  pqCoreUtilities::connect(property, vtkCommand::ModifiedEvent, this, SLOT(showNumber()));
  this->showNumber();
}

void pqMeasureWidget::showNumber()
{
  const double value = vtkSMPropertyHelper(this->property()).GetAsDouble();
  const bool isPercent = this->Unit == "%";
  // Six digits, as ParaView's own panels show, but counts whole.
  const bool isCount = this->property()->IsA("vtkSMIntVectorProperty");
  const QString number =
    QString::number(isPercent ? 100.0 * value : value, isCount ? 'f' : 'g', isCount ? 0 : 6);
  this->Number->setText(std::isnan(value) ? tr("undefined")
      : this->Unit.isEmpty()              ? number
                                          : number + " " + this->Unit);
}
