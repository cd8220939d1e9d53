// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_BackgroundTask_h
#define banyan_Base_BackgroundTask_h

#include "Base/StopFlag.h"

#include <exception>
#include <functional>
#include <memory>
#include <thread>

namespace banyan
{

/// One task at a time in a thread of its own, which has low priority (ThreadPool): nobody waits for
/// it. All functions are called by one thread, which is another one.
class BackgroundTask
{
public:
  /// Ends early, by an Interruption, when the flag asks for it.
  using Task = std::function<void(const StopFlag& stop)>;

  BackgroundTask() = default;
  /// Stops.
  ~BackgroundTask() { this->Stop(); }
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;

  /// Begins a task; one that is under way is stopped before.
  /// Throws Error when no thread can be started.
  void Start(Task task);

  /// Whether a task was started that was neither stopped nor waited for.
  bool IsStarted() const { return this->Now != nullptr; }
  /// Whether such a task has ended: Wait returns at once.
  bool HasEnded() const;

  /// Asks the task to end, and returns when it has. What it throws is nobody's concern.
  void Stop();
  /// Returns when the task has ended, if one was started.
  void Finish();
  /// The same, and throws what it threw.
  void Wait();

private:
  struct Shared;

  std::thread Thread;
  std::shared_ptr<Shared> Now; ///< with the thread; null for none
};

} // namespace banyan

#endif
