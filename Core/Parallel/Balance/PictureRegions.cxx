// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/PictureRegions.h"

#include "Parallel/Balance/FrameCost.h"
#include "Parallel/Composite/Footprints.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr int Edge = TileSamplings::Edge;

/// Pixels under the volume, by tiles.
BrickCosts PixelsUnder(const RayScene& scene, const glm::ivec3& tiles)
{
  BrickCosts costs(tiles, 1);
  const Footprint footprint =
    FootprintsOfZones(scene.Camera, scene.IndexToWorld, { scene.DomainCells }, scene.Viewport)[0];
  for (int y = footprint.Rect.Lo.y; y < footprint.Rect.Hi.y; ++y)
  {
    const Footprint::Interval row = footprint.Row(y);
    for (int x = row.Lo; x < row.Hi;)
    {
      const int end = std::min(row.Hi, (x / Edge + 1) * Edge);
      costs.Values[costs.NumberAt({ x / Edge, y / Edge, 0 })] += end - x;
      x = end;
    }
  }
  return costs;
}

/// Which rank gets which region: the pairs with the most pixels of the rank's place first, then all
/// others in their order.
std::vector<int> RanksNear(
  const std::vector<PixelRect>& regions, const std::vector<PicturePlace>& places)
{
  struct Pair
  {
    long long Pixels;
    std::size_t Seat;
    int Rank;
  };
  std::vector<Pair> pairs;
  for (std::size_t seat = 0; seat < regions.size(); ++seat)
  {
    for (const PicturePlace& place : places)
    {
      pairs.push_back({ Intersection(regions[seat], place.Rect).Count(), seat, place.Root });
    }
  }
  std::stable_sort(
    pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.Pixels > b.Pixels; });
  for (std::size_t seat = 0; seat < regions.size(); ++seat)
  {
    for (std::size_t rank = 0; rank < regions.size(); ++rank)
    {
      pairs.push_back({ 0, seat, static_cast<int>(rank) });
    }
  }
  std::vector<int> rankOfSeat(regions.size(), -1);
  std::vector<bool> taken(regions.size(), false);
  for (const Pair& pair : pairs)
  {
    const auto rank = static_cast<std::size_t>(pair.Rank);
    if (rankOfSeat[pair.Seat] < 0 && !taken[rank])
    {
      rankOfSeat[pair.Seat] = pair.Rank;
      taken[rank] = true;
    }
  }
  return rankOfSeat;
}

bool SamePlaces(const std::vector<PicturePlace>& a, const std::vector<PicturePlace>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
    [](const PicturePlace& one, const PicturePlace& other)
    { return one.Rect == other.Rect && one.Root == other.Root; });
}

} // namespace

PixelRect PictureRegions::PixelsOf(const Box& tiles) const
{
  const glm::ivec2 low = glm::min(glm::ivec2(tiles.Lo) * Edge, this->Size);
  return { low, glm::max(glm::min(glm::ivec2(tiles.Hi) * Edge, this->Size), low) };
}

void PictureRegions::Start(
  const glm::ivec2& size, int ranks, const std::vector<PicturePlace>& places)
{
  LoadBalancer::Options options;
  options.Positions = glm::ivec3(TileSamplings::TilesOf(size), 1);
  options.Ranks = ranks;
  options.BrickPositions = 1;
  options.BlockEdge = 1;
  options.BytesPerPosition = 0.0; // whoever draws a tile reads its bricks itself
  this->Balancer.emplace(options);
  this->Size = size;
  this->Places = places;
  std::vector<PixelRect> regions;
  for (const Box& tiles : ZonesOf(this->Balancer->Tree()))
  {
    regions.push_back(this->PixelsOf(tiles));
  }
  this->RankOfSeat = RanksNear(regions, places);
}

std::vector<PixelRect> PictureRegions::BeginFrame(
  RayScene& scene, int ranks, const std::vector<PicturePlace>& places)
{
  const glm::ivec2 size = scene.Camera.ImageSize();
  if (size != this->Size || !this->Balancer || this->Balancer->GetOptions().Ranks != ranks ||
      !SamePlaces(places, this->Places))
  {
    this->Start(size, ranks, places);
  }
  this->View = PixelsUnder(scene, this->Balancer->GetOptions().Positions);
  this->Balancer->BeginFrame(this->View);
  this->Tiles = ZonesOf(this->Balancer->Tree());
  std::vector<PixelRect> regions(this->Tiles.size());
  for (std::size_t seat = 0; seat < this->Tiles.size(); ++seat)
  {
    regions[static_cast<std::size_t>(this->RankOfSeat[seat])] = this->PixelsOf(this->Tiles[seat]);
  }
  this->Work = BrickWork();
  scene.Work = &this->Work;
  return regions;
}

void PictureRegions::EndFrame(Communicator& communicator)
{
  const RankWork mine{ this->Work.DrawSeconds, WorkOf(this->Work.Total()) };
  std::vector<RankWork> ranks(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), ranks.data());
  BrickCosts work(this->View.Positions, 1);
  std::vector<RankWork> seats;
  for (std::size_t seat = 0; seat < ranks.size(); ++seat)
  {
    seats.push_back(ranks[static_cast<std::size_t>(this->RankOfSeat[seat])]);
    work.Add(this->Tiles[seat], seats.back().Work, &this->View);
  }
  this->Balancer->FrameTook(seats, work);
}

} // namespace banyan
