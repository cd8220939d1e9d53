// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/LoadBalancer.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace banyan
{
namespace
{

/// An imbalance at which planes begin to move, and one at which they stop.
constexpr double MoveAbove = 1.06;
constexpr double StopBelow = 1.02;
/// By which the imbalance must fall for planes to begin to move, and to go on.
constexpr double LeastGain = 0.03;
constexpr double LeastFurtherGain = 0.01;

/// What a ray that a plane cuts takes once more, in samples: it is made twice, and goes on behind
/// what would have ended it. See Documentation/balancing.md.
constexpr double WorkPerCutRay = 24.0;
/// Axes that were chosen anew stay for some frames, unless the view rests.
constexpr int FramesBetweenTurns = 8;

/// Mistakes after which it waits between moves.
constexpr int MistakesForgiven = 4;
/// A block's work is never expected to be so many times as much as that of others that are seen as
/// large.
constexpr double MostRatio = 8.0;

/// Weight of a new frame in averages over many.
constexpr double LongWeight = 1.0 / 16.0;

constexpr std::int64_t MostBlocks = 4096;

double UsualRatio(const std::vector<double>& work, const std::vector<double>& view)
{
  const double done = std::accumulate(work.begin(), work.end(), 0.0);
  const double seen = std::accumulate(view.begin(), view.end(), 0.0);
  return done > 0.0 && seen > 0.0 ? done / seen : 1.0;
}

ZoneTree FirstZones(const LoadBalancer::Options& options)
{
  const int slice = options.SlicePositions;
  if (slice < 1)
  {
    throw Error("A slice of bricks is at least one position thick.");
  }
  if (!options.Start.Nodes.empty())
  {
    if (options.Start.Ranks() != options.Ranks || options.Start.Positions != options.Positions)
    {
      throw Error("The zones to begin with are those of another grid.");
    }
    return options.Start;
  }
  const glm::ivec3 bricks = (options.Positions + slice - 1) / slice;
  return Refined(EqualZoneTree(bricks, options.Ranks), slice, options.Positions);
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
  , Paces(static_cast<std::size_t>(options.Ranks))
{
  const std::size_t blocks = BrickCosts(options.Positions, options.BlockEdge).Values.size();
  this->Ratio.assign(blocks, -1.0);
  this->OlderRatio.assign(blocks, -1.0);
  this->LongWork.assign(blocks, 0.0);
  this->LastWork = this->OlderWork = this->LongWork;
}

void LoadBalancer::BeginFrame(const BrickCosts& view, const ScreenCuts* cuts)
{
  this->Moved = 0.0;
  if (view.Positions != this->Settings.Positions || view.Edge != this->Settings.BlockEdge ||
      view.Values.size() != this->Ratio.size())
  {
    throw Error("What is seen belongs to another grid than the zones.");
  }
  if (this->Settings.Mode == LoadBalancing::SliceStep && this->Frames > 0)
  {
    this->MoveSlices();
  }
  else if (this->Settings.Mode == LoadBalancing::MeasuredCost && this->Frames > 0)
  {
    this->MoveToBalance(view, cuts);
  }
  else if (this->Settings.Mode == LoadBalancing::MeasuredCost && cuts)
  {
    // Nothing is where it would have to be moved from.
    this->Zones = TurnedTree(
      this->Zones, CostSums(view), this->Speeds(), this->Settings.PlaneStep, *cuts, WorkPerCutRay);
  }
  this->View = view.Values;
  this->Cuts = cuts ? std::make_optional(*cuts) : std::nullopt;
}

void LoadBalancer::MoveSlices()
{
  std::vector<double> seconds;
  for (const RankWork& rank : this->Last)
  {
    seconds.push_back(rank.Seconds);
  }
  const ZoneTree before = this->Zones;
  this->Zones = RebalanceSliceStep(before, seconds, this->Settings.SlicePositions);
  this->Moved = MovedBetween(before, this->Zones, CostSums(this->DrawnBytes(this->LastWork)));
}

void LoadBalancer::MoveToBalance(const BrickCosts& view, const ScreenCuts* cuts)
{
  this->Costs[FromView] = this->ExpectedFromView(view);
  this->Costs[FromLast] = this->LastWork;
  for (std::size_t i = 0; i < this->LastWork.size(); ++i)
  {
    this->Costs[FromLast][i] = 0.5 * (this->LastWork[i] + this->OlderWork[i]);
  }
  this->Costs[FromMany] = this->LongWork;
  const auto best =
    std::min_element(this->Errors.begin(), this->Errors.end()) - this->Errors.begin();
  const BrickCosts costs = this->CostsOf(this->Costs[static_cast<std::size_t>(best)]);
  const BrickCosts bytes = this->DrawnBytes(costs.Values);
  RebalanceLimits limits;
  limits.Tolerated = this->Moving ? StopBelow : MoveAbove;
  limits.LeastGain = this->Moving ? LeastFurtherGain : LeastGain;
  limits.PlaneStep = this->Settings.PlaneStep;
  limits.Bytes = &bytes;
  limits.MostBytes = std::max(this->Settings.MostBytes, 0.5 * CostSums(bytes).Total());
  if (this->Wait > 0)
  {
    --this->Wait;
    limits.Tolerated = std::numeric_limits<double>::infinity();
  }
  this->Before = this->Zones;
  // Planes may look different even where as much is seen of each block.
  const bool sameCuts = cuts ? this->Cuts && *this->Cuts == *cuts : !this->Cuts;
  const bool sameView = view.Values == this->View && sameCuts;
  if (!sameView)
  {
    this->Search.Forget();
  }
  else if (this->Settings.Searches && this->SearchPlanes(bytes, limits.MostBytes))
  {
    return;
  }
  Rebalanced next = RebalanceMeasuredCost(this->Zones, costs, this->Speeds(), limits);
  if (cuts && this->Wait == 0)
  {
    // What a new view takes is known after its first frame: axes need not be what was expected.
    this->Rest = sameView && !this->SameViewBefore ? 0 : this->Rest;
    this->Turn(costs, bytes, *cuts, next);
  }
  this->SameViewBefore = sameView;
  this->Moving = next.Tree != this->Zones;
  this->Zones = std::move(next.Tree);
  this->Moved = next.BytesMoved;
  this->Expected = next.After;
  if (this->Moving && this->Mistakes > MistakesForgiven)
  {
    this->Wait = (1 << (this->Mistakes - MistakesForgiven)) - 1;
  }
}

/// Goes to the next tree of the search, as far as so many bytes go; false where there is none.
bool LoadBalancer::SearchPlanes(const BrickCosts& bytes, double mostBytes)
{
  std::vector<double> speeds;
  for (const Pace& pace : this->Paces)
  {
    speeds.push_back(1.0 / pace.SecondsPerWork);
  }
  const int step = this->Settings.PlaneStep;
  const BrickCosts costs = this->CostsOf(this->Costs[FromLast]);
  const std::optional<ZoneTree> found = this->Search.Next(costs, speeds, step);
  if (!found)
  {
    return false;
  }
  const ZoneTree& now = this->Zones;
  const CostSums sums(bytes);
  ZoneTree next = *found;
  double moved = MovedBetween(now, next, sums);
  for (double part = 0.5; moved > mostBytes; part *= 0.5)
  {
    next = part < 0.01 || !NestAlike(now, *found) ? now : PartOfTheWay(now, *found, part, step);
    moved = MovedBetween(now, next, sums);
  }
  this->Moved = moved;
  this->Moving = false; // nobody's mistake
  this->Zones = std::move(next);
  this->Expected = banyan::ExpectedImbalance(this->Zones, CostSums(costs), this->Speeds());
  return true;
}

/// Takes a tree with other axes in place of `next` if that is much better.
void LoadBalancer::Turn(
  const BrickCosts& costs, const BrickCosts& bytes, const ScreenCuts& cuts, Rebalanced& next)
{
  if (this->Rest > 0)
  {
    --this->Rest;
    return;
  }
  const CostSums sums(costs);
  const std::vector<double> speeds = this->Speeds();
  const double cutNow = RaysCut(this->Zones, sums, cuts);
  // What was measured has the rays in it that are cut now.
  const auto slowest = [&](const ZoneTree& tree)
  {
    const double least = 0.3 * sums.Total();
    const double more = WorkPerCutRay * (RaysCut(tree, sums, cuts) - cutNow);
    return banyan::ExpectedImbalance(tree, sums, speeds) * std::max(sums.Total() + more, least);
  };
  ZoneTree turned =
    TurnedTree(this->Zones, sums, speeds, this->Settings.PlaneStep, cuts, WorkPerCutRay);
  if (this->Settings.TurnGain * slowest(turned) < slowest(next.Tree))
  {
    next.BytesMoved = MovedBetween(this->Zones, turned, CostSums(bytes));
    next.After = banyan::ExpectedImbalance(turned, sums, speeds);
    next.Tree = std::move(turned);
    this->Rest = FramesBetweenTurns;
  }
}

std::vector<double> LoadBalancer::ExpectedFromView(const BrickCosts& view) const
{
  const double usual = UsualRatio(this->LastWork, this->View);
  std::vector<double> costs = view.Values;
  for (std::size_t i = 0; i < costs.size(); ++i)
  {
    const double newer = this->Ratio[i];
    const double older = this->OlderRatio[i];
    costs[i] *= newer < 0.0 ? usual : older < 0.0 ? newer : 0.5 * (newer + older);
  }
  return costs;
}

BrickCosts LoadBalancer::CostsOf(const std::vector<double>& values) const
{
  BrickCosts costs(this->Settings.Positions, this->Settings.BlockEdge);
  costs.Values = values;
  return costs;
}

/// What each block takes to move: nothing where nothing is drawn, for it is not even read.
BrickCosts LoadBalancer::DrawnBytes(const std::vector<double>& costs) const
{
  BrickCosts bytes = this->CostsOf(costs);
  for (std::size_t i = 0; i < bytes.Values.size(); ++i)
  {
    bytes.Values[i] = bytes.Values[i] > 0.0 ? static_cast<double>(bytes.PositionsOf(i).Count()) *
                                                this->Settings.BytesPerPosition
                                            : 0.0;
  }
  return bytes;
}

/// In work by blocks per second.
std::vector<double> LoadBalancer::Speeds() const
{
  std::vector<double> speeds;
  for (const Pace& pace : this->Paces)
  {
    speeds.push_back(pace.Share / pace.SecondsPerWork);
  }
  return speeds;
}

void LoadBalancer::FrameTook(const std::vector<RankWork>& ranks, const BrickCosts& work)
{
  if (ranks.size() != this->Paces.size() || work.Values.size() != this->Ratio.size())
  {
    throw Error("What a frame took belongs to other zones.");
  }
  const double seconds = std::max_element(ranks.begin(), ranks.end(),
    [](const RankWork& a, const RankWork& b) {
      return a.Seconds < b.Seconds;
    })->Seconds;
  if (!(seconds > 0.0))
  {
    return; // nothing was drawn, and nothing is learned from it
  }
  this->Last = ranks;
  if (this->Settings.Mode == LoadBalancing::MeasuredCost)
  {
    this->LearnErrors(work);
    this->LearnMistakes(work);
    this->LearnSpeeds(ranks, work);
  }
  this->LearnWork(work);
  if (this->Settings.Mode == LoadBalancing::MeasuredCost && this->Settings.Searches)
  {
    std::vector<double> done;
    for (const RankWork& rank : ranks)
    {
      done.push_back(rank.Work);
    }
    this->Search.Measured(this->Zones, done);
  }
  ++this->Frames;
}

void LoadBalancer::LearnWork(const BrickCosts& work)
{
  this->OlderWork = this->Frames == 0 ? work.Values : this->LastWork;
  this->LastWork = work.Values;
  const double most = MostRatio * UsualRatio(work.Values, this->View);
  for (std::size_t i = 0; i < this->LongWork.size(); ++i)
  {
    const double done = work.Values[i];
    this->LongWork[i] += (this->Frames == 0 ? 1.0 : LongWeight) * (done - this->LongWork[i]);
    const double seen = this->View.empty() ? 0.0 : this->View[i];
    if (seen > 0.0)
    {
      this->OlderRatio[i] = this->Ratio[i];
      this->Ratio[i] = std::min(done / seen, most);
    }
  }
}

} // namespace banyan
