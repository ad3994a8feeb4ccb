// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqMotionRowsWidget
 * @brief the motions of all handles but the active one, a column for each
 *
 * The numbers have names and units. A new column moves the next handle, does not scale it,
 * and turns it about its center. A button puts all handles back, the active one too.
 *
 * In XML: a DoubleVectorProperty that can be repeated, with the 14 elements of
 * MotionRows and panel_widget="cartan_motion_rows".
 */
#ifndef pqMotionRowsWidget_h
#define pqMotionRowsWidget_h

#include "pqPropertyWidget.h"

#include <QList>
#include <QVariant>

class QLabel;
class QPushButton;
class QTableWidget;

class pqMotionRowsWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QList<QVariant> rows READ rows WRITE setRows NOTIFY rowsChanged)
  typedef pqPropertyWidget Superclass;

public:
  pqMotionRowsWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqMotionRowsWidget() override = default;

  QList<QVariant> rows() const { return this->Rows; }
  void setRows(const QList<QVariant>& rows);

Q_SIGNALS:
  void rowsChanged();

private Q_SLOTS:
  /// Takes over that no row is left, which links of properties do not report.
  void notice();

private:
  void fill();
  void edit(int line, int column);
  void add();
  void remove();

  QList<QVariant> Rows;
  QLabel* Summary;
  QTableWidget* Table;
  QPushButton* Remove;
};

#endif
