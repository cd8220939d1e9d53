// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/FrameBalancer.h"

#include "Render/Levels/RayCaster.h"

namespace banyan
{

std::vector<Box> ZonesOfRanks::Zones() const
{
  const std::vector<Box> seats = ZonesOf(this->Tree);
  if (this->RankOfSeat.empty())
  {
    return seats;
  }
  std::vector<Box> zones(seats.size());
  for (std::size_t seat = 0; seat < seats.size(); ++seat)
  {
    zones.at(static_cast<std::size_t>(this->RankOfSeat.at(seat))) = seats[seat];
  }
  return zones;
}

void FrameBalancer::PlaceZones()
{
  this->ZoneCells = ZonesOfRanks{ this->Balancer->Tree(), this->RankOfSeat }.Zones();
}

void FrameBalancer::Start(LoadBalancing mode, const Field& field, int ranks)
{
  LoadBalancer::Options options;
  options.Positions = field.Cells;
  options.Ranks = ranks;
  options.Start = field.Start.Tree;
  options.BrickPositions = field.BrickCells;
  options.PlaneStep = 1 << field.CoarsestLevel;
  options.BlockEdge = BlockEdgeFor(field.Cells);
  options.BytesPerPosition = field.BytesPerCell;
  // The values may be others, of another step, say: what was learned is still the best guess.
  this->SeenOf = nullptr;
  if (this->Balancer)
  {
    const LoadBalancer::Options& now = this->Balancer->GetOptions();
    if (this->Mode == mode && now.Positions == options.Positions && now.Ranks == options.Ranks &&
        now.BrickPositions == options.BrickPositions && now.PlaneStep == options.PlaneStep &&
        now.BytesPerPosition == options.BytesPerPosition && now.Start == options.Start &&
        this->RankOfSeat == field.Start.RankOfSeat)
    {
      this->Balancer->ValuesChanged();
      return;
    }
  }
  this->Mode = mode;
  this->Balancer.emplace(options);
  this->RankOfSeat = field.Start.RankOfSeat;
  this->PlaceZones();
}

/// Which blocks can be seen changes with the values and the transfer function only.
void FrameBalancer::LookAgain(const RayScene& scene, const BrickSource& source)
{
  const TransferFunction& seenBy = this->SeenBy;
  if (this->SeenOf == &source && this->SeenAs == scene.Blend.Mode &&
      seenBy.Low == scene.Transfer.Low && seenBy.High == scene.Transfer.High &&
      seenBy.Entries == scene.Transfer.Entries && seenBy.Edges == scene.Transfer.Edges)
  {
    return;
  }
  const LoadBalancer::Options& options = this->Balancer->GetOptions();
  this->Visible = VisibleParts(scene, source, options.Positions, options.BlockEdge);
  this->SeenOf = &source;
  this->SeenAs = scene.Blend.Mode;
  this->SeenBy = scene.Transfer;
}

void FrameBalancer::BeginFrame(RayScene& scene, const BrickSource& source)
{
  if (this->IsOff())
  {
    return;
  }
  this->LookAgain(scene, source);
  const LoadBalancer::Options& options = this->Balancer->GetOptions();
  this->View = ViewCosts(scene, options.Positions, options.BlockEdge, this->Visible);
  // When zones are given to begin with, bricks travel, and GoBack knows the way: planes move, but
  // do not turn.
  const ScreenCuts cuts(scene);
  this->Balancer->BeginFrame(this->View, options.Start.Nodes.empty() ? &cuts : nullptr);
  this->PlaceZones();
  this->Work = BrickWork();
  scene.Work = &this->Work;
}

void FrameBalancer::GoBack(double part)
{
  if (!this->IsOff())
  {
    const LoadBalancer::Options& options = this->Balancer->GetOptions();
    const ZoneTree& start = options.Start;
    this->Balancer->SetTree(
      part > 0.0 ? PartOfTheWay(start, this->Balancer->Tree(), part, 1) : start);
    this->PlaceZones();
  }
}

void FrameBalancer::EndFrame(Communicator& communicator)
{
  if (this->IsOff())
  {
    return;
  }
  const FrameCost took = GatherCost(communicator, this->Work, this->ZoneCells, this->View);
  std::vector<RankWork> seats = took.Ranks;
  for (std::size_t seat = 0; seat < this->RankOfSeat.size(); ++seat)
  {
    seats[seat] = took.Ranks[static_cast<std::size_t>(this->RankOfSeat[seat])];
  }
  this->Balancer->FrameTook(seats, took.Blocks);
}

} // namespace banyan
