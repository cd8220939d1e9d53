// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Grid/PlaneRegion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace banyan
{
namespace
{

/// A plane of noise; what lies beyond the field's end is larger and smaller than all of it.
PlaneNumbers Noise(const glm::ivec3& samples, int edge, bool narrow)
{
  PlaneNumbers plane(samples, edge, narrow);
  std::mt19937 random(static_cast<unsigned>(samples.x + edge));
  for (int z = 0; z < plane.Padded.z; ++z)
  {
    for (int y = 0; y < plane.Padded.y; ++y)
    {
      for (int x = 0; x < plane.Padded.x; ++x)
      {
        const bool inside = x < samples.x && y < samples.y && z < samples.z;
        const int number = static_cast<int>(random() % 2000) - 1000;
        const std::int64_t at = plane.IndexOf({ x, y, z });
        plane.With(
          [&](auto* all)
          {
            all[at] =
              static_cast<std::remove_reference_t<decltype(*all)>>(inside            ? number
                                                                   : number % 2 == 0 ? 3000
                                                                                     : -3000);
          });
      }
    }
  }
  return plane;
}

NumberExtremes SlowExtremes(const PlaneNumbers& plane, const PlaneRegion& region)
{
  NumberExtremes extremes;
  for (int z = 0; z < region.Count.z; ++z)
  {
    for (int y = 0; y < region.Count.y; ++y)
    {
      for (int x = 0; x < region.Count.x; ++x)
      {
        const std::int32_t number =
          plane.At({ region.SampleAt(0, x), region.SampleAt(1, y), region.SampleAt(2, z) });
        extremes.Low = std::min(extremes.Low, number);
        extremes.High = std::max(extremes.High, number);
      }
    }
  }
  return extremes;
}

/// The regions of all bricks of a level of a field whose finest plane this is.
template <class Body>
void ForEachBrick(const PlaneNumbers& plane, int level, const Body& body)
{
  const BrickLayout layout(plane.Samples, plane.Edge, level);
  for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
  {
    body(PlaneRegion(level, layout.SamplesOf(brick), { 0, 1, 2 }, plane.Samples, plane.Edge));
  }
}

TEST(PlaneRegion, ExtremesOfBricksFollowFromThoseOfBlocks)
{
  for (const int edge : { 16, 32 })
  {
    for (const glm::ivec3 more : { glm::ivec3{ 1, 0, -1 }, glm::ivec3{ 2, 3, -3 } })
    {
      const PlaneNumbers plane =
        Noise(glm::ivec3{ 2 * edge, edge, 3 * edge } + more, edge, edge == 16);
      std::vector<BlockExtremes> blocks;
      for (std::int64_t block = 0; block < plane.BlockCount(); ++block)
      {
        blocks.push_back(ExtremesOfBlock(plane, 0, block, 2));
      }
      for (const int level : { 0, 1 })
      {
        ForEachBrick(plane, level,
          [&](const PlaneRegion& region)
          {
            const NumberExtremes expected = SlowExtremes(plane, region);
            EXPECT_EQ(ExtremesOfRegion(plane, region), expected) << "level " << level;
            EXPECT_EQ(ExtremesOfBlocks(blocks, plane, region), expected) << "level " << level;
          });
      }
    }
  }
}

TEST(PlaneRegion, FlatFieldsHaveExtremes)
{
  for (const glm::ivec3 samples : { glm::ivec3{ 1, 1, 1 }, glm::ivec3{ 17, 1, 2 } })
  {
    const PlaneNumbers plane = Noise(samples, 16, true);
    std::vector<BlockExtremes> blocks;
    for (std::int64_t block = 0; block < plane.BlockCount(); ++block)
    {
      blocks.push_back(ExtremesOfBlock(plane, 0, block, 1));
    }
    ForEachBrick(plane, 0,
      [&](const PlaneRegion& region)
      { EXPECT_EQ(ExtremesOfBlocks(blocks, plane, region), SlowExtremes(plane, region)); });
  }
}

TEST(PlaneRegion, OneOtherSampleOfABrickIsSeen)
{
  const PlaneNumbers plane = Noise({ 33, 17, 18 }, 16, true);
  for (const int level : { 0, 1 })
  {
    ForEachBrick(plane, level,
      [&](const PlaneRegion& region)
      {
        PlaneNumbers other = plane;
        EXPECT_TRUE(SameInRegion(plane, other, nullptr, region));
        const glm::ivec3 last = region.Count - 1;
        const glm::ivec3 sample{ region.SampleAt(0, last.x), region.SampleAt(1, last.y),
          region.SampleAt(2, last.z) };
        ++other.Data<std::int16_t>()[plane.IndexOf(sample)];
        EXPECT_FALSE(SameInRegion(plane, other, &plane, region)) << "level " << level;
        other = plane;
        // What lies between and beyond its samples is not looked at.
        if (region.Stride == 2)
        {
          ++other.Data<std::int16_t>()[plane.IndexOf(region.Low + 1)];
        }
        ++other.Data<std::int16_t>()[plane.IndexOf(plane.Padded - 1)];
        EXPECT_TRUE(SameInRegion(plane, other, nullptr, region)) << "level " << level;
      });
  }
}

} // namespace
} // namespace banyan
