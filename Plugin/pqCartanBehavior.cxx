// SPDX-License-Identifier: BSD-3-Clause
#include "pqCartanBehavior.h"

#include "pqColoring.h"
#include "pqStartingValues.h"
#ifdef CARTAN_HAVE_PYTHON
#include "pqTraceFilter.h"
#else
/// Without Python there are no traces.
class pqTraceFilter
{
};
#endif

#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkSMSourceProxy.h"

namespace
{
/// Whether a filter is one of this plugin's: they all say how much memory they keep.
bool IsOurs(pqPipelineSource* source)
{
  return source->getProxy()->GetProperty("KeptMemory") != nullptr;
}
}

pqCartanBehavior::pqCartanBehavior(QObject* parent)
  : QObject(parent)
{
  this->Refresh.setSingleShot(true);
  QObject::connect(&this->Refresh, &QTimer::timeout, this, &pqCartanBehavior::refresh);
}

pqCartanBehavior::~pqCartanBehavior() = default;

void pqCartanBehavior::startup()
{
  this->TraceFilter = std::make_unique<pqTraceFilter>();
  RegisterHandleColors();
  auto* core = pqApplicationCore::instance();
  auto* model = core->getServerManagerModel();
  QObject::connect(
    model, &pqServerManagerModel::dataUpdated, this, &pqCartanBehavior::refreshLater);
  QObject::connect(model, &pqServerManagerModel::viewAdded, this, &pqCartanBehavior::watchView);
  for (pqView* view : model->findItems<pqView*>())
  {
    this->watchView(view);
  }
  QObject::connect(core->getObjectBuilder(), &pqObjectBuilder::filterCreated, this,
    &pqCartanBehavior::startFilter);
}

void pqCartanBehavior::shutdown()
{
  this->Refresh.stop();
  this->TraceFilter.reset();
}

void pqCartanBehavior::watchView(pqView* view)
{
  QObject::connect(view, &pqView::updateDataEvent, this, &pqCartanBehavior::refreshLater);
}

void pqCartanBehavior::refreshLater()
{
  this->Refresh.start(0);
}

void pqCartanBehavior::refresh()
{
  for (pqPipelineSource* source :
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
  {
    if (IsOurs(source) && source->modifiedState() != pqProxy::UNINITIALIZED)
    {
      source->getProxy()->UpdatePropertyInformation();
      CenterColors(source);
    }
  }
  // A filter is colored once: other colors are the user's choice.
  if (this->NewMarking && ColorByHandle(this->NewMarking))
  {
    this->NewMarking = nullptr;
  }
}

void pqCartanBehavior::startFilter(pqPipelineSource* filter)
{
  if (IsOurs(filter))
  {
    SetStartingValues(filter);
    if (filter->getProxy()->GetProperty("MarkedPointIds"))
    {
      this->NewMarking = filter;
    }
  }
}
