// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/TreeSearch.h"

#include "Parallel/Rebalance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace banyan
{
namespace
{

/// Work of a rank that differs by more than this part of the ranks' mean is not the same.
constexpr double SameWork = 0.05;
constexpr int MostDoubts = 6;
/// An imbalance at which nobody searches, and one at which a search ends.
constexpr double SearchAbove = 1.06;
constexpr double GoodEnough = 1.02;
/// By which the imbalance must fall for a tree to be better.
constexpr double LeastGain = 0.005;
/// Trees of somebody else that take so much less time than all before lead on: the search waits.
constexpr double GainThatLeadsOn = 0.1;
/// By which it must rise, by the average speeds of so many frames, for the search to begin anew. A
/// rank whose speed is another one by this factor begins it at once, whether the search has ended
/// or not: noise of single frames, a fifth say, is less in the speeds that are smoothed.
constexpr double Worse = 0.1;
constexpr int FramesOfSpeeds = 32;
constexpr double OtherSpeed = 1.4;
/// How much is tried: little, for a trial may be a frame that takes longer; more where a view has
/// rested for some trials and still is far from balance.
struct Patience
{
  int Failures;       ///< trials without a better tree that end a search
  std::size_t Trials; ///< that do in any case
  int NewtonFailures; ///< after which all planes go one step
};
constexpr Patience Usual{ 8, 17, 2 };
constexpr Patience WhereItIsFar{ 12, 50, 6 };
constexpr std::size_t LateTrials = 8;
constexpr double FarFromBalance = 1.1;

double Slowest(const std::vector<double>& work, const std::vector<double>& speeds)
{
  double slowest = 0.0;
  for (std::size_t rank = 0; rank < work.size(); ++rank)
  {
    slowest = std::max(slowest, work[rank] / speeds[rank]);
  }
  return slowest;
}

/// Slowest over what no tree could beat.
double Imbalance(const std::vector<double>& work, const std::vector<double>& speeds)
{
  const double all = std::accumulate(work.begin(), work.end(), 0.0);
  const double speed = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  return all > 0.0 ? Slowest(work, speeds) * speed / all : 1.0;
}

} // namespace

void TreeSearch::Forget()
{
  this->Trials.clear();
  this->BestSoFar = 0.0;
  this->Failures = 0;
  this->Model = {};
  this->Kept.reset();
  this->KeptFrames = 0;
  this->UsualSpeeds.clear();
  this->SpeedFrames = 0;
  this->Begun = false;
}

void TreeSearch::Measured(const ZoneTree& tree, const std::vector<double>& work)
{
  const Trial* const before = this->Find(tree);
  this->LastWasNew = !before;
  if (!before)
  {
    this->Trials.push_back({ tree, work, {} });
    return;
  }
  const double mean =
    std::accumulate(work.begin(), work.end(), 0.0) / static_cast<double>(work.size());
  bool same = true;
  for (std::size_t rank = 0; rank < work.size(); ++rank)
  {
    same = same && std::abs(work[rank] - before->Work[rank]) <= SameWork * mean;
  }
  this->Repeats = same;
  this->Doubts = same ? 0 : std::min(this->Doubts + 1, MostDoubts);
  if (!same)
  {
    this->Wait = 1 << this->Doubts;
    this->Forget();
    this->Trials.push_back({ tree, work, {} });
  }
}

std::size_t TreeSearch::Best(const std::vector<double>& speeds) const
{
  std::size_t best = 0;
  for (std::size_t i = 1; i < this->Trials.size(); ++i)
  {
    if (Slowest(this->Trials[i].Work, speeds) < Slowest(this->Trials[best].Work, speeds))
    {
      best = i;
    }
  }
  return best;
}

/// Whether the last frame had a new tree, and it took much less than those before.
bool TreeSearch::GotBetter(std::size_t best, const std::vector<double>& speeds) const
{
  if (!this->LastWasNew || best + 1 != this->Trials.size())
  {
    return false;
  }
  const double now = Slowest(this->Trials[best].Work, speeds);
  return std::all_of(this->Trials.begin(), this->Trials.end() - 1,
    [&](const Trial& before)
    { return now < (1.0 - GainThatLeadsOn) * Slowest(before.Work, speeds); });
}

std::optional<ZoneTree> TreeSearch::Next(
  const BrickCosts& model, const std::vector<double>& speeds, int step)
{
  if (this->Wait > 0)
  {
    --this->Wait;
    return std::nullopt;
  }
  if (this->Trials.empty())
  {
    return std::nullopt;
  }
  if (this->SpeedsAreOthers(speeds))
  {
    this->Forget();
    return std::nullopt; // what is expected of costs leads there in fewer frames
  }
  if (this->Kept)
  {
    return this->KeepOn();
  }
  const std::size_t number = this->Best(speeds);
  const Trial& best = this->Trials[number];
  if (!this->Begun && this->GotBetter(number, speeds))
  {
    return std::nullopt; // what is expected of costs leads on
  }
  if (!this->Repeats)
  {
    return best.Tree; // once more
  }
  this->Begun = true;
  const double imbalance = Imbalance(best.Work, speeds);
  const bool begins = this->BestSoFar == 0.0;
  this->Failures = begins || imbalance < this->BestSoFar - LeastGain ? 0 : this->Failures + 1;
  this->BestSoFar = begins ? imbalance : std::min(imbalance, this->BestSoFar);
  const bool isFar = this->Trials.size() >= LateTrials && this->BestSoFar > FarFromBalance;
  const Patience& patience = isFar ? WhereItIsFar : Usual;
  if (imbalance <= (begins ? SearchAbove : GoodEnough) || this->Failures >= patience.Failures ||
      this->Trials.size() >= patience.Trials)
  {
    this->Kept = number;
    return best.Tree;
  }
  if (number + 1 == this->Trials.size() || this->Model.Values.empty())
  {
    this->Model = model;
  }
  std::optional<ZoneTree> next;
  if (this->Failures < patience.NewtonFailures)
  {
    next = this->NewtonTree(number, speeds, step);
  }
  else if (this->Failures == patience.NewtonFailures)
  {
    next = this->AllPlanesAStep(best, speeds, step);
  }
  next = next ? next : this->OnePlaneAway(best, speeds, step);
  if (!next)
  {
    this->Kept = number;
  }
  return next ? next : best.Tree;
}

/// Whether a rank has another speed than on average since the search knows of the view.
bool TreeSearch::SpeedsAreOthers(const std::vector<double>& speeds)
{
  this->UsualSpeeds = this->UsualSpeeds.empty() ? speeds : this->UsualSpeeds;
  this->SpeedFrames = std::min(this->SpeedFrames + 1, 2 * FramesOfSpeeds);
  bool others = false;
  for (std::size_t rank = 0; rank < speeds.size(); ++rank)
  {
    double& usual = this->UsualSpeeds[rank];
    others = others || speeds[rank] > OtherSpeed * usual || usual > OtherSpeed * speeds[rank];
    usual += (speeds[rank] - usual) / this->SpeedFrames;
  }
  return others;
}

/// The tree that the search ended with, unless ranks have slowly become slower.
std::optional<ZoneTree> TreeSearch::KeepOn()
{
  const Trial& kept = this->Trials[*this->Kept];
  this->KeptFrames = std::min(this->KeptFrames + 1, FramesOfSpeeds);
  if (this->KeptFrames == FramesOfSpeeds &&
      Imbalance(kept.Work, this->UsualSpeeds) > this->BestSoFar + Worse)
  {
    this->Forget();
    return std::nullopt;
  }
  return kept.Tree;
}

} // namespace banyan
