#include "Parallel/TreeSearch.h"

#include "Parallel/Rebalance.h"
#include "Parallel/ZoneDivision.h"
#include "Series/AsinhMath.h"

#include <algorithm>
#include <cmath>
#include <functional>
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
/// rank whose speed is another one by this factor begins it at once: noise of single frames, a
/// fifth say, is less in the speeds that are smoothed.
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
/// No logarithm of a ratio changes by more at once, nor by more than this part of the largest one,
/// and none goes all of its way: planes move at the same time, and those of children follow those
/// of their parents. Each trial that was no better shortens the next step.
constexpr double LongestStep = 0.7;
constexpr double LongestPart = 1.2;
constexpr double PartOfStep = 0.8;
constexpr double Shortened = 0.7;
/// Steps that ratios hardly followed, in this part of what the model expected, tell nothing: the
/// next one would be too long.
constexpr double LeastSlope = 0.3;
/// Of a plane's way: so many times what a ratio would move it by if the work were spread evenly.
/// Where a zone hides what lies behind, the model has gaps, and planes would jump over them.
constexpr double LongestWay = 2.0;
/// Where a side has hardly any work its ratio is cut off, in parts of the mean.
constexpr double LeastWork = 0.02;

double Dot(const std::vector<double>& a, const std::vector<double>& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<double> Difference(std::vector<double> a, const std::vector<double>& b)
{
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::minus<>());
  return a;
}

std::vector<double> ExpectedWork(const ZoneTree& tree, const CostSums& model)
{
  return ExpectedSeconds(
    tree, model, std::vector<double>(static_cast<std::size_t>(tree.Ranks()), 1.0));
}

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

/// The smallest box around all blocks that cost something.
Box CostlyPart(const BrickCosts& costs)
{
  Box all{ costs.Positions, glm::ivec3(0) };
  for (std::size_t i = 0; i < costs.Values.size(); ++i)
  {
    if (costs.Values[i] > 0.0)
    {
      const Box block = costs.PositionsOf(i);
      all = { glm::min(all.Lo, block.Lo), glm::max(all.Hi, block.Hi) };
    }
  }
  return all;
}

