// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Watchdog_Heartbeat_h
#define banyan_Parallel_Watchdog_Heartbeat_h

#include "Parallel/Watchdog/RankState.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// Signs of life of the ranks of one machine, in memory that they share. A thread of each rank
/// writes its own ten times a second, whatever the other threads do; any rank may read them all. No
/// message is needed.
class Heartbeat
{
public:
  /// Makes memory for so many ranks. One of them does. Throws Error.
  /// @return its name, for all of them
  static std::string MakeMemory(int ranks);
  /// When all have opened it: it ends with the last of them, however they end.
  static void ForgetName(const std::string& name);

  /// Opens it and begins to give states. Throws Error.
  /// @param place of this rank in the memory
  /// @param rank its number in the job
  /// @param limitSeconds after which `lost` is called, once, by the thread that gives the states,
  /// when this rank does not get on (StallTimer) or another one is lost (LostRankDetector)
  Heartbeat(const std::string& name, int ranks, int place, int rank, double limitSeconds,
    std::function<void(const std::string& sentence)> lost);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

  std::size_t Place() const;
  std::vector<RankState> States() const;

private:
  struct Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace banyan

#endif
