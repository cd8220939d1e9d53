// SPDX-License-Identifier: BSD-3-Clause
// Points that have no value: their bits, their flags, and what the tree says of all others.
#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SeriesEncoder.h"
#include "Series/Format/IndexText.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

namespace banyan::testing
{
namespace
{

using Flags = std::vector<std::uint8_t>;

/// A random mask of one of several kinds, which may move from step to step.
Flags RandomFlags(const Grid& grid, int kind, int step, std::mt19937& random)
{
  const glm::ivec3 n = grid.Samples();
  Flags flags;
  std::bernoulli_distribution few(0.02), half(0.5);
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        const glm::dvec3 off = glm::dvec3(x, y, z) / glm::dvec3(n) - 0.5;
        const bool hidden = kind == 0   ? few(random)
                            : kind == 1 ? half(random)
                            : kind == 2 ? off.x * off.x + off.y * off.y + off.z * off.z > 0.2
                            : kind == 3 ? x < 4 * step // none at first
                            : kind == 4 ? step != 1    // all but of one step
                                        : (x / 3 + y / 5 + z / 2) % 4 == 0;
        flags.push_back(hidden ? HiddenPointBits : 0);
      }
    }
  }
  return flags;
}

/// Waves; hidden ones are garbage, zeros, or (reals) NaN.
template <class T>
std::vector<T> RandomValues(
  const Flags& flags, int components, int step, int garbage, std::mt19937& random)
{
  std::vector<T> values;
  std::uniform_int_distribution<int> bytes(0, 255);
  for (std::size_t i = 0; i < flags.size(); ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      T value =
        static_cast<T>(50 + 40 * std::sin(0.05 * static_cast<double>(i % 4001) + c + 0.3 * step));
      if (flags[i] != 0 && garbage == 0)
      {
        value = T{};
      }
      else if (flags[i] != 0 && garbage == 1)
      {
        value = std::numeric_limits<T>::has_quiet_NaN ? std::numeric_limits<T>::quiet_NaN()
                                                      : std::numeric_limits<T>::max();
      }
      else if (flags[i] != 0 && garbage == 2)
      {
        unsigned char raw[sizeof(T)];
        for (unsigned char& byte : raw)
        {
          byte = static_cast<unsigned char>(bytes(random));
        }
        std::memcpy(&value, raw, sizeof(T));
      }
      values.push_back(value);
    }
  }
  return values;
}

struct Case
{
  unsigned Seed = 0;
  int Mask = 0;
  int Garbage = 0;
  int Components = 1;
  EncodeOptions Options;
};

/// The range of visible values of a component, over all steps and of one brick.
template <class T>
void ExpectTree(
  const SeriesFile& file, const FieldKey& key, const std::vector<T>& decoded, const Flags& flags)
{
  const BrickLayout layout = file.Layout(0);
  const glm::ivec3 n = layout.Samples();
  const auto nodes = file.Nodes(key);
  for (std::int64_t b = 0; b < layout.BrickCount(); ++b)
  {
    const Box box = layout.SamplesOf(b);
    ValueRange range;
    bool special = false;
    for (int z = box.Lo.z; z < box.Hi.z; ++z)
    {
      for (int y = box.Lo.y; y < box.Hi.y; ++y)
      {
        for (int x = box.Lo.x; x < box.Hi.x; ++x)
        {
          const auto i =
            (static_cast<std::size_t>(z) * n.y + y) * n.x + static_cast<std::size_t>(x);
          const double value = static_cast<double>(decoded[i]);
          special = special || flags[i] != 0 || !std::isfinite(value);
          if (flags[i] == 0 && std::isfinite(value))
          {
            range.Include(value);
          }
        }
      }
    }
    const BrickNode& node = (*nodes)[static_cast<std::size_t>(b)];
    ASSERT_EQ(node.Range.Empty(), range.Empty()) << "brick " << b;
    if (!range.Empty())
    {
      EXPECT_EQ(node.Range.Low, range.Low) << "brick " << b;
      EXPECT_EQ(node.Range.High, range.High) << "brick " << b;
    }
    EXPECT_EQ(node.HasNonFinite, special) << "brick " << b;
    EXPECT_TRUE(!special || !node.Uniform) << "brick " << b;
  }
}

