// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkSetNumberMacro.h
 * @brief vtkSetClampMacro for doubles that are numbers
 *
 * vtkSetNumberMacro(name, least, most) declares SetName(double), which clamps as
 * vtkSetClampMacro does, and GetNameMinValue() and GetNameMaxValue(). vtkSetClampMacro stores
 * what is not a number, and no later comparison finds it; here it is an error that changes
 * nothing.
 */
#ifndef vtkSetNumberMacro_h
#define vtkSetNumberMacro_h

#include "vtkSetGet.h"

#include <cmath> // For isnan

#define vtkSetNumberMacro(name, least, most)                                                       \
  virtual void Set##name(double _arg)                                                              \
  {                                                                                                \
    if (std::isnan(_arg))                                                                          \
    {                                                                                              \
      vtkErrorMacro(#name " must be a number; it stays " << this->name << ".");                    \
      return;                                                                                      \
    }                                                                                              \
    const double clamped = _arg < (least) ? (least) : (_arg > (most) ? (most) : _arg);             \
    if (this->name != clamped)                                                                     \
    {                                                                                              \
      this->name = clamped;                                                                        \
      this->Modified();                                                                            \
    }                                                                                              \
  }                                                                                                \
  virtual double Get##name##MinValue()                                                             \
  {                                                                                                \
    return least;                                                                                  \
  }                                                                                                \
  virtual double Get##name##MaxValue()                                                             \
  {                                                                                                \
    return most;                                                                                   \
  }

#endif
