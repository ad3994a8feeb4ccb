// SPDX-License-Identifier: BSD-3-Clause
// Takes the place of the thread pool of VTK's STDThread backend in builds with
// ThreadSanitizer, which reports two accesses only if nothing that it has seen orders them.
// VTK's own pool takes one job after another from a queue behind a mutex, and each visit to
// the mutex orders what was done before it before what others do afterwards: when one thread
// is done with a short job before another begins, a race between the jobs is not reported.
// Here job k goes to thread k modulo the number of threads, and between its start and its
// end a thread synchronizes with no other, so that a race between jobs of different threads
// is reported whatever the timing.
#include "SMP/STDThread/vtkSMPThreadPool.h"
#include "vtkSMPTools.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace
{
/// Without threads nothing would be found, and nothing would tell.
const bool IsThreaded = []
{
  const bool isThreaded = std::strcmp(vtkSMPTools::GetBackend(), "STDThread") == 0 &&
    vtkSMPTools::GetEstimatedNumberOfThreads() > 1;
  if (!isThreaded)
  {
    std::fprintf(stderr,
      "ERROR: VTK's backend is %s with %d threads. Races are found only with\n"
      "VTK_SMP_BACKEND_IN_USE=STDThread and VTK_SMP_MAX_THREADS=4, as ctest --preset tsan sets.\n",
      vtkSMPTools::GetBackend(), vtkSMPTools::GetEstimatedNumberOfThreads());
    std::exit(EXIT_FAILURE);
  }
  return isThreaded;
}();
}

namespace vtk
{
namespace detail
{
namespace smp
{
VTK_ABI_NAMESPACE_BEGIN

/// The threads start in Join(). Until then, none of them is "the single thread" that VTK
/// asks the first one to be.
vtkSMPThreadPool::vtkSMPThreadPool(int threadNumber)
  : Threads(threadNumber)
{
}

void vtkSMPThreadPool::DoJob(std::function<void(void)> job)
{
  this->JobQueue.push(std::move(job));
}

void vtkSMPThreadPool::Join()
{
  std::vector<std::vector<std::function<void(void)>>> shares(this->Threads.size());
  for (std::size_t k = 0; !this->JobQueue.empty(); ++k)
  {
    shares[k % shares.size()].push_back(std::move(this->JobQueue.front()));
    this->JobQueue.pop();
  }
  for (std::size_t t = 0; t < shares.size(); ++t)
  {
    if (!shares[t].empty())
    {
      this->Threads[t] = std::thread(
        [&share = shares[t]]
        {
          for (const auto& job : share)
          {
            job();
          }
        });
    }
  }
  for (std::thread& thread : this->Threads)
  {
    if (thread.joinable())
    {
      thread.join();
    }
  }
}

std::vector<std::thread>* vtkSMPThreadPool::GetThreads()
{
  return &this->Threads;
}

VTK_ABI_NAMESPACE_END
}
}
}
