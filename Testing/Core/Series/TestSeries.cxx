// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Decode/BrickTree.h"

#include <fstream>
#include <iterator>

namespace banyan::testing
{
namespace
{

TEST(Series, SeveralArraysAndVectors)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(19, 18, 5);
  const auto n = static_cast<std::size_t>(grid.Extent.Count());
  ArrayDescription velocity;
  velocity.Name = "velocity";
  velocity.Type = ScalarType::Float64;
  velocity.ComponentNames = { "u", "v", "w" };
  velocity.SeriesRanges = { { -1, 1 }, { -200, 200 }, { 0, 0 } };
  ArrayDescription label;
  label.Name = "label";
  label.Type = ScalarType::UInt16;
  label.ComponentNames = { "" };
  label.SeriesRanges = { { 0, 4000 } };
  std::vector<double> vectors(3 * n);
  std::vector<std::uint16_t> labels(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    vectors[3 * i] = std::sin(0.01 * static_cast<double>(i));
    vectors[3 * i + 1] = 200 * std::cos(0.02 * static_cast<double>(i));
    vectors[3 * i + 2] = 1e-3 * static_cast<double>(i); // outside the promised range: exact
    labels[i] = static_cast<std::uint16_t>(i % 4001);
  }
  ThreadPool pool(2);
  {
    SeriesEncoder encoder(path, grid, { velocity, label }, {}, pool);
    encoder.SetActiveScalars("label");
    EXPECT_THROW(encoder.SetActiveScalars("lable"), Error);
    encoder.AddStep(0.5, { { vectors.data() }, { labels.data() } });
    encoder.Finish();
  }
  const auto file = SeriesFile::Open(path);
  EXPECT_EQ(file->Index().ActiveScalars, "label");
  EXPECT_EQ(file->Index().FindArray("label"), 1);
  EXPECT_EQ(file->Index().FindArray("nothing"), -1);
  EXPECT_EQ(file->Index().Arrays[0].Components[1].Name, "v");
  EXPECT_EQ(file->Index().PayloadBytesIn, n * (3 * 8 + 2));
  BrickCache cache(1 << 24);
  std::vector<double> decoded(3 * n, -1);
  const Box whole = grid.Extent;
  for (int c = 0; c < 3; ++c)
  {
    ReadRegion(cache, *file, { 0, 0, c, 0 }, whole, decoded.data(), 3, c);
  }
  const double bounds[3] = { 2.0 / 512, 400.0 / 512, 0 };
  for (std::size_t i = 0; i < 3 * n; ++i)
  {
    ASSERT_LE(std::abs(decoded[i] - vectors[i]), bounds[i % 3]) << i;
  }
  EXPECT_EQ(file->Index().Arrays[0].Components[2].Range.High, vectors[3 * n - 1]);
  EXPECT_TRUE(WithinBound(labels, ReadAll<std::uint16_t>(*file, { 0, 1, 0, 0 }), 4000.0 / 512));
  EXPECT_GT(file->Index().Arrays[1].Components[0].MeasuredMaxError, 0);
}

TEST(Series, ValuesThatFailElsewhere)
{
  const Grid grid = GridOf(20, 19, 18);
  EncodeOptions options;
  const auto base = [](int x, int y, int z)
  { return std::sin(0.2 * x) * std::cos(0.3 * y) + 0.1 * z; };
  std::mt19937 random(41);
  std::normal_distribution<double> normal;
  const auto check = [&](auto tag, const char* what, auto&& f)
  {
    using T = typename decltype(tag)::Type;
    SCOPED_TRACE(what);
    return RoundTrip(grid, Sample<T>(grid, 2, f), options);
  };
  const TypeTag<float> f32;
  const TypeTag<double> f64;
  check(f32, "one NaN",
    [&](int x, int y, int z, int) { return x == 3 && y == 4 && z == 5 ? NAN : base(x, y, z); });
  const SeriesIndex holes = check(f64, "1 % not finite",
    [&](int x, int y, int z, int)
    {
      const auto dice = random() % 200;
      return dice == 0 ? std::nan("0x123") : dice == 1 ? -INFINITY : base(x, y, z);
    });
  EXPECT_GT(holes.Arrays[0].Components[0].NonFiniteCount, 50);
  EXPECT_LT(holes.Arrays[0].Components[0].Range.High, 4);
  check(f32, "fill value in 10 %",
    [&](int x, int y, int z, int) { return random() % 10 == 0 ? 1e20 : base(x, y, z); });
  check(f32, "one outlier",
    [&](int x, int y, int z, int) { return x + y + z == 0 ? 1e6 : base(x, y, z); });
  check(f32, "offset", [&](int x, int y, int z, int) { return 1e6 + 0.03 * base(x, y, z); });
  check(f32, "scale 1e-40", [&](int x, int y, int z, int) { return 1e-40 * base(x, y, z); });
  check(f64, "denormals", [&](int x, int y, int z, int) { return 1e-310 * base(x, y, z); });
  check(f32, "white noise", [&](int, int, int, int) { return normal(random); });
  check(f32, "all NaN", [&](int, int, int, int) { return NAN; });
  check(f32, "zeros of both signs", [&](int x, int, int, int) { return x % 2 ? 0.0 : -0.0; });
  check(f64, "whole range of doubles",
    [&](int x, int y, int, int) { return (x + y) % 2 ? 1.79e308 : -1.79e308; });
  options.ErrorBound = 0x1p-31;
  check(f32, "range / bound = 2^31", [&](int x, int y, int z, int) { return base(x, y, z); });
  check(f64, "range / bound = 2^31", [&](int x, int y, int z, int) { return base(x, y, z); });
  options.ErrorBound = 0;
  check(f32, "bound 0", [&](int x, int y, int z, int) { return base(x, y, z); });
  check(f64, "zeros of both signs", [&](int x, int, int, int) { return x % 2 ? 0.0 : -0.0; });
}

TEST(Series, AbsoluteBoundNeedsNoRanges)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(33, 17, 16);
  const auto steps = Sample<float>(
    grid, 3, [](int x, int y, int z, int s) { return s * 10 + Wavy<float>(x, y, z, s); });
  EncodeOptions options;
  options.Mode = ErrorBoundMode::Absolute;
  options.ErrorBound = 0.25;
  ArrayDescription description = Describe(steps);
  description.SeriesRanges.clear();
  ThreadPool pool(1);
  {
    SeriesEncoder encoder(folder / "s.banyan", grid, { description }, options, pool);
    for (std::size_t s = 0; s < 3; ++s)
    {
      encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
    }
    encoder.Finish();
  }
  const auto file = SeriesFile::Open(folder / "s.banyan");
  EXPECT_EQ(file->Index().Arrays[0].Components[0].ErrorBoundAbsolute, 0.25);
  EXPECT_EQ(file->Index().Mode, ErrorBoundMode::Absolute);
  const MaskRange masks = file->MaskRangeOf(0, 0);
  EXPECT_EQ(masks.Low, file->Index().Arrays[0].Components[0].Range.Low);
  for (int s = 0; s < 3; ++s)
  {
    const auto decoded = ReadAll<float>(*file, { s, 0, 0, 0 });
    EXPECT_TRUE(WithinBound(steps[static_cast<std::size_t>(s)], decoded, 0.25));
    const auto nodes = file->Nodes({ s, 0, 0, 0 });
    const BrickLayout layout = file->Layout(0);
    for (std::int64_t b = 0; b < layout.BrickCount(); ++b)
    {
      const Box box = layout.SamplesOf(b);
      std::vector<float> brick(static_cast<std::size_t>(box.Count()));
      file->DecodeBrick({ s, 0, 0, 0 }, b, brick.data());
      const BrickNode& node = (*nodes)[static_cast<std::size_t>(b)];
      EXPECT_EQ(node.Range.Low, RangeOf(brick).Low);
      EXPECT_EQ(node.Range.High, RangeOf(brick).High);
      ValueMask samples = 0;
      for (const float value : brick)
      {
        samples |= ValueMask{ 1 } << masks.BinOf(value);
      }
      EXPECT_EQ(samples & ~node.Mask, 0u) << "masks made over a step's range lost something";
    }
  }
}

