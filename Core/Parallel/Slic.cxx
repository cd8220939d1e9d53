#include "Parallel/Compositing.h"
#include "Parallel/FragmentMessage.h"
#include "Parallel/SlicParts.h"

#include <algorithm>
#include <memory>

namespace banyan
{
namespace
{

using Kind = CompositePlan::Kind;

FloatImage Transparent(const PixelRect& rect)
{
  return { rect, std::vector<glm::vec4>(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f)) };
}

/// One frame of one rank.
class SlicFrame
{
public:
  SlicFrame(Communicator& communicator, const FloatImage& mine, const std::vector<int>& frontToBack,
    const PixelRect& viewport, const CompositeOptions& options, CompositeStatistics& statistics)
    : Ranks(communicator)
    , Mine(mine)
    , Order(frontToBack)
    , Options(options)
    , Statistics(statistics)
    , Ordered(options.Combine == Combination::Over)
    , Pack(Packs(options))
    , Plan(PlanCompositing(options.Footprints, viewport, options.Behind, this->Ordered))
    , Position(frontToBack.size())
  {
    for (std::size_t i = 0; i < frontToBack.size(); ++i)
    {
      this->Position[frontToBack[i]] = static_cast<int>(i);
    }
  }

  FloatImage Run()
  {
    const int self = this->Ranks.Rank();
    if (self == 0)
    {
      this->Picture = Transparent(this->Plan.Viewport);
      this->CopyOwn();
      this->ExpectAtRoot();
    }
    else
    {
      this->ExpectAsOwner();
      for (int chunk = 0; chunk < this->Plan.Chunks; ++chunk)
      {
        this->SendShared(chunk);
        this->SendDirect(chunk);
      }
      for (int chunk = 0; chunk < this->Plan.Chunks; ++chunk)
      {
        if (this->Missing[chunk] == 0)
        {
          this->SendResult(chunk);
        }
      }
    }
    for (std::size_t i = 0; i < this->Expected.size(); ++i)
    {
      this->TakeOne();
    }
    this->Ranks.WaitAll();
    return std::move(this->Picture);
  }

private:
  struct Message
  {
    int From;
    SlicMessage Sort;
    int Chunk;
    std::unique_ptr<std::uint8_t[]> Data; ///< not cleared: most of it is never touched
    std::size_t Bytes;
  };

  bool Owns(int rank, int tile) const { return this->Plan.Tiles[tile].Owner == rank; }
  bool BeforeRoot(int rank) const { return this->Position[rank] < this->Position[0]; }

  FragmentFormat DirectFormat(Kind kind) const
  {
    return kind == Kind::Final ? FormatOfFinal(this->Options) : FormatFor(this->Options, 1, 1);
  }
  FragmentFormat SharedFormat(Kind kind, int tile) const
  {
    return FormatFor(this->Options, this->Plan.Tiles[tile].Meeting, kind == Kind::Final ? 1 : 2);
  }
  FragmentFormat ResultFormat(Kind kind) const
  {
    return kind == Kind::Final ? FormatOfFinal(this->Options)
                               : FormatFor(this->Options, kind == Kind::Split ? 2 : 1, 2);
  }

  template <typename Action>
  void ForEachPart(int from, int to, SlicMessage sort, int chunk, const Action& action)
  {
    ForEachSlicPart(this->Plan, from, to, sort, chunk, this->Region, action);
  }

  /// Posts the receipt of a message unless it has no parts.
  bool Expect(int from, SlicMessage sort, int chunk)
  {
    std::size_t capacity = 0;
    this->ForEachPart(from, this->Ranks.Rank(), sort, chunk,
      [&](int, Kind kind, const CompositePlan::Region& region)
      {
        const int parts = sort == SlicMessage::Result && kind == Kind::Split ? 2 : 1;
        capacity += parts * FragmentBytesAtMost(region);
      });
    if (capacity == 0)
    {
      return false;
    }
    this->Expected.push_back(
      { from, sort, chunk, std::unique_ptr<std::uint8_t[]>(new std::uint8_t[capacity]), 0 });
    this->Ranks.ReceiveWhole(
      from, TagOfSlic(sort, chunk), this->Expected.back().Data.get(), capacity);
    return true;
  }

  void ExpectAtRoot()
  {
    for (int chunk = 0; chunk < this->Plan.Chunks; ++chunk)
    {
      for (int rank = 1; rank < this->Ranks.Size(); ++rank)
      {
        this->Expect(rank, SlicMessage::Direct, chunk);
        this->Expect(rank, SlicMessage::Result, chunk);
      }
    }
  }

  void ExpectAsOwner()
  {
    const int self = this->Ranks.Rank();
    this->Missing.assign(static_cast<std::size_t>(this->Plan.Chunks), -1);
    for (int chunk = 0; chunk < this->Plan.Chunks; ++chunk)
    {
      const std::vector<int>& tiles = this->Plan.TilesOfChunk[chunk];
      if (std::none_of(
            tiles.begin(), tiles.end(), [&](int tile) { return this->Owns(self, tile); }))
      {
        continue;
      }
      this->Missing[chunk] = 0;
      for (int rank = 1; rank < this->Ranks.Size(); ++rank)
      {
        this->Missing[chunk] +=
          rank != self && this->Expect(rank, SlicMessage::Shared, chunk) ? 1 : 0;
      }
    }
  }

  void Send(int to, SlicMessage sort, int chunk, std::vector<std::uint8_t> bytes)
  {
    if (bytes.empty())
    {
      return;
    }
    this->Outgoing.push_back(std::move(bytes));
    const std::vector<std::uint8_t>& kept = this->Outgoing.back();
    this->Ranks.SendWhole(to, TagOfSlic(sort, chunk), kept.data(), kept.size());
    this->Statistics.Sent(kept.size());
  }

