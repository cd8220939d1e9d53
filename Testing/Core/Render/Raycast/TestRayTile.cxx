// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Raycast/RayTile.h"
#include "Render/Scenes.h"
#include "Targets.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

FloatImage Untouched(const RayScene& scene)
{
  FloatImage image;
  image.Rect = scene.Viewport;
  image.Pixels.assign(scene.Viewport.Count(), glm::vec4(0, 0, 0, 1));
  return image;
}

void ExpectSamePart(const PartialSample& a, const PartialSample& b)
{
  ASSERT_EQ(a.Fraction, b.Fraction);
  for (int axis = 0; axis < 3 && a.Fraction > 0.0f; ++axis)
  {
    ASSERT_EQ(a.Position[axis], b.Position[axis]);
  }
}

void ExpectSameRay(const RaySamples& a, const RaySamples& b)
{
  ASSERT_EQ(a.Count, b.Count);
  ExpectSamePart(a.Head, b.Head);
  ExpectSamePart(a.Tail, b.Tail);
  for (int axis = 0; axis < 3 && a.Count > 0; ++axis)
  {
    ASSERT_EQ(a.Base[axis], b.Base[axis]);
    ASSERT_EQ(a.Step[axis], b.Step[axis]);
    ASSERT_EQ(a.Start[axis], b.Start[axis]);
    ASSERT_EQ(a.InverseStep[axis], b.InverseStep[axis]);
  }
}

/// Rays of a tile against those made one by one, on all sets of instructions.
/// @return rays that are not empty
int Compare(const RayScene& scene)
{
  const RayLattice lattice(scene);
  const FloatImage picture = Untouched(scene);
  const auto tile = std::make_unique<RayTile>();
  int rays = 0;
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    rays = 0;
    const glm::ivec2 corner = scene.Viewport.Lo;
    tile->Open(
      lattice, Intersection({ corner, corner + RayTile::Edge }, scene.Viewport), picture, 0.0f);
    for (int y = tile->Rect.Lo.y; y < tile->Rect.Hi.y; ++y)
    {
      for (int x = tile->Rect.Lo.x; x < tile->Rect.Hi.x; ++x)
      {
        const RaySamples expected = lattice.SamplesOf(x, y);
        ExpectSameRay(tile->RayOf(tile->SlotOf(x, y)), expected);
        EXPECT_EQ(tile->IsEmpty(tile->SlotOf(x, y)), expected.Empty());
        rays += expected.Empty() ? 0 : 1;
        if (testing::Test::HasFatalFailure())
        {
          return -1;
        }
      }
    }
    EXPECT_EQ(tile->ActiveRays, rays);
  }
  return rays;
}

TEST(RayTile, PerspectiveAndParallel)
{
  const glm::ivec3 n(33, 20, 41);
  for (const bool parallel : { false, true })
  {
    for (const double distance : { 0.05, 0.3, 1.4 })
    {
      RayScene scene = scenes::Scene(n, { 61, 57 }, glm::dmat4(1.0), distance, parallel);
      scene.Viewport = { { 20, 21 }, { 51, 52 } };
      EXPECT_GT(Compare(scene), 500);
    }
  }
}

TEST(RayTile, EdgesOfTheDomain)
{
  RayScene scene = scenes::Scene({ 33, 20, 41 }, { 31, 30 });
  const int rays = Compare(scene);
  EXPECT_GT(rays, 200);
  EXPECT_LT(rays, 900);
}

TEST(RayTile, StepsOfAllSizes)
{
  RayScene scene = scenes::Scene({ 12, 9, 17 }, { 30, 30 });
  for (const double step : { 0.001, 0.3, 2.0, 9.0, 14.0, 500.0 })
  {
    scene.SampleDistance = step;
    EXPECT_GT(Compare(scene), 200);
  }
}