TEST(Series, UnchangedBricksAreStoredOnceAndKeepTheirIdentity)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(65, 33, 33);
  // Only one corner moves.
  const auto steps = Sample<float>(grid, 6,
    [](int x, int y, int z, int s) { return Wavy<float>(x, y, z, x < 16 && y < 16 ? s : 0); });
  EncodeOptions options;
  options.KeyframeInterval = 3;
  options.BrickCells = 16;
  const SeriesIndex index = Encode(folder / "s.banyan", grid, steps, options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  ASSERT_EQ(index.Segments.size(), 2u);
  const BrickLayout layout = file->Layout(0);
  std::int64_t unchanged = 0;
  for (int s = 1; s < 6; ++s)
  {
    const auto now = file->Nodes({ s, 0, 0, 0 });
    const auto before = file->Nodes({ s - 1, 0, 0, 0 });
    std::int64_t same = 0;
    for (std::int64_t b = 0; b < layout.BrickCount(); ++b)
    {
      const bool equal = (*now)[static_cast<std::size_t>(b)].Identity ==
                         (*before)[static_cast<std::size_t>(b)].Identity;
      const glm::ivec3 p = layout.PositionOf(b);
      // A key frame is predicted anew, and may differ within the bound.
      EXPECT_TRUE(equal == (p.x > 0 || p.y > 0) || s % 3 == 2) << "step " << s << " brick " << b;
      same += equal ? 1 : 0;
    }
    unchanged += s % 3 > 0 ? same : 0; // counted within segments
    const MergedTree merged =
      MergeWithPrevious(FuseMacroVoxels(*now, layout), FuseMacroVoxels(*before, layout));
    EXPECT_EQ(merged.ChangedBricks, layout.BrickCount() - same);
  }
  EXPECT_GE(index.Statistics.UnchangedBricks, unchanged);
  // Steps 0 and 1 share with 2, and 3 and 4 with it; 5 is a key frame again.
  EXPECT_EQ(layout.BrickCount(), 4 * 2 * 2);
  EXPECT_GE(index.Statistics.MergedBricks, 4 * (layout.BrickCount() - 2));
  for (int s = 0; s < 6; ++s)
  {
    EXPECT_TRUE(WithinBound(steps[static_cast<std::size_t>(s)],
      ReadAll<float>(*file, { s, 0, 0, 0 }), index.Arrays[0].Components[0].ErrorBoundAbsolute));
  }
}