  void SendDirect(int chunk)
  {
    FragmentWriter writer;
    this->ForEachPart(this->Ranks.Rank(), 0, SlicMessage::Direct, chunk,
      [&](int, Kind kind, const CompositePlan::Region& region)
      { writer.Append(region, this->Mine, this->DirectFormat(kind), this->Pack); });
    this->Send(0, SlicMessage::Direct, chunk, std::move(writer.Bytes));
  }

  void SendShared(int chunk)
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
      if (!owns[to + 1])
      {
        continue;
      }
      FragmentWriter writer;
      this->ForEachPart(self, to, SlicMessage::Shared, chunk,
        [&](int tile, Kind kind, const CompositePlan::Region& region)
        { writer.Append(region, this->Mine, this->SharedFormat(kind, tile), this->Pack); });
      this->Send(to, SlicMessage::Shared, chunk, std::move(writer.Bytes));
    }
  }

  /// Takes one message that has arrived, whichever.
  void TakeOne()
  {
    const Communicator::Arrival arrival = this->Ranks.WaitAnyWhole();
    Message& message = this->Expected[arrival.Posted];
    message.Bytes = arrival.Bytes;
    this->Statistics.BytesReceived += arrival.Bytes;
    if (this->Ranks.Rank() == 0)
    {
      this->BlendAtRoot(message);
      message.Data.reset();
    }
    else if (--this->Missing[message.Chunk] == 0)
    {
      this->SendResult(message.Chunk);
    }
  }

  void BlendAtRoot(const Message& message)
  {
    FragmentReader reader(message.Data.get(), message.Bytes);
    const auto blend = [&](const CompositePlan::Region& region, bool before)
    {
      reader.Blend(region, this->Picture,
        before ? FragmentReader::Place::Before : FragmentReader::Place::Behind,
        this->Options.Combine);
    };
    this->ForEachPart(message.From, 0, message.Sort, message.Chunk,
      [&](int, Kind kind, const CompositePlan::Region& region)
      {
        if (message.Sort == SlicMessage::Direct)
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

  /// The pixels of the root need not go anywhere.
  void CopyOwn()
  {
    const PixelRect& rect = this->Mine.Rect;
    for (int y = rect.Lo.y; y < rect.Hi.y && !rect.Empty(); ++y)
    {
      const glm::vec4* row = &this->Mine.At(rect.Lo.x, y);
      std::copy(row, row + rect.Size().x, &this->Picture.At(rect.Lo.x, y));
    }
  }

  /// Tiles of a chunk that this rank owns: what lies before the root's pixels (or all, where it has
  /// none), and what lies behind.
  struct Halves
  {
    FloatImage Before;
    FloatImage Behind;
  };

  void BlendOwn(int chunk, std::vector<Halves>& tiles)
  {
    const int self = this->Ranks.Rank();
    // Written and read as others' pixels are, but as floats: nothing is lost.
    FragmentWriter writer;
    this->ForEachPart(self, self, SlicMessage::Shared, chunk,
      [&](int, Kind, const CompositePlan::Region& region)
      { writer.Append(region, this->Mine, FragmentFormat{}, false); });
    this->BlendFrom(self, chunk, writer.Bytes.data(), writer.Bytes.size(), tiles);
  }

  void BlendFrom(
    int from, int chunk, const std::uint8_t* data, std::size_t bytes, std::vector<Halves>& tiles)
  {
    FragmentReader reader(data, bytes);
    this->ForEachPart(from, this->Ranks.Rank(), SlicMessage::Shared, chunk,
      [&](int tile, Kind kind, const CompositePlan::Region& region)
      {
        Halves& halves = tiles[this->IndexOfTile[tile]];
        const bool behind = kind == Kind::Split && !this->BeforeRoot(from);
        reader.Blend(region, behind ? halves.Behind : halves.Before, FragmentReader::Place::Behind,
          this->Options.Combine);
      });
  }

  void SendResult(int chunk)
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
        this->BlendOwn(chunk, tiles);
      }
      else if (from[rank])
      {
        this->BlendFrom(rank, chunk, from[rank]->Data.get(), from[rank]->Bytes, tiles);
        from[rank]->Data.reset();
      }
    }
    FragmentWriter writer;
    this->ForEachPart(self, 0, SlicMessage::Result, chunk,
      [&](int tile, Kind kind, const CompositePlan::Region& region)
      {
        const Halves& halves = tiles[this->IndexOfTile[tile]];
        writer.Append(region, halves.Before, this->ResultFormat(kind), this->Pack);
        if (kind == Kind::Split)
        {
          writer.Append(region, halves.Behind, this->ResultFormat(kind), this->Pack);
        }
      });
    this->Send(0, SlicMessage::Result, chunk, std::move(writer.Bytes));
  }

  Communicator& Ranks;
  const FloatImage& Mine;
  const std::vector<int>& Order;
  const CompositeOptions& Options;
  CompositeStatistics& Statistics;
  const bool Ordered;
  const bool Pack;
  const CompositePlan Plan;
  std::vector<int> Position; ///< of each rank in the visibility order
  FloatImage Picture;
  std::vector<Message> Expected;
  std::vector<int> Missing; ///< per chunk, messages for this owner under way; -1: not an owner
  std::vector<std::vector<std::uint8_t>> Outgoing;
  std::vector<std::size_t> IndexOfTile;
  CompositePlan::Region Region;
};

} // namespace

FloatImage CompositeSlic(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics)
{
  return SlicFrame(communicator, mine, frontToBack, viewport, options, statistics).Run();
}

} // namespace banyan
