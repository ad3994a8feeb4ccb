// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqPointIdsWidget
 * @brief a list of point ids, filled from the selection in the window
 *
 * Shows how many points there are, with a button that copies the points of the active
 * selection and one that empties the list. The ids are values of the property, so that
 * states and traces hold them.
 *
 * In XML: an IdTypeVectorProperty that can be repeated, with
 * panel_widget="cartan_point_ids".
 */
#ifndef pqPointIdsWidget_h
#define pqPointIdsWidget_h

#include "pqPropertyWidget.h"

#include <QList>
#include <QVariant>

class QLabel;
class QPushButton;

class pqPointIdsWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QList<QVariant> ids READ ids WRITE setIds NOTIFY idsChanged)
  typedef pqPropertyWidget Superclass;

public:
  pqPointIdsWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqPointIdsWidget() override = default;

  QList<QVariant> ids() const { return this->Ids; }
  void setIds(const QList<QVariant>& ids);

Q_SIGNALS:
  void idsChanged();

private:
  void copySelection();

  QList<QVariant> Ids;
  QLabel* Count;
  QPushButton* Clear;
};

#endif
