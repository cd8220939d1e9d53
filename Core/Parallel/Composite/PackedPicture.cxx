// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/PackedPicture.h"

#include "Base/Error.h"
#include "Parallel/Composite/PixelPacking.h"
#include "Series/Format/Zstd.h"

#include <cstring>

namespace banyan
{
namespace
{

struct Head
{
  glm::ivec2 Size;
  PixelRect Rect;
  std::uint64_t PackedBytes; ///< before zstd
};

constexpr int Level = 1;
constexpr int LargestSide = 1 << 15;

bool IsSound(const Head& head)
{
  const PixelRect& rect = head.Rect;
  return head.Size.x > 0 && head.Size.y > 0 && head.Size.x <= LargestSide &&
         head.Size.y <= LargestSide && rect.Lo.x >= 0 && rect.Lo.y >= 0 && rect.Lo.x <= rect.Hi.x &&
         rect.Lo.y <= rect.Hi.y && rect.Hi.x <= head.Size.x && rect.Hi.y <= head.Size.y &&
         head.PackedBytes <= PackedBytesAtMost(static_cast<std::size_t>(rect.Count()));
}

} // namespace

Bytes PackPicture(const BytePicture& picture)
{
  const std::vector<std::uint16_t> numbers(picture.Pixels.begin(), picture.Pixels.end());
  const std::size_t count = numbers.size() / 4;
  Bytes packed(PackedBytesAtMost(count));
  packed.resize(PackPixels(numbers.data(), count, packed.data()));
  const Head head{ picture.Size, picture.Rect, packed.size() };
  Bytes all(sizeof(head));
  std::memcpy(all.data(), &head, sizeof(head));
  AppendCompressed(packed.data(), packed.size(), Level, all);
  return all;
}

BytePicture UnpackPicture(const Bytes& packed)
{
  Head head{};
  if (packed.size() < sizeof(head))
  {
    throw Error("A picture from the server is too short.");
  }
  std::memcpy(&head, packed.data(), sizeof(head));
  if (!IsSound(head))
  {
    throw Error("A picture from the server is damaged.");
  }
  Bytes bytes(static_cast<std::size_t>(head.PackedBytes));
  Decompress(
    packed.data() + sizeof(head), packed.size() - sizeof(head), bytes.data(), bytes.size());
  const auto count = static_cast<std::size_t>(head.Rect.Count());
  std::vector<std::uint16_t> numbers(4 * count);
  UnpackPixels(bytes.data(), bytes.size(), count, numbers.data());
  return { head.Size, head.Rect, { numbers.begin(), numbers.end() } };
}

} // namespace banyan
