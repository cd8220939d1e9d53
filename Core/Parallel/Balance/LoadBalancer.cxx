// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/LoadBalancer.h"

#include "Base/Error.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace banyan
{
namespace
{

/// Blocks of costs, at most: each is looked at in each frame.
constexpr std::int64_t MostBlocks = 4096;
/// By which the expected imbalance must fall for planes to move.
constexpr double LeastGain = 0.03;
/// So many bytes may change ranks before a frame, or this part of what is drawn if that is more.
constexpr double BytesInAnyCase = 32.0 * 1048576.0;
constexpr double MostPart = 0.5;
/// Axes that were chosen anew stay for so many frames, unless the view rests.
constexpr int FramesBetweenTurns = 8;

ZoneTree FirstZones(const LoadBalancer::Options& options)
{
  const int brick = options.BrickPositions;
  if (brick < 1)
  {
    throw Error("A brick is at least one position thick.");
  }
  if (!options.Start.Nodes.empty())
  {
    if (options.Start.Ranks() != options.Ranks || options.Start.Positions != options.Positions)
    {
      throw Error("The zones to begin with are those of another grid.");
    }
    return options.Start;
  }
  const glm::ivec3 bricks = (options.Positions + brick - 1) / brick;
  return Refined(EqualZoneTree(bricks, options.Ranks), brick, options.Positions);
}

double SumOf(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0);
}

} // namespace

int BlockEdgeFor(const glm::ivec3& positions)
{
  int edge = 8;
  while (Box{ glm::ivec3(0), (positions + edge - 1) / edge }.Count() > MostBlocks)
  {
    edge *= 2;
  }
  return edge;
}

LoadBalancer::LoadBalancer(const Options& options)
  : Settings(options)
  , Zones(FirstZones(options))
  , Density(BrickCosts(options.Positions, options.BlockEdge).Values.size(), -1.0)
  , Speeds(options.Ranks)
{
}

void LoadBalancer::BeginFrame(const BrickCosts& view, const ScreenCuts* cuts)
{
  this->Moved = 0.0;
  if (view.Positions != this->Settings.Positions || view.Edge != this->Settings.BlockEdge ||
      view.Values.size() != this->Density.size())
  {
    throw Error("The visible parts belong to another grid than the zones.");
  }
  if (this->MeanDensity >= 0.0)
  {
    this->MovePlanes(view, cuts);
  }
  else if (cuts)
  {
    // Nothing is where it would have to be moved from.
    this->Zones = TurnedTree(this->Zones, CostSums(view), this->Speeds.CostsPerSecond(),
      this->Settings.PlaneStep, *cuts, WorkPerCutRay);
  }
  this->View = view.Values;
  this->Cuts = cuts ? std::make_optional(*cuts) : std::nullopt;
}

double LoadBalancer::MostBytes(double drawn)
{
  return std::max(BytesInAnyCase, MostPart * drawn);
}

void LoadBalancer::MovePlanes(const BrickCosts& view, const ScreenCuts* cuts)
{
  // Planes may look different even where as much is seen of each block.
  const bool sameCuts = cuts ? this->Cuts && *this->Cuts == *cuts : !this->Cuts;
  const bool rests = view.Values == this->View && sameCuts;
  if (!rests)
  {
    this->Trials.Forget();
  }
  const BrickCosts costs = this->ExpectedCosts(view);
  const CostSums sums(costs);
  const CostSums bytes(this->DrawnBytes(costs));
  ZoneTree next = this->NextTree(costs, bytes);
  // The first frame of a new view shows what it takes, and other axes may be better than the
  // expected ones.
  const bool isNewlyKnown = rests && !this->ViewWasResting;
  this->ViewWasResting = rests;
  if (cuts && (isNewlyKnown || (this->TurnCooldown == 0 && this->Trials.GetBetter())))
  {
    if (std::optional<ZoneTree> turned = this->TurnedTreeFor(sums, *cuts, next))
    {
      next = std::move(*turned);
      this->TurnCooldown = FramesBetweenTurns + 1;
    }
  }
  this->TurnCooldown = std::max(0, this->TurnCooldown - 1);
  this->Moved = MovedBetween(this->Zones, next, bytes);
  this->Zones = std::move(next);
  this->Expected = banyan::ExpectedImbalance(this->Zones, sums, this->Speeds.CostsPerSecond());
}

