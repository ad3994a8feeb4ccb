// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqActiveHandleWidget
 * @brief the handle that a deformation's panel moves, one of those in the input
 *
 * Another choice takes effect at once and moves nothing: each handle keeps its motion,
 * see ActivateHandle(). A handle is chosen in a list, or by a click on its number in the view.
 * If the input has no handle, the widget says so and offers to mark
 * both ends of the surface, by two Mark Handle filters before the deformation.
 *
 * In XML: an IntVectorProperty with panel_widget="cartan_active_handle" of a filter with
 * the properties `HandleBounds`, `Motion` and `MotionRows`.
 */
#ifndef pqActiveHandleWidget_h
#define pqActiveHandleWidget_h

#include "pqPropertyWidget.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;
class pqHandleLabels;

class pqActiveHandleWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(int handle READ handle WRITE setHandle NOTIFY handleChanged)
  typedef pqPropertyWidget Superclass;

public:
  pqActiveHandleWidget(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqActiveHandleWidget() override = default;

  int handle() const { return this->Handle; }
  void setHandle(int id);

  void select() override;
  void deselect() override;
  void setView(pqView* view) override;

Q_SIGNALS:
  void handleChanged();

private Q_SLOTS:
  /// Lists the handles that the input has.
  void listHandles();

private:
  void showLabels();
  void choose(int id);
  void markEnds();

  int Handle = 1;
  QComboBox* Choice;
  QCheckBox* Numbers;
  QLabel* Message;
  QPushButton* Mark;
  pqHandleLabels* Labels;
};

#endif
