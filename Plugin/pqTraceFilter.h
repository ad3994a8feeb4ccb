// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTraceFilter
 * @brief lets traces and states that are Python load the plugin, without what filters report
 *
 * A trace records all properties of a filter that change while settings are applied,
 * what the filter reports too; a script cannot set that. NaN counts as changed each
 * time. For filters of this plugin, traces look at settings only. Before the first of
 * them, lines name the plugin's file, which is loaded if it is not yet. Takes effect as
 * soon as Python runs.
 */
#ifndef pqTraceFilter_h
#define pqTraceFilter_h

#include "vtkNew.h"

class vtkPythonInterpreter;

class pqTraceFilter
{
public:
  pqTraceFilter();
  ~pqTraceFilter();

private:
  vtkNew<vtkPythonInterpreter> Interpreter;
};

#endif
