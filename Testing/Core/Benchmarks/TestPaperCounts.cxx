// SPDX-License-Identifier: BSD-3-Clause
#include "PaperCounts.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace banyan::bench
{
namespace
{

constexpr int Samples = 9;
constexpr int BrickCells = 4; ///< so 2 bricks per axis

TransferFunction FunctionThatShows(double from)
{
  TransferFunction function;
  function.Low = 0.0;
  function.High = 1.0;
  for (int i = 0; i < 256; ++i)
  {
    function.Entries.emplace_back(1.0f, 1.0f, 1.0f, i / 255.0 < from ? 0.0f : 0.1f);
  }
  return function;
}

/// Along +z, in parallel, two pixels per cell: a ray meets the two bricks of one column alone, and
/// no block of rays meets two columns.
RayScene SceneAlongZ()
{
  const double half = 0.5 * (Samples - 1);
  const glm::dmat4 view =
    glm::lookAt(glm::dvec3(half, half, 20), glm::dvec3(half, half, 0), glm::dvec3(0, 1, 0));
  const glm::dmat4 clip = glm::ortho(-half, half, -half, half, 1.0, 40.0) * view;
  constexpr int pixels = 2 * (Samples - 1);
  return { { clip, { pixels, pixels }, glm::dvec3(half) }, { { 0, 0 }, { pixels, pixels } },
    glm::dmat4(1.0), { glm::ivec3(0), glm::ivec3(Samples - 1) }, FunctionThatShows(0.0), 1.0 };
}

std::vector<float> Field(float value)
{
  return std::vector<float>(static_cast<std::size_t>(Samples) * Samples * Samples, value);
}

float& At(std::vector<float>& field, int x, int y, int z)
{
  return field[(static_cast<std::size_t>(z) * Samples + y) * Samples + x];
}

class PaperCountsTest : public ::testing::Test
{
protected:
  PaperCounts Counts{ SceneAlongZ(), glm::ivec3(Samples), BrickCells };
};

TEST_F(PaperCountsTest, NothingIsAsBeforeInTheFirstStepAndAllInAnEqualOne)
{
  this->Counts.Take(Field(0.5f));
  PaperCounts::Shares shares = this->Counts.Of(FunctionThatShows(0.0));
  EXPECT_EQ(shares.Bricks, 0.0);
  EXPECT_EQ(shares.EveryBrick, 0.0);
  EXPECT_EQ(shares.Blocks, 0.0);
  EXPECT_EQ(shares.Shown, 1.0);
  this->Counts.Take(Field(0.5f));
  shares = this->Counts.Of(FunctionThatShows(0.0));
  EXPECT_EQ(shares.Bricks, 1.0);
  EXPECT_EQ(shares.EveryBrick, 1.0);
  EXPECT_EQ(shares.ShownBricks, 1.0);
  EXPECT_EQ(shares.Blocks, 1.0);
}

TEST_F(PaperCountsTest, AChangeSpoilsItsBrickAndTheRaysOfItsColumn)
{
  this->Counts.Take(Field(0.5f));
  std::vector<float> next = Field(0.5f);
  At(next, 1, 1, 1) = 0.75f;
  this->Counts.Take(std::move(next));
  const PaperCounts::Shares shares = this->Counts.Of(FunctionThatShows(0.0));
  EXPECT_EQ(shares.Bricks, 7.0 / 8.0);
  EXPECT_EQ(shares.EveryBrick, 7.0 / 8.0);
  EXPECT_EQ(shares.ShownBricks, 7.0 / 8.0);
  EXPECT_EQ(shares.Blocks, 3.0 / 4.0);
}

TEST_F(PaperCountsTest, ASampleBetweenBricksSpoilsBoth)
{
  this->Counts.Take(Field(0.5f));
  std::vector<float> next = Field(0.5f);
  At(next, BrickCells, 1, 1) = 0.75f;
  this->Counts.Take(std::move(next));
  EXPECT_EQ(this->Counts.Of(FunctionThatShows(0.0)).Bricks, 6.0 / 8.0);
}

TEST_F(PaperCountsTest, WhatCannotBeSeenCountsForTheStudyAndSpoilsNoRay)
{
  std::vector<float> first = Field(0.25f);
  At(first, 6, 6, 6) = 0.75f; // the one visible brick
  this->Counts.Take(first);
  At(first, 1, 1, 1) = 0.375f; // stays invisible
  this->Counts.Take(first);
  const PaperCounts::Shares shares = this->Counts.Of(FunctionThatShows(0.5));
  EXPECT_EQ(shares.Shown, 1.0 / 8.0);
  EXPECT_EQ(shares.EveryBrick, 7.0 / 8.0);
  EXPECT_EQ(shares.ShownBricks, 1.0);
  EXPECT_EQ(shares.Blocks, 1.0);
}

TEST_F(PaperCountsTest, SmallChangesAreWithinATolerance)
{
  TransferFunction ramp = FunctionThatShows(0.0);
  for (std::size_t i = 0; i < ramp.Entries.size(); ++i)
  {
    ramp.Entries[i] = glm::vec4(1.0f, 1.0f, 1.0f, 0.1f * i / ramp.Entries.size());
  }
  const auto after = [&](float value)
  {
    std::vector<float> field = Field(0.5f);
    this->Counts.Take(field);
    At(field, 1, 1, 1) = value;
    this->Counts.Take(field);
    return this->Counts.Of(ramp).Within;
  };
  using Within = std::array<double, 2>;
  EXPECT_EQ(after(0.5f), (Within{ { 1.0, 1.0 } }));
  // So many samples lie in the brick on each ray.
  const float tolerance = 3.0f / 255.0f / 0.1f / BrickCells;
  EXPECT_EQ(after(0.5f + tolerance), (Within{ { 0.75, 1.0 } }));
  EXPECT_EQ(after(0.5f + 4.0f * tolerance), (Within{ { 0.75, 0.75 } }));
}

TEST_F(PaperCountsTest, WhatWasVisibleSpoilsRaysWhenItGoes)
{
  std::vector<float> first = Field(0.25f);
  At(first, 1, 1, 1) = 0.75f;
  At(first, 1, 1, 7) = 0.75f;
  this->Counts.Take(first);
  At(first, 1, 1, 1) = 0.25f;
  this->Counts.Take(first);
  const PaperCounts::Shares shares = this->Counts.Of(FunctionThatShows(0.5));
  EXPECT_EQ(shares.ShownBricks, 1.0);
  EXPECT_EQ(shares.Blocks, 0.0);
}

} // namespace
} // namespace banyan::bench
