// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Scene/RayLattice.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

double ReadView(const BrickView& view, const glm::ivec3& p)
{
  return Dispatch(view.Type,
    [&](auto tag)
    {
      const auto* values = static_cast<const typename decltype(tag)::Type*>(view.Values);
      return static_cast<double>(
        values[p.x * view.Stride[0] + p.y * view.Stride[1] + p.z * view.Stride[2]]);
    });
}

std::int64_t CountOf(const BrickSource& source)
{
  const glm::ivec3 n = source.Bricks();
  return std::int64_t{ n.x } * n.y * n.z;
}

/// All bricks of `source` hold what `value` says, and their cells are exactly those of `samples`.
void ExpectHolds(
  BrickSource& source, const Box& samples, const std::function<double(const glm::ivec3&)>& value)
{
  std::int64_t cells = 0;
  for (std::int64_t brick = 0; brick < CountOf(source); ++brick)
  {
    const Box box = source.CellsOf(brick);
    cells += box.Count();
    const BrickView view = source.Load(brick);
    for (int z = box.Lo.z; z <= box.Hi.z; ++z)
    {
      for (int y = box.Lo.y; y <= box.Hi.y; ++y)
      {
        for (int x = box.Lo.x; x <= box.Hi.x; ++x)
        {
          const glm::ivec3 p(x, y, z);
          ASSERT_TRUE(samples.Contains(p));
          const double found = ReadView(view, p - box.Lo);
          const double expected = value(p);
          ASSERT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected)))
            << found << " " << expected;
        }
      }
    }
  }
  EXPECT_EQ(cells, (Box{ samples.Lo, samples.Hi - 1 }).Count());
}

TEST(ArrayBrickSource, SizesAroundTheBrickSize)
{
  ThreadPool pool(2);
  for (const glm::ivec3& n : { glm::ivec3(1, 1, 1), glm::ivec3(2, 2, 2), glm::ivec3(8, 9, 10),
         glm::ivec3(1, 17, 5), glm::ivec3(31, 7, 1), glm::ivec3(16, 17, 2) })
  {
    const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
    ArrayBrickSource source(scenes::ArrayOf(values, n), 8, { 0, 1 }, pool);
    ExpectHolds(source, { glm::ivec3(0), n }, scenes::ValueOf(values, n));
    const glm::ivec3 bricks = glm::max((n - 1 + 7) / 8, glm::ivec3(1));
    EXPECT_EQ(source.Bricks(), bricks);
    EXPECT_EQ(source.LoadBytes(0), 0u);
  }
}

TEST(ArrayBrickSource, NoSamplesNoBricks)
{
  ThreadPool pool(1);
  SampleArray array;
  ArrayBrickSource source(array, 8, { 0, 1 }, pool);
  EXPECT_EQ(CountOf(source), 0);
  EXPECT_TRUE(FiniteRange(array, pool).Empty());
}

TEST(ArrayBrickSource, PiecesHaveTheWholeGridsBricks)
{
  ThreadPool pool(1);
  const glm::ivec3 n(30, 20, 11);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  SampleArray array = scenes::ArrayOf(values, n);
  array.Samples = { { 5, 8, 2 }, { 25, 20, 9 } };
  array.Values = values.data() + 5 + n.x * (8 + n.y * 2);
  ArrayBrickSource source(array, 8, { 0, 1 }, pool);
  ExpectHolds(source, array.Samples, scenes::ValueOf(values, n));
  EXPECT_EQ(source.CellsOf(0), (Box{ { 5, 8, 2 }, { 8, 16, 8 } }));
  EXPECT_EQ(source.Bricks(), glm::ivec3(3, 2, 1));
}

