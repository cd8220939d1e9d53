// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/RankSpeeds.h"

#include <algorithm>
#include <cstddef>

namespace banyan
{
namespace
{

/// Weight of a new frame in the speed of a rank.
constexpr double SpeedWeight = 1.0 / 32.0;
/// Seconds that differ from those of a rank so far by more than this factor, so many times one
/// after the other, are a change. Fewer are a disturbance, and count for nothing.
constexpr double ChangeFactor = 1.5;
constexpr int ChangeFrames = 3;
/// Nothing is learned from less than this part of the mean work of the ranks: other things than
/// samples take most of the time then.
constexpr double LeastPart = 0.1;

double Median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

bool RankSpeeds::Learn(const std::vector<RankWork>& ranks, const std::vector<double>& zoneCosts)
{
  double all = 0.0;
  for (const RankWork& rank : ranks)
  {
    all += rank.Work;
  }
  const double least = LeastPart * all / static_cast<double>(ranks.size());
  const auto tells = [least](const RankWork& rank)
  { return rank.Work > least && rank.Seconds > 0.0; };
  std::vector<double> known;
  for (const RankWork& rank : ranks)
  {
    if (tells(rank))
    {
      known.push_back(rank.Seconds / rank.Work);
    }
  }
  const double median = known.empty() ? 1.0 : Median(known);
  bool changed = false;
  for (std::size_t i = 0; i < ranks.size(); ++i)
  {
    Speed& speed = this->Ranks[i];
    speed.CostsPerWork = 1.0;
    if (tells(ranks[i]))
    {
      speed.CostsPerWork = zoneCosts[i] > 0.0 ? zoneCosts[i] / ranks[i].Work : 1.0;
      changed = Average(speed, ranks[i].Seconds / ranks[i].Work / median) || changed;
    }
  }
  return changed;
}

/// @return whether it has changed much
bool RankSpeeds::Average(Speed& speed, double now)
{
  const double factor = now / speed.SecondsPerWork;
  if (factor <= ChangeFactor && factor >= 1.0 / ChangeFactor)
  {
    const double weight = std::max(SpeedWeight, 1.0 / (speed.Frames + 1));
    speed.SecondsPerWork += weight * (now - speed.SecondsPerWork);
    ++speed.Frames;
    speed.ChangedFrames = 0;
    return false;
  }
  const bool wasSlower = speed.ChangedSum > speed.ChangedFrames * speed.SecondsPerWork;
  if (speed.ChangedFrames == 0 || wasSlower != (factor > 1.0))
  {
    speed.ChangedSum = 0.0;
    speed.ChangedFrames = 0;
  }
  speed.ChangedSum += now;
  if (++speed.ChangedFrames < ChangeFrames)
  {
    return false;
  }
  speed.SecondsPerWork = speed.ChangedSum / ChangeFrames;
  speed.Frames = ChangeFrames;
  speed.ChangedFrames = 0;
  return true;
}

std::vector<double> RankSpeeds::WorkPerSecond() const
{
  std::vector<double> speeds;
  for (const Speed& speed : this->Ranks)
  {
    speeds.push_back(1.0 / speed.SecondsPerWork);
  }
  return speeds;
}

std::vector<double> RankSpeeds::CostsPerSecond() const
{
  std::vector<double> speeds;
  for (const Speed& speed : this->Ranks)
  {
    speeds.push_back(speed.CostsPerWork / speed.SecondsPerWork);
  }
  return speeds;
}

} // namespace banyan
