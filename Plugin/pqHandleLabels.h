// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqHandleLabels
 * @brief numbers in the 3D view, at the centers of a deformation's handles, that can be clicked
 *
 * They lie over the surface and go where the motions take their handles. That of the active
 * handle is highlighted, lies over the others, and lets clicks through to the box. Like ParaView's
 * own widgets they are drawn by the client, whether the surface is rendered there or by a server.
 */
#ifndef pqHandleLabels_h
#define pqHandleLabels_h

#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <QObject>
#include <QPointer>

#include <vector>

class pqView;
class vtkObject;
class vtkRenderWindowInteractor;
class vtkRenderer;
class vtkSMProxy;
class vtkTextActor;

class pqHandleLabels : public QObject
{
  Q_OBJECT

public:
  /// The largest number of handles that have labels; more would hide the surface.
  static constexpr std::size_t Most = 100;

  /// For a filter with the properties that HandlePlaces() reads.
  pqHandleLabels(vtkSMProxy* filter, QObject* parent);
  ~pqHandleLabels() override;

  /// Where they are; nowhere without a 3D view.
  void setView(pqView* view);

  /// The handles that have one, the first ones if there are too many.
  void setHandles(const std::vector<int>& ids);

Q_SIGNALS:
  /// The label of a handle that is not active has been clicked.
  void clicked(int id);

private:
  struct Label
  {
    int Id;
    vtkSmartPointer<vtkTextActor> Actor;
  };

  void show();
  void hide();

  /// Before the view draws.
  void place();

  /// Returns true if the label of a handle that is not active is hit: the press is none for
  /// what lies under it.
  bool press(vtkObject*, unsigned long, void*);

  /// Neither part of a selection in the view nor with a key that means something else.
  bool isPlainPress() const;

  int active() const;
  bool isUnderMouse(const Label& label) const;

  vtkWeakPointer<vtkSMProxy> Filter;
  QPointer<pqView> View;
  std::vector<Label> Labels;
  int OnTop = 0; ///< the handle whose label is over the others; 0: none
  vtkWeakPointer<vtkRenderer> Renderer;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  unsigned long PlaceObserver = 0;
  unsigned long PressObserver = 0;
};

#endif
