// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqHandleBoxWidget
 * @brief the box around a handle in the 3D view, which the surface follows
 *
 * ParaView's interactive box, with these differences. The box starts at the
 * bounds of the handle that the panel names, applied or not, instead of at the
 * bounds of the data; the handle moves as the box does and can be grasped again.
 * There is no box if no point belongs to the handle. Once the filter has been
 * applied, the surface follows the box while it is dragged, without waiting for
 * Apply. And a trace records where each drag ends.
 *
 * In XML: a property group with panel_widget="cartan_handle_box" and the
 * functions `Position`, `Rotation`, `Scale` and `ReferenceBounds`.
 */
#ifndef pqHandleBoxWidget_h
#define pqHandleBoxWidget_h

#include "pqBoxPropertyWidget.h"
#include "vtkWeakPointer.h"

#include <QPointer>
#include <QTimer>

class pqProxy;
class vtkRenderWindowInteractor;
class vtkSMProxy;

class pqHandleBoxWidget : public pqBoxPropertyWidget
{
  Q_OBJECT
  typedef pqBoxPropertyWidget Superclass;

public:
  pqHandleBoxWidget(vtkSMProxy* motion, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqHandleBoxWidget() override;

protected:
  void showEvent(QShowEvent* event) override;

private Q_SLOTS:
  /// Puts the box around the handle that the panel names.
  void surroundHandle();

private:
  /// The filter whose handle moves, if it has been applied.
  pqProxy* appliedFilter() const;

  /// Whether the view draws the box by itself when it moves.
  void setBoxRenders(bool renders);

  void startDrag();
  void follow();
  void endDrag();
  void putBack();

  /// A drag is one step to undo.
  void closeUndoSet();
  bool IsUndoSetOpen = false;

  /// The view's interactor, and what keeps it from drawing, while the surface follows.
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  unsigned long RenderBlock = 0;

  /// Lets the surface follow.
  QTimer Follow;

  /// The filter that offers this motion.
  vtkWeakPointer<vtkSMProxy> Filter;

  /// Whether the handle that the panel names has points.
  bool HasHandle = true;

  /// The filter, if nothing but the box has changed since it was applied.
  QPointer<pqProxy> Unmodified;
};

#endif
