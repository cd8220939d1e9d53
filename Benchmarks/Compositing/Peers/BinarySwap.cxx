// SPDX-License-Identifier: BSD-3-Clause
#include "PeerFrame.h"

#include "Base/Error.h"
#include "Parallel/Composite/Compositing.h"
#include "Parallel/Composite/FragmentMessage.h"

#include <algorithm>
#include <cstring>
#include <memory>

namespace banyan::bench
{
namespace
{

constexpr int FirstTag = 40;
constexpr int TagGather = 39;

/// A rectangle of pixels as one message: the rectangle, then all of its pixels.
class RectMessages
{
public:
  RectMessages(Communicator& communicator, const FragmentFormat& format, const PixelRect& viewport,
    CompositeStatistics& statistics)
    : Ranks(communicator)
    , Format(format)
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
  void Send(int to, int tag, const FloatImage& image, const PixelRect& rect)
  {
    const PixelRect active = ActiveRect(image, rect);
    FragmentWriter writer;
    writer.Bytes.resize(sizeof(active));
    std::memcpy(writer.Bytes.data(), &active, sizeof(active));
    writer.Append(RowsOf(active), image, this->Format, false, true);
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
    reader.Blend(RowsOf(rect), target, place, Combination::Over);
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
  FragmentFormat Format;
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

/// One rank's part of a frame.
class SwapFrame
{
public:
  SwapFrame(Communicator& communicator, const PeerFrame& frame, CompositeStatistics& statistics)
    : Order(frame.FrontToBack)
    , Viewport(frame.Viewport)
    , Ranks(communicator.Size())
    , Messages(communicator, frame.Format, frame.Viewport, statistics)
    , Image(RectMessages::PartOf(frame.Mine, ActiveRect(frame.Mine, frame.Viewport)))
  {
    this->Position = static_cast<int>(
      std::find(this->Order.begin(), this->Order.end(), communicator.Rank()) - this->Order.begin());
    this->Group = this->Ranks.GroupOf(this->Position);
    this->IsSecond = this->Ranks.PositionOf(this->Group) != this->Position;
  }

  /// The second rank of a pair gives its picture to the first.
  void JoinPairs()
  {
    if (this->Group < this->Ranks.Pairs && this->IsSecond)
    {
      this->Messages.Send(this->Order[this->Position - 1], FirstTag, this->Image, this->Viewport);
      this->Image = {};
    }
    else if (this->Group < this->Ranks.Pairs)
    {
      this->Messages.Expect(this->Order[this->Position + 1], FirstTag, this->Viewport);
      this->Messages.BlendNext(this->Image, FragmentReader::Place::Behind);
    }
    this->Messages.Finish();
  }

  void ExchangeHalves()
  {
    this->Part = this->IsSecond ? PixelRect{} : this->Viewport;
    for (int stage = 0; stage < this->Ranks.Stages && !this->IsSecond; ++stage)
    {
      const int peer = this->Group ^ (1 << stage);
      const bool upper = (this->Group & (1 << stage)) != 0;
      const int peerRank = this->Order[this->Ranks.PositionOf(peer)];
      const PixelRect kept = HalfOf(this->Part, upper);
      const PixelRect given = HalfOf(this->Part, !upper);
      this->Messages.Expect(peerRank, FirstTag + 1 + stage, kept);
      this->Messages.Send(peerRank, FirstTag + 1 + stage, this->Image, given);
      this->Image = RectMessages::PartOf(this->Image, ActiveRect(this->Image, kept));
      this->Messages.BlendNext(this->Image,
        peer < this->Group ? FragmentReader::Place::Before : FragmentReader::Place::Behind);
      this->Messages.Finish();
      this->Part = kept;
    }
  }

  void SendPart()
  {
    if (!this->IsSecond)
    {
      this->Messages.Send(0, TagGather, this->Image, this->Part);
    }
    this->Messages.Finish();
  }

  FloatImage Gather()
  {
    FloatImage picture = RectMessages::PartOf(this->Image, this->Viewport);
    int gathered = 0;
    for (int group = 0; group < this->Ranks.Count; ++group)
    {
      const int rank = this->Order[this->Ranks.PositionOf(group)];
      if (rank != 0)
      {
        this->Messages.Expect(rank, TagGather, this->Viewport);
        ++gathered;
      }
    }
    for (int i = 0; i < gathered; ++i)
    {
      this->Messages.BlendNext(picture, FragmentReader::Place::Behind);
    }
    this->Messages.Finish();
    return picture;
  }

private:
  const std::vector<int>& Order;
  PixelRect Viewport;
  Groups Ranks;
  RectMessages Messages;
  FloatImage Image;
  PixelRect Part; ///< of the viewport, that this rank has blended
  int Position = 0;
  int Group = 0;
  bool IsSecond = false;
};

} // namespace

FloatImage CompositeBinarySwap(
  Communicator& communicator, const PeerFrame& frame, CompositeStatistics& statistics)
{
  SwapFrame swap(communicator, frame, statistics);
  swap.JoinPairs();
  swap.ExchangeHalves();
  if (communicator.Rank() == 0)
  {
    return swap.Gather();
  }
  swap.SendPart();
  return {};
}

} // namespace banyan::bench