TEST(Series, LevelsHoldEverySecondDecodedSample)
{
  for (const glm::ivec3& n :
    { glm::ivec3(72, 65, 33), glm::ivec3(121, 1, 37), glm::ivec3(1, 1, 200) })
  {
    const TemporaryFolder folder;
    const Grid grid = GridOf(n.x, n.y, n.z);
    auto steps = Sample<float>(grid, 1, Wavy<float>);
    steps[0][steps[0].size() / 2] = NAN; // raw bricks beside lattice bricks must agree
    EncodeOptions options;
    options.BrickCells = 16;
    const SeriesIndex index = Encode(folder / "s.banyan", grid, steps, options);
    const auto file = SeriesFile::Open(folder / "s.banyan");
    const auto finest = ReadAll<float>(*file, { 0, 0, 0, 0 });
    EXPECT_GT(file->Index().Levels, 2);
    for (int level = 1; level < file->Index().Levels; ++level)
    {
      const BrickLayout layout = file->Layout(level);
      const auto coarse = ReadAll<float>(*file, { 0, 0, 0, level });
      std::size_t i = 0;
      for (int z = 0; z < layout.Samples().z; ++z)
      {
        for (int y = 0; y < layout.Samples().y; ++y)
        {
          for (int x = 0; x < layout.Samples().x; ++x, ++i)
          {
            const glm::ivec3 p = layout.FineSample({ x, y, z });
            const std::size_t fine = static_cast<std::size_t>((p.z * n.y + p.y) * n.x + p.x);
            // A last sample that repeats the last fine one is bounded, not equal, on some levels.
            const glm::ivec3 q = glm::ivec3{ x, y, z } * (1 << level);
            if (p == q || std::isnan(finest[fine]))
            {
              ASSERT_TRUE(SameBits(coarse[i], finest[fine]));
            }
            ASSERT_TRUE(WithinBound<float>(
              { steps[0][fine] }, { coarse[i] }, index.Arrays[0].Components[0].ErrorBoundAbsolute));
          }
        }
      }
    }
    EXPECT_EQ(file->Layout(file->Index().Levels - 1).BrickCount(), 1);
  }
}

