// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/LoadBalancer.h"
#include "Parallel/Balance/ScreenCuts.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace
{

using namespace banyan;

const glm::ivec3 Samples{ 65, 65, 65 };
const glm::ivec2 Size{ 120, 90 };
const Box Cells{ glm::ivec3(0), Samples - 1 };

/// Looks from a place to the middle.
RayScene From(const glm::dvec3& eye, bool parallel)
{
  RayScene scene = scenes::Scene(Samples, Size, glm::dmat4(1.0), 1.0, parallel);
  const glm::dvec3 middle(32.0);
  const double away = glm::length(eye - middle);
  const glm::dmat4 projection =
    parallel ? glm::ortho(-40.0, 40.0, -30.0, 30.0, 0.1, away + 100.0)
             : glm::perspective(glm::radians(40.0), 4.0 / 3.0, 0.1, away + 100.0);
  const glm::dvec3 up =
    std::abs(eye.y - middle.y) > 0.9 * away ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  scene.Camera = RayCamera(projection * glm::lookAt(eye, middle, up), Size, middle);
  return scene;
}

/// The slow way: through each pixel's middle, where does the plane lie?
double CountPixels(const RayScene& scene, const Box& flat, int axis, bool parallel)
{
  const glm::dmat4 toIndex = glm::inverse(scene.IndexToWorld) * scene.Camera.ClipToWorldMatrix();
  double pixels = 0.0;
  for (int y = scene.Viewport.Lo.y; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = scene.Viewport.Lo.x; x < scene.Viewport.Hi.x; ++x)
    {
      const glm::dvec2 at = 2.0 * (glm::dvec2(x, y) + 0.5) / glm::dvec2(Size) - 1.0;
      glm::dvec4 a = toIndex * glm::dvec4(at, -1.0, 1.0);
      glm::dvec4 b = toIndex * glm::dvec4(at, 1.0, 1.0);
      a /= a.w;
      b /= b.w;
      const double t = (flat.Lo[axis] - a[axis]) / (b[axis] - a[axis]);
      const glm::dvec4 hit = a + t * (b - a);
      bool inside = parallel || (t >= 0.0 && t <= 1.0); // behind the eye nothing is seen
      for (int other = 0; other < 3; ++other)
      {
        inside = inside &&
                 (other == axis || (hit[other] >= flat.Lo[other] && hit[other] <= flat.Hi[other]));
      }
      pixels += inside ? 1.0 : 0.0;
    }
  }
  return pixels;
}

TEST(ScreenCuts, PixelsAreThoseThatRaysCount)
{
  const glm::dvec3 eyes[] = { { 130, 90, 150 }, { 32, 40, 140 }, { 20, 30, 44 }, { 32, 32, 33 },
    { -60, 35, 30 } };
  for (const glm::dvec3& eye : eyes)
  {
    for (const bool parallel : { false, true })
    {
      RayScene scene = From(eye, parallel);
      for (const PixelRect& viewport : { PixelRect{ { 0, 0 }, Size }, { { 13, 7 }, { 71, 80 } } })
      {
        scene.Viewport = viewport;
        const ScreenCuts cuts(scene);
        for (int axis = 0; axis < 3; ++axis)
        {
          for (const int plane : { 10, 32, 50 })
          {
            Box flat{ { 4, 8, 12 }, { 60, 56, 52 } };
            flat.Lo[axis] = flat.Hi[axis] = plane;
            const double counted = CountPixels(scene, flat, axis, parallel);
            // Half a pixel along an outline that is not longer than twice the viewport's.
            EXPECT_NEAR(counted, cuts.Pixels(flat), 0.03 * static_cast<double>(viewport.Count()))
              << axis << " " << plane << " from " << eye.x << " " << parallel;
          }
        }
      }
    }
  }
}

TEST(ScreenCuts, NothingIsSeenWithoutAViewportOrOfAPlaneEdgeOn)
{
  RayScene scene = From({ 32, 32, 200 }, true);
  Box flat = Cells;
  flat.Lo.x = flat.Hi.x = 20;
  EXPECT_NEAR(0.0, ScreenCuts(scene).Pixels(flat), 1e-6);
  flat = Cells;
  flat.Lo.z = flat.Hi.z = 20;
  EXPECT_GT(ScreenCuts(scene).Pixels(flat), 1000.0);
  scene.Viewport = {};
  EXPECT_EQ(0.0, ScreenCuts(scene).Pixels(flat));
}

BrickCosts Even()
{
  BrickCosts costs(Cells.Hi, 8);
  std::fill(costs.Values.begin(), costs.Values.end(), 1000.0);
  return costs;
}

std::string AxesOf(const ZoneTree& tree)
{
  std::string axes;
  for (const ZoneTree::Node& node : tree.Nodes)
  {
    axes += node.IsLeaf() ? "" : std::string(1, "xyz"[node.Axis]);
  }
  return axes;
}

TEST(ScreenCuts, TurnedTreesHaveZonesSideBySide)
{
  const CostSums costs(Even());
  for (const bool parallel : { false, true })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      glm::dvec3 eye(32.0);
      eye[axis] = 300.0;
      const ScreenCuts cuts(From(eye, parallel));
      for (const int ranks : { 1, 2, 3, 4, 7, 16 })
      {
        const ZoneTree equal = EqualZoneTree(Cells.Hi, ranks);
        const std::vector<double> speeds(static_cast<std::size_t>(ranks), 1.0);
        const ZoneTree turned = TurnedTree(equal, costs, speeds, 1, cuts, 24.0);
        EXPECT_EQ(std::string::npos, AxesOf(turned).find("xyz"[axis])) << AxesOf(turned);
        EXPECT_LE(ExpectedImbalance(turned, costs, speeds), 1.05); // of 64 positions per axis
        EXPECT_LE(RaysCut(turned, costs, cuts), RaysCut(equal, costs, cuts) + 1e-6);
        std::int64_t cells = 0;
        for (const Box& zone : ZonesOf(turned))
        {
          cells += zone.Count();
        }
        EXPECT_EQ(Cells.Count(), cells);
        // What stands well stays.
        EXPECT_EQ(turned, TurnedTree(turned, costs, speeds, 1, cuts, 24.0));
      }
    }
  }
}

