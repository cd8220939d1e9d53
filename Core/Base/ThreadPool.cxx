// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ThreadPool.h"

#include "Base/Error.h"
#include "Base/ProcessCores.h"
#include "Base/Progress.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

thread_local bool InsideLoop = false;
std::atomic<int> RanksOnThisNode{ 1 };
std::mutex ProcessPoolMutex;
std::unique_ptr<ThreadPool> ProcessPool;
std::unique_ptr<ThreadPool> LowPool; ///< of threads with low priority
thread_local bool IsLow = false;

/// Loops follow each other closely while a picture is drawn, and to put a thread to sleep and wake
/// it again takes as long as a short loop: threads look around for so long before they sleep.
constexpr auto AwakeFor = std::chrono::microseconds(200);

/// Waits until something has come, or for a while.
template <class Function>
void StayAwake(Function&& hasCome)
{
  const auto end = std::chrono::steady_clock::now() + AwakeFor;
  while (!hasCome() && std::chrono::steady_clock::now() < end)
  {
    std::this_thread::yield();
  }
}

/// One ParallelFor call. It outlives the call when a worker still holds it, hence shared_ptr.
struct Loop
{
  Loop(std::int64_t count, const std::function<void(std::int64_t, int)>& body)
    : Count(count)
    , Body(body)
  {
  }

  /// Takes items until none is left or one has failed.
  void Work(int worker)
  {
    const bool nested = InsideLoop;
    InsideLoop = true;
    for (std::int64_t i = this->Next++; i < this->Count; i = this->Next++)
    {
      try
      {
        if (!this->Failed)
        {
          this->Body(i, worker);
        }
      }
      catch (...)
      {
        std::lock_guard<std::mutex> lock(this->Mutex);
        if (!this->Failed.exchange(true))
        {
          this->Failure = std::current_exception();
        }
      }
      Progress::Note();
      if (++this->Done == this->Count)
      {
        std::lock_guard<std::mutex> lock(this->Mutex);
        this->AllDone.notify_all();
      }
    }
    InsideLoop = nested;
  }

  void WaitAndRethrow(bool awake)
  {
    if (awake)
    {
      StayAwake([this] { return this->Done == this->Count; });
    }
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->AllDone.wait(lock, [this] { return this->Done == this->Count; });
    if (this->Failure)
    {
      // Whoever still holds the loop must not be the one that destroys it.
      std::rethrow_exception(std::exchange(this->Failure, nullptr));
    }
  }

  bool Exhausted() const { return this->Next >= this->Count; }

  const std::int64_t Count;
  const std::function<void(std::int64_t, int)>& Body;
  std::atomic<std::int64_t> Next{ 0 };
  std::atomic<std::int64_t> Done{ 0 };
  std::atomic<bool> Failed{ false };
  std::exception_ptr Failure;
  std::mutex Mutex;
  std::condition_variable AllDone;
};

} // namespace

struct ThreadPool::Internals
{
  std::vector<std::thread> Threads;
  std::deque<std::shared_ptr<Loop>> Loops;
  std::mutex Mutex;
  std::condition_variable Wake;
  bool Stop = false;
  std::atomic<std::int64_t> Begun{ 0 }; ///< loops so far, and the end
  bool Awake = false;                   ///< whether there is a core for each thread

  void Run(int worker)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    while (true)
    {
      this->Wake.wait(lock, [this] { return this->Stop || !this->Loops.empty(); });
      if (this->Stop)
      {
        return;
      }
      const std::shared_ptr<Loop> loop = this->Loops.front();
      if (loop->Exhausted())
      {
        this->Loops.pop_front();
        continue;
      }
      const std::int64_t begun = this->Begun;
      lock.unlock();
      loop->Work(worker);
      if (this->Awake)
      {
        StayAwake([this, begun] { return this->Begun != begun; });
      }
      lock.lock();
    }
  }

  /// Ends all threads that have been started.
  void Join()
  {
    {
      std::lock_guard<std::mutex> lock(this->Mutex);
      this->Stop = true;
      ++this->Begun;
    }
    this->Wake.notify_all();
    for (std::thread& thread : this->Threads)
    {
      thread.join();
    }
  }

  void Remove(const std::shared_ptr<Loop>& loop)
  {
    std::lock_guard<std::mutex> lock(this->Mutex);
    for (auto it = this->Loops.begin(); it != this->Loops.end(); ++it)
    {
      if (*it == loop)
      {
        this->Loops.erase(it);
        return;
      }
    }
  }
};