template <class T>
void Check(const Case& one)
{
  std::mt19937 random(one.Seed);
  std::uniform_int_distribution<int> edge(1, 35);
  const Grid grid = GridOf(edge(random), edge(random) / 2 + 1, edge(random) + 3);
  constexpr int steps = 4;
  std::vector<Flags> flags;
  std::vector<std::vector<T>> values;
  ValueRange range;
  for (int step = 0; step < steps; ++step)
  {
    // Some masks rest, with or without values that rest, too.
    const bool rests = step > 0 && one.Seed % 5 == 0;
    flags.push_back(rests ? flags.back() : RandomFlags(grid, one.Mask, step, random));
    values.push_back(RandomValues<T>(
      flags.back(), one.Components, one.Seed % 3 == 0 ? 0 : step, one.Garbage, random));
    for (std::size_t i = 0; i < values.back().size(); ++i)
    {
      if (flags.back()[i / static_cast<std::size_t>(one.Components)] == 0)
      {
        range.Include(static_cast<double>(values.back()[i]));
      }
    }
  }
  const TemporaryFolder folder;
  const std::string path = folder.Path() + "/s.banyan";
  ThreadPool pool(2);
  ArrayDescription array;
  array.Name = "a";
  array.Type = ScalarTypeOf<T>();
  array.ComponentNames.resize(static_cast<std::size_t>(one.Components));
  array.SeriesRanges.assign(static_cast<std::size_t>(one.Components), range);
  SeriesEncoder encoder(
    path, grid, { DescriptionOfFlags(ArrayFlags::OfPoints), array }, one.Options, pool);
  for (std::size_t step = 0; step < steps; ++step)
  {
    encoder.AddStep(double(step), { { flags[step].data() }, { values[step].data() } });
  }
  const SeriesIndex index = encoder.Finish();
  EXPECT_EQ(FeaturesOf(index), std::vector<std::string>{ "hidden" });
  EXPECT_EQ(index.ActiveScalars, "a");
  const auto file = SeriesFile::Open(path);
  for (int step = 0; step < steps; ++step)
  {
    const Flags& hidden = flags[static_cast<std::size_t>(step)];
    ASSERT_EQ(ReadAll<std::uint8_t>(*file, { step, 0, 0, 0 }), hidden) << "step " << step;
    for (int c = 0; c < one.Components; ++c)
    {
      const ComponentIndex& component = index.Arrays[1].Components[static_cast<std::size_t>(c)];
      EXPECT_TRUE(component.Range.Empty() ||
                  (component.Range.Low >= range.Low - component.ErrorBoundAbsolute &&
                    component.Range.High <= range.High + component.ErrorBoundAbsolute));
      const std::vector<T> decoded = ReadAll<T>(*file, { step, 1, c, 0 });
      for (std::size_t i = 0; i < decoded.size(); ++i)
      {
        const T original = values[static_cast<std::size_t>(step)][i * one.Components + c];
        if (hidden[i] != 0)
        {
          ASSERT_EQ(std::memcmp(&decoded[i], &original, sizeof(T)), 0)
            << "step " << step << " " << i;
        }
        else
        {
          ASSERT_LE(std::abs(static_cast<double>(decoded[i]) - static_cast<double>(original)),
            component.ErrorBoundAbsolute * (1 + 1e-12))
            << "step " << step << " " << i;
        }
      }
      ExpectTree(*file, { step, 1, c, 0 }, decoded, hidden);
    }
  }
}

