// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceExchange.h"

#include "Parallel/Communicate/Collective.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr int ShellTag = 71;
constexpr int ListTag = 72;
constexpr int BricksTag = 73;

std::size_t Index(int rank)
{
  return static_cast<std::size_t>(rank);
}

/// ExchangeShells, in a part of Communicator::Together.
std::uint64_t ShellsTogether(Communicator& communicator, const PieceGrid& grid,
  const std::vector<ScalarType>& viewTypes, PieceSamples& mine)
{
  const int self = communicator.Rank();
  std::vector<SampledBox> received;
  std::vector<BrickView> sent; ///< keeps what is sent until it has arrived
  std::uint64_t bytes = 0;
  std::string failure;
  for (int rank = 0; rank < communicator.Size(); ++rank)
  {
    for (const PieceGrid::ShellPart& part : grid.ShellOf(rank))
    {
      const ScalarType type = viewTypes[Index(part.From)];
      const std::size_t size = static_cast<std::size_t>(part.Samples.Count()) * SizeOf(type);
      if (rank != self && part.From != self)
      {
        continue;
      }
      void* values = nullptr;
      const BrickView view = AllocateView(part.Samples, type, values);
      if (rank == self)
      {
        communicator.Receive(part.From, ShellTag, values, size);
        received.push_back({ view, part.Samples });
        bytes += size;
        continue;
      }
      Attempt(failure,
        [&] {
          CopySamples({ mine.View(part.Samples), part.Samples }, part.Samples, type, values);
        });
      communicator.Send(rank, ShellTag, values, size);
      sent.push_back(view);
    }
  }
  communicator.WaitAll();
  ThrowTogether(communicator, failure);
  mine.SetShell(std::move(received));
  return bytes;
}

} // namespace

std::uint64_t ExchangeShells(Communicator& communicator, const PieceGrid& grid,
  const std::vector<ScalarType>& viewTypes, PieceSamples& mine)
{
  std::uint64_t bytes = 0;
  communicator.Together(
    [&](Communicator& ranks) { bytes = ShellsTogether(ranks, grid, viewTypes, mine); });
  return bytes;
}

BrickFetch::BrickFetch(const PieceGrid& grid, const std::vector<ScalarType>& viewTypes,
  const PieceSamples& mine, bool around)
  : Grid(grid)
  , ViewTypes(viewTypes)
  , Mine(mine)
  , Around(around)
{
}

ScalarType BrickFetch::TypeOf(std::int64_t brick) const
{
  const ScalarType type = this->ViewTypes[Index(this->Grid.HolderOf(brick))];
  const Box samples = this->Grid.BrickSamples(brick, this->Around);
  const bool known = !this->Around ||
                     this->Grid.SamplesOf(this->Grid.HolderOf(brick)).Contains(samples) ||
                     this->Grid.IsKnown(samples);
  return known ? type : TypeWithMissing(type);
}

std::uint64_t BrickFetch::BytesOf(std::int64_t brick) const
{
  return static_cast<std::uint64_t>(this->Grid.BrickSamples(brick, this->Around).Count()) *
         SizeOf(this->TypeOf(brick));
}

std::uint64_t BrickFetch::BytesOf(
  const std::vector<std::int64_t>& bricks, std::size_t first, std::size_t last) const
{
  std::uint64_t bytes = 0;
  for (std::size_t i = first; i < last; ++i)
  {
    bytes += this->BytesOf(bricks[i]);
  }
  return bytes;
}

/// Bricks that go into one message: at least one.
std::size_t BrickFetch::EndOfMessage(
  const std::vector<std::int64_t>& bricks, std::size_t first) const
{
  std::uint64_t bytes = 0;
  std::size_t last = first;
  while (last < bricks.size() && bytes < MessageBytes)
  {
    bytes += this->BytesOf(bricks[last]);
    ++last;
  }
  return last;
}

