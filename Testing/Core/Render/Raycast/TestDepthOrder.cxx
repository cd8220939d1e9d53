// SPDX-License-Identifier: BSD-3-Clause
// Which of several turned boxes hides which, against rays that are cut with each of them.
#include "Render/Dice.h"

#include "Render/Raycast/DepthOrder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace
{

using namespace banyan;

const glm::ivec2 Picture(24, 18);

class BoxDice : public Dice
{
public:
  using Dice::Dice;

  /// Turned, scaled and often sheared, around its middle.
  PlacedBox Box(const glm::dvec3& middle, double size)
  {
    PlacedBox box;
    for (glm::dvec3& edge : box.Edges)
    {
      edge = this->Direction() * (size * std::pow(10.0, this->In(-1.0, 0.0)));
    }
    box.Corner = middle - 0.5 * (box.Edges[0] + box.Edges[1] + box.Edges[2]);
    return box;
  }
  RayCamera Camera()
  {
    const glm::dmat4 view =
      glm::lookAt(this->Direction() * 9.0, this->Point(1.0), this->Direction());
    return this->In(0.0, 1.0) < 0.5
             ? RayCamera(glm::perspective(0.8, 4.0 / 3.0, 0.1, 50.0) * view, Picture, {})
             : RayCamera(glm::ortho(-4.0, 4.0, -3.0, 3.0, 0.1, 50.0) * view, Picture, {});
  }
};

double Highest(const PlacedBox& box, const glm::dvec3& direction)
{
  double highest = glm::dot(box.Corner, direction);
  for (const glm::dvec3& edge : box.Edges)
  {
    highest += std::max(0.0, glm::dot(edge, direction));
  }
  return highest;
}

/// Two boxes on the two sides of a plane; touching it, or each other, now and then.
std::pair<PlacedBox, PlacedBox> Separated(BoxDice& dice)
{
  const glm::dvec3 normal = dice.Direction();
  const double plane = dice.In(-2.0, 2.0);
  std::pair<PlacedBox, PlacedBox> boxes{ dice.Box(dice.Point(2.0), 4.0),
    dice.Box(dice.Point(2.0), 4.0) };
  const double gap = std::max(0.0, dice.In(-0.5, 0.5));
  boxes.first.Corner -= normal * (Highest(boxes.first, normal) - plane);
  boxes.second.Corner += normal * (Highest(boxes.second, -normal) + plane + gap);
  return boxes;
}

/// Where a ray enters a box.
std::optional<double> Enters(const Ray& ray, const PlacedBox& box)
{
  const glm::dmat3 inverse = glm::inverse(glm::dmat3(box.Edges[0], box.Edges[1], box.Edges[2]));
  const glm::dvec3 origin = inverse * (ray.Origin - box.Corner);
  const glm::dvec3 step = inverse * ray.Direction;
  double enters = ray.Near;
  double leaves = ray.Far;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = -origin[axis] / step[axis];
    const double b = (1.0 - origin[axis]) / step[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters < leaves - 1e-6 ? std::optional<double>(enters) : std::nullopt;
}

/// @return rays that meet both
int ExpectAsRaysSay(
  DepthRelation relation, const std::pair<PlacedBox, PlacedBox>& boxes, const RayCamera& camera)
{
  int both = 0;
  for (int y = 0; y < Picture.y; ++y)
  {
    for (int x = 0; x < Picture.x; ++x)
    {
      const Ray ray = camera.RayOf(x, y);
      const std::optional<double> first = Enters(ray, boxes.first);
      const std::optional<double> second = Enters(ray, boxes.second);
      if (first && second)
      {
        ++both;
        EXPECT_EQ(
          relation, *first < *second ? DepthRelation::FirstNearer : DepthRelation::SecondNearer);
      }
    }
  }
  return both;
}

TEST(DepthOrder, BoxesOnTwoSidesOfAPlaneAreInTheOrderOfRays)
{
  int met = 0;
  for (unsigned seed = 0; seed < 800; ++seed)
  {
    SCOPED_TRACE(seed);
    BoxDice dice(seed);
    const auto boxes = Separated(dice);
    const RayCamera camera = dice.Camera();
    const DepthRelation relation = RelationInDepth({ boxes.first }, { boxes.second }, camera);
    EXPECT_NE(relation, DepthRelation::Unknown);
    met += ExpectAsRaysSay(relation, boxes, camera) > 0 ? 1 : 0;
    const DepthRelation reversed = RelationInDepth({ boxes.second }, { boxes.first }, camera);
    EXPECT_EQ(relation == DepthRelation::FirstNearer, reversed == DepthRelation::SecondNearer);
    EXPECT_EQ(relation == DepthRelation::Apart, reversed == DepthRelation::Apart);
  }
  EXPECT_GT(met, 100);
}

TEST(DepthOrder, BoxesWithAPointInCommonHaveNone)
{
  for (unsigned seed = 0; seed < 400; ++seed)
  {
    SCOPED_TRACE(seed);
    BoxDice dice(seed);
    const glm::dvec3 common = dice.Point(2.0);
    std::array<PlacedBox, 2> boxes;
    for (PlacedBox& box : boxes)
    {
      box = dice.Box(common, 4.0);
      for (const glm::dvec3& edge : box.Edges)
      {
        box.Corner += edge * dice.In(-0.49, 0.49);
      }
    }
    EXPECT_EQ(RelationInDepth({ boxes[0] }, { boxes[1] }, dice.Camera()), DepthRelation::Unknown);
    // One of several boxes around a body is enough.
    PlacedBox away = boxes[1];
    away.Corner += dice.Direction() * 40.0;
    EXPECT_NE(
      RelationInDepth({ boxes[0] }, { boxes[1], away }, dice.Camera()), DepthRelation::Unknown);
  }
}

TEST(DepthOrder, NeighboursShareAFaceWhateverRoundingDoes)
{
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1, 2, 3));
  const RayCamera camera(glm::perspective(0.8, 4.0 / 3.0, 0.1, 90.0) *
                           glm::lookAt(glm::dvec3(2, 3, 30), glm::dvec3(0.0), glm::dvec3(0, 1, 0)),
    Picture, {});
  for (int i = 1; i < 100; ++i)
  {
    const double border = 0.1 * i;
    const PlacedBox left = PlaceBox(glm::dvec3(0.0), { border, 1, 1 }, turned);
    const PlacedBox right = PlaceBox({ border - 1e-9, 0, 0 }, { border + 3, 1, 1 }, turned);
    EXPECT_NE(RelationInDepth({ left }, { right }, camera), DepthRelation::Unknown);
  }
}

