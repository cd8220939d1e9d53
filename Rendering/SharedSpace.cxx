// SPDX-License-Identifier: BSD-3-Clause
#include "SharedSpace.h"

#include "vtkBanyanVolumeMapper.h"

#include "Base/ThreadPool.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Composite/MixVolumes.h"
#include "Render/Raycast/DepthOrder.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace banyan
{
namespace
{

/// What volumes that share space may have along rays at a time, on a rank.
constexpr double BandBytes = 256e6;

/// Collective.
/// @param picture gets the band, on the root
/// @return bytes of what volumes had along rays, on the rank with most of it
double MixBand(Communicator& communicator, const std::vector<VolumeFrame*>& group,
  const PixelRect& band, int root, const CastBand& cast, FloatImage& picture)
{
  MixedVolumes mixed;
  mixed.Viewport = band;
  mixed.TransmittanceLimit = 1.0f;
  double bytes = 0.0;
  for (VolumeFrame* const frame : group)
  {
    SegmentPicture segments;
    mixed.TransmittanceLimit = std::min(mixed.TransmittanceLimit, cast(*frame, band, segments));
    bytes += static_cast<double>(segments.Bytes());
    mixed.Segments.push_back(segments.Take());
  }
  SentBytes sent;
  const FloatImage drawn =
    MixVolumes(communicator, std::move(mixed), ThreadPool::Process(), root, {}, sent);
  for (int y = band.Lo.y; y < band.Hi.y && communicator.Rank() == root; ++y)
  {
    std::copy_n(&drawn.At(band.Lo.x, y), band.Size().x, &picture.At(band.Lo.x, y));
  }
  return AllMax(communicator, bytes);
}

} // namespace

std::shared_ptr<const FloatImage> DrawMixed(Communicator& communicator,
  const std::vector<VolumeFrame*>& group, const PixelRect& rect, int root, const CastBand& cast)
{
  std::shared_ptr<FloatImage> picture;
  if (communicator.Rank() == root)
  {
    picture = std::make_shared<FloatImage>(
      FloatImage{ rect, PixelVector(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f)) });
  }
  FloatImage none;
  int rows = RayTile::Edge;
  for (int low = rect.Lo.y; low < rect.Hi.y;)
  {
    // Tiles are whole.
    const int high = std::min(low / RayTile::Edge * RayTile::Edge + rows, rect.Hi.y);
    const PixelRect band{ { rect.Lo.x, low }, { rect.Hi.x, high } };
    const double bytes = MixBand(communicator, group, band, root, cast, picture ? *picture : none);
    const double fits = BandBytes / std::max(bytes, 1.0) * (high - low);
    // What comes next may be more.
    rows = static_cast<int>(std::min(fits, 4.0 * rows)) / RayTile::Edge * RayTile::Edge;
    rows = std::max(rows, RayTile::Edge);
    low = high;
  }
  return picture;
}

std::vector<int> GroupsThatMix(const std::vector<VolumeFrame*>& frames, const DepthOrder& order)
{
  std::vector<int> groups(frames.size());
  std::iota(groups.begin(), groups.end(), 0);
  const auto mixes = [&](int volume)
  {
    const VolumeFrame& frame = *frames[static_cast<std::size_t>(volume)];
    return frame.Scene().Blend.Mode == BlendMode::Composite && frame.Mapper()->GetMixVolumes();
  };
  const auto groupOf = [&](int volume) { return groups[static_cast<std::size_t>(volume)]; };
  const auto join = [&](int one, int other)
  { std::replace(groups.begin(), groups.end(), groupOf(other), groupOf(one)); };
  for (const std::array<int, 2>& pair : order.Unknown())
  {
    if (mixes(pair[0]) && mixes(pair[1]))
    {
      join(pair[0], pair[1]);
    }
  }
  // What is before one of a group and behind another one belongs to it.
  const auto isBetween = [&](int volume, int one, int other)
  {
    return mixes(volume) && groupOf(one) == groupOf(other) && groupOf(volume) != groupOf(one) &&
           order.Nearer(volume, one) != order.Nearer(volume, other);
  };
  const int count = static_cast<int>(frames.size());
  for (bool grows = true; grows;)
  {
    grows = false;
    for (int i = 0; i < count * count * count; ++i)
    {
      const int volume = i % count;
      const int one = i / count % count;
      if (isBetween(volume, one, i / count / count))
      {
        join(one, volume);
        grows = true;
      }
    }
  }
  return groups;
}

} // namespace banyan
