// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/OwnedSpans.h"

#include "Parallel/FragmentMessage.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace banyan
{
namespace
{

constexpr int TagFragments = 32;
constexpr int TagResults = 33;

/// What one rank sends to another: spans that are still to be blended, and those that are not.
struct Parcel
{
  CompositePlan::Region Shared;
  CompositePlan::Region Sole;

  bool Empty() const { return this->Shared.empty() && this->Sole.empty(); }
};

void AddSpan(const OwnedSpan& span, const Footprint& footprint, Parcel& parcel)
{
  const Footprint::Interval row = footprint.Row(span.Y);
  const int lo = std::max(row.Lo, span.Lo);
  const int hi = std::min(row.Hi, span.Hi);
  if (lo < hi)
  {
    (span.Sole ? parcel.Sole : parcel.Shared).push_back({ span.Y, lo, hi, false });
  }
}

struct Incoming
{
  int From = 0;
  Parcel Pixels;
  std::unique_ptr<std::uint8_t[]> Data;
  std::size_t Bytes = 0;
};

class SpanFrame
{
public:
  SpanFrame(Communicator& communicator, const CompositeOptions& options,
    CompositeStatistics& statistics, int meeting, bool dense)
    : Ranks(communicator)
    , Options(options)
    , Statistics(statistics)
    , SoleFormat(options.Behind.Empty() ? FormatOfFinal(options) : FormatFor(options, 1, 1))
    , SharedFormat(FormatFor(options, meeting, options.Behind.Empty() ? 1 : 2))
    , ResultFormat(options.Behind.Empty() ? FormatOfFinal(options) : FormatFor(options, 1, 2))
    , Dense(dense)
  {
  }

  void Write(const Parcel& parcel, const FloatImage& image, int to, int tag)
  {
    if (parcel.Empty())
    {
      return;
    }
    FragmentWriter writer;
    const bool results = tag == TagResults;
    writer.Append(
      parcel.Shared, image, results ? this->ResultFormat : this->SharedFormat, false, this->Dense);
    writer.Append(parcel.Sole, image, this->SoleFormat, false, this->Dense);
    this->Outgoing.push_back(std::move(writer.Bytes));
    this->Ranks.SendWhole(to, tag, this->Outgoing.back().data(), this->Outgoing.back().size());
    this->Statistics.Sent(this->Outgoing.back().size());
  }

  void Expect(int from, Parcel parcel, int tag)
  {
    if (parcel.Empty())
    {
      return;
    }
    const std::size_t capacity =
      FragmentBytesAtMost(parcel.Shared) + FragmentBytesAtMost(parcel.Sole);
    this->Expected.push_back(
      { from, std::move(parcel), std::unique_ptr<std::uint8_t[]>(new std::uint8_t[capacity]), 0 });
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

  void Blend(const Incoming& message, FloatImage& target) const
  {
    FragmentReader reader(message.Data.get(), message.Bytes);
    for (const CompositePlan::Region* region : { &message.Pixels.Shared, &message.Pixels.Sole })
    {
      reader.Blend(*region, target, FragmentReader::Place::Behind, this->Options.Combine);
    }
  }

private:
  Communicator& Ranks;
  const CompositeOptions& Options;
  CompositeStatistics& Statistics;
  FragmentFormat SoleFormat;
  FragmentFormat SharedFormat;
  FragmentFormat ResultFormat;
  bool Dense;
  std::vector<Incoming> Expected;
  std::vector<std::vector<std::uint8_t>> Outgoing;
};

void BlendMine(
  const Parcel& parcel, const FloatImage& mine, FloatImage& target, Combination combination)
{
  for (const CompositePlan::Region* region : { &parcel.Shared, &parcel.Sole })
  {
    for (const CompositePlan::Run& run : *region)
    {
      const bool inside = run.Y >= mine.Rect.Lo.y && run.Y < mine.Rect.Hi.y;
      const int hi = inside ? std::min(run.Hi, mine.Rect.Hi.x) : run.Lo;
      for (int x = std::max(run.Lo, mine.Rect.Lo.x); x < hi; ++x)
      {
        glm::vec4& pixel = target.At(x, run.Y);
        pixel = Combined(pixel, mine.At(x, run.Y), combination);
      }
    }
  }
}

/// Around all spans of an owner, so that it needs no memory for the whole picture.
PixelRect RectOf(const std::vector<OwnedSpan>& spans, int owner)
{
  PixelRect rect;
  for (const OwnedSpan& span : spans)
  {
    if (span.Owner == owner)
    {
      rect = Union(rect, { { span.Lo, span.Y }, { span.Hi, span.Y + 1 } });
    }
  }
  return rect;
}

} // namespace

FloatImage CompositeOwnedSpans(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics, const std::vector<OwnedSpan>& spans, int meeting, bool dense)
{
  const int self = communicator.Rank();
  const std::size_t ranks = options.Footprints.size();
  SpanFrame frame(communicator, options, statistics, meeting, dense);
  std::vector<Parcel> outgoing(ranks);
  std::vector<Parcel> incoming(ranks);
  std::vector<Parcel> results(ranks);
  for (const OwnedSpan& span : spans)
  {
    AddSpan(span, options.Footprints[self], outgoing[span.Owner]);
    for (std::size_t rank = 0; rank < ranks && span.Owner == self; ++rank)
    {
      AddSpan(span, options.Footprints[rank], incoming[rank]);
    }
    results[span.Owner].Shared.push_back({ span.Y, span.Lo, span.Hi, false });
  }
  for (std::size_t i = 1; i < ranks; ++i)
  {
    const std::size_t peer = (static_cast<std::size_t>(self) + i) % ranks;
    frame.Expect(static_cast<int>(peer), incoming[peer], TagFragments);
  }
  for (std::size_t i = 1; i < ranks; ++i)
  {
    const std::size_t peer = (static_cast<std::size_t>(self) + i) % ranks;
    frame.Write(outgoing[peer], mine, static_cast<int>(peer), TagFragments);
  }
  const std::vector<Incoming> fragments = frame.TakeAll();
  std::vector<const Incoming*> from(ranks, nullptr);
  for (const Incoming& message : fragments)
  {
    from[message.From] = &message;
  }
  FloatImage picture;
  picture.Rect = self == 0 ? viewport : RectOf(spans, self);
  picture.Pixels.assign(static_cast<std::size_t>(picture.Rect.Count()), glm::vec4(0.0f));
  for (const int rank : frontToBack)
  {
    if (rank == self)
    {
      BlendMine(incoming[self], mine, picture, options.Combine);
    }
    else if (from[rank])
    {
      frame.Blend(*from[rank], picture);
    }
  }
  if (self != 0)
  {
    frame.Write(results[self], picture, 0, TagResults);
    frame.TakeAll();
    return {};
  }
  for (std::size_t rank = 1; rank < ranks; ++rank)
  {
    frame.Expect(static_cast<int>(rank), results[rank], TagResults);
  }
  for (const Incoming& message : frame.TakeAll())
  {
    frame.Blend(message, picture);
  }
  return picture;
}

} // namespace banyan
