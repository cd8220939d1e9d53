// SPDX-License-Identifier: BSD-3-Clause
#include "OwnedSpans.h"

#include "Parallel/Composite/FragmentMessage.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace banyan::bench
{
namespace
{

constexpr int TagFragments = 32;
constexpr int TagResults = 33;

using Region = CompositePlan::Region;

void AddSpan(const OwnedSpan& span, const Footprint& footprint, Region& region)
{
  const Footprint::Interval row = footprint.Row(span.Y);
  const int lo = std::max(row.Lo, span.Lo);
  const int hi = std::min(row.Hi, span.Hi);
  if (lo < hi)
  {
    region.push_back({ span.Y, lo, hi, false });
  }
}

struct Incoming
{
  int From = 0;
  Region Pixels;
  std::unique_ptr<std::uint8_t[]> Data;
  std::size_t Bytes = 0;
};

/// What each rank sends to each other, in two rounds: fragments to owners, and results to the root.
struct Regions
{
  Regions(const PeerFrame& frame, const std::vector<OwnedSpan>& spans, int self)
    : Outgoing(frame.Footprints.size())
    , Incoming(frame.Footprints.size())
    , Results(frame.Footprints.size())
  {
    for (const OwnedSpan& span : spans)
    {
      AddSpan(span, frame.Footprints[static_cast<std::size_t>(self)], this->Outgoing[span.Owner]);
      for (std::size_t rank = 0; rank < this->Incoming.size() && span.Owner == self; ++rank)
      {
        AddSpan(span, frame.Footprints[rank], this->Incoming[rank]);
      }
      this->Results[span.Owner].push_back({ span.Y, span.Lo, span.Hi, false });
    }
  }

  std::vector<Region> Outgoing; ///< by owner
  std::vector<Region> Incoming; ///< by sender, of spans that this rank owns
  std::vector<Region> Results;  ///< by owner
};

/// The messages of one rank.
class SpanMessages
{
public:
  SpanMessages(Communicator& communicator, const FragmentFormat& format, bool dense,
    CompositeStatistics& statistics)
    : Ranks(communicator)
    , Format(format)
    , Dense(dense)
    , Statistics(statistics)
  {
  }

  void Send(const Region& region, const FloatImage& image, int to, int tag)
  {
    if (region.empty())
    {
      return;
    }
    FragmentWriter writer;
    writer.Append(region, image, this->Format, false, this->Dense);
    this->Outgoing.push_back(std::move(writer.Bytes));
    this->Ranks.SendWhole(to, tag, this->Outgoing.back().data(), this->Outgoing.back().size());
    this->Statistics.Sent(this->Outgoing.back().size());
  }

  void Expect(int from, const Region& region, int tag)
  {
    if (region.empty())
    {
      return;
    }
    const std::size_t capacity = FragmentBytesAtMost(region);
    this->Expected.push_back(
      { from, region, std::unique_ptr<std::uint8_t[]>(new std::uint8_t[capacity]), 0 });
    this->Ranks.ReceiveWhole(from, tag, this->Expected.back().Data.get(), capacity);
  }

  /// What has been expected, once all of it is here.
  std::vector<Incoming> TakeAll()
  {
    for (std::size_t i = 0; i < this->Expected.size(); ++i)
    {
      const Communicator::Arrival arrival = this->Ranks.WaitAnyWhole();
      this->Expected[arrival.Posted].Bytes = arrival.Bytes;
      this->Statistics.BytesReceived += arrival.Bytes;
    }
    this->Ranks.WaitAll();
    this->Outgoing.clear();
    return std::exchange(this->Expected, {});
  }

private:
  Communicator& Ranks;
  FragmentFormat Format;
  bool Dense;
  CompositeStatistics& Statistics;
  std::vector<Incoming> Expected;
  std::vector<std::vector<std::uint8_t>> Outgoing;
};

void Blend(const Incoming& message, FloatImage& target)
{
  FragmentReader(message.Data.get(), message.Bytes)
    .Blend(message.Pixels, target, FragmentReader::Place::Behind, Combination::Over);
}

void BlendMine(const Region& region, const FloatImage& mine, FloatImage& target)
{
  for (const CompositePlan::Run& run : region)
  {
    const bool inside = run.Y >= mine.Rect.Lo.y && run.Y < mine.Rect.Hi.y;
    const int hi = inside ? std::min(run.Hi, mine.Rect.Hi.x) : run.Lo;
    for (int x = std::max(run.Lo, mine.Rect.Lo.x); x < hi; ++x)
    {
      glm::vec4& pixel = target.At(x, run.Y);
      pixel = Combined(pixel, mine.At(x, run.Y), Combination::Over);
    }
  }
}

/// Around all spans of an owner, so that it needs no memory for the whole picture.
PixelRect RectOf(const Region& region)
{
  PixelRect rect;
  for (const CompositePlan::Run& run : region)
  {
    rect = Union(rect, { { run.Lo, run.Y }, { run.Hi, run.Y + 1 } });
  }
  return rect;
}

/// This rank's pixels and those that others have sent, in visibility order.
FloatImage BlendOwned(
  const PeerFrame& frame, const Regions& regions, const std::vector<Incoming>& fragments, int self)
{
  std::vector<const Incoming*> from(regions.Incoming.size(), nullptr);
  for (const Incoming& message : fragments)
  {
    from[message.From] = &message;
  }
  FloatImage picture;
  picture.Rect = self == 0 ? frame.Viewport : RectOf(regions.Results[self]);
  picture.Pixels.assign(static_cast<std::size_t>(picture.Rect.Count()), glm::vec4(0.0f));
  for (const int rank : frame.FrontToBack)
  {
    if (rank == self)
    {
      BlendMine(regions.Incoming[self], frame.Mine, picture);
    }
    else if (from[rank])
    {
      Blend(*from[rank], picture);
    }
  }
  return picture;
}

} // namespace

FloatImage CompositeOwnedSpans(Communicator& communicator, const PeerFrame& frame,
  const std::vector<OwnedSpan>& spans, bool dense, CompositeStatistics& statistics)
{
  const int self = communicator.Rank();
  const int ranks = communicator.Size();
  SpanMessages messages(communicator, frame.Format, dense, statistics);
  const Regions regions(frame, spans, self);
  for (int i = 1; i < ranks; ++i)
  {
    const int peer = (self + i) % ranks;
    messages.Expect(peer, regions.Incoming[peer], TagFragments);
  }
  for (int i = 1; i < ranks; ++i)
  {
    const int peer = (self + i) % ranks;
    messages.Send(regions.Outgoing[peer], frame.Mine, peer, TagFragments);
  }
  FloatImage picture = BlendOwned(frame, regions, messages.TakeAll(), self);
  if (self != 0)
  {
    messages.Send(regions.Results[self], picture, 0, TagResults);
    messages.TakeAll();
    return {};
  }
  for (int rank = 1; rank < ranks; ++rank)
  {
    messages.Expect(rank, regions.Results[rank], TagResults);
  }
  for (const Incoming& message : messages.TakeAll())
  {
    Blend(message, picture);
  }
  return picture;
}

} // namespace banyan::bench
