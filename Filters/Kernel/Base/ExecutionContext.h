// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"

#include <functional>

namespace cartan
{
/// How the kernel reaches its caller's threads, progress bar and abort button.
/// A default-constructed one runs in the calling thread and never stops.
class ExecutionContext
{
public:
  using Range = std::function<void(int begin, int end)>;

  ExecutionContext() = default;

  /// `parallelFor(n, body)` calls body on disjoint ranges that cover [0, n),
  /// in any order and from any thread. `progress(fraction)` gets a number in
  /// [0, 1] and returns false to stop; it is called from the calling thread.
  ExecutionContext(
    std::function<void(int, const Range&)> parallelFor, std::function<bool(double)> progress)
    : ParallelFor(std::move(parallelFor))
    , Progress(std::move(progress))
  {
  }

  /// Calls body(begin, end) on ranges that cover [0, n). The body must write
  /// only to its own range, so that results do not depend on the thread count.
  void For(int n, const Range& body) const
  {
    if (n <= 0)
    {
      return;
    }
    if (this->ParallelFor)
    {
      this->ParallelFor(n, body);
    }
    else
    {
      body(0, n);
    }
  }

  /// Reports progress and throws Error(Aborted) when the caller asked to stop.
  void Report(double fraction) const
  {
    if (this->Progress && !this->Progress(this->From + fraction * (this->To - this->From)))
    {
      throw Error(ErrorCode::Aborted, "Stopped on request.");
    }
  }

  /// The same context, for a step that takes the part [from, to] of the whole.
  ExecutionContext Part(double from, double to) const
  {
    ExecutionContext part = *this;
    part.From = this->From + from * (this->To - this->From);
    part.To = this->From + to * (this->To - this->From);
    return part;
  }

private:
  std::function<void(int, const Range&)> ParallelFor;
  std::function<bool(double)> Progress;
  double From = 0.0;
  double To = 1.0;
};
}
