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

} // namespace

std::vector<PixelRect> PictureRegions::BeginFrame(RayScene& scene, int ranks)
{
  const glm::ivec2 size = scene.Camera.ImageSize();
  const glm::ivec2 counts = TileSamplings::TilesOf(size);
  const glm::ivec3 tiles(counts, 1);
  if (size != this->Size || !this->Balancer || this->Balancer->GetOptions().Ranks != ranks)
  {
    LoadBalancer::Options options;
    options.Positions = tiles;
    options.Ranks = ranks;
    options.BrickPositions = 1;
    options.BlockEdge = 1;
    options.BytesPerPosition = 0.0; // whoever draws a tile reads its bricks itself
    this->Balancer.emplace(options);
    this->Size = size;
  }
  this->View = PixelsUnder(scene, tiles);
  this->Balancer->BeginFrame(this->View);
  this->Tiles = ZonesOf(this->Balancer->Tree());
  std::vector<PixelRect> regions;
  for (const Box& box : this->Tiles)
  {
    const glm::ivec2 low = glm::min(glm::ivec2(box.Lo) * Edge, size);
    regions.push_back({ low, glm::max(glm::min(glm::ivec2(box.Hi) * Edge, size), low) });
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
  for (std::size_t rank = 0; rank < ranks.size(); ++rank)
  {
    work.Add(this->Tiles[rank], ranks[rank].Work, &this->View);
  }
  this->Balancer->FrameTook(ranks, work);
}

} // namespace banyan
