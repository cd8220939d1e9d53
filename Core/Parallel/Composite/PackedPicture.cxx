// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/PackedPicture.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Parallel/Composite/PixelPacking.h"
#include "Series/Format/Zstd.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace banyan
{
namespace
{

constexpr std::size_t MostBoxes = 8;

/// Comes first, and sizes of all bands behind it.
struct Head
{
  glm::ivec2 Size;
  PixelRect Rect;
  std::uint64_t Boxes;
  std::array<PlacedBox, MostBoxes> Body;
};

/// Rows of a picture that are packed by themselves: by any thread, and in its cache.
struct Band
{
  std::uint32_t PackedBytes; ///< before zstd
  std::uint32_t Bytes;
};

constexpr int Level = 1;
constexpr int LargestSide = 1 << 15;
constexpr std::int64_t BandPixels = 1 << 15; ///< about

bool IsSound(const Head& head)
{
  const PixelRect& rect = head.Rect;
  return head.Size.x > 0 && head.Size.y > 0 && head.Size.x <= LargestSide &&
         head.Size.y <= LargestSide && rect.Lo.x >= 0 && rect.Lo.y >= 0 && rect.Lo.x <= rect.Hi.x &&
         rect.Lo.y <= rect.Hi.y && rect.Hi.x <= head.Size.x && rect.Hi.y <= head.Size.y &&
         head.Boxes <= MostBoxes;
}

/// First pixels of the bands, and the end of the last one.
std::vector<std::size_t> BandsOf(const PixelRect& rect)
{
  const auto count = static_cast<std::size_t>(rect.Count());
  const std::int64_t width = std::max(1, rect.Size().x);
  const auto step = static_cast<std::size_t>(width * std::max<std::int64_t>(1, BandPixels / width));
  std::vector<std::size_t> firsts;
  for (std::size_t first = 0; first < count; first += step)
  {
    firsts.push_back(first);
  }
  firsts.push_back(count);
  return firsts;
}

Bytes PackBand(const std::uint8_t* pixels, std::size_t count, Band& band)
{
  const std::vector<std::uint16_t> numbers(pixels, pixels + 4 * count);
  Bytes packed(PackedBytesAtMost(count));
  packed.resize(PackPixels(numbers.data(), count, packed.data()));
  Bytes all;
  AppendCompressed(packed.data(), packed.size(), Level, all);
  band = { static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(all.size()) };
  return all;
}

void UnpackBand(
  const std::uint8_t* packed, const Band& band, std::size_t count, std::uint8_t* pixels)
{
  Bytes bytes(band.PackedBytes);
  Decompress(packed, band.Bytes, bytes.data(), bytes.size());
  std::vector<std::uint16_t> numbers(4 * count);
  UnpackPixels(bytes.data(), bytes.size(), count, numbers.data());
  std::copy(numbers.begin(), numbers.end(), pixels);
}

} // namespace

Bytes PackPicture(const PlacedPicture& placed, ThreadPool& threads)
{
  const BytePicture& picture = placed.Picture;
  const std::vector<std::size_t> firsts = BandsOf(picture.Rect);
  const std::size_t count = firsts.size() - 1;
  std::vector<Band> bands(count);
  std::vector<Bytes> contents(count);
  threads.ParallelFor(static_cast<std::int64_t>(count),
    [&](std::int64_t number)
    {
      const auto i = static_cast<std::size_t>(number);
      contents[i] =
        PackBand(picture.Pixels.data() + 4 * firsts[i], firsts[i + 1] - firsts[i], bands[i]);
    });
  if (placed.Body.size() > MostBoxes)
  {
    throw Error("A volume that lies in so many boxes cannot be sent to a client.");
  }
  Head head{ picture.Size, picture.Rect, placed.Body.size(), {} };
  std::copy_n(placed.Body.begin(), head.Boxes, head.Body.begin());
  Bytes all(sizeof(head) + count * sizeof(Band));
  std::memcpy(all.data(), &head, sizeof(head));
  std::memcpy(all.data() + sizeof(head), bands.data(), count * sizeof(Band));
  for (const Bytes& content : contents)
  {
    all.insert(all.end(), content.begin(), content.end());
  }
  return all;
}

PlacedPicture UnpackPicture(const Bytes& packed, ThreadPool& threads)
{
  Head head{};
  if (packed.size() < sizeof(head))
  {
    throw Error("A picture from the server is too short.");
  }
  std::memcpy(&head, packed.data(), sizeof(head));
  const Error damaged("A picture from the server is damaged.");
  if (!IsSound(head))
  {
    throw damaged;
  }
  const std::vector<std::size_t> firsts = BandsOf(head.Rect);
  const std::size_t count = firsts.size() - 1;
  std::vector<Band> bands(count);
  std::vector<std::size_t> begins(count);
  std::size_t end = sizeof(head) + count * sizeof(Band);
  if (packed.size() < end)
  {
    throw damaged;
  }
  std::memcpy(bands.data(), packed.data() + sizeof(head), count * sizeof(Band));
  for (std::size_t i = 0; i < count; ++i)
  {
    begins[i] = end;
    end += bands[i].Bytes;
    if (end > packed.size() || bands[i].PackedBytes > PackedBytesAtMost(firsts[i + 1] - firsts[i]))
    {
      throw damaged;
    }
  }
  PlacedPicture placed{ { head.Size, head.Rect, {} },
    { head.Body.begin(), head.Body.begin() + static_cast<std::ptrdiff_t>(head.Boxes) } };
  placed.Picture.Pixels.resize(4 * firsts.back());
  threads.ParallelFor(static_cast<std::int64_t>(count),
    [&](std::int64_t number)
    {
      const auto i = static_cast<std::size_t>(number);
      UnpackBand(packed.data() + begins[i], bands[i], firsts[i + 1] - firsts[i],
        placed.Picture.Pixels.data() + 4 * firsts[i]);
    });
  return placed;
}

} // namespace banyan