template <class T>
void CheckSome(unsigned first)
{
  for (unsigned number = 0; number < 18; ++number)
  {
    Case one;
    one.Seed = first * 100 + number;
    one.Mask = static_cast<int>(number % 6);
    one.Garbage = static_cast<int>(number / 6);
    one.Components = one.Seed % 4 == 1 ? 3 : 1;
    one.Options.KeyframeInterval = 2 + static_cast<int>(number % 2);
    one.Options.ErrorBound = number % 7 == 3 ? 0.0 : 1.0 / 64;
    one.Options.Mode =
      number % 3 == 2 ? ErrorBoundMode::Absolute : ErrorBoundMode::RelativeToSeriesRange;
    one.Options.ClosedGroups = number % 4 == 3;
    one.Options.BrickCells = number % 2 == 0 ? 16 : 32;
    SCOPED_TRACE(std::string(NameOf(ScalarTypeOf<T>())) + ", seed " + std::to_string(one.Seed));
    Check<T>(one);
  }
}

TEST(HiddenPoints, KeepTheirBitsAndDoNotCount)
{
  CheckSome<float>(1);
  CheckSome<double>(2);
  CheckSome<std::uint8_t>(3);
  CheckSome<std::int16_t>(4);
  CheckSome<std::int32_t>(5);
  CheckSome<std::uint64_t>(6);
  CheckSome<std::int8_t>(7);
}

/// Clamping, fill values and an opacity function leave hidden values alone.
TEST(HiddenPoints, AreLeftAloneByQuantizers)
{
  for (unsigned seed = 0; seed < 12; ++seed)
  {
    Case one;
    one.Seed = 9000 + seed;
    one.Mask = static_cast<int>(seed % 6);
    one.Garbage = static_cast<int>(seed % 3);
    one.Options.KeyframeInterval = 3;
    QuantizerOptions& quantizer = one.Options.Quantizer;
    quantizer.Range.From = RangeRule::Source::Given;
    quantizer.Range.Given = { 0.0, 100.0 };
    quantizer.Range.ClampOutside = true;
    if (seed % 2 == 0)
    {
      quantizer.FillValues = { 0.0 };
    }
    SCOPED_TRACE(seed);
    Check<float>(one);
    Check<std::int16_t>(one);
  }
}

TEST(HiddenPoints, IndexIsRefusedWhereFlagsDoNotFit)
{
  const TemporaryFolder folder;
  ThreadPool pool(1);
  const Grid grid = GridOf(4, 4, 4);
  const std::vector<std::uint8_t> flags(64, 0);
  const std::vector<float> values(64, 1.0f);
  ArrayDescription array;
  array.Name = "a";
  array.ComponentNames = { "" };
  array.SeriesRanges = { { 0.0, 1.0 } };
  SeriesEncoder encoder(folder.Path() + "/s.banyan", grid,
    { DescriptionOfFlags(ArrayFlags::OfCells), array }, {}, pool);
  encoder.AddStep(0, { { flags.data() }, { values.data() } });
  const SeriesIndex good = encoder.Finish();
  EXPECT_NO_THROW(CheckIndex(good));
  const auto refused = [&](const std::function<void(SeriesIndex&)>& change)
  {
    SeriesIndex bad = good;
    change(bad);
    EXPECT_THROW(CheckIndex(bad), Error);
  };
  refused([](SeriesIndex& index) { index.Mesh = MeshIndex{ false, "a.mesh", 1, 0, 0, 8, 1 }; });
  refused([](SeriesIndex& index) { index.Arrays[0].Type = ScalarType::Int8; });
  refused([](SeriesIndex& index) { index.Arrays[0].Components[0].ErrorBoundAbsolute = 1; });
  refused([](SeriesIndex& index) { std::swap(index.Arrays[0], index.Arrays[1]); });
  refused([](SeriesIndex& index) { index.Arrays.pop_back(); });
  refused(
    [](SeriesIndex& index)
    {
      index.Arrays[1] = index.Arrays[0];
      index.Arrays[1].Name = "b";
    });
  const SeriesIndex again = IndexFromText(IndexToText(good), "s.banyan");
  EXPECT_EQ(again.FindFlags(ArrayFlags::OfCells), 0);
  EXPECT_EQ(again.FindFlags(ArrayFlags::OfPoints), -1);
}

} // namespace
} // namespace banyan::testing