TEST(ArrayBrickSource, ComponentsStridesAndMagnitude)
{
  ThreadPool pool(2);
  const glm::ivec3 n(9, 5, 6);
  std::vector<std::int16_t> values(n.x * n.y * n.z * 3);
  std::mt19937 random(3);
  for (auto& value : values)
  {
    value = static_cast<std::int16_t>(static_cast<int>(random() % 2001) - 1000);
  }
  SampleArray array;
  array.Values = values.data();
  array.Type = ScalarType::Int16;
  array.Components = 3;
  array.Stride[0] = 3;
  array.Stride[1] = 3 * n.x;
  array.Stride[2] = 3 * n.x * n.y;
  array.Samples = { glm::ivec3(0), n };
  const auto component = [&](int c)
  {
    return [&values, n, c](const glm::ivec3& p)
    { return double(values[3 * (p.x + n.x * (p.y + n.y * p.z)) + c]); };
  };
  array.Component = 2;
  ArrayBrickSource second(array, 4, { -1000, 1000 }, pool);
  ExpectHolds(second, array.Samples, component(2));
  EXPECT_EQ(second.Load(0).Type, ScalarType::Int16);

  array.Component = SampleArray::Magnitude;
  ArrayBrickSource magnitude(array, 4, { 0, 2000 }, pool);
  ExpectHolds(magnitude, array.Samples,
    [&](const glm::ivec3& p)
    {
      double sum = 0;
      for (int c = 0; c < 3; ++c)
      {
        sum += component(c)(p) * component(c)(p);
      }
      return double(float(std::sqrt(sum)));
    });
  EXPECT_EQ(magnitude.LoadBytes(0), 5u * 5 * 5 * sizeof(float));
}

TEST(ArrayBrickSource, HiddenSamplesAreNotANumber)
{
  ThreadPool pool(1);
  const glm::ivec3 n(7, 6, 5);
  const std::vector<double> values = scenes::Sampled<double>(scenes::Linear, n);
  std::vector<std::uint8_t> flags(values.size(), 1); // duplicates: not hidden
  flags[17] |= 2;
  flags.back() = 2;
  SampleArray array = scenes::ArrayOf(values, n);
  array.Flags = flags.data();
  ArrayBrickSource source(array, 4, { 0, 1 }, pool);
  const auto plain = scenes::ValueOf(values, n);
  ExpectHolds(source, array.Samples,
    [&](const glm::ivec3& p)
    { return flags[p.x + n.x * (p.y + n.y * p.z)] & 2 ? NotANumber : plain(p); });
  EXPECT_LT(FiniteRange(array, pool).High, 0.92); // the hidden last sample has 0.95
}

TEST(ArrayBrickSource, FiniteRangeLeavesOutWhatIsNotFinite)
{
  ThreadPool pool(2);
  const glm::ivec3 n(3, 2, 2);
  std::vector<double> values = { 4, NotANumber, -INFINITY, 7, 5, 6, INFINITY, -2, 0, 1, 2, 3 };
  const ValueRange range = FiniteRange(scenes::ArrayOf(values, n), pool);
  EXPECT_EQ(range.Low, -2.0);
  EXPECT_EQ(range.High, 7.0);
  values.assign(12, NotANumber);
  EXPECT_TRUE(FiniteRange(scenes::ArrayOf(values, n), pool).Empty());
}

TEST(ArrayBrickSource, RefusesWhatCannotBeUsed)
{
  ThreadPool pool(1);
  const glm::ivec3 n(4);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  const auto refused = [&](const std::function<void(SampleArray&)>& change, int brickCells = 4)
  {
    SampleArray array = scenes::ArrayOf(values, n);
    change(array);
    EXPECT_THROW(ArrayBrickSource(array, brickCells, { 0, 1 }, pool), Error);
  };
  refused([](SampleArray& a) { a.Component = 1; });
  refused([](SampleArray& a) { a.Component = -3; });
  refused([](SampleArray& a) { a.Values = nullptr; });
  refused([](SampleArray& a) { a.Samples.Lo.x = -1; });
  refused([](SampleArray&) {}, 0);
}

/// Every value that an interpolation inside a brick gives is in the brick's range and mask, and a
/// mask has no more bins than the cells need.
TEST(ArrayBrickSource, RangesAndMasksAgainstInterpolants)
{
  ThreadPool pool(2);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const glm::ivec3 n(19, 13, 9);
  std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  for (int i = 0; i < 40; ++i)
  {
    values[random() % values.size()] = i % 2 ? NAN : INFINITY;
  }
  const auto value = scenes::ValueOf(values, n);
  const MaskRange over{ 0.05, 0.8 };
  ArrayBrickSource source(scenes::ArrayOf(values, n), 4, over, pool);
  for (std::int64_t brick = 0; brick < CountOf(source); ++brick)
  {
    const Box cells = source.CellsOf(brick);
    const ValueRange range = source.RangeOf(brick);
    ValueRange found;
    ValueMask needed = 0;
    for (int z = cells.Lo.z; z < cells.Hi.z; ++z)
    {
      for (int y = cells.Lo.y; y < cells.Hi.y; ++y)
      {
        for (int x = cells.Lo.x; x < cells.Hi.x; ++x)
        {
          ValueRange cell;
          bool finite = true;
          for (int corner = 0; corner < 8; ++corner)
          {
            const double v = value({ x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2) });
            finite = finite && std::isfinite(v);
            if (std::isfinite(v))
            {
              cell.Include(v);
              found.Include(v);
            }
          }
          if (finite)
          {
            const double inside = cell.Low + unit(random) * cell.Width();
            EXPECT_TRUE(source.MaskOf(brick) >> over.BinOf(inside) & 1);
          }
          if (!cell.Empty())
          {
            needed |= MaskOfBins(over.BinOf(cell.Low), over.BinOf(cell.High));
          }
        }
      }
    }
    EXPECT_EQ(range.Low, found.Low);
    EXPECT_EQ(range.High, found.High);
    EXPECT_EQ(source.MaskOf(brick), needed);
  }
}