/// Tells each holder what is wanted of it. @return what others want of this rank
BrickFetch::Lists BrickFetch::TellHolders(
  Communicator& communicator, const Lists& from, const std::vector<std::int32_t>& counts)
{
  const std::size_t ranks = from.size();
  const std::size_t self = Index(communicator.Rank());
  Lists asked(ranks);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    asked[rank].resize(static_cast<std::size_t>(counts[rank * ranks + self]));
    if (!asked[rank].empty())
    {
      communicator.Receive(static_cast<int>(rank), ListTag, asked[rank].data(),
        asked[rank].size() * sizeof(std::int64_t));
    }
    if (!from[rank].empty())
    {
      communicator.Send(static_cast<int>(rank), ListTag, from[rank].data(),
        from[rank].size() * sizeof(std::int64_t));
    }
  }
  communicator.WaitAll();
  return asked;
}

void BrickFetch::Pack(
  const std::vector<std::int64_t>& bricks, std::size_t first, std::size_t last, char* out)
{
  for (std::size_t i = first; i < last; ++i)
  {
    const Box samples = this->Grid.BrickSamples(bricks[i], this->Around);
    Attempt(this->Failure,
      [&] {
        CopySamples({ this->Mine.View(samples), samples }, samples, this->TypeOf(bricks[i]), out);
      });
    out += this->BytesOf(bricks[i]);
  }
}

void BrickFetch::Unpack(const std::vector<std::int64_t>& bricks, std::size_t first,
  std::size_t last, const char* in, FetchedBricks& into)
{
  for (std::size_t i = first; i < last; ++i)
  {
    const Box samples = this->Grid.BrickSamples(bricks[i], this->Around);
    const std::uint64_t bytes = this->BytesOf(bricks[i]);
    Attempt(this->Failure,
      [&]
      {
        void* values = nullptr;
        const BrickView view = AllocateView(samples, this->TypeOf(bricks[i]), values);
        std::copy_n(in, bytes, static_cast<char*>(values));
        into.Keep(bricks[i], { view, samples }, bytes);
      });
    in += bytes;
  }
}

void BrickFetch::Exchange(Communicator& communicator, const std::vector<std::int64_t>& wanted,
  const std::vector<std::int32_t>& counts, FetchedBricks& into)
{
  communicator.Together(
    [&](Communicator& ranks) { this->ExchangeTogether(ranks, wanted, counts, into); });
}

void BrickFetch::ExchangeTogether(Communicator& communicator,
  const std::vector<std::int64_t>& wanted, const std::vector<std::int32_t>& counts,
  FetchedBricks& into)
{
  const std::size_t ranks = Index(communicator.Size());
  Lists from(ranks);
  for (const std::int64_t brick : wanted)
  {
    from[Index(this->Grid.HolderOf(brick))].push_back(brick);
  }
  const Lists to = this->TellHolders(communicator, from, counts);
  std::vector<std::size_t> sent(ranks, 0);
  std::vector<std::size_t> received(ranks, 0);
  // Rounds need no agreement: the n-th message between two ranks is in the n-th round of both, and
  // a rank that is behind finds all messages for its round on their way.
  for (bool more = true; more;)
  {
    more = false;
    std::vector<std::vector<char>> out(ranks);
    std::vector<std::vector<char>> in(ranks);
    std::vector<std::size_t> until(ranks, 0);
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      until[rank] = this->EndOfMessage(from[rank], received[rank]);
      in[rank].resize(this->BytesOf(from[rank], received[rank], until[rank]));
      if (!in[rank].empty())
      {
        communicator.Receive(static_cast<int>(rank), BricksTag, in[rank].data(), in[rank].size());
      }
    }
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      const std::size_t last = this->EndOfMessage(to[rank], sent[rank]);
      out[rank].resize(this->BytesOf(to[rank], sent[rank], last));
      if (!out[rank].empty())
      {
        this->Pack(to[rank], sent[rank], last, out[rank].data());
        communicator.Send(static_cast<int>(rank), BricksTag, out[rank].data(), out[rank].size());
      }
      sent[rank] = last;
      more = more || last < to[rank].size();
    }
    communicator.WaitAll();
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      this->Unpack(from[rank], received[rank], until[rank], in[rank].data(), into);
      received[rank] = until[rank];
      more = more || received[rank] < from[rank].size();
    }
  }
  const std::string agreed = AgreeOnError(communicator, this->Failure);
  if (!agreed.empty())
  {
    // Bricks that a rank could not give have come empty: the next frame must not find them.
    into.Clear();
    throw CollectiveError(agreed);
  }
}

} // namespace banyan