/// ln(r) and e^y, the same bits on every processor, which those of a library need not be: all ranks
/// must come to the same tree.
double Logarithm(double r)
{
  return asinh_math::ForwardOfAny(0.5 * (r - 1.0 / r), 1.0);
}
double Exponential(double y)
{
  const double sinh = asinh_math::Inverse(y, 1.0);
  return y < 0.0 ? 1.0 / (std::sqrt(sinh * sinh + 1.0) - sinh)
                 : std::sqrt(sinh * sinh + 1.0) + sinh;
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

TreeSearch::Ratios TreeSearch::RatiosOf(
  const ZoneTree& tree, const std::vector<double>& work, const std::vector<double>& speeds)
{
  const std::vector<double> workOf = SumsOfNodes(tree, work);
  const std::vector<double> speedOf = SumsOfNodes(tree, speeds);
  const double least = LeastWork * workOf.front() / speedOf.front();
  Ratios ratios(tree.Nodes.size(), 0.0);
  for (std::size_t number = 0; number < ratios.size() && least > 0.0; ++number)
  {
    const ZoneTree::Node& node = tree.Nodes[number];
    if (!node.IsLeaf())
    {
      const auto seconds = [&](int child)
      {
        const auto at = static_cast<std::size_t>(child);
        return std::max(workOf[at] / speedOf[at], least);
      };
      ratios[number] = Logarithm(seconds(node.Below) / seconds(node.Above));
    }
  }
  return ratios;
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

/// How the model's ratios of a trial should change for the true ones to be 0.
TreeSearch::Ratios TreeSearch::NewtonStep(std::size_t from, const std::vector<double>& speeds) const
{
  // The inverse Jacobian begins as the identity, and each step that was measured adds a matrix of
  // rank one: Change times the transpose of Step.
  struct Update
  {
    Ratios Change;
    Ratios Step;
  };
  std::vector<Update> updates;
  const auto times = [&](Ratios vector)
  {
    for (const Update& update : updates)
    {
      const double along = Dot(update.Step, vector);
      for (std::size_t i = 0; i < vector.size(); ++i)
      {
        vector[i] += along * update.Change[i];
      }
    }
    return vector;
  };
  const Trial& base = this->Trials[from];
  const auto expected = [&](const Trial& trial)
  { return RatiosOf(trial.Tree, trial.Model, speeds); };
  const auto found = [&](const Trial& trial) { return RatiosOf(trial.Tree, trial.Work, speeds); };
  for (std::size_t i = 0; i < this->Trials.size(); ++i)
  {
    const Trial& trial = this->Trials[i];
    if (i == from || !NestAlike(trial.Tree, base.Tree))
    {
      continue;
    }
    Ratios step = Difference(expected(trial), expected(base));
    const Ratios change = times(Difference(found(trial), found(base)));
    const double along = Dot(step, change);
    if (along < LeastSlope * Dot(step, step) || !(Dot(step, step) > 0.0))
    {
      continue; // it says too little
    }
    Ratios wrong = Difference(step, change);
    for (double& value : wrong)
    {
      value /= along;
    }
    updates.push_back({ std::move(wrong), std::move(step) });
  }
  const Ratios now = found(base);
  double most = 0.0;
  for (const double ratio : now)
  {
    most = std::max(most, std::abs(ratio));
  }
  double shortened = 1.0;
  for (int failure = 0; failure < this->Failures; ++failure)
  {
    shortened *= Shortened;
  }
  most = shortened * std::min(LongestStep, LongestPart * most);
  Ratios step = times(now);
  for (double& value : step)
  {
    value = std::clamp(-PartOfStep * shortened * value, -most, most);
  }
  return step;
}

/// A tree whose planes have these ratios by the model; none if it has been tried.
std::optional<ZoneTree> TreeSearch::PlanesAt(const ZoneTree& from, const Ratios& ratios,
  const CostSums& model, const std::vector<double>& speeds, int step) const
{
  const std::vector<double> speedOf = SumsOfNodes(from, speeds);
  const Ratios before = RatiosOf(from, ExpectedWork(from, model), speeds);
  const Box costly = CostlyPart(this->Model);
  ZoneTree tree = from;
  std::vector<Box> zones(tree.Nodes.size());
  zones.front() = tree.Whole();
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    ZoneTree::Node& node = tree.Nodes[number];
    if (!node.IsLeaf())
    {
      const Division division(model, zones[number], node.Axis, step,
        speedOf[static_cast<std::size_t>(node.Below)] * Exponential(ratios[number]),
        speedOf[static_cast<std::size_t>(node.Above)]);
      // ln(b / a) changes by four times what the middle of b + a = 1 does.
      const Box part = Intersection(zones[number], costly);
      const double change = std::abs(ratios[number] - before[number]);
      const double way = LongestWay * 0.25 * change * std::max(0, part.Size()[node.Axis]);
      const int most = step * std::max(1, static_cast<int>(std::lround(way / step)));
      const int now =
        std::clamp(node.Plane, zones[number].Lo[node.Axis], zones[number].Hi[node.Axis]);
      node.Plane = std::clamp(division.Best(now), now - most, now + most);
      Cut(zones[number], node, zones);
    }
  }
  return this->Find(tree) ? std::nullopt : std::optional<ZoneTree>(tree);
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
  if (this->Kept)
  {
    return this->KeepOn(speeds);
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

/// A tree whose planes stand where true ratios are expected to be 0; none if it has been tried.
std::optional<ZoneTree> TreeSearch::NewtonTree(
  std::size_t from, const std::vector<double>& speeds, int step)
{
  const CostSums sums(this->Model);
  for (Trial& trial : this->Trials)
  {
    trial.Model = ExpectedWork(trial.Tree, sums);
  }
  const Trial& base = this->Trials[from];
  Ratios ratios = RatiosOf(base.Tree, base.Model, speeds);
  const Ratios change = this->NewtonStep(from, speeds);
  std::transform(ratios.begin(), ratios.end(), change.begin(), ratios.begin(), std::plus<>());
  return this->PlanesAt(base.Tree, ratios, sums, speeds, step);
}

/// The tree that the search ended with, unless a rank has become slower.
std::optional<ZoneTree> TreeSearch::KeepOn(const std::vector<double>& speeds)
{
  const Trial& kept = this->Trials[*this->Kept];
  if (this->KeptFrames == 0)
  {
    this->KeptSpeeds = speeds;
  }
  this->KeptFrames = std::min(this->KeptFrames + 1, 2 * FramesOfSpeeds);
  bool other = false;
  for (std::size_t rank = 0; rank < speeds.size(); ++rank)
  {
    double& usual = this->KeptSpeeds[rank];
    other = other || speeds[rank] > OtherSpeed * usual || usual > OtherSpeed * speeds[rank];
    usual += (speeds[rank] - usual) / this->KeptFrames;
  }
  const bool worse = this->KeptFrames >= FramesOfSpeeds &&
                     Imbalance(kept.Work, this->KeptSpeeds) > this->BestSoFar + Worse;
  if (other || worse)
  {
    this->Forget();
    return std::nullopt;
  }
  return kept.Tree;
}

} // namespace banyan
