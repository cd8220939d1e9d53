// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/Compositing.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Composite/TileOwnerCompositor.h"

#include <algorithm>
#include <deque>
#include <iterator>
#include <limits>
#include <utility>

namespace banyan
{
namespace
{

bool Inside(const PixelRect& inner, const PixelRect& outer)
{
  return inner.Empty() || Intersection(inner, outer) == inner;
}

bool Drawn(const glm::vec4& pixel)
{
  return pixel != glm::vec4(0.0f);
}

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

/// Whether a rank has drawn where its footprint says that it cannot.
bool DrawsOutside(const FloatImage& image, const Footprint& footprint)
{
  for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y && !image.Rect.Empty(); ++y)
  {
    const Footprint::Interval row = footprint.Row(y);
    const glm::vec4* pixels = &image.At(image.Rect.Lo.x, y);
    const int width = image.Rect.Size().x;
    const int left = std::clamp(row.Lo - image.Rect.Lo.x, 0, width);
    const int right = std::clamp(row.Hi - image.Rect.Lo.x, left, width);
    if (std::any_of(pixels, pixels + left, Drawn) ||
        std::any_of(pixels + right, pixels + width, Drawn))
    {
      return true;
    }
  }
  return false;
}

/// Pictures whose messages are under way at the same time.
class PicturesUnderWay
{
public:
  /// Everything referred to must stay.
  PicturesUnderWay(Communicator& communicator, const std::vector<PictureOfRanks>& pictures,
    CompositeStatistics& statistics)
    : Ranks(communicator)
    , Pictures(pictures)
  {
    int chunks = 0;
    for (const PictureOfRanks& picture : pictures)
    {
      TileOwnerCompositor& frame = this->Frames.emplace_back(
        communicator, picture.FrontToBack, picture.Viewport, picture.Options, statistics, chunks);
      chunks += frame.GetPlan().Chunks;
    }
    std::size_t posted = 0;
    for (TileOwnerCompositor& frame : this->Frames)
    {
      frame.Begin(posted);
      posted += frame.Posted();
    }
    this->Open = posted;
  }

  /// @return as CompositeTogether
  std::vector<FloatImage> Finish()
  {
    // Everybody begins with another picture, so that not all send to the same root at once.
    const std::size_t count = this->Pictures.size();
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Add((i + static_cast<std::size_t>(this->Ranks.Rank())) % count);
    }
    while (this->Open > 0)
    {
      this->Take(this->Ranks.WaitAnyWhole());
    }
    std::vector<FloatImage> finished;
    finished.reserve(count);
    for (TileOwnerCompositor& frame : this->Frames)
    {
      finished.push_back(frame.Finish());
    }
    return finished;
  }

private:
  void Add(std::size_t number)
  {
    TileOwnerCompositor& frame = this->Frames[number];
    for (int chunk = 0; chunk < frame.GetPlan().Chunks; ++chunk)
    {
      frame.Add(chunk, &this->Pictures[number].Mine);
    }
  }

  void Take(const Communicator::Arrival& arrival)
  {
    --this->Open;
    for (TileOwnerCompositor& frame : this->Frames)
    {
      frame.Take(arrival);
    }
  }

  Communicator& Ranks;
  const std::vector<PictureOfRanks>& Pictures;
  std::deque<TileOwnerCompositor> Frames;
  std::size_t Open = 0; ///< messages
};

/// Is told by every rank to all others before pixels travel.
struct Announcement
{
  PixelRect Active; ///< of this rank's image
  std::uint64_t Arguments = 0;
};

/// Returns a hash (FNV-1a) of everything that must be the same on all ranks.
std::uint64_t Fingerprint(
  const std::vector<int>& order, const PixelRect& viewport, const CompositeOptions& options)
{
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&hash](long long value)
  { hash = (hash ^ static_cast<std::uint64_t>(value)) * 1099511628211u; };
  for (const int rank : order)
  {
    add(rank);
  }
  for (const PixelRect& rect : { viewport, options.Behind })
  {
    for (const int value : { rect.Lo.x, rect.Lo.y, rect.Hi.x, rect.Hi.y })
    {
      add(value);
    }
  }
  add(options.Root);
  add(static_cast<int>(options.Combine));
  add(static_cast<int>(options.Transport));
  add(Packs(options) ? 1 : 0);
  for (const Footprint& footprint : options.Footprints)
  {
    for (const Footprint::Interval& row : footprint.Rows)
    {
      add(row.Lo);
      add(row.Hi);
    }
  }
  return hash;
}

/// Collective; throws CollectiveError when one of them was called wrongly, because a
/// rank that gave up alone would leave the others waiting.
std::vector<Footprint> Announce(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options)
{
  ThrowTogether(communicator,
    ProblemOf(communicator.Rank(), communicator.Size(), mine, frontToBack, viewport, options));
  Announcement own;
  own.Arguments = Fingerprint(frontToBack, viewport, options);
  own.Active = options.Footprints.empty() ? ActiveRect(mine, viewport) : PixelRect{};
  std::vector<Announcement> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&own, sizeof(own), all.data());
  std::vector<Footprint> footprints = options.Footprints;
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    if (all[rank].Arguments != all[0].Arguments)
    {
      throw CollectiveError(
        "Rank " + std::to_string(rank) +
        " and rank 0 disagree about the viewport, the visibility order or how pixels travel, "
        "so no picture could be put together.");
    }
    if (options.Footprints.empty())
    {
      footprints.push_back(FootprintOf(all[rank].Active, viewport));
    }
  }
  return footprints;
}

} // namespace

