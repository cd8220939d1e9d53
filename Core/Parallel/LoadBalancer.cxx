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
/// Axes that were chosen anew stay for some frames.
constexpr int FramesBetweenTurns = 8;

/// Moves that made a frame's imbalance worse by more than this factor count as mistakes, twice;
/// those that made it better make up for one.
constexpr double MistakeFactor = 1.05;
constexpr int MistakesForgiven = 4;
constexpr int MostMistakes = 10;
/// A block's work is never expected to be so many times as much as that of others that are seen as
/// large.
constexpr double MostRatio = 8.0;
/// Weight of a new frame in the errors of expectations.
constexpr double ErrorWeight = 0.4;

/// Weight of a new frame in averages over many.
constexpr double LongWeight = 1.0 / 16.0;
/// The same in the speed of a rank, once it is known: noise must not move planes.
constexpr double SpeedWeight = 0.1;
/// Seconds that differ from those of a rank so far by more than this factor are a change when they
/// come twice, and a disturbance when they come once.
constexpr double OutlierFactor = 1.5;
/// A rank's speed is not learned from less than this part of the ranks' mean work.
constexpr double LeastPart = 0.1;

constexpr std::int64_t MostBlocks = 4096;

double Median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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
  Rebalanced next = RebalanceMeasuredCost(this->Zones, costs, this->Speeds(), limits);
  if (cuts && this->Wait == 0)
  {
    this->Turn(costs, bytes, *cuts, next);
  }
  this->Moving = next.Tree != this->Zones;
  this->Zones = std::move(next.Tree);
  this->Moved = next.BytesMoved;
  this->Expected = next.After;
  if (this->Moving && this->Mistakes > MistakesForgiven)
  {
    this->Wait = (1 << (this->Mistakes - MistakesForgiven)) - 1;
  }
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
    else if (pace.Outlier > 0.0 && (pace.Outlier > pace.SecondsPerWork) == (factor > 1.0))
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
