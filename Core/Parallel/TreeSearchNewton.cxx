// SPDX-License-Identifier: BSD-3-Clause
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

} // namespace banyan
