// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTraceFilter
 * @brief keeps what filters report out of traces
 *
 * A trace records all properties of a filter that change while settings are applied,
 * what the filter reports too; a script cannot set that. NaN counts as changed each
 * time. For filters of this plugin, traces look at settings only. Takes effect as soon
 * as Python runs.
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
