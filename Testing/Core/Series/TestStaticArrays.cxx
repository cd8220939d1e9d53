// SPDX-License-Identifier: BSD-3-Clause
/// Arrays that stay the same beside others that move: they are stored once.
#include "Series/SeriesTesting.h"

#include <functional>
#include <limits>

namespace banyan::testing
{
namespace
{

const Grid Cube = GridOf(33, 32, 32);
constexpr int Count = 37;
constexpr int Interval = 8;

/// Values that cost some bits each.
std::vector<float> Rough(int seed, std::size_t count)
{
  std::mt19937 random(static_cast<unsigned>(seed));
  std::vector<float> values(count);
  for (float& value : values)
  {
    value = static_cast<float>(random() % 1000) / 1000.0f;
  }
  values[17] = std::numeric_limits<float>::quiet_NaN();
  return values;
}

float Moving(int x, int y, int z, int step)
{
  return static_cast<float>(std::sin(0.2 * x + 0.4 * step) * std::cos(0.15 * y - 0.1 * z));
}

/// A series of a scalar that moves and a vector that is whatever a function says.
struct Pair
{
  Steps<float> Scalars = Sample<float>(Cube, Count, Moving);
  Steps<float> Vectors; ///< three components

  explicit Pair(const std::function<int(int)>& seedOfStep)
  {
    for (int s = 0; s < Count; ++s)
    {
      this->Vectors.push_back(Rough(seedOfStep(s), 3 * this->Scalars[0].size()));
    }
  }

  std::vector<ArrayDescription> Descriptions(bool both = true) const
  {
    ArrayDescription scalars = Describe(this->Scalars, "moving");
    ArrayDescription vectors = Describe(this->Vectors, "vectors");
    vectors.ComponentNames = { "X", "Y", "Z" };
    vectors.SeriesRanges.assign(3, { 0, 1 });
    return both ? std::vector<ArrayDescription>{ scalars, vectors }
                : std::vector<ArrayDescription>{ scalars };
  }

  SeriesIndex Encode(const std::string& path, EncodeOptions options, bool both = true) const
  {
    options.KeyframeInterval = Interval;
    options.BrickCells = 16;
    ThreadPool pool(2);
    SeriesEncoder encoder(path, Cube, this->Descriptions(both), options, pool);
    for (std::size_t s = 0; s < this->Scalars.size(); ++s)
    {
      std::vector<ArrayValues> values{ { this->Scalars[s].data() } };
      if (both)
      {
        values.push_back({ this->Vectors[s].data() });
      }
      encoder.AddStep(static_cast<double>(s), values);
    }
    return encoder.Finish();
  }

  std::vector<float> Component(int step, int component) const
  {
    std::vector<float> values;
    for (std::size_t i = static_cast<std::size_t>(component); i < this->Vectors[0].size(); i += 3)
    {
      values.push_back(this->Vectors[static_cast<std::size_t>(step)][i]);
    }
    return values;
  }

