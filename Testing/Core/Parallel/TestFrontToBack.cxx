// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/Zones.h"

#include "Base/Error.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace banyan
{
namespace
{

class Random
{
public:
  explicit Random(unsigned seed)
    : Engine(seed)
  {
  }
  int Int(int low, int high) { return std::uniform_int_distribution<int>(low, high)(this->Engine); }
  double Real(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Engine);
  }
  glm::dvec3 Point(double low, double high)
  {
    const double x = this->Real(low, high);
    const double y = this->Real(low, high);
    return { x, y, this->Real(low, high) };
  }
  glm::dvec3 PointIn(const Box& box)
  {
    const double x = this->Real(box.Lo.x, box.Hi.x);
    const double y = this->Real(box.Lo.y, box.Hi.y);
    return { x, y, this->Real(box.Lo.z, box.Hi.z) };
  }
  template <typename T>
  void Shuffle(std::vector<T>& values)
  {
    std::shuffle(values.begin(), values.end(), this->Engine);
  }

private:
  std::mt19937 Engine;
};

/// Boxes of a random kd-tree, some shrunk so that gaps open, some emptied, in random order.
std::vector<Box> RandomBoxes(Random& random)
{
  std::vector<Box> boxes{ Box{ glm::ivec3(0), { 24, 17, 31 } } };
  const int cuts = random.Int(1, 24);
  for (int cut = 0; cut < cuts; ++cut)
  {
    Box& box = boxes[static_cast<std::size_t>(random.Int(0, static_cast<int>(boxes.size()) - 1))];
    const int axis = random.Int(0, 2);
    Box high = box;
    box.Hi[axis] = high.Lo[axis] = random.Int(box.Lo[axis], box.Hi[axis]);
    boxes.push_back(high);
  }
  for (Box& box : boxes)
  {
    const int axis = random.Int(0, 5);
    if (axis < 3)
    {
      box.Lo[axis] = std::min(box.Lo[axis] + random.Int(0, 2), box.Hi[axis]);
    }
  }
  random.Shuffle(boxes);
  return boxes;
}

/// Whether origin + t * direction passes through the inside of a box for some t >= from, and where
/// it enters and leaves.
bool Passes(const Box& box, const glm::dvec3& origin, const glm::dvec3& direction, double from,
  double& enter, double& leave)
{
  enter = from;
  leave = 1e300;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (direction[axis] == 0.0)
    {
      if (origin[axis] <= box.Lo[axis] || box.Hi[axis] <= origin[axis])
      {
        return false;
      }
      continue;
    }
    const double a = (box.Lo[axis] - origin[axis]) / direction[axis];
    const double b = (box.Hi[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return leave - enter > 1e-9;
}

/// Many rays through the boxes: each must meet them in the given order.
void ExpectRaysAgree(Random& random, const Viewpoint& view, const std::vector<Box>& boxes)
{
  const std::vector<int> order = FrontToBack(view, boxes);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    ASSERT_EQ(sorted[i], static_cast<int>(i));
  }
  for (const Box& target : boxes)
  {
    for (int sample = 0; sample < 6 && !target.Empty(); ++sample)
    {
      const glm::dvec3 through = random.PointIn(target);
      const glm::dvec3 direction =
        glm::normalize(view.Parallel ? view.Direction : through - view.Eye);
      const glm::dvec3 origin = view.Parallel ? through : view.Eye;
      double last = -1e300;
      for (const int index : order)
      {
        double enter = 0, leave = 0;
        const double from = view.Parallel ? -1e300 : 0.0;
        if (!boxes[index].Empty() && Passes(boxes[index], origin, direction, from, enter, leave))
        {
          ASSERT_GE(enter, last - 1e-9) << "box " << index << " comes too late";
          last = leave;
        }
      }
    }
  }
}

TEST(FrontToBack, AgreesWithRaysInPerspective)
{
  Random random(2);
  for (int trial = 0; trial < 400; ++trial)
  {
    const std::vector<Box> boxes = RandomBoxes(random);
    Viewpoint view;
    view.Eye = random.Point(-20.0, 50.0);
    ExpectRaysAgree(random, view, boxes);
    view.Eye = random.PointIn({ { 0, 0, 0 }, { 24, 17, 31 } });
    ExpectRaysAgree(random, view, boxes);
    // On the planes, edges and corners of boxes.
    view.Eye = glm::floor(view.Eye);
    ExpectRaysAgree(random, view, boxes);
    view.Eye.x = random.Real(-10.0, 30.0);
    ExpectRaysAgree(random, view, boxes);
  }
}

TEST(FrontToBack, AgreesWithRaysInParallelProjection)
{
  Random random(3);
  for (int trial = 0; trial < 400; ++trial)
  {
    const std::vector<Box> boxes = RandomBoxes(random);
    Viewpoint view;
    view.Parallel = true;
    view.Direction = random.Point(-1.0, 1.0);
    ExpectRaysAgree(random, view, boxes);
    view.Direction[random.Int(0, 2)] = 0.0;
    ExpectRaysAgree(random, view, boxes);
    view.Direction = glm::dvec3(0.0);
    view.Direction[random.Int(0, 2)] = random.Int(0, 1) ? 0.001 : -1000.0;
    ExpectRaysAgree(random, view, boxes);
  }
}

TEST(FrontToBack, AgreesWithRaysForStaticZones)
{
  Random random(4);
  for (int ranks = 1; ranks <= 64; ranks += 3)
  {
    const glm::ivec3 bricks(random.Int(1, 9), random.Int(1, 9), random.Int(1, 9));
    std::vector<Box> zones = StaticZones(bricks, ranks);
    Viewpoint view;
    view.Eye = random.Point(-5.0, 15.0);
    ExpectRaysAgree(random, view, zones);
  }
}

TEST(FrontToBack, FollowsTheSideOfTheEye)
{
  const std::vector<Box> boxes{ { { 0, 0, 0 }, { 4, 8, 8 } }, { { 4, 0, 0 }, { 8, 8, 8 } } };
  Viewpoint view;
  view.Eye = { -3.0, 100.0, 4.0 };
  EXPECT_EQ(FrontToBack(view, boxes), (std::vector<int>{ 0, 1 }));
  view.Eye = { 11.0, 100.0, 4.0 };
  EXPECT_EQ(FrontToBack(view, boxes), (std::vector<int>{ 1, 0 }));
  view.Parallel = true;
  view.Direction = { 1e-9, -1.0, 0.0 };
  EXPECT_EQ(FrontToBack(view, boxes), (std::vector<int>{ 0, 1 }));
  view.Direction = { -1e-9, -1.0, 0.0 };
  EXPECT_EQ(FrontToBack(view, boxes), (std::vector<int>{ 1, 0 }));
}

TEST(FrontToBack, TakesTheLowestNumberWhereSeveralOrdersAreRight)
{
  // Side by side as seen from the front, and empty boxes at the end.
  std::vector<Box> boxes;
  for (int i = 7; i >= 0; --i)
  {
    boxes.push_back({ { i, 0, 0 }, { i + 1, 1, 1 } });
    boxes.push_back(Box{});
  }
  Viewpoint view;
  view.Parallel = true;
  view.Direction = { 0.0, 0.0, -1.0 };
  EXPECT_EQ(FrontToBack(view, boxes),
    (std::vector<int>{ 0, 2, 4, 6, 8, 10, 12, 14, 1, 3, 5, 7, 9, 11, 13, 15 }));
  EXPECT_TRUE(FrontToBack(view, {}).empty());
}

TEST(FrontToBack, RefusesACircleOnlyWhereThereIsOne)
{
  // Three bars, each lying on the next: from the diagonal they hide each other in a circle.
  const std::vector<Box> bars{ { { 0, 0, 2 }, { 6, 2, 4 } }, { { 4, 0, 0 }, { 6, 6, 2 } },
    { { 0, 4, 0 }, { 4, 6, 6 } } };
  Random random(5);
  int circles = 0;
  for (int trial = 0; trial < 500; ++trial)
  {
    Viewpoint view;
    view.Eye = random.Point(-30.0, 30.0);
    try
    {
      FrontToBack(view, bars);
      ExpectRaysAgree(random, view, bars);
    }
    catch (const Error&)
    {
      ++circles;
    }
  }
  EXPECT_GT(circles, 0);
  EXPECT_LT(circles, 250);
}

TEST(FrontToBack, RefusesOverlapAndCamerasWithoutPlace)
{
  Viewpoint view;
  view.Eye = { 0.5, 0.5, 9.0 };
  EXPECT_THROW(
    FrontToBack(view, { { { 0, 0, 0 }, { 2, 2, 2 } }, { { 0, 0, 1 }, { 2, 2, 3 } } }), Error);
  view.Eye.x = std::nan("");
  EXPECT_THROW(FrontToBack(view, {}), Error);
  view.Parallel = true;
  view.Direction = glm::dvec3(0.0);
  EXPECT_THROW(FrontToBack(view, {}), Error);
}

} // namespace
} // namespace banyan
