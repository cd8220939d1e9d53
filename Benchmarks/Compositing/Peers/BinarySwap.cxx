// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Compositing.h"
#include "Parallel/FragmentMessage.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstring>
#include <memory>

namespace banyan
{
namespace
{

constexpr int FirstTag = 40;
constexpr int TagGather = 39;

/// A rectangle of pixels as one message: the rectangle, then all of its pixels.
class RectMessages
{
public:
  RectMessages(Communicator& communicator, const CompositeOptions& options,
    const PixelRect& viewport, CompositeStatistics& statistics)
    : Ranks(communicator)
    , Options(options)
    , Viewport(viewport)
    , Statistics(statistics)
  {
  }

  static CompositePlan::Region RowsOf(const PixelRect& rect)
  {
    CompositePlan::Region region;
    for (int y = rect.Lo.y; y < rect.Hi.y && !rect.Empty(); ++y)
    {
      region.push_back({ y, rect.Lo.x, rect.Hi.x, false });
    }
    return region;
  }

  /// What of `image` is drawn inside `rect`.
  void Send(
    int to, int tag, const FloatImage& image, const PixelRect& rect, const FragmentFormat& format)
  {
    const PixelRect active = ActiveRect(image, rect);
    FragmentWriter writer;
    writer.Bytes.resize(sizeof(active));
    std::memcpy(writer.Bytes.data(), &active, sizeof(active));
    writer.Append(RowsOf(active), image, format, false, true);
    this->Sent.push_back(std::move(writer.Bytes));
    this->Ranks.SendWhole(to, tag, this->Sent.back().data(), this->Sent.back().size());
    this->Statistics.Sent(this->Sent.back().size());
  }

  /// @param rect where what is sent lies
  void Expect(int from, int tag, const PixelRect& rect)
  {
    const std::size_t capacity = sizeof(rect) + FragmentBytesAtMost(RowsOf(rect));
    this->Received.emplace_back(new std::uint8_t[capacity]);
    this->Ranks.ReceiveWhole(from, tag, this->Received.back().get(), capacity);
  }

  /// Blends the next message that arrives into `target`, which grows.
  void BlendNext(FloatImage& target, FragmentReader::Place place)
  {
    const Communicator::Arrival arrival = this->Ranks.WaitAnyWhole();
    this->Statistics.BytesReceived += arrival.Bytes;
    const std::uint8_t* data = this->Received[arrival.Posted].get();
    PixelRect rect;
    if (arrival.Bytes >= sizeof(rect))
    {
      std::memcpy(&rect, data, sizeof(rect));
    }
    if (arrival.Bytes < sizeof(rect) ||
        !(rect.Empty() || Intersection(rect, this->Viewport) == rect))
    {
      throw Error("Pixels that another rank has sent lie outside of the viewport.");
    }
    if (!rect.Empty() && !(Union(target.Rect, rect) == target.Rect))
    {
      target = PartOf(target, Union(target.Rect, rect));
    }
    FragmentReader reader(data + sizeof(rect), arrival.Bytes - sizeof(rect));
    reader.Blend(RowsOf(rect), target, place, this->Options.Combine);
  }

  void Finish()
  {
    this->Ranks.WaitAll();
    this->Sent.clear();
    this->Received.clear();
  }

  /// The part of `image` inside `rect`, and nothing around it.
  static FloatImage PartOf(const FloatImage& image, const PixelRect& rect)
  {
    FloatImage part{ rect, PixelVector(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f)) };
    const PixelRect kept = Intersection(image.Rect, rect);
    for (int y = kept.Lo.y; y < kept.Hi.y; ++y)
    {
      const glm::vec4* row = &image.At(kept.Lo.x, y);
      std::copy(row, row + kept.Size().x, &part.At(kept.Lo.x, y));
    }
    return part;
  }

private:
  Communicator& Ranks;
  const CompositeOptions& Options;
  PixelRect Viewport;
  CompositeStatistics& Statistics;
  std::vector<std::vector<std::uint8_t>> Sent;
  std::vector<std::unique_ptr<std::uint8_t[]>> Received;
};

/// Who composites with whom: the largest power of two of groups, one after the other in visibility
/// order; the first groups have two ranks, of which the second one gives its picture to the first.
struct Groups
{
  int Count = 1;
  int Pairs = 0;
  int Stages = 0; ///< in which halves are exchanged

