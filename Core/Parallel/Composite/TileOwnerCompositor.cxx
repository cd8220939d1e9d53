// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/TileOwnerCompositor.h"

#include "Parallel/Composite/FragmentMessage.h"

#include <algorithm>
#include <new>
#include <utility>

namespace banyan
{
namespace
{

FloatImage Transparent(const PixelRect& rect)
{
  return { rect, PixelVector(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f)) };
}

} // namespace

TileOwnerCompositor::TileOwnerCompositor(Communicator& communicator,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics, int chunksBefore)
  : Ranks(communicator)
  , Order(frontToBack)
  , Options(options)
  , Statistics(statistics)
  , ChunksBefore(chunksBefore)
  , Ordered(options.Combine == Combination::Over)
  , Pack(Packs(options))
  , SharedPlan(CompositePlanCache::From(
      options.Plans, options.Footprints, viewport, options.Behind, this->Ordered, options.Root))
  , Plan(*this->SharedPlan)
  , Position(frontToBack.size())
  , Parts(static_cast<std::size_t>(this->Plan.Chunks))
{
  for (std::size_t i = 0; i < frontToBack.size(); ++i)
  {
    this->Position[frontToBack[i]] = static_cast<int>(i);
  }
}

TileOwnerCompositor::~TileOwnerCompositor()
{
  if (!this->Finished)
  {
    // After an error messages may still be under way, while this process says what is wrong and
    // ends: their memory is not given back.
    for (Message& message : this->Expected)
    {
      (void)message.Data.release();
    }
    (void)new (std::nothrow) std::vector<std::vector<std::uint8_t>>(std::move(this->Outgoing));
  }
}

void TileOwnerCompositor::Begin(std::size_t postedBefore)
{
  this->PostedBefore = postedBefore;
  if (this->IsRoot())
  {
    this->Picture = Transparent(this->Plan.Viewport);
    for (int chunk = 0; chunk < this->Plan.Chunks; ++chunk)
    {
      for (int rank = 0; rank < this->Ranks.Size(); ++rank)
      {
        if (rank != this->Plan.Root)
        {
          this->Expect(rank, TileMessage::Direct, chunk);
          this->Expect(rank, TileMessage::Result, chunk);
        }
      }
    }
  }
  else
  {
    this->ExpectAsOwner();
  }
}

void TileOwnerCompositor::Add(int chunk, const FloatImage* mine)
{
  Part& part = this->Parts[chunk];
  part.Added = true;
  part.Failed = part.Failed || !mine;
  if (!this->IsRoot())
  {
    this->SendShared(chunk, mine);
    this->SendDirect(chunk, mine);
    if (mine && part.Missing >= 0)
    {
      this->KeepOwn(chunk, *mine);
    }
    this->SendResults();
    return;
  }
  if (mine)
  {
    this->CopyOwn(chunk, *mine);
  }
  for (Message& message : this->Expected)
  {
    if (message.Here && message.Chunk == chunk)
    {
      this->BlendAtRoot(message);
    }
  }
}

void TileOwnerCompositor::Poll()
{
  Communicator::Arrival arrival;
  while (this->Ranks.TakeAnyWhole(arrival))
  {
    this->Take(arrival);
  }
}

FloatImage TileOwnerCompositor::Finish()
{
  while (this->Open > 0)
  {
    this->Take(this->Ranks.WaitAnyWhole());
  }
  this->Ranks.WaitAll();
  this->Finished = true;
  return std::move(this->Picture);
}

/// Posts the receipt of a message unless it has no parts.
bool TileOwnerCompositor::Expect(int from, TileMessage sort, int chunk)
{
  std::size_t capacity = 0;
  this->ForEachPart(from, this->Ranks.Rank(), sort, chunk,
    [&](int, Kind kind, const CompositePlan::Region& region)
    {
      const int parts = sort == TileMessage::Result && kind == Kind::Split ? 2 : 1;
      capacity += parts * FragmentBytesAtMost(region);
    });
  if (capacity == 0)
  {
    return false;
  }
  this->Expected.push_back(
    { from, sort, chunk, std::unique_ptr<std::uint8_t[]>(new std::uint8_t[capacity]), 0, false });
  this->Ranks.ReceiveWhole(
    from, this->TagOf(sort, chunk), this->Expected.back().Data.get(), capacity);
  ++this->Open;
  return true;
}

