// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/MixVolumes.h"

#include "Base/StopFlag.h"
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

/// That segments of a band may take on a rank.
constexpr double BandBytes = 32e6;

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
    if (space.Stop)
    {
      space.Stop->Check();
    }
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

std::shared_ptr<const FloatImage> MixInBands(Communicator& communicator, std::size_t volumes,
  const PixelRect& rect, int root, ThreadPool& pool, const CastBand& cast, SentBytes& sent)
{
  std::shared_ptr<FloatImage> picture;
  if (communicator.Rank() == root)
  {
    picture = std::make_shared<FloatImage>(
      FloatImage{ rect, PixelVector(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f)) });
  }
  int rows = RayTile::Edge;
  for (int low = rect.Lo.y; low < rect.Hi.y;)
  {
    // Tiles are whole.
    const int high = std::min(low / RayTile::Edge * RayTile::Edge + rows, rect.Hi.y);
    MixedVolumes mixed;
    mixed.Viewport = { { rect.Lo.x, low }, { rect.Hi.x, high } };
    mixed.TransmittanceLimit = 1.0f;
    double bytes = 1.0;
    for (std::size_t volume = 0; volume < volumes; ++volume)
    {
      SegmentPicture segments;
      const float limit = cast(volume, mixed.Viewport, segments);
      mixed.TransmittanceLimit = std::min(mixed.TransmittanceLimit, limit);
      bytes += static_cast<double>(segments.Bytes());
      mixed.Segments.push_back(segments.Take());
    }
    const FloatImage band = MixVolumes(communicator, std::move(mixed), pool, root, {}, sent);
    for (int y = low; y < high && picture; ++y)
    {
      std::copy_n(&band.At(rect.Lo.x, y), rect.Size().x, &picture->At(rect.Lo.x, y));
    }
    // The next band may have more.
    const double fits = BandBytes / AllMax(communicator, bytes) * (high - low);
    rows = static_cast<int>(std::min(fits, 4.0 * rows)) / RayTile::Edge * RayTile::Edge;
    rows = std::max(rows, RayTile::Edge);
    low = high;
  }
  return picture;
}

} // namespace banyan