/// Only what costs something is cut.
TEST(ScreenCuts, RaysThroughNothingAreNotCut)
{
  BrickCosts costs(Cells.Hi, 8);
  costs.Values[costs.NumberAt({ 1, 1, 1 })] = 7.0;
  const CostSums sums(costs);
  const ScreenCuts cuts(From({ 32, 32, 300 }, true));
  ZoneTree tree = EqualZoneTree(Cells.Hi, 2);
  tree.Nodes.front().Axis = 2;
  tree.Nodes.front().Plane = 32;
  EXPECT_EQ(0.0, RaysCut(tree, sums, cuts));
  tree.Nodes.front().Plane = 12;
  EXPECT_NEAR(64.0 * ScreenCuts(From({ 32, 32, 300 }, true)).Pixels({ { 8, 8, 12 }, { 9, 9, 12 } }),
    RaysCut(tree, sums, cuts), 1e-6);
}

class Turning : public ::testing::Test
{
protected:
  Turning()
    : Balancer(OptionsFor(4))
  {
  }

  static LoadBalancer::Options OptionsFor(int ranks)
  {
    LoadBalancer::Options options;
    options.Positions = Cells.Hi;
    options.Ranks = ranks;
    return options;
  }

  /// A frame in which a ray that is cut takes `perRay` more. @return work of all ranks
  double Draw(const glm::dvec3& eye, double perRay)
  {
    const ScreenCuts cuts(From(eye, false));
    const BrickCosts view = Even();
    this->Balancer.BeginFrame(view, &cuts);
    BrickCosts work = view;
    const CostSums sums(view);
    const double more = perRay * RaysCut(this->Balancer.Tree(), sums, cuts) / sums.Total();
    for (double& value : work.Values)
    {
      value *= 1.0 + more;
    }
    const CostSums all(work);
    std::vector<RankWork> ranks;
    for (const Box& zone : ZonesOf(this->Balancer.Tree()))
    {
      ranks.push_back({ 1e-6 * all.In(zone), all.In(zone) });
    }
    this->Balancer.FrameTook(ranks, work);
    return all.Total();
  }

  LoadBalancer Balancer;
};

TEST_F(Turning, ItBeginsSideBySideAndFollowsTheCamera)
{
  const glm::dvec3 front(32, 32, 100);
  const glm::dvec3 side(100, 32, 32);
  const double least = this->Draw(front, 24.0);
  EXPECT_EQ(std::string::npos, AxesOf(this->Balancer.Tree()).find('z'));
  EXPECT_EQ(0.0, this->Balancer.BytesMoved());
  for (int frame = 0; frame < 20; ++frame)
  {
    EXPECT_NEAR(least, this->Draw(front, 24.0), 1e-6 * least);
    EXPECT_EQ(0.0, this->Balancer.BytesMoved());
  }
  this->Draw(side, 24.0);
  EXPECT_EQ(std::string::npos, AxesOf(this->Balancer.Tree()).find('x'));
  EXPECT_GT(this->Balancer.BytesMoved(), 0.0);
  EXPECT_LE(this->Balancer.BytesMoved(), 4.0 * static_cast<double>(Cells.Count()));
}

TEST_F(Turning, ACameraThatFliesAroundTurnsZonesNowAndThen)
{
  int turns = 0;
  std::string axes;
  for (int frame = 0; frame < 200; ++frame)
  {
    const double angle = 0.5 * frame;
    this->Draw(glm::dvec3(32.0) + 80.0 * glm::dvec3(std::cos(angle), 0.2, std::sin(angle)), 24.0);
    const std::string now = AxesOf(this->Balancer.Tree());
    turns += now != axes ? 1 : 0;
    axes = now;
    EXPECT_NEAR(1.0, this->Balancer.ExpectedImbalance(), 0.07);
  }
  EXPECT_LE(turns, 200 / 8);
}

TEST_F(Turning, AViewThatRestsTurnsZonesAtOnce)
{
  const glm::dvec3 front(32, 32, 100);
  this->Draw(front, 24.0);
  this->Draw(glm::dvec3(100, 32, 32), 24.0);
  EXPECT_EQ(std::string::npos, AxesOf(this->Balancer.Tree()).find('x'));
  // Not in the next frame of a camera that flies about, but as soon as it rests.
  this->Draw(front, 24.0);
  EXPECT_NE(std::string::npos, AxesOf(this->Balancer.Tree()).find('z'));
  this->Draw(front, 24.0);
  EXPECT_EQ(std::string::npos, AxesOf(this->Balancer.Tree()).find('z'));
}

TEST_F(Turning, WithoutAViewAxesStay)
{
  const std::string axes = AxesOf(this->Balancer.Tree());
  for (int frame = 0; frame < 5; ++frame)
  {
    this->Balancer.BeginFrame(Even());
    std::vector<RankWork> ranks(4, RankWork{ 1.0, 100.0 });
    this->Balancer.FrameTook(ranks, Even());
    EXPECT_EQ(axes, AxesOf(this->Balancer.Tree()));
  }
}

} // namespace
