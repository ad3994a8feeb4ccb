// SPDX-License-Identifier: BSD-3-Clause
#include "CountedMessages.h"

#include <mpi.h>

// MPI's profiling interface: these take the place of the library's functions in the whole
// process, and call them by their second names.
namespace
{
long long messageCount = 0;
}

long long CountedMessages()
{
  return messageCount;
}

#define COUNTED(name, parameters, arguments)                                                       \
  int MPI_##name parameters                                                                        \
  {                                                                                                \
    ++messageCount;                                                                                \
    return PMPI_##name arguments;                                                                  \
  }

extern "C"
{
  COUNTED(
    Send, (const void* a, int b, MPI_Datatype c, int d, int e, MPI_Comm f), (a, b, c, d, e, f))
  COUNTED(Recv, (void* a, int b, MPI_Datatype c, int d, int e, MPI_Comm f, MPI_Status* g),
    (a, b, c, d, e, f, g))
  COUNTED(Isend, (const void* a, int b, MPI_Datatype c, int d, int e, MPI_Comm f, MPI_Request* g),
    (a, b, c, d, e, f, g))
  COUNTED(Irecv, (void* a, int b, MPI_Datatype c, int d, int e, MPI_Comm f, MPI_Request* g),
    (a, b, c, d, e, f, g))
  COUNTED(Barrier, (MPI_Comm a), (a))
  COUNTED(Bcast, (void* a, int b, MPI_Datatype c, int d, MPI_Comm e), (a, b, c, d, e))
  COUNTED(Allreduce, (const void* a, void* b, int c, MPI_Datatype d, MPI_Op e, MPI_Comm f),
    (a, b, c, d, e, f))
  COUNTED(Reduce, (const void* a, void* b, int c, MPI_Datatype d, MPI_Op e, int f, MPI_Comm g),
    (a, b, c, d, e, f, g))
  COUNTED(
    Scan, (const void* a, void* b, int c, MPI_Datatype d, MPI_Op e, MPI_Comm f), (a, b, c, d, e, f))
  COUNTED(Exscan, (const void* a, void* b, int c, MPI_Datatype d, MPI_Op e, MPI_Comm f),
    (a, b, c, d, e, f))
  COUNTED(Allgather,
    (const void* a, int b, MPI_Datatype c, void* d, int e, MPI_Datatype f, MPI_Comm g),
    (a, b, c, d, e, f, g))
  COUNTED(Allgatherv,
    (const void* a, int b, MPI_Datatype c, void* d, const int* e, const int* f, MPI_Datatype g,
      MPI_Comm h),
    (a, b, c, d, e, f, g, h))
  COUNTED(Alltoall,
    (const void* a, int b, MPI_Datatype c, void* d, int e, MPI_Datatype f, MPI_Comm g),
    (a, b, c, d, e, f, g))
  COUNTED(Alltoallv,
    (const void* a, const int* b, const int* c, MPI_Datatype d, void* e, const int* f, const int* g,
      MPI_Datatype h, MPI_Comm i),
    (a, b, c, d, e, f, g, h, i))
}
