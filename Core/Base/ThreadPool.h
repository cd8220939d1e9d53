// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_ThreadPool_h
#define banyan_Base_ThreadPool_h

#include <cstdint>
#include <functional>
#include <memory>

namespace banyan
{

/// A pool of worker threads for loops over independent items. The calling thread works too, so a
/// pool of width 1 starts no thread at all.
///
/// `ParallelFor` may be called from several threads at once and from inside a loop body (the inner
/// loop then runs on the calling thread alone).
class ThreadPool
{
public:
  /// @param width number of threads that work on a loop, the caller included; at least 1.
  /// Its threads have the priority of the thread that makes it.
  explicit ThreadPool(int width);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int Width() const noexcept;

  /// Calls `body(i)` for each i in [0, count), in any order, and returns when all are done.
  /// The first exception that a body throws is thrown again here, after the others have ended;
  /// items that have not started by then are skipped.
  void ParallelFor(std::int64_t count, const std::function<void(std::int64_t)>& body);

  /// Does the same; the second argument of the body is the worker's number in [0, Width()), so that
  /// a body can use scratch memory of its own.
  void ParallelFor(std::int64_t count, const std::function<void(std::int64_t, int worker)>& body);

  /// The pool shared by everything in this process; its width is `DefaultWidth()` until
  /// `SetProcessWidth` is called. One for all series and volumes: the cores are the process's.
  /// Threads of low priority share another one, of the same width.
  static ThreadPool& Process();

  /// Gives the calling thread low priority for the rest of its life: where others want its core, a
  /// tenth of what they get (nice 10).
  static void LowerPriority();

  /// Replaces the shared pools by some of another width. Must not be called while they work.
  /// @param width at least 1, or 0 for `DefaultWidth()`.
  static void SetProcessWidth(int width);

  /// Whether `SetProcessWidth` with that width would leave the pool as it is.
  static bool HasProcessWidth(int width);

  /// `BANYAN_THREADS` from the environment if set; otherwise the cores this process may run on
  /// divided by the ranks on this node (as told by `SetRanksOnThisNode`), at least 1.
  static int DefaultWidth();

  /// Tells how many MPI ranks share this machine (default 1). Takes effect at the next
  /// `SetProcessWidth(0)`.
  static void SetRanksOnThisNode(int ranks);

private:
  struct Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace banyan

#endif