TEST(ArrayBrickSource, MasksOfFlatVolumesCountSamples)
{
  ThreadPool pool(1);
  const glm::ivec3 n(1, 3, 1);
  const std::vector<float> values = { 0.0f, 1.0f, 0.5f };
  ArrayBrickSource source(scenes::ArrayOf(values, n), 4, { 0, 1 }, pool);
  EXPECT_EQ(source.MaskOf(0) & MaskOfBins(0, 0), 1u);
  EXPECT_EQ(source.RangeOf(0).High, 1.0);
}

/// Contents of all bricks at a level, looked at. @param array is copied to other memory
std::vector<Hash128> ContentsOf(const SampleArray& array, int level)
{
  ThreadPool pool(2);
  ArrayBrickSource source(array, 4, { 0, 1 }, pool);
  BrickSource& at = *source.AtLevel(level, { array.Samples.Lo, array.Samples.Hi - 1 });
  std::vector<std::int64_t> all;
  for (std::int64_t brick = 0; brick < CountOf(at); ++brick)
  {
    EXPECT_FALSE(at.ContentOf(brick));
    all.push_back(brick);
  }
  at.LookAt(all);
  std::vector<Hash128> contents;
  for (const std::int64_t brick : all)
  {
    contents.push_back(at.ContentOf(brick).value());
  }
  return contents;
}

TEST(ArrayBrickSource, ContentIsThatOfTheSamplesThatABrickHas)
{
  const glm::ivec3 n(19, 13, 9);
  std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  const std::vector<float> same = values;
  for (int level = 0; level < 3; ++level)
  {
    const std::vector<Hash128> before = ContentsOf(scenes::ArrayOf(values, n), level);
    EXPECT_EQ(ContentsOf(scenes::ArrayOf(same, n), level), before);
    for (const glm::ivec3& at : { glm::ivec3(8, 4, 4), glm::ivec3(9, 5, 3), n - 1 })
    {
      float& value = values[static_cast<std::size_t>(at.x + n.x * (at.y + n.y * at.z))];
      const float old = value;
      value += 0.25f;
      const std::vector<Hash128> now = ContentsOf(scenes::ArrayOf(values, n), level);
      value = old;
      ThreadPool pool(1);
      ArrayBrickSource source(scenes::ArrayOf(values, n), 4, { 0, 1 }, pool);
      BrickSource& bricks = *source.AtLevel(level, { glm::ivec3(0), n - 1 });
      const glm::ivec3 edges = bricks.CellEdges();
      EXPECT_EQ(edges, LevelEdges::Following(n - 1).At(level)); // the axes rest 0, 0 and 1 levels
      for (std::size_t brick = 0; brick < now.size(); ++brick)
      {
        const Box cells = bricks.CellsOf(static_cast<std::int64_t>(brick));
        bool has = true;
        for (int axis = 0; axis < 3; ++axis)
        {
          const int every = edges[axis];
          // The last sample is repeated where the last cell is not whole.
          const int position =
            at[axis] == n[axis] - 1 ? (at[axis] + every - 1) / every * every : at[axis];
          has = has && position % every == 0 && position / every >= cells.Lo[axis] &&
                position / every <= cells.Hi[axis];
        }
        EXPECT_EQ(now[brick] != before[brick], has) << level << " " << brick;
      }
    }
  }
}

