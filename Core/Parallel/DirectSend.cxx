#include "Parallel/DirectSend.h"

#include "Base/Error.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace banyan
{
namespace
{

constexpr int TagRect = 1;
constexpr int TagPixels = 2;

PixelRect Common(const PixelRect& a, const PixelRect& b)
{
  return { glm::max(a.Lo, b.Lo), glm::min(a.Hi, b.Hi) };
}

bool Inside(const PixelRect& inner, const PixelRect& outer)
{
  return inner.Empty() || Common(inner, outer) == inner;
}

std::size_t RowLength(const PixelRect& rect)
{
  return static_cast<std::size_t>(rect.Size().x);
}

/// Where pixel (rect.Lo.x, y) lies in an image of that rectangle.
std::size_t RowBegin(const PixelRect& image, const PixelRect& rect, int y)
{
  return static_cast<std::size_t>(y - image.Lo.y) * RowLength(image) +
         static_cast<std::size_t>(rect.Lo.x - image.Lo.x);
}

FloatImage Transparent(const PixelRect& rect)
{
  return { rect, std::vector<glm::vec4>(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f)) };
}

/// Smallest rectangle around the pixels of `image` inside `rect` that are not all zero.
PixelRect ActiveRect(const FloatImage& image, const PixelRect& rect)
{
  constexpr int most = std::numeric_limits<int>::max();
  constexpr int least = std::numeric_limits<int>::min();
  const PixelRect searched = Common(image.Rect, rect);
  PixelRect active{ glm::ivec2(most), glm::ivec2(least) };
  const auto drawn = [](const glm::vec4& pixel) { return pixel != glm::vec4(0.0f); };
  for (int y = searched.Lo.y; y < searched.Hi.y && !searched.Empty(); ++y)
  {
    const glm::vec4* begin = image.Pixels.data() + RowBegin(image.Rect, searched, y);
    const glm::vec4* end = begin + RowLength(searched);
    const glm::vec4* first = std::find_if(begin, end, drawn);
    if (first == end)
    {
      continue;
    }
    const auto last =
      std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), drawn);
    active.Lo.x = std::min(active.Lo.x, searched.Lo.x + static_cast<int>(first - begin));
    active.Hi.x = std::max(active.Hi.x, searched.Lo.x + static_cast<int>(last.base() - begin));
    active.Lo.y = std::min(active.Lo.y, y);
    active.Hi.y = y + 1;
  }
  return active.Empty() ? PixelRect{} : active;
}

FloatImage Cut(const FloatImage& image, const PixelRect& rect)
{
  FloatImage part{ rect, {} };
  part.Pixels.reserve(static_cast<std::size_t>(rect.Count()));
  for (int y = rect.Lo.y; y < rect.Hi.y && !rect.Empty(); ++y)
  {
    const auto begin =
      image.Pixels.begin() + static_cast<std::ptrdiff_t>(RowBegin(image.Rect, rect, y));
    part.Pixels.insert(
      part.Pixels.end(), begin, begin + static_cast<std::ptrdiff_t>(RowLength(rect)));
  }
  return part;
}

glm::vec4 Combine(const glm::vec4& front, const glm::vec4& back, Combination combination)
{
  switch (combination)
  {
    case Combination::Largest:
      return glm::max(front, back);
    case Combination::Sum:
      return front + back;
    default:
      return Over(front, back);
  }
}

/// Puts `behind`, whose rectangle lies inside that of `target`, behind what is there.
void BlendBehind(FloatImage& target, const FloatImage& behind, Combination combination)
{
  const glm::vec4* from = behind.Pixels.data();
  for (int y = behind.Rect.Lo.y; y < behind.Rect.Hi.y && !behind.Rect.Empty(); ++y)
  {
    glm::vec4* to = target.Pixels.data() + RowBegin(target.Rect, behind.Rect, y);
    for (std::size_t x = 0; x < RowLength(behind.Rect); ++x, ++to, ++from)
    {
      *to = Combine(*to, *from, combination);
    }
  }
}

/// What every rank tells all others before pixels travel.
struct Announcement
{
  PixelRect Viewport;
  PixelRect Active; ///< of this rank's image
  std::uint64_t Order = 0;
  std::int64_t Valid = 0; ///< whether this rank's arguments fit together
};

bool IsPermutation(const std::vector<int>& order, int ranks)
{
  std::vector<bool> seen(static_cast<std::size_t>(ranks), false);
  for (const int rank : order)
  {
    if (rank < 0 || rank >= ranks || seen[rank])
    {
      return false;
    }
    seen[rank] = true;
  }
  return order.size() == seen.size();
}

std::uint64_t Fingerprint(const std::vector<int>& order)
{
  std::uint64_t hash = 14695981039346656037u; // FNV-1a
  for (const int rank : order)
  {
    hash = (hash ^ static_cast<std::uint64_t>(rank)) * 1099511628211u;
  }
  return hash;
}

/// Collective; throws the same Error on all ranks when one of them was called wrongly, because a
/// rank that gave up alone would leave the others waiting.
std::vector<Announcement> Announce(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport)
{
  Announcement own;
  own.Viewport = viewport;
  own.Order = Fingerprint(frontToBack);
  own.Valid = Inside(mine.Rect, viewport) && IsPermutation(frontToBack, communicator.Size()) &&
              static_cast<long long>(mine.Pixels.size()) == mine.Rect.Count();
  if (own.Valid)
  {
    own.Active = ActiveRect(mine, viewport);
  }
  std::vector<Announcement> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&own, sizeof(own), all.data());
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    if (!all[rank].Valid)
    {
      throw Error(
        "Rank " + std::to_string(rank) +
        " brought an image that does not fit into the viewport, or a visibility order that is not "
        "one of all ranks, so no picture could be put together.");
    }
    if (all[rank].Order != all[0].Order || !(all[rank].Viewport == all[0].Viewport))
    {
      throw Error(
        "Rank " + std::to_string(rank) +
        " and rank 0 disagree about the viewport or the visibility order, so no picture could be "
        "put together.");
    }
  }
  return all;
}