  explicit Groups(int ranks)
  {
    while (2 * this->Count <= ranks)
    {
      this->Count *= 2;
      ++this->Stages;
    }
    this->Pairs = ranks - this->Count;
  }
  /// Position in the visibility order of the first rank of a group.
  int PositionOf(int group) const { return group < this->Pairs ? 2 * group : group + this->Pairs; }
  int GroupOf(int position) const
  {
    return position < 2 * this->Pairs ? position / 2 : position - this->Pairs;
  }
};

/// Halves `rect` across its longer side; the lower half is that of the group with bit 0.
PixelRect HalfOf(const PixelRect& rect, bool upper)
{
  PixelRect half = rect;
  const int axis = rect.Size().x > rect.Size().y ? 0 : 1;
  const int middle = rect.Lo[axis] + rect.Size()[axis] / 2;
  (upper ? half.Lo : half.Hi)[axis] = middle;
  return half;
}

} // namespace

FloatImage CompositeBinarySwap(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics)
{
  const int ranks = communicator.Size();
  const Groups groups(ranks);
  const int position = static_cast<int>(
    std::find(frontToBack.begin(), frontToBack.end(), communicator.Rank()) - frontToBack.begin());
  const int group = groups.GroupOf(position);
  const bool second = groups.PositionOf(group) != position;
  const int behind = options.Behind.Empty() ? 0 : 1;
  // All fragments that meet in a pixel are rounded once per stage at most.
  const FragmentFormat format =
    FormatFor(options, ranks, std::max(1, groups.Stages + (groups.Pairs > 0 ? 1 : 0) + behind));

  RectMessages messages(communicator, options, viewport, statistics);
  FloatImage image = RectMessages::PartOf(mine, ActiveRect(mine, viewport));

  if (group < groups.Pairs)
  {
    if (second)
    {
      messages.Send(frontToBack[position - 1], FirstTag, image, viewport, format);
      image = {};
    }
    else
    {
      messages.Expect(frontToBack[position + 1], FirstTag, viewport);
      messages.BlendNext(image, FragmentReader::Place::Behind);
    }
    messages.Finish();
  }
  PixelRect part = second ? PixelRect{} : viewport;
  for (int stage = 0; stage < groups.Stages && !second; ++stage)
  {
    const int peer = group ^ (1 << stage);
    const bool upper = (group & (1 << stage)) != 0;
    const int peerRank = frontToBack[groups.PositionOf(peer)];
    const PixelRect kept = HalfOf(part, upper);
    messages.Expect(peerRank, FirstTag + 1 + stage, kept);
    messages.Send(peerRank, FirstTag + 1 + stage, image, HalfOf(part, !upper), format);
    image = RectMessages::PartOf(image, ActiveRect(image, kept));
    messages.BlendNext(
      image, peer < group ? FragmentReader::Place::Before : FragmentReader::Place::Behind);
    messages.Finish();
    part = kept;
  }

  if (communicator.Rank() != 0)
  {
    if (!second)
    {
      messages.Send(0, TagGather, image, part,
        behind != 0 ? FormatFor(options, 1, groups.Stages + 2) : FormatOfFinal(options));
    }
    messages.Finish();
    return {};
  }
  FloatImage picture = RectMessages::PartOf(image, viewport);
  int gathered = 0;
  for (int other = 0; other < groups.Count; ++other)
  {
    const int rank = frontToBack[groups.PositionOf(other)];
    if (rank != 0)
    {
      messages.Expect(rank, TagGather, viewport);
      ++gathered;
    }
  }
  for (int i = 0; i < gathered; ++i)
  {
    messages.BlendNext(picture, FragmentReader::Place::Behind);
  }
  messages.Finish();
  return picture;
}

} // namespace banyan