TEST(RayTile, TransformedGrids)
{
  glm::dmat4 toWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(100, -50, 7));
  toWorld = glm::rotate(toWorld, 0.8, glm::normalize(glm::dvec3(1, 2, 3)));
  toWorld = glm::scale(toWorld, glm::dvec3(0.5, -1.25, 2.0));
  for (const bool parallel : { false, true })
  {
    EXPECT_GT(Compare(scenes::Scene({ 20, 31, 12 }, { 30, 30 }, toWorld, 1.4, parallel)), 200);
  }
}

TEST(RayTile, RaysAlongTheAxes)
{
  const glm::dvec3 centre(4.0);
  const glm::dmat4 projection = glm::ortho(-4.25, 4.25, -4.25, 4.25, 1.0, 40.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    glm::dvec3 forward(0.0);
    forward[axis] = 1.0;
    glm::dvec3 up(0.0);
    up[(axis + 1) % 3] = 1.0;
    RayScene scene = scenes::Scene(glm::ivec3(9), { 17, 17 });
    scene.Camera =
      RayCamera(projection * glm::lookAt(centre - 20.0 * forward, centre, up), { 17, 17 }, centre);
    EXPECT_GT(Compare(scene), 200);
  }
}

TEST(RayTile, Geometry)
{
  RayScene scene = scenes::Scene(glm::ivec3(33), { 30, 30 });
  for (int i = 0; i < 900; ++i)
  {
    scene.Depth.push_back(i % 3 == 0 ? 1.0f : 0.3f + 0.0006f * static_cast<float>(i));
  }
  EXPECT_GT(Compare(scene), 100);
}

TEST(RayTile, ClippedRays)
{
  const glm::ivec3 n(20, 31, 12);
  glm::dmat4 toWorld = glm::rotate(glm::dmat4(1.0), 0.8, glm::normalize(glm::dvec3(1, 2, 3)));
  toWorld = glm::scale(toWorld, glm::dvec3(0.5, -1.25, 2.0));
  for (const bool parallel : { false, true })
  {
    for (const double distance : { 0.1, 1.4 })
    {
      RayScene scene = scenes::Scene(n, { 30, 30 }, toWorld, distance, parallel);
      const int whole = Compare(scene);
      const glm::dvec3 centre = scenes::CentreOf(scene.DomainCells, toWorld);
      scene.ClipPlanes = { { { 1, 0.3, -0.2 }, 3.0 - glm::dot(glm::dvec3(1, 0.3, -0.2), centre) },
        { { 0, -5, 0 }, 15.0 + 5.0 * centre.y } };
      const int rays = Compare(scene);
      EXPECT_GT(rays, 50);
      EXPECT_TRUE(rays < whole || distance < 1.0);
    }
  }
}

TEST(RayTile, RaysAlongClipPlanes)
{
  const glm::dvec3 centre(4.0);
  RayScene scene = scenes::Scene(glm::ivec3(9), { 17, 17 });
  scene.Camera = RayCamera(glm::ortho(-4.25, 4.25, -4.25, 4.25, 1.0, 40.0) *
                             glm::lookAt(centre - glm::dvec3(0, 0, 20), centre, { 0, 1, 0 }),
    { 17, 17 }, centre);
  scene.ClipPlanes = { { { 1, 0, 0 }, -3.25 }, { { 0, -1, 0 }, 5.25 }, { { 0, 0, 1 }, -2.25 } };
  const int rays = Compare(scene);
  EXPECT_GT(rays, 80);
  EXPECT_LT(rays, 120);
}

TEST(RayTile, FarFromTheOrigin)
{
  const glm::dmat4 toWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(4e5, -5e6, 3e4));
  EXPECT_GT(Compare(scenes::Scene(glm::ivec3(33), { 30, 30 }, toWorld)), 200);
}