/// Coarse levels of a flat array are what one gets by hand: some of its samples, farther apart.
TEST(ArrayBrickSource, LevelsOfFlatArraysKeepTheShortAxis)
{
  ThreadPool pool(2);
  const glm::ivec3 n(65, 33, 9); // the axes rest 0, 1 and 3 levels
  for (const int level : { 1, 2, 3, 4 })
  {
    RayScene scene = scenes::Scene(n, { 60, 50 }, glm::dmat4(1.0), 1.1, false);
    scene.Transfer = scenes::Tabulate(scenes::Sparse);
    scene.Shading.On = level == 2;
    scene.Levels = LevelEdges::Following(n - 1);
    const glm::ivec3 edges = scene.Levels.At(level);
    EXPECT_EQ(edges, glm::ivec3(1 << level, 1 << (level - 1), level > 3 ? 2 : 1));
    const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
    const glm::ivec3 fewer = (n - 1) / edges + 1;
    const std::vector<float> some = scenes::Sampled(
      [&](const glm::dvec3& at)
      {
        const glm::ivec3 p = glm::ivec3(glm::round(at * glm::dvec3(fewer - 1))) * edges;
        return values[static_cast<std::size_t>(p.x + n.x * (p.y + n.y * p.z))];
      },
      fewer);
    RayScene byHand = scene;
    byHand.DomainCells = { glm::ivec3(0), fewer - 1 };
    byHand.IndexToWorld = IndexToWorldAt(scene, edges);
    byHand.Levels = {};
    scene.Samplings = std::make_shared<const TileSamplings>(
      scene.Camera.ImageSize(), std::vector{ RaySampling{ level, scene.SampleDistance } });
    ArrayBrickSource all(scenes::ArrayOf(values, n), 4, { 0, 1 }, pool);
    ArrayBrickSource taken(scenes::ArrayOf(some, fewer), 4, { 0, 1 }, pool);
    RayStatistics statistics;
    const FloatImage picture = CastRays(scene, all, scene.DomainCells, 1u << 24, pool, statistics);
    const FloatImage expected =
      CastRays(byHand, taken, byHand.DomainCells, 1u << 24, pool, statistics);
    EXPECT_EQ(picture.Rect, expected.Rect);
    EXPECT_EQ(picture.Pixels, expected.Pixels) << level;
    EXPECT_GT(statistics.SamplesTaken, 1000) << level;
    scene.Levels = {};
    EXPECT_THROW(CastRays(scene, all, scene.DomainCells, 1u << 24, pool, statistics), Error);
  }
}

TEST(ArrayBrickSource, ContentTellsComponentsTypesAndWhatIsHidden)
{
  const glm::ivec3 n(6, 5, 5);
  std::vector<std::int16_t> values(static_cast<std::size_t>(n.x * n.y * n.z * 2), 3);
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(n.x * n.y * n.z), 0);
  SampleArray array;
  array.Values = values.data();
  array.Type = ScalarType::Int16;
  array.Components = 2;
  array.Stride[0] = 2;
  array.Stride[1] = 2 * n.x;
  array.Stride[2] = 2 * n.x * n.y;
  array.Samples = { glm::ivec3(0), n };
  const std::vector<Hash128> first = ContentsOf(array, 0);
  array.Type = ScalarType::UInt16;
  EXPECT_NE(ContentsOf(array, 0), first);
  array.Type = ScalarType::Int16;
  array.Component = SampleArray::Magnitude;
  const std::vector<Hash128> length = ContentsOf(array, 0);
  values[1] = 4; // of the other component
  EXPECT_NE(ContentsOf(array, 0), length);
  array.Component = 0;
  EXPECT_EQ(ContentsOf(array, 0), first);
  array.Flags = flags.data();
  const std::vector<Hash128> shown = ContentsOf(array, 0);
  flags[0] = 2;
  EXPECT_NE(ContentsOf(array, 0), shown);
}

TEST(ArrayBrickSource, WhatIsKnownStaysWhenValuesGo)
{
  ThreadPool pool(1);
  const glm::ivec3 n(9);
  std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  SampleArray array = scenes::ArrayOf(values, n);
  const auto owner = std::make_shared<int>(0);
  array.Owner = owner;
  ArrayBrickSource source(array, 4, { 0, 1 }, pool);
  array.Owner.reset();
  BrickSource& coarse = *source.AtLevel(1, { glm::ivec3(0), n - 1 });
  source.LookAt({ 0 });
  coarse.LookAt({ 0 });
  const std::optional<Hash128> fine = source.ContentOf(0);
  EXPECT_EQ(owner.use_count(), 2);
  source.LetGoOfValues();
  EXPECT_EQ(owner.use_count(), 1);
  EXPECT_TRUE(fine && source.ContentOf(0) == fine && coarse.ContentOf(0));
  EXPECT_FALSE(source.ContentOf(1));
}

} // namespace