TEST(Series, BrickSizeChangesNoValue)
{
  const Grid grid = GridOf(70, 35, 20);
  auto steps = Sample<float>(grid, 1, Wavy<float>);
  for (std::size_t i = 0; i < steps[0].size(); i += 997)
  {
    steps[0][i] = i % 2 ? INFINITY : 1e30f;
  }
  std::vector<float> first;
  for (const int cells : { 16, 32 })
  {
    const TemporaryFolder folder;
    EncodeOptions options;
    options.BrickCells = cells;
    options.Mode = ErrorBoundMode::Absolute;
    options.ErrorBound = 0.1;
    Encode(folder / "s.banyan", grid, steps, options);
    const auto values = ReadAll<float>(*SeriesFile::Open(folder / "s.banyan"), { 0, 0, 0, 0 });
    first = first.empty() ? values : first;
    EXPECT_EQ(std::memcmp(first.data(), values.data(), values.size() * 4), 0) << cells;
  }
}

std::string ReadFile(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), {} };
}

TEST(Series, EveryThreadCountGivesTheSameBytes)
{
  const Grid grid = GridOf(70, 40, 33);
  const auto steps = Sample<double>(grid, 3, Wavy<double>);
  EncodeOptions options;
  options.KeyframeInterval = 2;
  std::vector<std::string> first;
  double squares = 0;
  for (const int threads : { 1, 2, 3, 7 })
  {
    const TemporaryFolder folder;
    const SeriesIndex index = Encode(folder / "s.banyan", grid, steps, options, threads);
    std::vector<std::string> segments;
    for (const SegmentIndex& segment : index.Segments)
    {
      segments.push_back(ReadFile(folder / ("s.banyan.d/" + segment.File)));
    }
    if (first.empty())
    {
      first = segments;
      squares = index.Arrays[0].Components[0].SumSquaredError;
    }
    EXPECT_TRUE(first == segments) << threads << " threads";
    EXPECT_EQ(squares, index.Arrays[0].Components[0].SumSquaredError);
  }
}

TEST(Series, ErrorFiguresAreThoseOfTheVoxels)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(50, 33, 18);
  const auto steps = Sample<float>(grid, 2, Wavy<float>);
  const SeriesIndex index = Encode(folder / "s.banyan", grid, steps, {});
  const auto file = SeriesFile::Open(folder / "s.banyan");
  double greatest = 0;
  double squares = 0;
  ValueRange range;
  for (std::size_t s = 0; s < 2; ++s)
  {
    const auto decoded = ReadAll<float>(*file, { static_cast<int>(s), 0, 0, 0 });
    range.Include(RangeOf(decoded));
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      const double error =
        std::abs(static_cast<double>(decoded[i]) - static_cast<double>(steps[s][i]));
      greatest = std::max(greatest, error);
      squares += error * error;
    }
  }
  const ComponentIndex& component = index.Arrays[0].Components[0];
  EXPECT_EQ(component.MeasuredMaxError, greatest);
  EXPECT_NEAR(component.SumSquaredError, squares, 1e-9 * squares);
  EXPECT_EQ(component.FiniteCount, 2 * grid.Extent.Count());
  EXPECT_EQ(component.Range.Low, range.Low);
  EXPECT_EQ(component.Range.High, range.High);
}

TEST(Series, MetadataOfTheGridComesBack)
{
  const TemporaryFolder folder;
  Grid grid;
  grid.Extent = { { -7, 3, 100 }, { 5, 9, 104 } };
  grid.Origin = { 0.1, -2.5e300, 3e-300 };
  grid.Spacing = { 1.0 / 3.0, -1, 7 };
  grid.Direction[0] = { 0, 1, 0 };
  grid.Direction[1] = { -1, 0, 0 };
  const auto steps = Sample<std::uint8_t>(grid, 1, [](int x, int y, int, int) { return x * y; });
  Encode(folder / "s.banyan", grid, steps, {});
  EXPECT_TRUE(SeriesFile::Open(folder / "s.banyan")->Index().Domain == grid);
}

} // namespace
} // namespace banyan::testing
