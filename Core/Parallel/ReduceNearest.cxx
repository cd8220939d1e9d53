#include "Parallel/DirectSend.h"

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

} // namespace

// Every rank decides one part of the picture: each pixel crosses the network twice and no rank
// carries more than another, whatever the number of ranks.
void ReduceNearest(Communicator& communicator, std::vector<OpaquePixel>& pixels)
{
  CheckSizes(communicator, pixels.size());
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
  std::vector<OpaquePixel> candidates(count * ranks);
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

} // namespace banyan
