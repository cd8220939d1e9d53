// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Communicate_CollectiveTask_h
#define banyan_Parallel_Communicate_CollectiveTask_h

#include "Base/BackgroundTask.h"
#include "Parallel/Communicate/Communicator.h"

#include <functional>
#include <memory>
#include <string>

namespace banyan
{

/// One task at a time that all ranks do together, by a thread on each, while only their main
/// threads may send messages. Each collective operation of the threads waits until all of them
/// have asked for it, and the main threads serve.
///
///     thread 0   works ── gather ...................... works ───────── done
///     thread 1   works ─────────── gather ............. works ── done
///     main       Serve ─────────── leaves ... Serve ─ gathers ────────── true
///
/// Main threads come and go together: no message is ever half done. Wherever a task is stopped, all
/// threads end at the same operation: they have had the same answers, and their ranks know the
/// same.
///
/// All functions are called by the main thread. Start and Stop send no messages; all ranks call
/// them between the same calls of Serve.
class CollectiveTask
{
public:
  /// Ends early, by an Interruption, when the flag asks for it, or when it next asks for a message.
  /// @param ranks for this thread: single messages (Send, Receive and so on) are an Error in it,
  /// but for those in a part of Communicator::Together, which the main thread runs
  using Task = std::function<void(Communicator& ranks, const StopFlag& stop)>;

  /// @param ranks of the main threads, which may use it for other things between calls of Serve;
  /// has to stay
  explicit CollectiveTask(Communicator& ranks);
  /// Stops.
  ~CollectiveTask();
  CollectiveTask(const CollectiveTask&) = delete;
  CollectiveTask& operator=(const CollectiveTask&) = delete;

  /// Begins a task; one that is under way is stopped before. When no thread can be started, Serve
  /// says so on all ranks.
  void Start(Task task);

  /// Whether a task was started that was neither stopped nor has ended on all ranks: the same on
  /// all of them.
  bool IsStarted() const { return this->OfThread != nullptr; }

  /// Collective: serves the threads. It sleeps while they work.
  /// @param leave asked every millisecond, and before each operation; that of rank 0 counts for all
  /// ranks; must not throw
  /// @return true when the threads of all ranks have ended, or none was started; false when rank 0
  /// leaves: what was asked for by then waits for the next call
  /// When a thread throws, or has ended while others wait for it, all ranks throw the same
  /// CollectiveError; the task is over then.
  bool Serve(const std::function<bool()>& leave);

  /// Asks the thread to end, and returns when it has. What it throws is nobody's concern.
  void Stop();

private:
  class Requests;

  void End();

  Communicator& Ranks;
  std::unique_ptr<Requests> OfThread; ///< null for no task
  BackgroundTask Thread;
  std::string Failure; ///< of Start
};

} // namespace banyan

#endif
