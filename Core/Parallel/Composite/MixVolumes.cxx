// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/MixVolumes.h"

#include "Base/ThreadPool.h"
#include "Base/Varint.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Raycast/SegmentMixer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>

namespace banyan
{
namespace
{

/// That segments of a block may take on a rank.
constexpr double BlockBytes = 48e6;
/// Of segments, in what was not drawn yet.
constexpr double LeastPerPixel = 512.0;
/// Of the first block, of which nothing is known.
constexpr double FirstPixels = 2.0 * RayTile::Edge * RayTile::Edge;

static_assert(std::is_trivially_copyable_v<RaySegment>, "sent as it is");

void PutTile(Bytes& message, std::size_t volume, const TileSegments& tile)
{
  const std::int64_t head[4] = { static_cast<std::int64_t>(volume), tile.Position.x,
    tile.Position.y, static_cast<std::int64_t>(tile.Segments.size()) };
  const std::size_t bytes = tile.Segments.size() * sizeof(RaySegment);
  const std::size_t at = message.size();
  message.resize(at + sizeof(head) + bytes);
  std::memcpy(message.data() + at, head, sizeof(head));
  std::memcpy(message.data() + at + sizeof(head), tile.Segments.data(), bytes);
}

/// @param segments by volume; is added to
void TakeTiles(const Bytes& message, std::vector<std::vector<TileSegments>>& segments)
{
  ByteReader in(message.data(), message.size());
  while (in.Left() > 0)
  {
    const auto volume = static_cast<std::size_t>(in.Number<std::int64_t>());
    TileSegments tile;
    tile.Position.x = static_cast<int>(in.Number<std::int64_t>());
    tile.Position.y = static_cast<int>(in.Number<std::int64_t>());
    tile.Segments.resize(static_cast<std::size_t>(in.Number<std::int64_t>()));
    const std::size_t bytes = tile.Segments.size() * sizeof(RaySegment);
    std::memcpy(tile.Segments.data(), in.Skip(bytes), bytes);
    segments.at(volume).push_back(std::move(tile));
  }
}

/// Collective: brings tiles to their ranks.
void ToOwners(Communicator& communicator, std::vector<std::vector<TileSegments>>& segments,
  const TileShare& share, std::string& failure, SentBytes& sent)
{
  std::vector<Bytes> messages(static_cast<std::size_t>(communicator.Size()));
  Attempt(failure,
    [&]
    {
      for (std::size_t volume = 0; volume < segments.size(); ++volume)
      {
        std::vector<TileSegments> mine;
        for (TileSegments& tile : segments[volume])
        {
          const int owner = share.OwnerOf(tile.Position);
          if (owner == share.Rank)
          {
            mine.push_back(std::move(tile));
          }
          else
          {
            PutTile(messages[static_cast<std::size_t>(owner)], volume, tile);
          }
        }
        segments[volume] = std::move(mine);
      }
    });
  const std::vector<Bytes> from = ExchangeCounted(communicator, std::move(messages), failure, sent);
  Attempt(failure,
    [&]
    {
      for (const Bytes& message : from)
      {
        TakeTiles(message, segments);
      }
    });
}

/// Makes the pixels of this rank's tiles.
void MixTiles(const MixedVolumes& space, ThreadPool& pool, TilePicture& picture)
{
  using Part = std::pair<std::size_t, const TileSegments*>; // number of a volume
  std::map<std::pair<int, int>, std::vector<Part>> parts;
  for (std::size_t volume = 0; volume < space.Segments.size(); ++volume)
  {
    for (const TileSegments& tile : space.Segments[volume])
    {
      parts[{ tile.Position.y, tile.Position.x }].emplace_back(volume, &tile);
    }
  }
  const std::vector<std::pair<std::pair<int, int>, std::vector<Part>>> tiles(
    parts.begin(), parts.end());
  struct Worker
  {
    explicit Worker(std::size_t volumes)
      : Mixer(volumes)
    {
    }
    SegmentMixer Mixer;
    std::array<glm::vec4, RayTile::Slots> Pixels;
  };
  std::vector<std::unique_ptr<Worker>> workers(static_cast<std::size_t>(pool.Width()));
  const std::function<void(std::int64_t, int)> mix = [&](std::int64_t number, int worker)
  {
    std::unique_ptr<Worker>& mine = workers[static_cast<std::size_t>(worker)];
    mine = mine ? std::move(mine) : std::make_unique<Worker>(space.Segments.size());
    const auto& [position, ofTile] = tiles[static_cast<std::size_t>(number)];
    for (const Part& part : ofTile)
    {
      mine->Mixer.Add(part.first, part.second->Segments);
    }
    mine->Mixer.Mix(space.TransmittanceLimit, mine->Pixels.data());
    picture.Set({ position.second, position.first }, mine->Pixels.data());
  };
  pool.ParallelFor(static_cast<std::int64_t>(tiles.size()), mix);
}

/// The next block of a picture: rows of tiles, or a part of one. Tiles are whole.
/// @param at its lower left corner
/// @param pixels about as many as it may have; one tile at least
PixelRect BlockAt(const glm::ivec2& at, const PixelRect& rect, double pixels)
{
  constexpr int edge = RayTile::Edge;
  const auto along = [&](double length, int from, int end)
  {
    const int tiles = std::max(1, static_cast<int>(std::min(length, 65536.0)) / edge);
    return std::min((from / edge + tiles) * edge, end);
  };
  const int width = rect.Size().x;
  const bool isRow = at.x == rect.Lo.x && pixels >= static_cast<double>(width) * edge;
  return { at, { isRow ? rect.Hi.x : along(pixels / edge, at.x, rect.Hi.x),
                 along(isRow ? pixels / width : edge, at.y, rect.Hi.y) } };
}

} // namespace

FloatImage MixVolumes(Communicator& communicator, MixedVolumes space, ThreadPool& pool, int root,
  std::string failure, SentBytes& sent)
{
  TilePicture picture(communicator);
  ToOwners(communicator, space.Segments, picture.Share(), failure, sent);
  Attempt(failure,
    [&]
    {
      picture.Clear(space.Viewport);
      MixTiles(space, pool, picture);
    });
  return picture.Gather(communicator, root, failure, sent);
}

std::shared_ptr<const FloatImage> MixInBlocks(Communicator& communicator, std::size_t volumes,
  const PixelRect& rect, int root, ThreadPool& pool, const CastBlock& cast, SentBytes& sent)
{
  std::shared_ptr<FloatImage> picture;
  if (communicator.Rank() == root)
  {
    picture = std::make_shared<FloatImage>(
      FloatImage{ rect, PixelVector(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f)) });
  }
  double perPixel = LeastPerPixel;
  double pixels = FirstPixels;
  for (glm::ivec2 at = rect.Lo; at.y < rect.Hi.y;)
  {
    MixedVolumes mixed;
    mixed.Viewport = BlockAt(at, rect, pixels);
    mixed.TransmittanceLimit = 1.0f;
    double bytes = 0.0;
    for (std::size_t volume = 0; volume < volumes; ++volume)
    {
      SegmentPicture segments;
      const float limit = cast(volume, mixed.Viewport, segments);
      mixed.TransmittanceLimit = std::min(mixed.TransmittanceLimit, limit);
      bytes += static_cast<double>(segments.Bytes());
      mixed.Segments.push_back(segments.Take());
    }
    const PixelRect block = mixed.Viewport;
    const FloatImage drawn = MixVolumes(communicator, std::move(mixed), pool, root, {}, sent);
    for (int y = block.Lo.y; y < block.Hi.y && picture; ++y)
    {
      std::copy_n(&drawn.At(block.Lo.x, y), block.Size().x, &picture->At(block.Lo.x, y));
    }
    // The densest block tells how large others may be.
    perPixel = std::max(perPixel, AllMax(communicator, bytes) / static_cast<double>(block.Count()));
    pixels = std::min(BlockBytes / perPixel, 4.0 * pixels);
    const bool ended = block.Hi.x == rect.Hi.x;
    at = ended ? glm::ivec2(rect.Lo.x, block.Hi.y) : glm::ivec2(block.Hi.x, at.y);
  }
  return picture;
}

} // namespace banyan
