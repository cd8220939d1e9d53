// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/ReduceNearest.h"

#include "Base/Error.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr int TagCandidates = 3;
constexpr int TagNearest = 4;

/// Collective; throws on all ranks when the pictures are not of one size.
void CheckSizes(Communicator& communicator, std::uint64_t mine)
{
  std::vector<std::uint64_t> sizes(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), sizes.data());
  for (std::size_t rank = 0; rank < sizes.size(); ++rank)
  {
    if (sizes[rank] != sizes[0])
    {
      ErrorPlace place;
      place.Found = sizes[rank];
      place.Allowed = sizes[0];
      throw Error(
        "Rank " + std::to_string(rank) +
          " sees another number of pixels than rank 0, so the nearest geometry is not known.",
        place);
    }
  }
}

/// Every rank decides one part of the picture: each pixel crosses the network twice and no rank
/// carries more than another, whatever the number of ranks.
void NearestTogether(Communicator& communicator, OpaquePixels& pixels)
{
  const std::size_t ranks = static_cast<std::size_t>(communicator.Size());
  const std::size_t self = static_cast<std::size_t>(communicator.Rank());
  const auto begin = [&](std::size_t rank) { return pixels.size() * rank / ranks; };
  const auto bytes = [&](std::size_t rank)
  { return (begin(rank + 1) - begin(rank)) * sizeof(OpaquePixel); };
  const auto forEachOther = [&](const auto& action)
  {
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      if (rank != self)
      {
        action(rank, static_cast<int>(rank));
      }
    }
  };

  const std::size_t count = begin(self + 1) - begin(self);
  OpaquePixels candidates(count * ranks);
  std::copy_n(pixels.data() + begin(self), count, candidates.data() + self * count);
  forEachOther([&](std::size_t rank, int peer)
    { communicator.Receive(peer, TagCandidates, candidates.data() + rank * count, bytes(self)); });
  forEachOther([&](std::size_t rank, int peer)
    { communicator.Send(peer, TagCandidates, pixels.data() + begin(rank), bytes(rank)); });
  communicator.WaitAll();

  // In the order of the ranks, so that the lower one keeps a tie.
  OpaquePixel* nearest = pixels.data() + begin(self);
  std::copy_n(candidates.data(), count, nearest);
  for (std::size_t rank = 1; rank < ranks; ++rank)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      const OpaquePixel& other = candidates[rank * count + i];
      nearest[i] = other.Depth < nearest[i].Depth ? other : nearest[i];
    }
  }
  forEachOther([&](std::size_t rank, int peer)
    { communicator.Receive(peer, TagNearest, pixels.data() + begin(rank), bytes(rank)); });
  forEachOther(
    [&](std::size_t, int peer) { communicator.Send(peer, TagNearest, nearest, bytes(self)); });
  communicator.WaitAll();
}

} // namespace

void ReduceNearest(Communicator& communicator, OpaquePixels& pixels)
{
  CheckSizes(communicator, pixels.size());
  communicator.Together([&](Communicator& ranks) { NearestTogether(ranks, pixels); });
}

PixelRect ReduceNearestGeometry(Communicator& communicator, const PixelRect& rect,
  OpaquePixels& pixels, CompositeStatistics& statistics)
{
  const PixelRect mine =
    RectAround(rect, pixels, [](const OpaquePixel& pixel) { return pixel.Depth < 1.0f; });
  std::vector<PixelRect> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  PixelRect geometry;
  for (const PixelRect& one : all)
  {
    geometry = Union(geometry, one);
  }
  if (geometry.Empty() || communicator.Size() == 1)
  {
    return geometry;
  }
  const glm::ivec2 size = geometry.Size();
  OpaquePixels part;
  part.reserve(static_cast<std::size_t>(geometry.Count()));
  const auto rowOf = [&](int y)
  {
    const glm::ivec2 at = glm::ivec2(geometry.Lo.x, y) - rect.Lo;
    return pixels.begin() + static_cast<std::ptrdiff_t>(at.y) * rect.Size().x +
           static_cast<std::ptrdiff_t>(at.x);
  };
  for (int y = geometry.Lo.y; y < geometry.Hi.y; ++y)
  {
    part.insert(part.end(), rowOf(y), rowOf(y) + size.x);
  }
  ReduceNearest(communicator, part);
  for (int y = geometry.Lo.y; y < geometry.Hi.y; ++y)
  {
    std::copy_n(
      part.begin() + static_cast<std::ptrdiff_t>(y - geometry.Lo.y) * size.x, size.x, rowOf(y));
  }
  // Its own part of the pixels to the others, and theirs back: as ReduceNearest cuts them.
  const std::size_t ranks = all.size();
  const std::size_t self = static_cast<std::size_t>(communicator.Rank());
  const std::size_t own = part.size() * (self + 1) / ranks - part.size() * self / ranks;
  const std::uint64_t sent = (part.size() - own) + own * (ranks - 1);
  statistics.BytesSent += sent * sizeof(OpaquePixel);
  statistics.BytesReceived += sent * sizeof(OpaquePixel);
  statistics.MessagesSent += 2 * (ranks - 1);
  return geometry;
}

} // namespace banyan