/// One strip of whole rows per rank, balanced by the pixels that may be drawn in each row.
std::vector<PixelRect> Strips(const std::vector<Announcement>& all)
{
  const PixelRect viewport = all[0].Viewport;
  std::vector<long long> until(static_cast<std::size_t>(viewport.Size().y) + 1, 0);
  for (int y = viewport.Lo.y; y < viewport.Hi.y; ++y)
  {
    const std::size_t row = static_cast<std::size_t>(y - viewport.Lo.y);
    until[row + 1] = until[row];
    for (const Announcement& rank : all)
    {
      const bool crosses = rank.Active.Lo.y <= y && y < rank.Active.Hi.y;
      until[row + 1] += crosses ? rank.Active.Size().x : 0;
    }
  }
  std::vector<PixelRect> strips(all.size());
  int begin = 0;
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    const long long share = until.back() * static_cast<long long>(rank + 1);
    int end = begin;
    while (static_cast<std::size_t>(end) + 1 < until.size() &&
           until[end] * static_cast<long long>(all.size()) < share)
    {
      ++end;
    }
    strips[rank] = { { viewport.Lo.x, viewport.Lo.y + begin },
      { viewport.Hi.x, viewport.Lo.y + end } };
    begin = end;
  }
  return strips;
}

/// Sends images to ranks and returns those that arrive from `sources`, in that order.
std::vector<FloatImage> Exchange(Communicator& communicator,
  const std::vector<std::pair<int, FloatImage>>& outgoing, const std::vector<int>& sources,
  CompositeStatistics& statistics)
{
  std::vector<FloatImage> incoming(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    communicator.Receive(sources[i], TagRect, &incoming[i].Rect, sizeof(PixelRect));
  }
  for (const auto& [to, image] : outgoing)
  {
    communicator.Send(to, TagRect, &image.Rect, sizeof(PixelRect));
    statistics.BytesSent += sizeof(PixelRect) + image.Pixels.size() * sizeof(glm::vec4);
  }
  communicator.WaitAll();
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    FloatImage& image = incoming[i];
    image.Pixels.resize(static_cast<std::size_t>(image.Rect.Count()));
    if (!image.Rect.Empty())
    {
      communicator.Receive(
        sources[i], TagPixels, image.Pixels.data(), image.Pixels.size() * sizeof(glm::vec4));
    }
  }
  for (const auto& [to, image] : outgoing)
  {
    if (!image.Rect.Empty())
    {
      communicator.Send(
        to, TagPixels, image.Pixels.data(), image.Pixels.size() * sizeof(glm::vec4));
    }
  }
  communicator.WaitAll();
  return incoming;
}

/// Brings the fragments of this rank's strip here and blends them.
FloatImage BlendOwnStrip(Communicator& communicator, const FloatImage& mine,
  const std::vector<Announcement>& all, const std::vector<PixelRect>& strips,
  const std::vector<int>& frontToBack, CompositeStatistics& statistics, Combination combination)
{
  const int self = communicator.Rank();
  std::vector<std::pair<int, FloatImage>> outgoing;
  std::vector<int> sources;
  for (int rank = 0; rank < communicator.Size(); ++rank)
  {
    if (rank != self && !Common(all[self].Active, strips[rank]).Empty())
    {
      outgoing.emplace_back(rank, Cut(mine, ActiveRect(mine, strips[rank])));
    }
  }
  std::vector<int> position(frontToBack.size(), -1);
  for (const int rank : frontToBack)
  {
    if (rank != self && !Common(all[rank].Active, strips[self]).Empty())
    {
      position[rank] = static_cast<int>(sources.size());
      sources.push_back(rank);
    }
  }
  const std::vector<FloatImage> incoming = Exchange(communicator, outgoing, sources, statistics);

  FloatImage strip = Transparent(strips[self]);
  for (const int rank : frontToBack)
  {
    if (rank == self)
    {
      BlendBehind(strip, Cut(mine, ActiveRect(mine, strips[self])), combination);
    }
    else if (position[rank] >= 0)
    {
      BlendBehind(strip, incoming[position[rank]], combination);
    }
  }
  return strip;
}

} // namespace

FloatImage CompositeDirectSend(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, CompositeStatistics& statistics,
  Combination combination)
{
  const std::vector<Announcement> all = Announce(communicator, mine, frontToBack, viewport);
  const std::vector<PixelRect> strips = Strips(all);
  const FloatImage strip =
    BlendOwnStrip(communicator, mine, all, strips, frontToBack, statistics, combination);

  std::vector<std::pair<int, FloatImage>> outgoing;
  if (communicator.Rank() != 0)
  {
    if (!strip.Rect.Empty())
    {
      outgoing.emplace_back(0, Cut(strip, ActiveRect(strip, strip.Rect)));
    }
    Exchange(communicator, outgoing, {}, statistics);
    return {};
  }
  std::vector<int> sources;
  for (int rank = 1; rank < communicator.Size(); ++rank)
  {
    if (!strips[rank].Empty())
    {
      sources.push_back(rank);
    }
  }
  FloatImage picture = Transparent(viewport);
  BlendBehind(picture, strip, combination);
  for (const FloatImage& part : Exchange(communicator, outgoing, sources, statistics))
  {
    BlendBehind(picture, part, combination);
  }
  return picture;
}

} // namespace banyan
