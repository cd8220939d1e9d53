// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/ExchangeBytes.h"

#include "Parallel/Communicate/Communicator.h"

#include <cstdint>
#include <utility>

namespace banyan
{
namespace
{

constexpr int Tag = 60; // below those of compositing

} // namespace

std::vector<Bytes> ExchangeBytes(Communicator& communicator, std::vector<Bytes> to)
{
  const auto size = static_cast<std::size_t>(communicator.Size());
  const auto mine = static_cast<std::size_t>(communicator.Rank());
  std::vector<std::uint64_t> sizes(size);
  for (std::size_t rank = 0; rank < size; ++rank)
  {
    sizes[rank] = to[rank].size();
  }
  std::vector<std::uint64_t> all(size * size);
  communicator.AllGather(sizes.data(), size * sizeof(sizes[0]), all.data());
  std::vector<Bytes> from(size);
  from[mine] = std::move(to[mine]);
  communicator.Together(
    [&](Communicator& ranks)
    {
      for (std::size_t rank = 0; rank < size; ++rank)
      {
        const auto bytes = static_cast<std::size_t>(all[rank * size + mine]);
        if (rank != mine && bytes > 0)
        {
          from[rank].resize(bytes);
          ranks.Receive(static_cast<int>(rank), Tag, from[rank].data(), bytes);
        }
      }
      for (std::size_t rank = 0; rank < size; ++rank)
      {
        if (rank != mine && !to[rank].empty())
        {
          ranks.Send(static_cast<int>(rank), Tag, to[rank].data(), to[rank].size());
        }
      }
      ranks.WaitAll();
    });
  return from;
}

} // namespace banyan