TEST(DepthOrder, FlatThingsHaveSides)
{
  const RayCamera camera(
    glm::perspective(0.8, 4.0 / 3.0, 0.1, 90.0) *
      glm::lookAt(glm::dvec3(0.5, 0.5, 30), glm::dvec3(0.5, 0.5, 0.0), glm::dvec3(0, 1, 0)),
    Picture, {});
  const glm::dmat4 same(1.0);
  const PlacedBody cube{ PlaceBox(glm::dvec3(0.0), glm::dvec3(1.0), same) };
  const auto at = [&](double z, double size)
  {
    return PlacedBody{ PlaceBox(
      { 0.5 - size, 0.5 - size, z }, { 0.5 + size, 0.5 + size, z }, same) };
  };
  EXPECT_EQ(RelationInDepth(cube, at(-1.0, 3.0), camera), DepthRelation::FirstNearer);
  EXPECT_EQ(RelationInDepth(cube, at(0.0, 3.0), camera), DepthRelation::FirstNearer);
  EXPECT_EQ(RelationInDepth(cube, at(0.5, 3.0), camera), DepthRelation::Unknown);
  EXPECT_EQ(RelationInDepth(cube, at(1.0, 3.0), camera), DepthRelation::SecondNearer);
  EXPECT_EQ(RelationInDepth(cube, at(1.5, 0.0), camera), DepthRelation::SecondNearer);
  EXPECT_EQ(RelationInDepth(at(2.0, 3.0), at(1.0, 3.0), camera), DepthRelation::FirstNearer);
}

TEST(DepthOrder, AnEyeBetweenTwoBoxesSeesOneAtATime)
{
  const PlacedBody low{ PlaceBox(glm::dvec3(-1.0), { 1, 1, 0 }, glm::dmat4(1.0)) };
  const PlacedBody high{ PlaceBox({ -1, -1, 2 }, { 1, 1, 3 }, glm::dmat4(1.0)) };
  const RayCamera camera(
    glm::perspective(0.8, 4.0 / 3.0, 0.1, 90.0) *
      glm::lookAt(glm::dvec3(4, 0, 1), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1)),
    Picture, {});
  EXPECT_EQ(RelationInDepth(low, high, camera), DepthRelation::Apart);
}

/// One colour wherever a ray meets a box.
FloatImage Filled(const PlacedBox& box, const RayCamera& camera, const glm::vec4& color)
{
  FloatImage image{ { { 0, 0 }, Picture }, {} };
  for (int y = 0; y < Picture.y; ++y)
  {
    for (int x = 0; x < Picture.x; ++x)
    {
      image.Pixels.push_back(Enters(camera.RayOf(x, y), box) ? color : glm::vec4(0.0f));
    }
  }
  return image;
}

