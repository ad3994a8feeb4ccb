// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqMatrixWidget
 * @brief edits a property of n x n numbers as a square
 *
 * In XML: a DoubleVectorProperty with panel_widget="cartan_matrix" and 9 or 16
 * elements, row by row.
 */
#ifndef pqMatrixWidget_h
#define pqMatrixWidget_h

#include "pqPropertyWidget.h"

class pqMatrixWidget : public pqPropertyWidget
{
  Q_OBJECT
  typedef pqPropertyWidget Superclass;

public:
  pqMatrixWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqMatrixWidget() override = default;
};

#endif
