// SPDX-License-Identifier: BSD-3-Clause
// Tolerances of still pictures: at once, or in passes after an interaction.
#include "Render/Sampling/RefinementPasses.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr RefinementPasses::Wish InPasses{ true, 1.0, 8.0 };

TEST(RefinementPasses, PicturesOfScriptsKeepTheToleranceAtOnce)
{
  RefinementPasses passes;
  EXPECT_EQ(passes.ToleranceOf(false, { false, 1.0, 8.0 }), 1.0);
  EXPECT_FALSE(passes.Next());
  EXPECT_EQ(passes.ToleranceOf(true, InPasses), 1.0) << "nobody moved the camera";
  EXPECT_FALSE(passes.Next());
}

TEST(RefinementPasses, EachTakesAQuarterOfTheToleranceBefore)
{
  RefinementPasses passes;
  passes.Interacted();
  EXPECT_EQ(passes.ToleranceOf(true, InPasses), 8.0);
  EXPECT_EQ(passes.ToleranceOf(false, InPasses), 8.0) << "no pass was asked for";
  EXPECT_TRUE(passes.Next());
  EXPECT_FALSE(passes.Next()) << "was not drawn since";
  EXPECT_EQ(passes.ToleranceOf(false, InPasses), 8.0);
  EXPECT_TRUE(passes.Next());
  EXPECT_EQ(passes.ToleranceOf(false, InPasses), 2.0);
  EXPECT_TRUE(passes.Next());
  EXPECT_EQ(passes.ToleranceOf(false, InPasses), 1.0) << "never below the one that is wanted";
  EXPECT_FALSE(passes.Next());
}

TEST(RefinementPasses, AScenesPictureNeverBecomesWorse)
{
  RefinementPasses passes;
  passes.ToleranceOf(true, InPasses);
  passes.Interacted();
  EXPECT_EQ(passes.ToleranceOf(false, InPasses), 1.0) << "the camera is where it was";
}

TEST(RefinementPasses, SeesWhatDecidesAPicture)
{
  const RayScene scene = scenes::Scene({ 9, 8, 7 }, { 20, 10 });
  RefinementPasses passes;
  EXPECT_TRUE(passes.SceneChanged(scene, 1));
  EXPECT_FALSE(passes.SceneChanged(scene, 1));
  EXPECT_TRUE(passes.SceneChanged(scene, 2));
  RayScene other = scene;
  other.Transfer.Entries.front().a += 0.25f;
  EXPECT_TRUE(passes.SceneChanged(other, 2));
  EXPECT_FALSE(passes.SceneChanged(other, 2));
  other.Depth.assign(200, 0.5f);
  EXPECT_TRUE(passes.SceneChanged(other, 2));
  EXPECT_TRUE(passes.SceneChanged(scene, 2));
  EXPECT_TRUE(passes.SceneChanged(scenes::Scene({ 9, 8, 7 }, { 20, 10 }, glm::dmat4(1.0), 1.5), 2));
}

} // namespace
