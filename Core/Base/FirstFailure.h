// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_FirstFailure_h
#define banyan_Base_FirstFailure_h

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <string>

namespace banyan
{

/// Keeps what is wrong with the first bad one of many items, which several threads look at. Any
/// number of threads finds the same item.
class FirstFailure
{
public:
  void Report(std::int64_t item, const std::string& sentence)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (item < this->First)
    {
      this->First = item;
      this->Sentence = sentence;
    }
  }

  /// Whether an item before this one has failed, so that this one does not matter any more.
  bool IsBefore(std::int64_t item) const { return this->First < item; }

  /// Throws Error if an item has failed.
  void Throw() const
  {
    if (!this->Sentence.empty())
    {
      throw Error(this->Sentence);
    }
  }

private:
  std::atomic<std::int64_t> First{ std::numeric_limits<std::int64_t>::max() };
  std::string Sentence;
  std::mutex Mutex;
};

/// Calls body(begin, end, worker) for runs of items, in parallel, and throws what has failed first.
template <class Body>
void ForRuns(std::int64_t count, ThreadPool& pool, FirstFailure& failure, const Body& body)
{
  constexpr std::int64_t run = 16384;
  const std::function<void(std::int64_t, int)> each = [&](std::int64_t i, int worker)
  {
    if (!failure.IsBefore(i * run))
    {
      body(i * run, std::min((i + 1) * run, count), worker);
    }
  };
  pool.ParallelFor((count + run - 1) / run, each);
  failure.Throw();
}

} // namespace banyan

#endif
