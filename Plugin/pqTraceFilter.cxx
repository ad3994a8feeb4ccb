// SPDX-License-Identifier: BSD-3-Clause
#include "pqTraceFilter.h"

#include "vtkCallbackCommand.h"
#include "vtkPythonInterpreter.h"

namespace
{
/// ParaView asks these functions for what a trace knows of a proxy; NotImplementedError
/// lets it ask the next.
constexpr const char* Script = R"python(
def _cartan_trace_filter():
    from paraview import servermanager, smtrace

    def load(proxy):
        def file_in(information):
            names = [information.GetPluginName(i) for i in range(information.GetNumberOfPlugins())]
            return information.GetPluginFileName(names.index("CartanPlugin"))

        manager = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager()
        file = file_in(manager.GetLocalInformation())
        lines = ["    LoadPlugin(%r, remote=False, ns=globals())" % file]
        connection = servermanager.ActiveConnection
        if connection.IsRemote():
            file = file_in(manager.GetRemoteInformation(connection.Session))
            lines += ["    if paraview.servermanager.ActiveConnection.IsRemote():",
                      "        LoadPlugin(%r, ns=globals())" % file]
        name = servermanager._make_name_valid(proxy.GetXMLLabel())
        return ["# load CartanPlugin, unless ParaView has done so by Auto Load or PV_PLUGIN_PATH",
                "if %r not in globals():" % name] + lines

    class PluginAccessor(smtrace.RealProxyAccessor):
        def trace_ctor(self, *args, **kwargs):
            output = smtrace.Trace.Output
            if not hasattr(output, "cartan_plugin_is_loaded"):
                output.cartan_plugin_is_loaded = True
                output.append_separated(load(self.get_object().SMProxy))
            return super().trace_ctor(*args, **kwargs)

    class SettingsAccessor(PluginAccessor):
        def __init__(self, name, proxy):
            super().__init__(name, proxy)
            self.OrderedProperties = [helper for helper in self.OrderedProperties
                                      if not helper.get_object().GetInformationOnly()]

    def create(name, proxy):
        if proxy.SMProxy.GetProperty("KeptMemory"):
            return SettingsAccessor(name, proxy)
        if proxy.SMProxy.GetXMLName() == "CompressedSurfaceReader":
            return PluginAccessor(name, proxy)
        raise NotImplementedError()

    smtrace.RealProxyAccessor.register_create_callback(create)
_cartan_trace_filter()
del _cartan_trace_filter
)python";

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
