// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib> // defines __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cartan
{
/// Gives memory that was released back to the system, where the C library would keep it. It
/// does so for large blocks too in processes with MPI, whose library asks for that, and the
/// many arrays of an assembly leave no room in one piece for the factor that follows them:
/// both would count. Takes milliseconds.
inline void ReturnFreedMemory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}
}