void TileOwnerCompositor::ExpectAsOwner()
{
  const int self = this->Ranks.Rank();
  for (int chunk = 0; chunk < this->Plan.Chunks; ++chunk)
  {
    const std::vector<int>& tiles = this->Plan.TilesOfChunk[chunk];
    if (std::none_of(tiles.begin(), tiles.end(), [&](int tile) { return this->Owns(self, tile); }))
    {
      continue;
    }
    int& missing = this->Parts[chunk].Missing;
    missing = 0;
    for (int rank = 0; rank < this->Ranks.Size(); ++rank)
    {
      missing +=
        rank != self && rank != this->Plan.Root && this->Expect(rank, TileMessage::Shared, chunk)
          ? 1
          : 0;
    }
  }
}

/// Sends a message unless it has no parts.
/// @param failed sends an empty one then
/// @param write called as write(writer, tile, kind, region) for each part
template <typename Write>
void TileOwnerCompositor::Send(int to, TileMessage sort, int chunk, bool failed, const Write& write)
{
  FragmentWriter writer;
  bool any = false;
  this->ForEachPart(this->Ranks.Rank(), to, sort, chunk,
    [&](int tile, Kind kind, const CompositePlan::Region& region)
    {
      any = true;
      if (!failed)
      {
        write(writer, tile, kind, region);
      }
    });
  if (!any)
  {
    return;
  }
  this->Outgoing.push_back(std::move(writer.Bytes));
  const std::vector<std::uint8_t>& kept = this->Outgoing.back();
  this->Ranks.SendWhole(to, this->TagOf(sort, chunk), kept.data(), kept.size());
  this->Statistics.Sent(kept.size());
}

void TileOwnerCompositor::SendDirect(int chunk, const FloatImage* mine)
{
  this->Send(this->Plan.Root, TileMessage::Direct, chunk, !mine,
    [&](FragmentWriter& writer, int, Kind kind, const CompositePlan::Region& region)
    { writer.Append(region, *mine, this->DirectFormat(kind), this->Pack); });
}

void TileOwnerCompositor::SendShared(int chunk, const FloatImage* mine)
{
  // Everybody begins with another owner, so that not all send to the same one at once.
  const int ranks = this->Ranks.Size();
  const int self = this->Ranks.Rank();
  std::vector<bool> owns(static_cast<std::size_t>(ranks) + 1, false);
  for (const int tile : this->Plan.TilesOfRank[self])
  {
    owns[this->Plan.Tiles[tile].Owner + 1] = true;
  }
  for (int i = 1; i < ranks; ++i)
  {
    const int to = (self + i) % ranks;
    if (owns[to + 1])
    {
      this->Send(to, TileMessage::Shared, chunk, !mine,
        [&](FragmentWriter& writer, int tile, Kind kind, const CompositePlan::Region& region)
        { writer.Append(region, *mine, this->SharedFormat(kind, tile), this->Pack); });
    }
  }
}

void TileOwnerCompositor::Take(const Communicator::Arrival& arrival)
{
  const std::size_t number = arrival.Posted - this->PostedBefore; // of another picture: too large
  if (number >= this->Expected.size())
  {
    return;
  }
  Message& message = this->Expected[number];
  message.Bytes = arrival.Bytes;
  message.Here = true;
  --this->Open;
  this->Statistics.BytesReceived += arrival.Bytes;
  Part& part = this->Parts[message.Chunk];
  if (!this->IsRoot())
  {
    --part.Missing;
    part.Failed = part.Failed || arrival.Bytes == 0;
  }
  else if (part.Added)
  {
    this->BlendAtRoot(message);
  }
  this->SendResults();
}

void TileOwnerCompositor::BlendAtRoot(Message& message)
{
  FragmentReader reader(message.Data.get(), message.Bytes);
  const auto blend = [&](const CompositePlan::Region& region, bool before)
  {
    reader.Blend(region, this->Picture,
      before ? FragmentReader::Place::Before : FragmentReader::Place::Behind,
      this->Options.Combine);
  };
  if (message.Bytes > 0)
  {
    this->ForEachPart(message.From, this->Plan.Root, message.Sort, message.Chunk,
      [&](int, Kind kind, const CompositePlan::Region& region)
      {
        if (message.Sort == TileMessage::Direct)
        {
          blend(region, this->BeforeRoot(message.From));
          return;
        }
        blend(region, true);
        if (kind == Kind::Split)
        {
          blend(region, false);
        }
      });
  }
  message.Data.reset();
}

