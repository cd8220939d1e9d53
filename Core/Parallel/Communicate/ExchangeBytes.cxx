// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/ExchangeBytes.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <cstdint>
#include <utility>

namespace banyan
{
namespace
{

constexpr int Tag = 60; // below those of compositing

/// @param to gives the message to each rank
template <class Function>
std::vector<Bytes> Exchange(Communicator& communicator, const Function& to, std::string failure)
{
  const auto size = static_cast<std::size_t>(communicator.Size());
  const auto mine = static_cast<std::size_t>(communicator.Rank());
  std::vector<std::uint64_t> sizes(size);
  for (std::size_t rank = 0; rank < size; ++rank)
  {
    sizes[rank] = failure.empty() && rank != mine ? to(rank).size() : 0;
  }
  std::vector<std::uint64_t> all(size * size);
  communicator.AllGather(sizes.data(), size * sizeof(sizes[0]), all.data());
  std::vector<Bytes> from(size);
  Attempt(failure,
    [&]
    {
      for (std::size_t rank = 0; rank < size; ++rank)
      {
        from[rank].resize(static_cast<std::size_t>(all[rank * size + mine]));
      }
    });
  ThrowTogether(communicator, failure);
  communicator.Together(
    [&](Communicator& ranks)
    {
      for (std::size_t rank = 0; rank < size; ++rank)
      {
        if (!from[rank].empty())
        {
          ranks.Receive(static_cast<int>(rank), Tag, from[rank].data(), from[rank].size());
        }
      }
      for (std::size_t rank = 0; rank < size; ++rank)
      {
        if (sizes[rank] > 0)
        {
          ranks.Send(static_cast<int>(rank), Tag, to(rank).data(), to(rank).size());
        }
      }
      ranks.WaitAll();
    });
  return from;
}

} // namespace

std::vector<Bytes> ExchangeBytes(
  Communicator& communicator, std::vector<Bytes> to, std::string failure)
{
  to.resize(static_cast<std::size_t>(communicator.Size()));
  std::vector<Bytes> from = Exchange(
    communicator, [&](std::size_t rank) -> const Bytes& { return to[rank]; }, std::move(failure));
  const auto mine = static_cast<std::size_t>(communicator.Rank());
  from[mine] = std::move(to[mine]);
  return from;
}

std::vector<Bytes> AllGatherBytes(Communicator& communicator, Bytes mine, std::string failure)
{
  std::vector<Bytes> from = Exchange(
    communicator, [&](std::size_t) -> const Bytes& { return mine; }, std::move(failure));
  from[static_cast<std::size_t>(communicator.Rank())] = std::move(mine);
  return from;
}

} // namespace banyan
