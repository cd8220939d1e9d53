// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Watchdog_RankState_h
#define banyan_Parallel_Watchdog_RankState_h

#include "Base/Progress.h"

#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{

/// Holds what can be seen of a rank from outside.
struct RankState
{
  int Rank = -1;                       ///< -1: it has not begun to give signs
  int Process = 0;                     ///< number of the process
  std::uint32_t Beats = 0;             ///< changes while the process runs
  std::uint32_t Waits = 0;             ///< Progress::Waits
  std::uint32_t StallMilliseconds = 0; ///< StallTimer::Tick
  Phase Doing = Phase::Outside;
  bool Ended = false; ///< in good order: it gives no signs any more
};

/// Seconds for which a process that is drawing has not got on, as far as its own loops and messages
/// tell. Only time in which the process uses a processor counts fully: who waits for a disk uses
/// none, and gets ten times as long.
class StallTimer
{
public:
  /// @param seconds since the last tick
  /// @param processorSeconds that the process used in them, of all threads
  /// @param working whether it draws and does not wait for other ranks
  /// @param noted Progress::Noted
  /// @return seconds
  double Tick(double seconds, double processorSeconds, bool working, std::uint64_t noted);

private:
  std::uint64_t Last = 0;
  double Stalled = 0;
};

/// Finds out that a rank will not do what others wait for, by what can be seen of it from tick to
/// tick. Time is counted in ticks, and long ones count as short ones: when all ranks are stopped
/// together and go on later, none of them has been silent.
class LostRankDetector
{
public:
  static constexpr double LongestTick = 0.5;

  /// @param limitSeconds that a rank may be silent, or not get on
  /// @param all whether all ranks that there are can be seen
  LostRankDetector(double limitSeconds, bool all)
    : Limit(limitSeconds)
    , All(all)
  {
  }

  /// @param waiting whether this rank waits for the others: then it misses those that have ended,
  /// too
  /// @param seconds since the last tick
  /// @param self which of the states are the own ones
  /// @param states in the same order each time
  /// @return empty; or a sentence that says which rank is lost, what it was doing and for how long
  std::string Tick(
    double seconds, std::size_t self, const std::vector<RankState>& states, bool waiting = true);

private:
  struct Seen
  {
    std::uint32_t Beats = 0;
    std::uint32_t Waits = 0;
    double Silent = 0;
  };

  std::string Sentence(const RankState& rank, double seconds, const std::string& why) const;

  double Limit;
  bool All;
  std::vector<Seen> Before;
  double AllWait = 0;
};

} // namespace banyan

#endif
