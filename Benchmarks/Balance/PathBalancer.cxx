// SPDX-License-Identifier: BSD-3-Clause
#include "PathBalancer.h"

#include "SliceStep.h"

#include <utility>

namespace banyan::bench
{

PathBalancer::PathBalancer(BalanceMode mode, const LoadBalancer::Options& options)
  : Mode(mode)
  , Measured(options)
  , Zones(this->Measured.Tree())
{
}

void PathBalancer::BeginFrame(const BrickCosts& view, const ScreenCuts* cuts)
{
  if (this->Mode == BalanceMode::MeasuredCost)
  {
    this->Measured.BeginFrame(view, cuts);
    this->Zones = this->Measured.Tree();
    this->Moved = this->Measured.BytesMoved();
  }
  else if (this->Mode == BalanceMode::SliceStep && !this->Seconds.empty())
  {
    ZoneTree before = std::exchange(this->Zones,
      RebalanceSliceStep(this->Zones, this->Seconds, this->GetOptions().BrickPositions));
    this->Moved = MovedBetween(before, this->Zones, CostSums(this->Bytes));
  }
}

void PathBalancer::FrameTook(const std::vector<RankWork>& ranks, const BrickCosts& work)
{
  if (this->Mode == BalanceMode::MeasuredCost)
  {
    this->Measured.FrameTook(ranks, work);
    return;
  }
  this->Seconds.clear();
  for (const RankWork& rank : ranks)
  {
    this->Seconds.push_back(rank.Seconds);
  }
  this->Bytes = work;
  for (std::size_t i = 0; i < work.Values.size(); ++i)
  {
    this->Bytes.Values[i] =
      work.Values[i] > 0.0
        ? static_cast<double>(work.PositionsOf(i).Count()) * this->GetOptions().BytesPerPosition
        : 0.0;
  }
}

} // namespace banyan::bench
