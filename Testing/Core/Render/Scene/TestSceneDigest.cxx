// SPDX-License-Identifier: BSD-3-Clause
// Whatever decides a picture changes the digest of its scene, and nothing else does.
#include "Render/Scene/SceneDigest.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <functional>

namespace
{

using namespace banyan;

RayScene Whole()
{
  RayScene scene = scenes::Scene({ 9, 8, 7 }, { 20, 10 });
  scene.Depth.assign(200, 0.5f);
  scene.ClipPlanes = { { glm::dvec3(1.0, 0.0, 0.0), 0.5 } };
  scene.Shading.On = true;
  return scene;
}

TEST(SceneDigest, SeesWhatDecidesAPicture)
{
  const std::vector<std::function<void(RayScene&)>> changes{
    [](RayScene& scene) { scene.Transfer.Entries.front().a += 0.25f; },
    [](RayScene& scene) { scene.Transfer.Entries.back().r += 0.25f; },
    [](RayScene& scene) { scene.Transfer.Low -= 1.0; },
    [](RayScene& scene) { scene.Transfer.UnitDistance *= 2.0; },
    [](RayScene& scene) {
      scene.Transfer.Edges.assign(scene.Transfer.Entries.size() - 1, { 0.5, false });
    },
    [](RayScene& scene) { scene.Depth.back() = 0.25f; },
    [](RayScene& scene) { scene.Depth.clear(); },
    [](RayScene& scene) { scene.ClipPlanes.front().Offset = 0.25; },
    [](RayScene& scene) { scene.ClipPlanes.clear(); },
    [](RayScene& scene) { scene.Shading.On = false; },
    [](RayScene& scene) { scene.Shading.SpecularPower = 3.0f; },
    [](RayScene& scene) { scene.Interpolation = SampleInterpolation::Nearest; },
    [](RayScene& scene) { scene.Blend.Mode = BlendMode::Maximum; },
    [](RayScene& scene) { scene.SampleDistance *= 0.5; },
    [](RayScene& scene) { scene.Viewport.Hi.x -= 1; },
    [](RayScene& scene) { scene.DomainCells.Hi.z -= 1; },
    [](RayScene& scene) { scene.IndexToWorld[3][0] += 1.0; },
    [](RayScene& scene) {
      scene.Camera = scene.Camera.WithSize({ 20, 11 });
    },
    [](RayScene& scene) {
      scene.Camera = scenes::Scene({ 9, 8, 7 }, { 20, 10 }, glm::dmat4(1.0), 1.5).Camera;
    },
  };
  const RayScene scene = Whole();
  const Hash128 digest = DigestOf(scene);
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    RayScene other = scene;
    changes[i](other);
    EXPECT_NE(DigestOf(other), digest) << "change " << i;
  }
  EXPECT_EQ(DigestOf(Whole()), digest);
}

TEST(SceneDigest, DoesNotSeeHowFinelyItIsSampled)
{
  const RayScene scene = Whole();
  RayScene other = scene;
  other.OpacityLimit = 0.5f;
  other.Samplings = std::make_shared<const TileSamplings>(
    scene.Camera.ImageSize(), std::vector<RaySampling>{ { 1, 0.5 } });
  EXPECT_EQ(DigestOf(other), DigestOf(scene));
  other.Shading.On = false;
  RayScene unlit = other;
  unlit.Shading.Ambient = 0.75f;
  EXPECT_EQ(DigestOf(unlit), DigestOf(other)) << "there is no light";
}

} // namespace