/// Three beams, each over the end of the next one.
TEST(DepthOrder, BoxesThatHideEachOtherInACircleAreBlendedPixelByPixel)
{
  const RayCamera camera(glm::ortho(-4.0, 4.0, -3.0, 3.0, 0.1, 50.0) *
                           glm::lookAt(glm::dvec3(0, 0, 20), glm::dvec3(0.0), glm::dvec3(0, 1, 0)),
    Picture, {});
  const std::array<glm::vec4, 3> colors{ glm::vec4(0.5f, 0, 0, 0.5f), glm::vec4(0, 0.6f, 0, 0.6f),
    glm::vec4(0, 0, 0.7f, 0.7f) };
  std::vector<PlacedBox> beams;
  std::vector<PlacedBody> bodies;
  std::vector<std::shared_ptr<const FloatImage>> pictures;
  for (int i = 0; i < 3; ++i)
  {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 2.0943951 * i, glm::dvec3(0, 0, 1)) *
                              glm::translate(glm::dmat4(1.0), glm::dvec3(0, -1, 0)) *
                              glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0, 1, 0));
    beams.push_back(PlaceBox({ -3, -0.4, -0.1 }, { 3, 0.4, 0.1 }, turned));
    bodies.push_back({ beams.back() });
    pictures.push_back(std::make_shared<const FloatImage>(
      Filled(beams.back(), camera, colors[static_cast<std::size_t>(i)])));
  }
  const DepthOrder order(bodies, camera);
  EXPECT_FALSE(order.SomeUnknown());
  EXPECT_TRUE(order.Nearer(0, 1) == order.Nearer(1, 2) && order.Nearer(1, 2) == order.Nearer(2, 0));
  const FloatImage blended = BlendInDepth(pictures, order, { { 0, 0 }, Picture });
  int several = 0;
  for (int y = 0; y < Picture.y; ++y)
  {
    for (int x = 0; x < Picture.x; ++x)
    {
      std::vector<std::pair<double, int>> met;
      for (int i = 0; i < 3; ++i)
      {
        const auto enters = Enters(camera.RayOf(x, y), beams[static_cast<std::size_t>(i)]);
        if (enters)
        {
          met.emplace_back(*enters, i);
        }
      }
      std::sort(met.begin(), met.end());
      several += met.size() > 1 ? 1 : 0;
      glm::vec4 sum(0.0f);
      for (const auto& one : met)
      {
        sum += (1.0f - sum.a) * colors[static_cast<std::size_t>(one.second)];
      }
      EXPECT_LT(glm::length(sum - blended.At(x, y)), 1e-6f) << x << " " << y;
    }
  }
  EXPECT_GT(several, 10);
}

TEST(GroupsThatMix, ThoseThatShareSpace)
{
  const RayCamera camera(glm::ortho(-9.0, 9.0, -9.0, 9.0, 1.0, 90.0) *
                           glm::lookAt(glm::dvec3(0, 0, 50), glm::dvec3(0.0), glm::dvec3(0, 1, 0)),
    Picture, {});
  const auto box = [](double x, double z, double length) -> PlacedBody {
    return { PlaceBox({ x, 0, z }, { x + 2, 2, z + length }, glm::dmat4(1.0)) };
  };
  using Groups = std::vector<std::vector<int>>;
  const auto groupsOf = [&](const std::vector<PlacedBody>& bodies, const std::vector<bool>& mixes)
  { return GroupsThatMix(DepthOrder(bodies, camera), mixes); };
  // Two that share space, one beside them.
  const std::vector<PlacedBody> three{ box(0, 0, 4), box(5, 0, 4), box(1, 2, 4) };
  EXPECT_EQ(groupsOf(three, { true, true, true }), (Groups{ { 0, 2 }, { 1 } }));
  EXPECT_EQ(groupsOf(three, { true, true, false }), (Groups{ { 0 }, { 1 }, { 2 } }));
  // A chain is one group.
  EXPECT_EQ(groupsOf({ box(0, 0, 4), box(0, 6, 4), box(0, 3, 4) }, { true, true, true }),
    (Groups{ { 0, 1, 2 } }));
  // A third that is before the one of two, and beside the other: no picture of the two is before or
  // behind it.
  const PlacedBody below = { PlaceBox({ 0, -4, 0 }, { 2, 2, 1 }, glm::dmat4(1.0)) };
  const PlacedBody across = { PlaceBox({ 0, 0, 0.5 }, { 2, 2, 8 }, glm::dmat4(1.0)) };
  const PlacedBody between = { PlaceBox({ 0, -4, 2 }, { 2, -0.5, 3 }, glm::dmat4(1.0)) };
  EXPECT_EQ(groupsOf({ below, across, between }, { true, true, true }), (Groups{ { 0, 1, 2 } }));
  EXPECT_EQ(
    groupsOf({ between, across, below }, { false, true, true }), (Groups{ { 0 }, { 1, 2 } }));
  const PlacedBody behind = { PlaceBox({ 0, 0, -3 }, { 2, 2, -1 }, glm::dmat4(1.0)) };
  EXPECT_EQ(groupsOf({ below, across, behind }, { true, true, true }), (Groups{ { 0, 1 }, { 2 } }));
  EXPECT_EQ(groupsOf({}, {}), Groups{});
}

} // namespace
