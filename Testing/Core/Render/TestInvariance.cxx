// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{

using namespace banyan;

constexpr std::uint64_t NoLimit = std::uint64_t{ 1 } << 40;

struct Case
{
  glm::ivec3 N{ 45, 38, 41 };
  std::vector<float> Values = scenes::Sampled(scenes::Standard, N);
  RayScene Scene = scenes::Scene(N, { 70, 60 });

  explicit Case(const scenes::Function& function = scenes::Sparse)
  {
    this->Scene.Transfer = scenes::Tabulate(function);
    this->Scene.SampleDistance = 0.7;
    this->Scene.OpacityLimit = 0.9961f;
  }

  FloatImage Draw(const scenes::DrawOptions& options) const
  {
    return scenes::Draw(this->Scene, scenes::ArrayOf(this->Values, this->N), options).Image;
  }
};

TEST(Invariance, BrickSizeChangesNoBit)
{
  const Case test;
  const FloatImage image = test.Draw({ 16, 1, NoLimit });
  EXPECT_GT(image.At(35, 30).a, 0.1f);
  for (const int cells : { 1, 3, 7, 8, 11, 32, 64 })
  {
    EXPECT_EQ(MaxDifference(test.Draw({ cells, 1, NoLimit }), image), 0.0) << cells;
  }
}

TEST(Invariance, ThreadsChangeNoBit)
{
  const Case test;
  const FloatImage image = test.Draw({ 8, 1, NoLimit });
  for (const int threads : { 2, 3, 8 })
  {
    EXPECT_EQ(MaxDifference(test.Draw({ 8, threads, NoLimit }), image), 0.0);
  }
}

/// A source whose bricks take memory, so that the budget makes batches.
FloatImage DrawCopies(const Case& test, std::uint64_t budget, int threads)
{
  const std::vector<std::uint8_t> flags(test.Values.size(), 0);
  SampleArray array = scenes::ArrayOf(test.Values, test.N);
  array.Flags = flags.data();
  return scenes::Draw(test.Scene, array, { 8, threads, budget }).Image;
}

TEST(Invariance, BudgetsChangeNoBit)
{
  const Case test;
  const FloatImage image = test.Draw({ 8, 1, NoLimit });
  for (const std::uint64_t budget :
    { std::uint64_t{ 0 }, std::uint64_t{ 10000 }, std::uint64_t{ 100000 }, NoLimit })
  {
    EXPECT_EQ(MaxDifference(DrawCopies(test, budget, 2), image), 0.0) << budget;
  }
}

TEST(Invariance, ViewportsAreCutouts)
{
  const Case test;
  const FloatImage image = test.Draw({ 16, 1, NoLimit });
  for (const PixelRect& viewport : { PixelRect{ { 10, 5 }, { 43, 50 } },
         PixelRect{ { 33, 30 }, { 34, 31 } }, PixelRect{ { 0, 0 }, { 70, 1 } } })
  {
    Case part;
    part.Scene.Viewport = viewport;
    const FloatImage cutout = part.Draw({ 16, 1, NoLimit });
    EXPECT_EQ(Intersection(cutout.Rect, viewport), cutout.Rect);
    for (int y = viewport.Lo.y; y < viewport.Hi.y; ++y)
    {
      for (int x = viewport.Lo.x; x < viewport.Hi.x; ++x)
      {
        const bool drawn = !Intersection(cutout.Rect, { { x, y }, { x + 1, y + 1 } }).Empty();
        EXPECT_EQ(drawn ? cutout.At(x, y) : glm::vec4(0.0f),
          Intersection(image.Rect, { { x, y }, { x + 1, y + 1 } }).Empty() ? glm::vec4(0.0f)
                                                                           : image.At(x, y));
      }
    }
  }
}

/// Cuts a box at random planes into `parts` boxes: any kd-tree of zones.
std::vector<Box> Cut(const Box& whole, int parts, std::mt19937& random)
{
  std::vector<Box> boxes = { whole };
  while (static_cast<int>(boxes.size()) < parts)
  {
    const std::size_t which = random() % boxes.size();
    const int axis = static_cast<int>(random() % 3);
    Box& box = boxes[which];
    if (box.Size()[axis] >= 2)
    {
      Box upper = box;
      const int plane = box.Lo[axis] + 1 + static_cast<int>(random() % (box.Size()[axis] - 1));
      upper.Lo[axis] = plane;
      box.Hi[axis] = plane;
      boxes.push_back(upper);
    }
  }
  return boxes;
}