  /// Every voxel of every step, in an order that jumps between groups.
  void ExpectWithin(const SeriesFile& file) const
  {
    for (int k = 0; k < Count; ++k)
    {
      const int s = k * 11 % Count;
      EXPECT_TRUE(WithinBound(this->Scalars[static_cast<std::size_t>(s)],
        ReadAll<float>(file, { s, 0, 0, 0 }),
        file.Index().Arrays[0].Components[0].ErrorBoundAbsolute))
        << "step " << s;
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_TRUE(WithinBound(this->Component(s, c), ReadAll<float>(file, { s, 1, c, 0 }),
          file.Index().Arrays[1].Components[static_cast<std::size_t>(c)].ErrorBoundAbsolute))
          << "step " << s << ", component " << c;
      }
    }
  }
};

std::uint64_t BytesOf(const SeriesIndex& index)
{
  return index.Statistics.PayloadBytes + index.Statistics.TableBytes;
}

TEST(StaticArrays, CostNextToNothingBesideMovingOnes)
{
  const TemporaryFolder folder;
  const Pair pair([](int) { return 1; });
  for (const double bound : { 1.0 / 512, 0.0 })
  {
    SCOPED_TRACE(bound);
    EncodeOptions options;
    options.ErrorBound = bound;
    const std::uint64_t alone = BytesOf(pair.Encode(folder / "alone.banyan", options, false));
    const std::string path = folder / "both.banyan";
    const SeriesIndex index = pair.Encode(path, options);
    options.Ablation.StaticArrays = false;
    const std::uint64_t stored = BytesOf(pair.Encode(folder / "stored.banyan", options)) - alone;
    const std::uint64_t cost = BytesOf(index) - alone;
    ASSERT_EQ(index.Segments.size(), 5u);
    // The first group has it, the four others only directories of empty tables.
    const std::uint64_t empty = 4 * (3 * (Interval + 1) * 24 + 300);
    EXPECT_LT(cost, stored / 4);
    EXPECT_LT(cost, stored / 5 + empty + stored / 50);
    const auto file = SeriesFile::Open(path);
    pair.ExpectWithin(*file);
    // All bricks are known to be the same, on all levels.
    for (int level = 0; level < index.Levels; ++level)
    {
      const auto first = file->Nodes({ Interval - 1, 1, 2, level });
      for (int s = Interval; s < Count; ++s)
      {
        const auto now = file->Nodes({ s, 1, 2, level });
        ASSERT_EQ(now->size(), first->size());
        for (std::size_t brick = 0; brick < now->size(); ++brick)
        {
          EXPECT_EQ((*now)[brick].Identity, (*first)[brick].Identity);
          EXPECT_EQ((*now)[brick].PayloadBytes, 0u);
        }
      }
    }
  }
}

/// What is measured of an array does not depend on how it is stored.
TEST(StaticArrays, AreMeasuredLikeOthers)
{
  const TemporaryFolder folder;
  const Pair pair([](int) { return 2; });
  EncodeOptions options;
  const SeriesIndex rests = pair.Encode(folder / "rests.banyan", options);
  options.Ablation.StaticArrays = false;
  const SeriesIndex moves = pair.Encode(folder / "moves.banyan", options);
  for (std::size_t c = 0; c < 3; ++c)
  {
    const ComponentIndex& a = rests.Arrays[1].Components[c];
    const ComponentIndex& b = moves.Arrays[1].Components[c];
    EXPECT_EQ(a.FiniteCount, b.FiniteCount);
    EXPECT_EQ(a.NonFiniteCount, b.NonFiniteCount);
    EXPECT_EQ(a.Range.Low, b.Range.Low);
    EXPECT_EQ(a.Range.High, b.Range.High);
    EXPECT_EQ(a.MeasuredMaxError, b.MeasuredMaxError);
    EXPECT_NEAR(a.SumSquaredError, b.SumSquaredError, 1e-9 * b.SumSquaredError);
  }
  ASSERT_EQ(rests.Arrays[1].Magnitudes.size(), static_cast<std::size_t>(Count));
  for (std::size_t s = 0; s < rests.Arrays[1].Magnitudes.size(); ++s)
  {
    EXPECT_EQ(rests.Arrays[1].Magnitudes[s].Low, moves.Arrays[1].Magnitudes[s].Low);
    EXPECT_EQ(rests.Arrays[1].Magnitudes[s].High, moves.Arrays[1].Magnitudes[s].High);
  }
  EXPECT_EQ(rests.Statistics.Bricks, moves.Statistics.Bricks);
  EXPECT_EQ(rests.Statistics.Blocks, moves.Statistics.Blocks);
  EXPECT_EQ(rests.Statistics.ChainBricks, moves.Statistics.ChainBricks);
  EXPECT_EQ(rests.Statistics.ExceptionVoxels, moves.Statistics.ExceptionVoxels);
}

/// It rests, moves within a group, rests as something else, and moves again.
TEST(StaticArrays, MayMoveAgain)
{
  const TemporaryFolder folder;
  const Pair pair([](int s) { return s < 19 ? 3 : s < 35 ? 4 : s; });
  const std::string path = folder / "s.banyan";
  (void)pair.Encode(path, {});
  pair.ExpectWithin(*SeriesFile::Open(path));
}

/// A group that moves from the start refers to the last step before that is stored.
TEST(StaticArrays, AreReferredToFromLaterGroups)
{
  const TemporaryFolder folder;
  Pair pair([](int) { return 5; });
  const std::size_t from = 3 * Interval;
  for (std::size_t s = from; s < pair.Vectors.size(); ++s)
  {
    for (std::size_t i = 0; i < pair.Vectors[s].size(); i += 7)
    {
      pair.Vectors[s][i] += 0.01f * static_cast<float>(s - from + 1);
    }
  }
  const std::string path = folder / "s.banyan";
  (void)pair.Encode(path, {});
  pair.ExpectWithin(*SeriesFile::Open(path));
}

} // namespace
} // namespace banyan::testing
