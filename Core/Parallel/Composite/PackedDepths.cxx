// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/PackedDepths.h"

#include "Base/Error.h"
#include "Series/Format/Zstd.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace banyan
{
namespace
{

struct Head
{
  glm::ivec2 Size;
  PixelRect Rect;
};

constexpr int Level = 1;
constexpr int LargestSide = 1 << 15;
constexpr std::uint32_t Largest = (1u << 24) - 1; ///< number of depth 1

bool IsSound(const Head& head)
{
  const PixelRect& rect = head.Rect;
  return head.Size.x >= 0 && head.Size.y >= 0 && head.Size.x <= LargestSide &&
         head.Size.y <= LargestSide && rect.Lo.x >= 0 && rect.Lo.y >= 0 && rect.Lo.x <= rect.Hi.x &&
         rect.Lo.y <= rect.Hi.y && rect.Hi.x <= head.Size.x && rect.Hi.y <= head.Size.y;
}

/// A number's value in the plane of its left, lower, and lower left neighbour. Arithmetic
/// wraps around, the same way in both directions.
std::uint32_t Predicted(
  const std::uint32_t* numbers, std::size_t x, std::size_t y, std::size_t columns)
{
  const std::size_t at = y * columns + x;
  if (x == 0 || y == 0)
  {
    return y > 0 ? numbers[at - columns] : (x > 0 ? numbers[at - 1] : Largest);
  }
  return numbers[at - 1] + numbers[at - columns] - numbers[at - columns - 1];
}

/// Small numbers of either sign become small ones without.
std::uint32_t Folded(std::uint32_t difference)
{
  return (difference << 1) ^ (0u - (difference >> 31));
}

std::uint32_t Unfolded(std::uint32_t folded)
{
  return (folded >> 1) ^ (0u - (folded & 1));
}

} // namespace

Bytes PackDepths(const DepthPicture& picture)
{
  std::vector<std::uint32_t> numbers;
  numbers.reserve(picture.Depths.size());
  for (const float depth : picture.Depths)
  {
    const double in = std::clamp(double{ depth }, 0.0, 1.0);
    numbers.push_back(static_cast<std::uint32_t>(std::lround(in * Largest)));
  }
  std::vector<std::uint32_t> differences(numbers.size());
  const auto columns = static_cast<std::size_t>(picture.Rect.Size().x);
  const auto rows = static_cast<std::size_t>(picture.Rect.Size().y);
  for (std::size_t at = 0, y = 0; y < rows; ++y)
  {
    for (std::size_t x = 0; x < columns; ++x, ++at)
    {
      differences[at] = Folded(numbers[at] - Predicted(numbers.data(), x, y, columns));
    }
  }
  Bytes planes(4 * differences.size());
  ToPlanes(differences.data(), differences.size(), planes.data());
  const Head head{ picture.Size, picture.Rect };
  Bytes all(sizeof(head));
  std::memcpy(all.data(), &head, sizeof(head));
  AppendCompressed(planes.data(), planes.size(), Level, all);
  return all;
}

DepthPicture UnpackDepths(const Bytes& packed)
{
  Head head{};
  if (packed.size() < sizeof(head))
  {
    throw Error("The depths that a client sent are too few bytes.");
  }
  std::memcpy(&head, packed.data(), sizeof(head));
  if (!IsSound(head))
  {
    throw Error("The depths that a client sent are damaged.");
  }
  const auto count = static_cast<std::size_t>(head.Rect.Count());
  Bytes planes(4 * count);
  Decompress(
    packed.data() + sizeof(head), packed.size() - sizeof(head), planes.data(), planes.size());
  std::vector<std::uint32_t> numbers(count);
  FromPlanes(planes.data(), count, numbers.data());
  DepthPicture picture{ head.Size, head.Rect, {} };
  picture.Depths.reserve(count);
  const auto columns = static_cast<std::size_t>(head.Rect.Size().x);
  const auto rows = static_cast<std::size_t>(head.Rect.Size().y);
  for (std::size_t at = 0, y = 0; y < rows; ++y)
  {
    for (std::size_t x = 0; x < columns; ++x, ++at)
    {
      numbers[at] = Unfolded(numbers[at]) + Predicted(numbers.data(), x, y, columns);
      const double depth = double(std::min(numbers[at], Largest)) / Largest;
      picture.Depths.push_back(static_cast<float>(depth));
    }
  }
  return picture;
}

} // namespace banyan