/// The pixels of the root need not go anywhere.
void TileOwnerCompositor::CopyOwn(int chunk, const FloatImage& mine)
{
  for (const int tile : this->Plan.TilesOfRank[this->Plan.Root])
  {
    const bool wanted = this->Plan.Tiles[tile].Chunk == chunk;
    const PixelRect rect =
      wanted ? Intersection(mine.Rect, this->Plan.RectOfTile(tile)) : PixelRect{};
    for (int y = rect.Lo.y; y < rect.Hi.y && !rect.Empty(); ++y)
    {
      const glm::vec4* row = &mine.At(rect.Lo.x, y);
      std::copy(row, row + rect.Size().x, &this->Picture.At(rect.Lo.x, y));
    }
  }
}

/// Written and read as others' pixels are, but as floats: nothing is lost.
void TileOwnerCompositor::KeepOwn(int chunk, const FloatImage& mine)
{
  const int self = this->Ranks.Rank();
  FragmentWriter writer;
  this->ForEachPart(self, self, TileMessage::Shared, chunk,
    [&](int, Kind, const CompositePlan::Region& region)
    { writer.Append(region, mine, FragmentFormat{}, false); });
  this->Parts[chunk].Own = std::move(writer.Bytes);
}

void TileOwnerCompositor::BlendFrom(
  int from, int chunk, const std::uint8_t* data, std::size_t bytes, std::vector<Halves>& tiles)
{
  FragmentReader reader(data, bytes);
  this->ForEachPart(from, this->Ranks.Rank(), TileMessage::Shared, chunk,
    [&](int tile, Kind kind, const CompositePlan::Region& region)
    {
      Halves& halves = tiles[this->IndexOfTile[tile]];
      const bool behind = kind == Kind::Split && !this->BeforeRoot(from);
      reader.Blend(region, behind ? halves.Behind : halves.Before, FragmentReader::Place::Behind,
        this->Options.Combine);
    });
}

/// Sends the results of all chunks that are complete.
void TileOwnerCompositor::SendResults()
{
  for (std::size_t chunk = 0; chunk < this->Parts.size(); ++chunk)
  {
    Part& part = this->Parts[chunk];
    if (part.Added && part.Missing == 0 && !part.Passed)
    {
      this->SendResult(static_cast<int>(chunk));
      part.Passed = true;
    }
  }
}

/// Blends the tiles that this rank owns.
std::vector<TileOwnerCompositor::Halves> TileOwnerCompositor::BlendTiles(int chunk)
{
  const int self = this->Ranks.Rank();
  std::vector<Halves> tiles;
  this->IndexOfTile.resize(this->Plan.Tiles.size());
  for (const int tile : this->Plan.TilesOfChunk[chunk])
  {
    if (this->Owns(self, tile))
    {
      this->IndexOfTile[tile] = tiles.size();
      const PixelRect rect = this->Plan.RectOfTile(tile);
      tiles.push_back({ Transparent(rect), {} });
      this->Plan.ResultRegion(tile, Kind::Split, this->Region);
      if (!this->Region.empty())
      {
        tiles.back().Behind = Transparent(rect);
      }
    }
  }
  std::vector<Message*> from(this->Position.size(), nullptr);
  for (Message& message : this->Expected)
  {
    if (message.Chunk == chunk)
    {
      from[message.From] = &message;
    }
  }
  for (const int rank : this->Order)
  {
    if (rank == self)
    {
      const std::vector<std::uint8_t> own = std::move(this->Parts[chunk].Own);
      this->BlendFrom(self, chunk, own.data(), own.size(), tiles);
    }
    else if (from[rank])
    {
      this->BlendFrom(rank, chunk, from[rank]->Data.get(), from[rank]->Bytes, tiles);
      from[rank]->Data.reset();
    }
  }
  return tiles;
}

void TileOwnerCompositor::SendResult(int chunk)
{
  const bool failed = this->Parts[chunk].Failed;
  const std::vector<Halves> tiles = failed ? std::vector<Halves>{} : this->BlendTiles(chunk);
  this->Send(this->Plan.Root, TileMessage::Result, chunk, failed,
    [&](FragmentWriter& writer, int tile, Kind kind, const CompositePlan::Region& region)
    {
      const Halves& halves = tiles[this->IndexOfTile[tile]];
      writer.Append(region, halves.Before, this->ResultFormat(kind), this->Pack);
      if (kind == Kind::Split)
      {
        writer.Append(region, halves.Behind, this->ResultFormat(kind), this->Pack);
      }
    });
}

} // namespace banyan
