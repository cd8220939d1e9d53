// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/PlaneTrials.h"

#include "Parallel/Balance/Rebalance.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace banyan
{
namespace
{

/// Trees that were no better, after which the best one stays.
constexpr int MostTrials = 12;
/// An imbalance for which trees that are expected to be no better need not be tried.
constexpr double GoodEnough = 1.2;

double SlowestSeconds(const std::vector<double>& work, const std::vector<double>& speeds)
{
  double slowest = 0.0;
  for (std::size_t rank = 0; rank < work.size(); ++rank)
  {
    slowest = std::max(slowest, work[rank] / speeds[rank]);
  }
  return slowest;
}

/// Seconds of the slowest rank over those that any tree could have.
double Imbalance(const std::vector<double>& work, const std::vector<double>& speeds)
{
  const double all = std::accumulate(work.begin(), work.end(), 0.0);
  const double speed = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  return all > 0.0 ? SlowestSeconds(work, speeds) * speed / all : 1.0;
}

/// Positions that a plane goes at most.
int LongestWay(const ZoneTree& from, const ZoneTree& to)
{
  int longest = 0;
  for (std::size_t number = 0; number < from.Nodes.size(); ++number)
  {
    longest = std::max(longest, std::abs(to.Nodes[number].Plane - from.Nodes[number].Plane));
  }
  return longest;
}

} // namespace

void PlaneTrials::Measured(
  const ZoneTree& tree, const std::vector<double>& work, const std::vector<double>& speeds)
{
  const bool isBest = !this->Best || tree == this->Best->Tree ||
                      SlowestSeconds(work, speeds) < SlowestSeconds(this->Best->Work, speeds);
  if (isBest)
  {
    this->Best = Trial{ tree, work };
  }
  else
  {
    ++this->Failures;
  }
}

ZoneTree PlaneTrials::Next(const ZoneTree& now, const std::vector<double>& speeds, int step,
  const std::function<ZoneTree(const ZoneTree&)>& balanced) const
{
  if (!this->Best)
  {
    return balanced(now);
  }
  const ZoneTree& best = this->Best->Tree;
  ZoneTree target = balanced(best);
  if (this->Failures == 0 || target == best)
  {
    return target;
  }
  const double part = std::exp2(-this->Failures);
  if (LongestWay(best, target) * part >= step)
  {
    return PartOfTheWay(best, target, part, step);
  }
  const bool isGoodEnough = Imbalance(this->Best->Work, speeds) <= GoodEnough;
  return isGoodEnough || this->Failures >= MostTrials ? best : balanced(now);
}

} // namespace banyan
