// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/FieldQuantizer.h"

#include "Base/ThreadPool.h"
#include "Codec/BlockScratch.h"
#include "Series/Format/FieldLattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace banyan
{
namespace
{

/// A field of one step, smoothest along one of its axes.
struct OneStep
{
  std::vector<float> Values;
  FieldGroup Field;
  group::FieldHead Head;
  ThreadPool Pool{ 2 };

  /// @param bound of a range of 4
  OneStep(const glm::ivec3& samples, int smoothest, double bound)
  {
    std::mt19937 random(static_cast<unsigned>(samples.x));
    std::uniform_real_distribution<float> noise(-0.5f, 0.5f);
    for (int z = 0; z < samples.z; ++z)
    {
      for (int y = 0; y < samples.y; ++y)
      {
        for (int x = 0; x < samples.x; ++x)
        {
          const int along = smoothest == 0 ? y + 31 * z : smoothest == 1 ? x + 31 * z : x + 31 * y;
          this->Values.push_back(std::sin(0.7f * static_cast<float>(along)) + noise(random) / 16);
        }
      }
    }
    this->Field.Steps = { this->Values.data() };
    this->Field.Samples = samples;
    this->Field.Bound = bound;
    this->Field.Expected = { -2.0, 2.0 };
    ChooseLattice(
      this->Field.Type, this->Field.Map, bound, this->Field.Expected, false, this->Head);
  }

  /// Whether what is made block by block, from the last one to the first, is what is made at once.
  /// @param blockwise whether blocks are to be made one by one
  void ExpectTheSame(bool blockwise)
  {
    const FieldQuantizer<float> target(this->Field, this->Head, this->Pool);
    std::vector<PlaneNumbers> expected = target.NewPlanes(), found = target.NewPlanes();
    target.Make(0, expected);
    EXPECT_EQ(target.MakeCoarser(0, found), blockwise);
    for (std::int64_t block = blockwise ? found[0].BlockCount() : 0; block-- > 0;)
    {
      target.MakeBlock(0, block, found[0]);
    }
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t p = 0; p < found.size(); ++p)
    {
      EXPECT_TRUE(found[p] == expected[p]) << "plane " << p;
    }
  }
};

TEST(FieldQuantizer, BlocksHaveTheNumbersOfTheWhole)
{
  for (const glm::ivec3 samples : { glm::ivec3{ 33, 17, 40 }, glm::ivec3{ 16, 48, 19 },
         glm::ivec3{ 300, 5, 1 }, glm::ivec3{ 7, 11, 70 } })
  {
    for (const int smoothest : { 0, 1, 2 })
    {
      for (const double bound : { 0.01, 1e-5 }) // numbers of 16 and of 32 bits
      {
        OneStep step(samples, smoothest, bound);
        EXPECT_EQ(block::Narrow(step.Head.Least, step.Head.Greatest), bound == 0.01);
        for (const int edge : { 16, 32 })
        {
          step.Field.BrickCells = edge;
          step.ExpectTheSame(true);
        }
      }
    }
  }
}

TEST(FieldQuantizer, ValuesThatAreNotHeldAreFilledInAlike)
{
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  OneStep between({ 40, 21, 18 }, 1, 0.01);
  for (const std::size_t at : { 5u, 6u, 7u, 999u, 4711u, 15118u })
  {
    between.Values[at] = at % 2 == 0 ? none : 1000.0f;
  }
  between.ExpectTheSame(true);
  OneStep coarse({ 40, 21, 18 }, 1, 0.01);
  coarse.Values[0] = none; // of the coarser plane, too: all is made at once
  coarse.ExpectTheSame(false);
}

} // namespace
} // namespace banyan
