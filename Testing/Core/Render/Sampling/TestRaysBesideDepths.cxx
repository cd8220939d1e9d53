// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/RaysBesideDepths.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

RayScene PartOfPicture()
{
  RayScene scene = scenes::Scene({ 9, 9, 9 }, { 200, 160 }, glm::dmat4(1.0), 1.6);
  scene.Viewport = { { 40, 10 }, { 200, 160 } };
  scene.Depth.assign(static_cast<std::size_t>(scene.Viewport.Count()), 1.0f);
  return scene;
}

std::shared_ptr<TileSamplings> SomeSamplings()
{
  auto samplings = std::make_shared<TileSamplings>(
    glm::ivec2(200, 160), std::vector<RaySampling>{ { 1, 0.5, 4 }, { 0, 0.25, 1 }, { 2, 2.0, 8 } });
  for (int y = 0; y < samplings->Tiles().y; ++y)
  {
    for (int x = 0; x < samplings->Tiles().x; ++x)
    {
      samplings->SetNumber({ x, y }, (x + y) % 3);
    }
  }
  return samplings;
}

TEST(RaysBesideDepths, TilesBesideSomethingOpaqueHaveAllRays)
{
  RayScene scene = PartOfPicture();
  const glm::ivec2 pixel(100, 70); // in tile 3, 2
  scene.Depth[static_cast<std::size_t>((pixel.y - 10) * 160 + pixel.x - 40)] = 0.5f;
  const auto before = SomeSamplings();
  const auto after = WithRaysBesideDepths(before, scene);
  for (int y = 0; y < before->Tiles().y; ++y)
  {
    for (int x = 0; x < before->Tiles().x; ++x)
    {
      RaySampling expected = before->At({ x, y });
      if (std::abs(x - 3) <= 1 && std::abs(y - 2) <= 1)
      {
        expected.PixelStride = 1;
      }
      EXPECT_EQ(after->At({ x, y }), expected) << x << " " << y;
    }
  }
}

TEST(RaysBesideDepths, AllElseStaysAsItIs)
{
  RayScene scene = PartOfPicture();
  const auto before = SomeSamplings();
  const auto same = WithRaysBesideDepths(before, scene);
  for (int tile = 0; tile < before->Tiles().x * before->Tiles().y; ++tile)
  {
    const glm::ivec2 at(tile % before->Tiles().x, tile / before->Tiles().x);
    EXPECT_EQ(same->At(at), before->At(at));
  }
  scene.Depth.clear();
  EXPECT_EQ(WithRaysBesideDepths(before, scene), before);
  EXPECT_EQ(WithRaysBesideDepths(nullptr, scene), nullptr);
}

} // namespace
