// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Grid/PlaneRegion.h"

#include <type_traits>

namespace banyan
{

PlaneRegion::PlaneRegion(int level, const Box& box, const std::array<std::uint8_t, 3>& axes,
  const glm::ivec3& samples, int edge)
  : Plane(level / 2)
  , Stride(level % 2 == 0 ? 1 : 2)
{
  const glm::ivec3 size = box.Size();
  for (int a = 0; a < 3; ++a)
  {
    const int real = axes[static_cast<std::size_t>(a)];
    this->Low[a] = box.Lo[real] * this->Stride;
    this->Count[a] = size[real];
    this->Last[a] = samples[a] - 1;
    this->FirstBlock[a] = this->SampleAt(a, 0) / edge;
    this->EndBlock[a] = this->SampleAt(a, this->Count[a] - 1) / edge + 1;
  }
}

PlaneRegion::PlaneRegion(int level, const glm::ivec3& block, const glm::ivec3& samples, int edge)
  : Plane(level / 2)
  , Stride(level % 2 == 0 ? 1 : 2)
  , Low(block * edge)
  , Last(samples - 1)
  , FirstBlock(block)
{
  for (int a = 0; a < 3; ++a)
  {
    const int cells = (this->Last[a] + this->Stride - 1) / this->Stride; // of the level
    this->Count[a] = std::min(edge / this->Stride, cells - this->Low[a] / this->Stride) + 1;
    this->EndBlock[a] = this->SampleAt(a, this->Count[a] - 1) / edge + 1;
  }
}

namespace
{

/// Calls body(box) for the samples of a region: those on the plane, and what stands for those
/// beyond its last one, once for each axis.
/// @param before and @param next of other steps, or null
template <class Number, class Body>
void ForEachBox(const PlaneNumbers& plane, const PlaneNumbers* before, const PlaneNumbers* next,
  const PlaneRegion& region, const Body& body)
{
  glm::ivec3 inside = region.Count;
  glm::ivec3 parts(1);
  for (int a = 0; a < 3; ++a)
  {
    while (inside[a] > 1 && region.Low[a] + (inside[a] - 1) * region.Stride > region.Last[a])
    {
      --inside[a];
    }
    parts[a] = inside[a] < region.Count[a] ? 2 : 1;
  }
  const glm::i64vec3 gaps{ 1, plane.Padded.x, std::int64_t{ plane.Padded.x } * plane.Padded.y };
  for (int part = 0; part < parts.x * parts.y * parts.z; ++part)
  {
    const glm::ivec3 beyond{ part % parts.x, part / parts.x % parts.y, part / parts.x / parts.y };
    const glm::ivec3 first =
      beyond * region.Last + (1 - beyond) * glm::min(region.Low, region.Last);
    const glm::ivec3 count = beyond + (1 - beyond) * inside;
    const std::int64_t at = plane.IndexOf(first);
    NumberBox<Number> box;
    box.Numbers = plane.Data<Number>() + at;
    box.Before = before != nullptr ? before->Data<Number>() + at : nullptr;
    box.Next = next != nullptr ? next->Data<Number>() + at : nullptr;
    box.Count = count.x;
    box.Stride = region.Stride;
    box.RowGap = region.Stride * gaps.y;
    box.SliceGap = region.Stride * gaps.z;
    box.Rows = count.y;
    box.Slices = count.z;
    body(box);
  }
}

} // namespace

NumberExtremes ExtremesOfRegion(const PlaneNumbers& plane, const PlaneRegion& region)
{
  NumberExtremes extremes;
  plane.With(
    [&](const auto* numbers)
    {
      using Number = std::remove_const_t<std::remove_pointer_t<decltype(numbers)>>;
      ForEachBox<Number>(plane, nullptr, nullptr, region,
        [&](const NumberBox<Number>& box) { IncludeBox(box, extremes); });
    });
  return extremes;
}

bool SameInRegion(const PlaneNumbers& plane, const PlaneNumbers& before, const PlaneNumbers* next,
  const PlaneRegion& region)
{
  bool same = true;
  plane.With(
    [&](const auto* numbers)
    {
      using Number = std::remove_const_t<std::remove_pointer_t<decltype(numbers)>>;
      ForEachBox<Number>(plane, &before, next, region,
        [&](const NumberBox<Number>& box) { same = same && SameAsBefore(box); });
    });
  return same;
}

BlockExtremes ExtremesOfBlock(
  const PlaneNumbers& numbers, int plane, std::int64_t block, int levels)
{
  const glm::ivec3 blocks = numbers.Blocks;
  const glm::ivec3 position{ static_cast<int>(block % blocks.x),
    static_cast<int>(block / blocks.x % blocks.y), static_cast<int>(block / blocks.x / blocks.y) };
  BlockExtremes result;
  for (int level = 2 * plane; level < std::min(2 * plane + 2, levels); ++level)
  {
    result.OfLevel[level % 2] =
      ExtremesOfRegion(numbers, PlaneRegion(level, position, numbers.Samples, numbers.Edge));
  }
  return result;
}

NumberExtremes ExtremesOfBlocks(
  const std::vector<BlockExtremes>& blocks, const PlaneNumbers& plane, const PlaneRegion& region)
{
  // A brick takes one block of its plane along each axis, or two: their layers are its own.
  const glm::ivec3 first = region.Low / plane.Edge;
  const glm::ivec3 end = glm::min(first + region.Stride, plane.Blocks);
  NumberExtremes extremes;
  for (int z = first.z; z < end.z; ++z)
  {
    for (int y = first.y; y < end.y; ++y)
    {
      for (int x = first.x; x < end.x; ++x)
      {
        const std::size_t index =
          (static_cast<std::size_t>(z) * plane.Blocks.y + y) * plane.Blocks.x +
          static_cast<std::size_t>(x);
        const NumberExtremes& block = blocks[index].OfLevel[region.Stride - 1];
        extremes.Low = std::min(extremes.Low, block.Low);
        extremes.High = std::max(extremes.High, block.High);
        extremes.Check = 31 * extremes.Check + block.Check;
      }
    }
  }
  return extremes;
}

} // namespace banyan
