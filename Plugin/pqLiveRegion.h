// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqLiveRegion
 * @brief applies a property of a filter while it is edited
 *
 * Once the filter has been applied, the view shows each change at once, without Apply,
 * and while a widget is dragged in the view: what a region catches. The end of a change is
 * recorded in a trace.
 *
 * In XML: <PropertyWidgetDecorator type="cartan_live"/> in the hints of the property.
 */
#ifndef pqLiveRegion_h
#define pqLiveRegion_h

#include "pqPropertyWidgetDecorator.h"

#include <QTimer>

class pqProxy;

class pqLiveRegion : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  typedef pqPropertyWidgetDecorator Superclass;

public:
  pqLiveRegion(vtkPVXMLElement* xml, pqPropertyWidget* parent);
  ~pqLiveRegion() override = default;

private:
  /// The filter, if it has been applied.
  pqProxy* appliedFilter() const;

  void noteChange();
  void follow();
  void finish();

  QTimer Follow;
  QTimer Finish;

  /// Whether nothing but this property has changed since the filter was applied.
  bool IsAlone = false;
};

#endif
