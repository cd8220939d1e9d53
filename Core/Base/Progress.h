// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Progress_h
#define banyan_Base_Progress_h

#include <atomic>
#include <cstdint>

namespace banyan
{

/// Says what the thread that draws is doing, for those who look at a process from outside.
enum class Phase : std::uint32_t
{
  Outside, ///< nothing of ours: anything may take any time
  Beginning,
  Fetching,
  Sampling,
  Casting,
  Compositing,
  Balancing
};

/// Returns words that fit into "while it was ..."; "outside of drawing" for Outside.
const char* NameOf(Phase phase);

/// Signs of a process that it gets on. One per process; all functions may be called by any thread.
struct Progress
{
  /// A piece of work is done: an item of a loop of ThreadPool, a message.
  static void Note() noexcept { Count().fetch_add(1, std::memory_order_relaxed); }
  static std::uint64_t Noted() noexcept { return Count().load(std::memory_order_relaxed); }

  static Phase Now() noexcept { return Current().load(std::memory_order_relaxed); }
  /// Odd while the drawing thread waits for other ranks; another number for each time.
  static std::uint32_t Waits() noexcept { return Waited().load(std::memory_order_relaxed); }

private:
  friend class PhaseScope;
  friend class WaitScope;
  static std::atomic<std::uint64_t>& Count() noexcept;
  static std::atomic<Phase>& Current() noexcept;
  static std::atomic<std::uint32_t>& Waited() noexcept;
};

/// The phase of the process while an object lives; the one before comes back with its end. Only one
/// thread draws for a process; objects of others, at the same time, have no effect (simulated
/// ranks).
class PhaseScope
{
public:
  explicit PhaseScope(Phase phase);
  ~PhaseScope();
  PhaseScope(const PhaseScope&) = delete;
  PhaseScope& operator=(const PhaseScope&) = delete;

private:
  bool Counts = false;
  bool First = false; ///< of its thread
  Phase Before = Phase::Outside;
};

/// Lives while the drawing thread waits for other ranks. Not to be nested.
class WaitScope
{
public:
  WaitScope() { ++Progress::Waited(); }
  ~WaitScope()
  {
    Progress::Note();
    ++Progress::Waited();
  }
  WaitScope(const WaitScope&) = delete;
  WaitScope& operator=(const WaitScope&) = delete;
};

} // namespace banyan

#endif
