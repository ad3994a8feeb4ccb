// SPDX-License-Identifier: BSD-3-Clause
#include "pqTraceFilter.h"

#include "vtkCallbackCommand.h"
#include "vtkPythonInterpreter.h"

namespace
{
/// ParaView asks these functions for what a trace knows of a proxy; NotImplementedError
/// lets it ask the next.
constexpr const char* Script = R"(
def _cartan_trace_filter():
    from paraview import smtrace

    class SettingsAccessor(smtrace.RealProxyAccessor):
        def __init__(self, name, proxy):
            super().__init__(name, proxy)
            self.OrderedProperties = [helper for helper in self.OrderedProperties
                                      if not helper.get_object().GetInformationOnly()]

    def create(name, proxy):
        if not proxy.SMProxy.GetProperty("KeptMemory"):
            raise NotImplementedError()
        return SettingsAccessor(name, proxy)

    smtrace.RealProxyAccessor.register_create_callback(create)
_cartan_trace_filter()
del _cartan_trace_filter
)";

void Register(vtkObject*, unsigned long, void*, void*)
{
  vtkPythonInterpreter::RunSimpleString(Script);
}
}

pqTraceFilter::pqTraceFilter()
{
  if (vtkPythonInterpreter::IsInitialized())
  {
    Register(nullptr, 0, nullptr, nullptr);
    return;
  }
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(Register);
  this->Interpreter->AddObserver(vtkCommand::EnterEvent, command);
}

pqTraceFilter::~pqTraceFilter() = default;