ThreadPool::ThreadPool(int width)
  : Self(std::make_unique<Internals>())
{
  if (width < 1)
  {
    throw Error("A thread pool needs at least one thread");
  }
  this->Self->Awake = width * RanksOnThisNode <= ProcessCores();
  try
  {
    this->Self->Threads.reserve(static_cast<std::size_t>(width - 1));
    for (int worker = 1; worker < width; ++worker)
    {
      this->Self->Threads.emplace_back([this, worker] { this->Self->Run(worker); });
    }
  }
  catch (const std::exception& error)
  {
    const std::size_t started = this->Self->Threads.size() + 1;
    this->Self->Join();
    throw Error("Only " + std::to_string(started) + " of " + std::to_string(width) +
                " threads could be started (" + error.what() +
                "). Set fewer: 'Number Of Threads' (NumberOfThreads) of the display, the option "
                "--threads or the variable BANYAN_THREADS.");
  }
}

ThreadPool::~ThreadPool()
{
  this->Self->Join();
}

int ThreadPool::Width() const noexcept
{
  return static_cast<int>(this->Self->Threads.size()) + 1;
}

void ThreadPool::ParallelFor(
  std::int64_t count, const std::function<void(std::int64_t, int worker)>& body)
{
  if (count <= 0)
  {
    return;
  }
  const auto loop = std::make_shared<Loop>(count, body);
  const bool share = count > 1 && !InsideLoop && !this->Self->Threads.empty();
  if (share)
  {
    {
      std::lock_guard<std::mutex> lock(this->Self->Mutex);
      this->Self->Loops.push_back(loop);
      ++this->Self->Begun;
    }
    this->Self->Wake.notify_all();
  }
  // Concurrent callers from outside share worker number 0 only with themselves: scratch memory is
  // per call, so two loops never meet in it.
  loop->Work(0);
  if (share)
  {
    this->Self->Remove(loop);
  }
  loop->WaitAndRethrow(share && this->Self->Awake);
}

void ThreadPool::ParallelFor(std::int64_t count, const std::function<void(std::int64_t)>& body)
{
  const std::function<void(std::int64_t, int)> wrapped = [&body](std::int64_t i, int) { body(i); };
  this->ParallelFor(count, wrapped);
}

ThreadPool& ThreadPool::Process()
{
  std::lock_guard<std::mutex> lock(ProcessPoolMutex);
  std::unique_ptr<ThreadPool>& pool = IsLow ? LowPool : ProcessPool;
  if (!pool)
  {
    pool = std::make_unique<ThreadPool>(ProcessPool ? ProcessPool->Width() : DefaultWidth());
  }
  return *pool;
}

void ThreadPool::LowerPriority()
{
  IsLow = true;
#ifdef __linux__
  constexpr int lower = 10;
  constexpr int lowest = 19;
  // Of this thread alone, and of those that it starts; no harm where it is refused.
  const auto self = static_cast<id_t>(gettid());
  (void)setpriority(PRIO_PROCESS, self, std::min(getpriority(PRIO_PROCESS, self) + lower, lowest));
#endif
}

void ThreadPool::SetProcessWidth(int width)
{
  const int wanted = width > 0 ? width : DefaultWidth();
  std::lock_guard<std::mutex> lock(ProcessPoolMutex);
  if (!ProcessPool || ProcessPool->Width() != wanted)
  {
    ProcessPool = std::make_unique<ThreadPool>(wanted);
    LowPool.reset();
  }
}

bool ThreadPool::HasProcessWidth(int width)
{
  std::lock_guard<std::mutex> lock(ProcessPoolMutex);
  return ProcessPool && ProcessPool->Width() == (width > 0 ? width : DefaultWidth());
}

int ThreadPool::DefaultWidth()
{
  if (const char* text = std::getenv("BANYAN_THREADS"))
  {
    const int threads = std::atoi(text);
    if (threads > 0)
    {
      return threads;
    }
  }
  return std::max(1, ProcessCores() / RanksOnThisNode.load());
}

void ThreadPool::SetRanksOnThisNode(int ranks)
{
  RanksOnThisNode = std::max(1, ranks);
}

} // namespace banyan
