// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Watchdog/RankState.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

double StallTimer::Tick(double seconds, double processorSeconds, bool working, std::uint64_t noted)
{
  constexpr double busy = 0.3;     // of a processor
  constexpr double allowance = 10; // times the limit, for a rank that waits for something else
  if (!working || noted != this->Last)
  {
    this->Last = noted;
    this->Stalled = 0;
    return 0;
  }
  const double counted = std::min(seconds, LostRankDetector::LongestTick);
  this->Stalled += processorSeconds >= busy * seconds ? counted : counted / allowance;
  return this->Stalled;
}

std::string LostRankDetector::Sentence(
  const RankState& rank, double seconds, const std::string& why) const
{
  return "Rank " + std::to_string(rank.Rank) + " (process " + std::to_string(rank.Process) + ") " +
         why + " for " + std::to_string(std::lround(seconds)) +
         " s; the last thing known is that it was " + NameOf(rank.Doing) + ".";
}

std::string LostRankDetector::Tick(
  double seconds, std::size_t self, const std::vector<RankState>& states, bool waiting)
{
  const double counted = std::min(seconds, LongestTick);
  this->Before.resize(states.size());
  bool allWait = this->All;
  for (std::size_t i = 0; i < states.size(); ++i)
  {
    const RankState& rank = states[i];
    Seen& before = this->Before[i];
    allWait = allWait && rank.Waits % 2 == 1 && rank.Waits == before.Waits;
    before.Waits = rank.Waits;
    before.Silent = rank.Beats == before.Beats ? before.Silent + counted : 0.0;
    before.Beats = rank.Beats;
    if (i == self || rank.Rank < 0 || (rank.Ended && !waiting))
    {
      continue;
    }
    if (before.Silent >= this->Limit)
    {
      return this->Sentence(rank, before.Silent, "has given no sign of life");
    }
    if (rank.StallMilliseconds >= 1e3 * this->Limit)
    {
      return this->Sentence(rank, 1e-3 * rank.StallMilliseconds, "runs, but has not got on");
    }
  }
  this->AllWait = allWait ? this->AllWait + counted : 0.0;
  if (this->AllWait >= this->Limit)
  {
    return "All ranks have waited for each other for " +
           std::to_string(std::lround(this->AllWait)) + " s, and no message came.";
  }
  return {};
}

} // namespace banyan
