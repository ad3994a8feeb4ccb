// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqMeasureWidget
 * @brief a number that a filter reports, with its unit
 *
 * In XML: a Double- or IntVectorProperty with information_only="1" and
 * panel_widget="cartan_measure"; its hints say the unit: <Unit name="1/length"/>, or name="%"
 * for a ratio that is shown in percent.
 */
#ifndef pqMeasureWidget_h
#define pqMeasureWidget_h

#include "pqPropertyWidget.h"

class QLabel;

class pqMeasureWidget : public pqPropertyWidget
{
  Q_OBJECT
  typedef pqPropertyWidget Superclass;

public:
  pqMeasureWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqMeasureWidget() override = default;

private Q_SLOTS:
  void showNumber();

private:
  QString Unit;
  QLabel* Number;
};

#endif