/// Whether a plane of the grid separates the boxes so that a can hide b.
bool CanHide(const Viewpoint& view, const Box& a, const Box& b)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double toward = view.Parallel ? view.Direction[axis] : 0.0;
    if (a.Lo[axis] >= b.Hi[axis]) // a lies above b: behind it when seen from below
    {
      if (view.Parallel ? toward >= 0.0 : view.Eye[axis] <= a.Lo[axis])
      {
        return false;
      }
    }
    if (a.Hi[axis] <= b.Lo[axis])
    {
      if (view.Parallel ? toward <= 0.0 : view.Eye[axis] >= a.Hi[axis])
      {
        return false;
      }
    }
  }
  return true;
}

/// Front to back by taking, again and again, a box that no other can hide.
std::vector<Box> Ordered(const Viewpoint& view, std::vector<Box> boxes)
{
  std::vector<Box> order;
  while (!boxes.empty())
  {
    const auto front = std::find_if(boxes.begin(), boxes.end(),
      [&](const Box& candidate)
      {
        return std::none_of(boxes.begin(), boxes.end(),
          [&](const Box& other)
          { return !(other == candidate) && CanHide(view, other, candidate); });
      });
    if (front == boxes.end())
    {
      return {};
    }
    order.push_back(*front);
    boxes.erase(front);
  }
  return order;
}

FloatImage DrawZones(const Case& test, const std::vector<Box>& zones)
{
  ThreadPool pool(1);
  ArrayBrickSource source(scenes::ArrayOf(test.Values, test.N), 8, { 0, 1 }, pool);
  FloatImage picture;
  picture.Rect = test.Scene.Viewport;
  picture.Pixels.assign(picture.Rect.Count(), glm::vec4(0.0f));
  RayStatistics statistics;
  for (const Box& zone : zones)
  {
    const FloatImage part = CastRays(test.Scene, source, zone, NoLimit, pool, statistics);
    for (int y = part.Rect.Lo.y; y < part.Rect.Hi.y; ++y)
    {
      for (int x = part.Rect.Lo.x; x < part.Rect.Hi.x; ++x)
      {
        glm::vec4& pixel = picture.At(x, y);
        pixel += (1.0f - pixel.a) * part.At(x, y);
      }
    }
  }
  return picture;
}

TEST(Invariance, ZonesBlendToTheWhole)
{
  std::mt19937 random(2);
  Case test;
  test.Scene.OpacityLimit = 1.0f;
  for (const int camera : { 0, 1, 2 })
  {
    const RayScene view =
      scenes::Scene(test.N, { 70, 60 }, glm::dmat4(1.0), camera == 2 ? 0.2 : 1.4, camera == 1);
    test.Scene.Camera = view.Camera;
    const FloatImage whole = test.Draw({ 16, 1, NoLimit });
    for (const int parts : { 2, 3, 5, 16 })
    {
      const std::vector<Box> zones =
        Ordered(InIndexSpace(test.Scene.Camera, test.Scene.IndexToWorld),
          Cut(test.Scene.DomainCells, parts, random));
      ASSERT_EQ(static_cast<int>(zones.size()), parts);
      EXPECT_LE(MaxDifference(DrawZones(test, zones), whole), 1e-5);
    }
  }
}

TEST(Invariance, ZonesWithEarlyEndDifferByWhatIsLeft)
{
  std::mt19937 random(4);
  Case test;
  for (glm::vec4& entry : test.Scene.Transfer.Entries)
  {
    entry.a = std::min(1.0f, 6.0f * entry.a);
  }
  const FloatImage whole = test.Draw({ 16, 1, NoLimit });
  const std::vector<Box> zones = Ordered(InIndexSpace(test.Scene.Camera, test.Scene.IndexToWorld),
    Cut(test.Scene.DomainCells, 4, random));
  ASSERT_EQ(zones.size(), 4u);
  EXPECT_LE(MaxDifference(DrawZones(test, zones), whole), 1.0 - 0.9961 + 1e-5);
}