/// The planes that are next, with the axes of now, as far as bytes allow.
ZoneTree LoadBalancer::NextTree(const BrickCosts& costs, const CostSums& bytes) const
{
  const int step = this->Settings.PlaneStep;
  const std::vector<double> speeds = this->Speeds.CostsPerSecond();
  const ZoneTree next = this->Trials.Next(this->Zones, this->Speeds.WorkPerSecond(), step,
    [&](const ZoneTree& tree)
    { return RebalanceMeasuredCost(tree, costs, speeds, LeastGain, step); });
  return WithinBytes(this->Zones, next, bytes, MostBytes(bytes.Total()), step);
}

/// A tree with other axes, if that is much better than one that was only moved.
std::optional<ZoneTree> LoadBalancer::TurnedTreeFor(
  const CostSums& costs, const ScreenCuts& cuts, const ZoneTree& moved) const
{
  const std::vector<double> speeds = this->Speeds.CostsPerSecond();
  // The costs have those rays in them that the planes cut now.
  const double uncut =
    std::max(0.0, costs.Total() - WorkPerCutRay * RaysCut(this->Zones, costs, cuts));
  const auto slowest = [&](const ZoneTree& tree)
  {
    return banyan::ExpectedImbalance(tree, costs, speeds) *
           (uncut + WorkPerCutRay * RaysCut(tree, costs, cuts));
  };
  ZoneTree turned =
    TurnedTree(this->Zones, costs, speeds, this->Settings.PlaneStep, cuts, WorkPerCutRay);
  return this->Settings.TurnGain * slowest(turned) < slowest(moved)
           ? std::make_optional(std::move(turned))
           : std::nullopt;
}

BrickCosts LoadBalancer::ExpectedCosts(const BrickCosts& view) const
{
  BrickCosts costs = view;
  for (std::size_t i = 0; i < costs.Values.size(); ++i)
  {
    costs.Values[i] *= this->Density[i] < 0.0 ? this->MeanDensity : this->Density[i];
  }
  return costs;
}

/// Returns the bytes that moving each block takes. A block where nothing is drawn takes none, for
/// it is not even read.
BrickCosts LoadBalancer::DrawnBytes(BrickCosts costs) const
{
  for (std::size_t i = 0; i < costs.Values.size(); ++i)
  {
    costs.Values[i] = costs.Values[i] > 0.0 ? static_cast<double>(costs.PositionsOf(i).Count()) *
                                                this->Settings.BytesPerPosition
                                            : 0.0;
  }
  return costs;
}

void LoadBalancer::FrameTook(const std::vector<RankWork>& ranks, const BrickCosts& work)
{
  if (ranks.size() != static_cast<std::size_t>(this->Settings.Ranks) ||
      work.Values.size() != this->Density.size())
  {
    throw Error("The measured frame belongs to other zones.");
  }
  if (std::none_of(
        ranks.begin(), ranks.end(), [](const RankWork& rank) { return rank.Seconds > 0.0; }))
  {
    return; // nothing was drawn
  }
  const CostSums sums(work);
  std::vector<double> zoneCosts;
  zoneCosts.reserve(ranks.size());
  for (const Box& zone : ZonesOf(this->Zones))
  {
    zoneCosts.push_back(sums.In(zone));
  }
  if (this->Speeds.Learn(ranks, zoneCosts))
  {
    this->Trials.Forget();
  }
  std::vector<double> done;
  done.reserve(ranks.size());
  for (const RankWork& rank : ranks)
  {
    done.push_back(rank.Work);
  }
  this->Trials.Measured(this->Zones, done, this->Speeds.WorkPerSecond());
  this->LearnDensities(work);
}

void LoadBalancer::LearnDensities(const BrickCosts& work)
{
  const double seen = SumOf(this->View);
  const double done = SumOf(work.Values);
  this->MeanDensity = seen > 0.0 && done > 0.0 ? done / seen : 1.0;
  for (std::size_t i = 0; i < this->View.size(); ++i)
  {
    if (this->View[i] > 0.0)
    {
      this->Density[i] = work.Values[i] / this->View[i];
    }
  }
}

} // namespace banyan
