// SPDX-License-Identifier: BSD-3-Clause
#include "pqMatrixWidget.h"

#include "pqDoubleLineEdit.h"
#include "vtkSMVectorProperty.h"

#include <QGridLayout>

#include <cmath>

pqMatrixWidget::pqMatrixWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
  : Superclass(proxy, parent)
{
  auto* numbers = vtkSMVectorProperty::SafeDownCast(property);
  const int count = numbers ? static_cast<int>(numbers->GetNumberOfElements()) : 0;
  const int columns = static_cast<int>(std::lround(std::sqrt(count)));

  auto* layout = new QGridLayout(this);
  layout->setMargin(0);
  layout->setSpacing(2);
  for (int i = 0; i < count; ++i)
  {
    auto* edit = new pqDoubleLineEdit(this);
    edit->setObjectName(QString("Element%1").arg(i));
    edit->setUseGlobalPrecisionAndNotation(true);
    layout->addWidget(edit, i / columns, i % columns);
    this->addPropertyLink(edit, "text2", SIGNAL(textChangedAndEditingFinished()), property, i);
    QObject::connect(edit, &pqDoubleLineEdit::textChangedAndEditingFinished, this,
      &pqMatrixWidget::changeFinished);
  }
}
