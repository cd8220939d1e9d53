// SPDX-License-Identifier: BSD-3-Clause
// Tolerances of still pictures: at once, or in passes after an interaction.
#include "Render/Sampling/RefinementPasses.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr RefinementPasses::Wish InPasses{ true, 1.0, 8.0 };

constexpr Hash128 Scene{ 1, 2 };
constexpr Hash128 Other{ 1, 3 };
constexpr Hash128 Third{ 2, 3 };

TEST(RefinementPasses, PicturesOfScriptsKeepTheToleranceAtOnce)
{
  RefinementPasses passes;
  EXPECT_EQ(passes.ToleranceOf(Scene, { false, 1.0, 8.0 }), 1.0);
  EXPECT_FALSE(passes.Next());
  EXPECT_EQ(passes.ToleranceOf(Other, InPasses), 1.0) << "nobody moved the camera";
  EXPECT_FALSE(passes.Next());
}

TEST(RefinementPasses, EachTakesAQuarterOfTheToleranceBefore)
{
  RefinementPasses passes;
  passes.Interacted();
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 8.0);
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 8.0) << "no pass was asked for";
  EXPECT_TRUE(passes.Next());
  EXPECT_FALSE(passes.Next()) << "was not drawn since";
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 8.0);
  EXPECT_TRUE(passes.Next());
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 2.0);
  EXPECT_TRUE(passes.Next());
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 1.0) << "never below the one that is wanted";
  EXPECT_FALSE(passes.Next());
}

TEST(RefinementPasses, AScenesPictureNeverBecomesWorse)
{
  RefinementPasses passes;
  passes.ToleranceOf(Scene, InPasses);
  passes.Interacted();
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 1.0) << "the camera is where it was";
}

TEST(RefinementPasses, OneThatWasDrawnBeforeCounts)
{
  RefinementPasses passes;
  passes.Interacted();
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 8.0);
  passes.Showed(4.0, InPasses);
  EXPECT_TRUE(passes.Next());
  EXPECT_EQ(passes.ToleranceOf(Scene, InPasses), 1.0) << "a quarter of 4";
  passes.Interacted();
  EXPECT_EQ(passes.ToleranceOf(Other, InPasses), 8.0);
  passes.Showed(0.5, InPasses);
  EXPECT_FALSE(passes.Next()) << "the tolerance is kept";
  passes.Interacted();
  EXPECT_EQ(passes.ToleranceOf(Third, InPasses), 8.0);
}

} // namespace