/// Pieces with ghost layers of samples, each its own source, as distributed image data is drawn.
TEST(Invariance, PiecesWithTheirOwnSourcesBlendToTheWhole)
{
  Case test;
  test.Scene.OpacityLimit = 1.0f;
  const FloatImage whole = test.Draw({ 16, 1, NoLimit });
  const Box all = test.Scene.DomainCells;
  const Box low{ all.Lo, { all.Hi.x, all.Hi.y, 19 } };
  const Box high{ { 0, 0, 19 }, all.Hi };
  ThreadPool pool(1);
  FloatImage picture;
  picture.Rect = test.Scene.Viewport;
  picture.Pixels.assign(picture.Rect.Count(), glm::vec4(0.0f));
  for (const Box& cells :
    Ordered(InIndexSpace(test.Scene.Camera, test.Scene.IndexToWorld), { low, high }))
  {
    // Two more layers than needed below and above.
    SampleArray array = scenes::ArrayOf(test.Values, test.N);
    array.Samples.Lo.z = std::max(cells.Lo.z - 2, 0);
    array.Samples.Hi.z = std::min(cells.Hi.z + 3, test.N.z);
    array.Values = test.Values.data() + array.Samples.Lo.z * test.N.x * test.N.y;
    ArrayBrickSource source(array, 16, { 0, 1 }, pool);
    RayStatistics statistics;
    const FloatImage part = CastRays(test.Scene, source, cells, NoLimit, pool, statistics);
    for (int y = part.Rect.Lo.y; y < part.Rect.Hi.y; ++y)
    {
      for (int x = part.Rect.Lo.x; x < part.Rect.Hi.x; ++x)
      {
        glm::vec4& pixel = picture.At(x, y);
        pixel += (1.0f - pixel.a) * part.At(x, y);
      }
    }
  }
  EXPECT_LE(MaxDifference(picture, whole), 1e-5);
}

TEST(Invariance, SamplesAreCountedOnceWhateverTheZones)
{
  std::mt19937 random(9);
  Case test(scenes::Smooth); // everything visible
  test.Scene.OpacityLimit = 2.0f;
  ThreadPool pool(1);
  const auto count = [&](int brickCells, const std::vector<Box>& zones)
  {
    ArrayBrickSource source(scenes::ArrayOf(test.Values, test.N), brickCells, { 0, 1 }, pool);
    RayStatistics statistics;
    for (const Box& zone : zones)
    {
      CastRays(test.Scene, source, zone, NoLimit, pool, statistics);
    }
    return statistics.SamplesTaken;
  };
  const std::int64_t samples = count(16, { test.Scene.DomainCells });
  EXPECT_GT(samples, 50000);
  EXPECT_EQ(count(5, { test.Scene.DomainCells }), samples);
  EXPECT_EQ(count(8, Cut(test.Scene.DomainCells, 13, random)), samples);
}

/// All coordinates times ten, the unit distance and the step too.
TEST(Invariance, UnitsOfLength)
{
  const Case test(scenes::Smooth);
  const FloatImage image = test.Draw({ 16, 1, NoLimit });
  for (const double factor : { 10.0, 1e-3, 7e6 })
  {
    Case scaled(scenes::Smooth);
    const glm::dmat4 toWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(factor));
    scaled.Scene.IndexToWorld = toWorld;
    scaled.Scene.Camera = scenes::Scene(test.N, { 70, 60 }, toWorld).Camera;
    scaled.Scene.SampleDistance *= factor;
    scaled.Scene.Transfer.UnitDistance *= factor;
    EXPECT_LE(MaxDifference(scaled.Draw({ 16, 1, NoLimit }), image), 1e-4) << factor;
  }
}

TEST(Invariance, FarFromTheOrigin)
{
  const Case test(scenes::Smooth);
  Case moved(scenes::Smooth);
  const glm::dmat4 toWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(4e5, -5e6, 3e4));
  moved.Scene.IndexToWorld = toWorld;
  moved.Scene.Camera = scenes::Scene(test.N, { 70, 60 }, toWorld).Camera;
  const FloatImage image = test.Draw({ 16, 1, NoLimit });
  EXPECT_LE(MaxDifference(moved.Draw({ 16, 1, NoLimit }), image), 1e-3);
}

TEST(Invariance, HalfTheStep)
{
  for (const bool parallel : { false, true })
  {
    Case test(scenes::Smooth);
    test.Scene = scenes::Scene(test.N, { 70, 60 }, glm::dmat4(1.0), 1.4, parallel);
    const FloatImage image = test.Draw({ 16, 1, NoLimit });
    test.Scene.SampleDistance *= 0.5;
    EXPECT_LE(MaxDifference(test.Draw({ 16, 1, NoLimit }), image), 2.0 / 255.0);
  }
}

} // namespace