TEST(RayTile, EndedRaysAreLeftEmpty)
{
  const RayScene scene = scenes::Scene(glm::ivec3(33), { 30, 30 });
  const RayLattice lattice(scene);
  FloatImage picture = Untouched(scene);
  for (int x = 0; x < 30; ++x)
  {
    picture.At(x, 15) = { 0.5f, 0.25f, 0.125f, 0.01f };
  }
  const auto tile = std::make_unique<RayTile>();
  tile->Open(lattice, scene.Viewport, picture, 0.01f);
  EXPECT_TRUE(tile->IsEmpty(tile->SlotOf(15, 15)));
  EXPECT_FALSE(tile->IsEmpty(tile->SlotOf(15, 14)));
  tile->SetPixel(tile->SlotOf(3, 4), { 1, 2, 3, 4 });
  tile->Close(picture);
  EXPECT_EQ(picture.At(15, 15), glm::vec4(0.5f, 0.25f, 0.125f, 0.01f));
  EXPECT_EQ(picture.At(3, 4), glm::vec4(1, 2, 3, 4));
  EXPECT_EQ(picture.At(4, 3), glm::vec4(0, 0, 0, 1));
}

TEST(RayTile, RaysOfPixelsThatAreNotDrawnAreLeftEmpty)
{
  const RayScene scene = scenes::Scene(glm::ivec3(33), { 30, 30 });
  const RayLattice lattice(scene);
  FloatImage picture = Untouched(scene);
  picture.At(2, 20) = { 0.5f, 0.25f, 0.125f, 0.5f };
  const FloatImage before = picture;
  const auto all = std::make_unique<RayTile>();
  all->Open(lattice, scene.Viewport, picture, 0.01f);
  const auto tile = std::make_unique<RayTile>();
  const PixelRect drawn{ { 5, 9 }, { 22, 18 } };
  tile->Open(lattice, scene.Viewport, picture, 0.01f, 1, true, drawn);
  for (int y = 0; y < 30; ++y)
  {
    for (int x = 0; x < 30; ++x)
    {
      const int slot = tile->SlotOf(x, y);
      const bool here = x >= drawn.Lo.x && x < drawn.Hi.x && y >= drawn.Lo.y && y < drawn.Hi.y;
      EXPECT_EQ(tile->IsEmpty(slot), !here || all->IsEmpty(slot)) << x << ' ' << y;
      EXPECT_TRUE(!here || tile->Count[slot] == all->Count[slot]) << x << ' ' << y;
    }
  }
  tile->Close(picture);
  EXPECT_EQ(picture.Pixels, before.Pixels);
}

TEST(RayTile, TooManySamplesAreRefused)
{
  RayScene scene = scenes::Scene(glm::ivec3(9), { 20, 20 });
  const glm::dvec3 centre(4.0);
  const glm::dvec3 eye = centre + glm::dvec3(0, 0, 1e14);
  const glm::dmat4 view = glm::lookAt(eye, centre, glm::dvec3(0, 1, 0));
  scene.Camera = RayCamera(glm::perspective(1e-13, 1.0, 0.5e14, 2e14) * view, { 20, 20 }, centre);
  scene.SampleDistance = 0.01;
  const RayLattice lattice(scene);
  const FloatImage picture = Untouched(scene);
  const auto tile = std::make_unique<RayTile>();
  EXPECT_THROW(tile->Open(lattice, scene.Viewport, picture, 0.0f), Error);
}

TEST(OpacityOfDepth, IsOneMinusTheExponential)
{
  EXPECT_EQ(OpacityOfDepth::Of(0.0f), 0.0f);
  EXPECT_EQ(OpacityOfDepth::Of(std::numeric_limits<float>::infinity()), 1.0f);
  EXPECT_EQ(OpacityOfDepth::Of(std::numeric_limits<float>::max()), 1.0f);
  for (double depth = 1e-30; depth < 200.0; depth *= 1.003)
  {
    const float x = static_cast<float>(depth);
    const double expected = -std::expm1(-double{ x });
    ASSERT_NEAR(OpacityOfDepth::Of(x), expected, 3e-7 * expected) << depth;
  }
}

} // namespace
