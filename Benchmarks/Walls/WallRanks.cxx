// SPDX-License-Identifier: BSD-3-Clause
#include "WallRanks.h"

#include "BenchScene.h"
#include "FrameFile.h"

#include "Base/Error.h"
#include "Parallel/Balance/LevelZones.h"
#include "Parallel/Composite/Compositing.h"
#include "Parallel/Fields/DrawnField.h"
#include "Render/Levels/RayCaster.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"

#include <ctime>

#include <algorithm>
#include <fstream>
#include <numeric>

namespace banyan::bench
{
namespace
{

constexpr std::uint64_t AllMemory = ~std::uint64_t{ 0 };

double ProcessorSeconds()
{
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Without the background around what is drawn.
FloatImage Trimmed(const FloatImage& image)
{
  FloatImage part{ ActiveRect(image, image.Rect), {} };
  for (int y = part.Rect.Lo.y; y < part.Rect.Hi.y; ++y)
  {
    const glm::vec4* row = &image.At(part.Rect.Lo.x, y);
    part.Pixels.insert(part.Pixels.end(), row, row + part.Rect.Size().x);
  }
  return part;
}

/// @param cells of the finest level, of which a zone may have cut some off
BrickName NameOf(const Box& cells)
{
  const glm::ivec3 size = cells.Size();
  const int longest = std::max({ size.x, size.y, size.z });
  int level = 0;
  while ((BrickCells << level) < longest)
  {
    ++level;
  }
  const glm::ivec3 place = cells.Lo / (BrickCells << level);
  return { level, place.x, place.y, place.z };
}

} // namespace

WallRanks::WallRanks(BrickSource& source, int ranks, bool byPicture)
  : Source(source)
  , ByPicture(byPicture)
  , Parts(static_cast<std::size_t>(ranks))
{
  for (int rank = 0; rank < ranks; ++rank)
  {
    this->OfPicture.push_back(std::make_unique<PictureRegions>());
    this->OfData.push_back(std::make_unique<FrameBalancer>());
  }
}

void WallRanks::BeginFrame(const RayScene& scene, const Wall& wall)
{
  const auto ranks = static_cast<int>(this->Parts.size());
  for (std::size_t rank = 0; rank < this->Parts.size(); ++rank)
  {
    Part& part = this->Parts[rank];
    part = Part();
    RayScene own = scene;
    own.Work = &part.Own;
    if (this->ByPicture)
    {
      this->Regions = this->OfPicture[rank]->BeginFrame(own, ranks, wall.Tiles);
    }
    else
    {
      FrameBalancer::Field field;
      field.Cells = scene.DomainCells.Size();
      field.BrickCells = BrickCells;
      field.CoarsestLevel = DrawnField::CoarsestLevelOf(field.Cells);
      field.BytesPerCell = 1.0;
      FrameBalancer& balancer = *this->OfData[rank];
      if (balancer.Zones().empty())
      {
        balancer.Start(LoadBalancing::MeasuredCost, field, ranks);
      }
      balancer.BeginFrame(own, this->Source);
      this->Zones = balancer.Zones();
    }
    // A rank has a core of its own: what others took of this one does not count.
    part.Work = own.Work;
    part.Work->Clock = ProcessorSeconds;
  }
}

/// What a rank draws for a tile, on the clock.
FloatImage WallRanks::CastTile(int rank, const RayScene& ofTile, int every)
{
  Part& part = this->Parts[static_cast<std::size_t>(rank)];
  RayScene drawn = ofTile;
  drawn.GoesOn = true; // all ranks have one source here: no part lets go of what another one has
  drawn.Work = part.Work;
  const double before = ProcessorSeconds();
  if (this->ByPicture)
  {
    drawn.Viewport = Intersection(drawn.Viewport, this->Regions[static_cast<std::size_t>(rank)]);
  }
  const Box cells =
    this->ByPicture ? drawn.DomainCells : this->Zones[static_cast<std::size_t>(rank)];
  FloatImage image;
  RayStatistics statistics;
  const auto cast = [&]
  { image = CastRays(drawn, this->Source, cells, AllMemory, this->Pool, statistics); };
  if (every == 1 && !drawn.Viewport.Empty() && !cells.Empty())
  {
    cast();
  }
  const PixelRect all = drawn.Viewport;
  constexpr int edge = TileSamplings::Edge;
  for (int y = all.Lo.y / edge * edge; every > 1 && y < all.Hi.y && !cells.Empty(); y += edge)
  {
    drawn.Viewport = Intersection(all, { { all.Lo.x, y }, { all.Hi.x, y + edge / every } });
    if (!drawn.Viewport.Empty())
    {
      cast();
    }
  }
  part.Seconds += ProcessorSeconds() - before;
  return image;
}

/// All ranks, for one tile.
void WallRanks::DrawTile(
  const RayScene& scene, const PicturePlace& tile, const std::string& folder, int every)
{
  RayScene ofTile = scene;
  ofTile.Viewport = WithMargin(scene, tile.Rect);
  const auto ranks = static_cast<int>(this->Parts.size());
  std::vector<FloatImage> images;
  for (int rank = 0; rank < ranks; ++rank)
  {
    FloatImage image = this->CastTile(rank, ofTile, every);
    images.push_back(folder.empty() ? FloatImage{} : Trimmed(image));
  }
  if (folder.empty())
  {
    return;
  }
  FrameHead head{ ofTile.Viewport, {}, {} };
  if (this->ByPicture)
  {
    head.Order.resize(images.size());
    std::iota(head.Order.begin(), head.Order.end(), 0);
    for (const PixelRect& region : this->Regions)
    {
      head.Footprints.push_back(
        FootprintOf(Intersection(region, ofTile.Viewport), ofTile.Viewport));
    }
  }
  else
  {
    head.Order = OrderAsDrawn(ofTile, this->Zones);
    head.Footprints = FootprintsOfZones(
      scene.Camera, scene.IndexToWorld, ZonesAsDrawn(ofTile, this->Zones), ofTile.Viewport);
  }
  WriteFrame(folder + "/" + std::to_string(tile.Root) + ".frame", head, images);
}

/// Zones, then regions: six and four numbers a line.
void WallRanks::WriteShares(const std::string& path) const
{
  std::ofstream file(path);
  for (const Box& zone : this->Zones)
  {
    file << zone.Lo.x << ' ' << zone.Lo.y << ' ' << zone.Lo.z << ' ' << zone.Hi.x << ' '
         << zone.Hi.y << ' ' << zone.Hi.z << '\n';
  }
  for (const PixelRect& region : this->Regions)
  {
    file << region.Lo.x << ' ' << region.Lo.y << ' ' << region.Hi.x << ' ' << region.Hi.y << '\n';
  }
  file.close();
  if (!file)
  {
    throw Error("The zones or regions cannot be written.", { path });
  }
}

WallFrame WallRanks::Draw(
  const RayScene& scene, const Wall& wall, const std::string& folder, int every)
{
  this->BeginFrame(scene, wall);
  for (const PicturePlace& tile : wall.Tiles)
  {
    this->DrawTile(scene, tile, folder, every);
  }
  if (!folder.empty())
  {
    this->WriteShares(folder + "/shares");
  }
  WallFrame frame;
  for (const Part& part : this->Parts)
  {
    frame.RankSeconds.push_back(part.Seconds);
    frame.Bricks.emplace_back();
    for (const BrickWork::Part& drawn : part.Work->Parts)
    {
      frame.Bricks.back().insert(NameOf(drawn.Cells));
    }
  }
  RunOnSimulatedRanks(static_cast<int>(this->Parts.size()),
    [&](Communicator& ranks)
    {
      const auto self = static_cast<std::size_t>(ranks.Rank());
      this->ByPicture ? this->OfPicture[self]->EndFrame(ranks)
                      : this->OfData[self]->EndFrame(ranks);
    });
  return frame;
}

} // namespace banyan::bench
