// SPDX-License-Identifier: BSD-3-Clause
#include "pqLiveRegion.h"

#include "pqApplicationCore.h"
#include "pqProxy.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyProperty.h"
#include "vtkSMTrace.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"

namespace
{
/// A trace records what is modified within its scope; the data that a widget is placed on is
/// no value of a script.
void ModifyAll(vtkSMProxy* proxy)
{
  auto properties = vtkSmartPointer<vtkSMPropertyIterator>::Take(proxy->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    vtkSMProperty* property = properties->GetProperty();
    if (!property->GetInformationOnly() && !property->GetIsInternal() &&
      !vtkSMProxyProperty::SafeDownCast(property))
    {
      property->Modified();
    }
  }
}
}

pqLiveRegion::pqLiveRegion(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : Superclass(xml, parent)
{
  // Later, because properties learn what widgets show only after the signals; and once for
  // all changes that have come meanwhile.
  this->Follow.setSingleShot(true);
  this->Finish.setSingleShot(true);
  QObject::connect(&this->Follow, &QTimer::timeout, this, &pqLiveRegion::follow);
  QObject::connect(&this->Finish, &QTimer::timeout, this, &pqLiveRegion::finish);
  QObject::connect(parent, &pqPropertyWidget::changeAvailable, this, &pqLiveRegion::noteChange);
  QObject::connect(
    parent, &pqPropertyWidget::changeFinished, this, [this] { this->Finish.start(0); });
}

pqProxy* pqLiveRegion::appliedFilter() const
{
  auto* filter = pqApplicationCore::instance()->getServerManagerModel()->findItem<pqProxy*>(
    this->parentWidget()->proxy());
  return filter && filter->modifiedState() != pqProxy::UNINITIALIZED ? filter : nullptr;
}

void pqLiveRegion::noteChange()
{
  // The panel, which marks the filter as modified, gets the signal after this object.
  pqProxy* filter = this->appliedFilter();
  this->IsAlone = this->IsAlone || (filter && filter->modifiedState() == pqProxy::UNMODIFIED);
  this->Follow.start(0);
}

void pqLiveRegion::follow()
{
  pqPropertyWidget* widget = this->parentWidget();
  if (this->Finish.isActive() || !this->appliedFilter())
  {
    return;
  }
  widget->apply();
  widget->proxy()->UpdateVTKObjects();
  auto* view = widget->view() ? vtkSMViewProxy::SafeDownCast(widget->view()->getProxy()) : nullptr;
  if (view)
  {
    view->Update();
    view->InteractiveRender();
  }
}

void pqLiveRegion::finish()
{
  pqProxy* filter = this->appliedFilter();
  if (!filter)
  {
    return;
  }
  this->Follow.stop();
  pqPropertyWidget* widget = this->parentWidget();
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", filter->getProxy());
    widget->apply();
    widget->property()->Modified();
    auto* region = vtkSMProxyProperty::SafeDownCast(widget->property());
    vtkSMProxy* chosen = region ? vtkSMPropertyHelper(region).GetAsProxy() : nullptr;
    if (chosen)
    {
      ModifyAll(chosen);
    }
    filter->getProxy()->UpdateVTKObjects();
  }
  if (this->IsAlone)
  {
    filter->setModifiedState(pqProxy::UNMODIFIED);
    this->IsAlone = false;
  }
  if (widget->view())
  {
    widget->view()->forceRender();
  }
}
