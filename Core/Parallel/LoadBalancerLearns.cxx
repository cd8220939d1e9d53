// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/LoadBalancer.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Moves that made a frame's imbalance worse by more than this factor count as mistakes, twice;
/// those that made it better make up for one.
constexpr double MistakeFactor = 1.05;
constexpr int MostMistakes = 10;
/// Weight of a new frame in the errors of expectations.
constexpr double ErrorWeight = 0.4;
/// Weight of a new frame in the speed of a rank, once it is known: noise must not move planes.
constexpr double SpeedWeight = 0.1;
/// Seconds that differ from those of a rank so far by more than this factor are a change when they
/// come three times, and a disturbance when they come less often: where every frame is off by a
/// fifth, two such ones follow each other now and then. By a larger one, twice is enough.
constexpr double OutlierFactor = 1.5;
constexpr double LargeFactor = 2.5;
/// A rank's speed is not learned from less than this part of the ranks' mean work.
constexpr double LeastPart = 0.1;

double Median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

void LoadBalancer::LearnSpeeds(const std::vector<RankWork>& ranks, const BrickCosts& work)
{
  double all = 0.0;
  for (const RankWork& rank : ranks)
  {
    all += rank.Work;
  }
  const double least = LeastPart * all / static_cast<double>(ranks.size());
  std::vector<double> known;
  for (const RankWork& rank : ranks)
  {
    if (rank.Work > least && rank.Seconds > 0.0)
    {
      known.push_back(rank.Seconds / rank.Work);
    }
  }
  if (known.empty())
  {
    return;
  }
  const double median = Median(known);
  const CostSums sums(work);
  const std::vector<Box> zones = ZonesOf(this->Zones);
  for (std::size_t i = 0; i < ranks.size(); ++i)
  {
    Pace& pace = this->Paces[i];
    if (!(ranks[i].Work > least) || !(ranks[i].Seconds > 0.0))
    {
      pace.Share = 1.0;
      continue;
    }
    pace.Share = std::clamp(sums.In(zones[i]) / ranks[i].Work, 0.5, 2.0);
    const double now = ranks[i].Seconds / ranks[i].Work / median;
    const double factor = now / pace.SecondsPerWork;
    const bool outlier = factor > OutlierFactor || factor < 1.0 / OutlierFactor;
    if (!outlier)
    {
      const double weight = std::max(SpeedWeight, 1.0 / (pace.Frames + 1));
      pace.SecondsPerWork += weight * (now - pace.SecondsPerWork);
      ++pace.Frames;
    }
    const bool again = pace.Outlier > 0.0 && (pace.Outlier > pace.SecondsPerWork) == (factor > 1.0);
    const bool large = factor > LargeFactor || factor < 1.0 / LargeFactor;
    pace.Outliers = !outlier ? 0 : again ? pace.Outliers + 1 : 1;
    if (pace.Outliers >= (large ? 2 : 3))
    {
      pace.SecondsPerWork = 0.5 * (now + pace.Outlier);
      pace.Frames = 2;
    }
    pace.Outlier = outlier ? now : 0.0;
  }
}

/// How wrong each expectation was about the work of the zones.
void LoadBalancer::LearnErrors(const BrickCosts& work)
{
  if (this->Costs[FromView].empty())
  {
    return;
  }
  const std::vector<double> speeds(this->Paces.size(), 1.0);
  const auto parts = [&](const BrickCosts& costs)
  {
    const CostSums sums(costs);
    std::vector<double> zones = ExpectedSeconds(this->Zones, sums, speeds);
    for (double& zone : zones)
    {
      zone *= sums.Total() > 0.0 ? static_cast<double>(zones.size()) / sums.Total() : 0.0;
    }
    return zones;
  };
  const std::vector<double> truth = parts(work);
  for (std::size_t way = 0; way < Expectations; ++way)
  {
    const std::vector<double> expected = parts(this->CostsOf(this->Costs[way]));
    double error = 0.0;
    for (std::size_t rank = 0; rank < truth.size(); ++rank)
    {
      error = std::max(error, std::abs(expected[rank] - truth[rank]));
    }
    this->Errors[way] += (this->Frames <= 1 ? 1.0 : ErrorWeight) * (error - this->Errors[way]);
  }
}

/// Whether it would have been better not to move planes.
void LoadBalancer::LearnMistakes(const BrickCosts& work)
{
  if (this->Moving)
  {
    const CostSums sums(work);
    const double stayed = banyan::ExpectedImbalance(this->Before, sums, this->Speeds());
    const double moved = banyan::ExpectedImbalance(this->Zones, sums, this->Speeds());
    const int change = moved > MistakeFactor * stayed ? 2 : moved < stayed ? -1 : 0;
    this->Mistakes = std::clamp(this->Mistakes + change, 0, MostMistakes);
  }
}

} // namespace banyan