PixelRect ActiveRect(const FloatImage& image, const PixelRect& rect)
{
  const PixelRect searched = Intersection(image.Rect, rect);
  PixelRect active{ glm::ivec2(std::numeric_limits<int>::max()),
    glm::ivec2(std::numeric_limits<int>::min()) };
  for (int y = searched.Lo.y; y < searched.Hi.y; ++y)
  {
    const glm::vec4* begin = &image.At(searched.Lo.x, y);
    const glm::vec4* end = begin + searched.Size().x;
    const glm::vec4* first = std::find_if(begin, end, Drawn);
    if (first == end)
    {
      continue;
    }
    const auto last =
      std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), Drawn);
    active.Lo.x = std::min(active.Lo.x, searched.Lo.x + static_cast<int>(first - begin));
    active.Hi.x = std::max(active.Hi.x, searched.Lo.x + static_cast<int>(last.base() - begin));
    active.Lo.y = std::min(active.Lo.y, y);
    active.Hi.y = y + 1;
  }
  return active.Empty() ? PixelRect{} : active;
}

FragmentFormat FormatFor(const CompositeOptions& options, int meeting, int shares)
{
  if (options.Combine != Combination::Over || options.Transport == PixelTransport::Floats)
  {
    return {};
  }
  return FormatOfFragments(meeting, shares, options.Brightest);
}

FragmentFormat FormatOfFinal(const CompositeOptions& options)
{
  FragmentFormat format;
  const bool floats =
    options.Combine != Combination::Over || options.Transport == PixelTransport::Floats;
  format.Kind = floats ? FragmentFormat::Floats : FragmentFormat::Bytes;
  return format;
}

bool Packs(const CompositeOptions& options)
{
  return options.Packing == PixelPacking::Always ||
         (options.Packing == PixelPacking::ByCosts && PackingPays(options.Costs));
}

std::string ProblemOf(int rank, int ranks, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options)
{
  if (!IsPermutation(frontToBack, ranks))
  {
    return "The visibility order is not one of all ranks, so no picture could be put together.";
  }
  if (!Inside(mine.Rect, viewport) ||
      static_cast<long long>(mine.Pixels.size()) != mine.Rect.Count())
  {
    return "An image does not fit into the viewport, so no picture could be put together.";
  }
  if (options.Footprints.empty())
  {
    return {};
  }
  if (options.Footprints.size() != static_cast<std::size_t>(ranks))
  {
    return "There is not one outline for each rank, so no picture could be put together.";
  }
  for (const Footprint& footprint : options.Footprints)
  {
    if (!Inside(footprint.Rect, viewport) ||
        footprint.Rows.size() != static_cast<std::size_t>(footprint.Rect.Size().y))
    {
      return "The outline of a rank does not fit into the viewport, so no picture could be put "
             "together.";
    }
  }
  if (DrawsOutside(mine, options.Footprints[static_cast<std::size_t>(rank)]))
  {
    return "Pixels were drawn outside of the outline of their rank, so no picture could be put "
           "together.";
  }
  return {};
}

std::size_t EndOfBatch(
  const std::vector<PictureOfRanks>& pictures, std::size_t first, std::uint64_t mostBytes)
{
  std::vector<std::uint64_t> bytes; // per rank
  for (std::size_t number = first; number < pictures.size(); ++number)
  {
    const std::vector<Footprint>& footprints = pictures[number].Options.Footprints;
    bytes.resize(footprints.size());
    bool fits = true;
    for (std::size_t rank = 0; rank < footprints.size(); ++rank)
    {
      const Footprint& footprint = footprints[rank];
      bytes[rank] += footprint.Empty()
                       ? 0
                       : sizeof(glm::vec4) * static_cast<std::uint64_t>(footprint.Rect.Count());
      fits = fits && bytes[rank] <= mostBytes;
    }
    if (!fits && number > first)
    {
      return number;
    }
  }
  return pictures.size();
}

std::vector<FloatImage> CompositeTogether(Communicator& communicator,
  const std::vector<PictureOfRanks>& pictures, CompositeStatistics& statistics)
{
  std::vector<FloatImage> composited;
  communicator.Together([&](Communicator& ranks)
    { composited = PicturesUnderWay(ranks, pictures, statistics).Finish(); });
  return composited;
}

FloatImage Composite(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics)
{
  PictureOfRanks picture{ mine, frontToBack, viewport, options };
  if (!options.Agreed || options.Footprints.empty())
  {
    picture.Options.Footprints = Announce(communicator, mine, frontToBack, viewport, options);
  }
  return std::move(CompositeTogether(communicator, { picture }, statistics).front());
}

} // namespace banyan
