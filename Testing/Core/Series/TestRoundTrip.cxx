// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

namespace banyan::testing
{
namespace
{

TEST(RoundTrip, AwkwardSizes)
{
  const std::vector<glm::ivec3> sizes = { { 1, 1, 1 }, { 1, 7, 9 }, { 5, 1, 3 }, { 20, 20, 1 },
    { 1, 1, 40 }, { 2, 2, 2 }, { 15, 15, 15 }, { 16, 16, 16 }, { 17, 17, 17 }, { 18, 18, 18 },
    { 31, 13, 37 }, { 32, 33, 34 }, { 53, 2, 1 } };
  for (const glm::ivec3& size : sizes)
  {
    SCOPED_TRACE(
      std::to_string(size.x) + "x" + std::to_string(size.y) + "x" + std::to_string(size.z));
    for (const int cells : { 16, 32 })
    {
      const Grid grid = GridOf(size.x, size.y, size.z);
      EncodeOptions options;
      options.BrickCells = cells;
      RoundTrip(grid, Sample<float>(grid, 2, Wavy<float>), options);
    }
  }
}

TEST(RoundTrip, ConstantIsMacroVoxels)
{
  const Grid grid = GridOf(40, 33, 17);
  const auto steps = Sample<float>(grid, 3, [](int, int, int, int) { return 3.25f; });
  const SeriesIndex index = RoundTrip(grid, steps, {});
  EXPECT_EQ(index.Statistics.MacroVoxelBricks, index.Statistics.Bricks);
  EXPECT_EQ(index.Statistics.PayloadBytes, 0u);
  EXPECT_EQ(index.Arrays[0].Components[0].MeasuredMaxError, 0.0);
}

template <class T>
class RoundTripOf : public ::testing::Test
{
};
using AllTypes = ::testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(RoundTripOf, AllTypes);

TYPED_TEST(RoundTripOf, RelativeBound)
{
  const Grid grid = GridOf(35, 20, 19);
  EncodeOptions options;
  options.ErrorBound = 0.01;
  const auto index = RoundTrip(grid, Sample<TypeParam>(grid, 2, Wavy<TypeParam>), options);
  EXPECT_GT(index.Arrays[0].Components[0].ErrorBoundAbsolute, 0.0);
  EXPECT_EQ(index.Arrays[0].Components[0].FiniteCount, 2 * grid.Extent.Count());
}

TYPED_TEST(RoundTripOf, BoundZeroIsBitExact)
{
  const Grid grid = GridOf(21, 20, 19);
  EncodeOptions options;
  options.ErrorBound = 0;
  RoundTrip(grid, Sample<TypeParam>(grid, 2, Wavy<TypeParam>), options);
}

/// What packing takes for granted, and what it does not.
TEST(RoundTrip, ValuesAreMultiplesOfTheStepThatIsTold)
{
  const Grid grid = GridOf(40, 33, 20);
  auto steps = Sample<float>(grid, 3, Wavy<float>);
  steps[1][777] = std::numeric_limits<float>::quiet_NaN();
  const TemporaryFolder folder;
  EncodeOptions options;
  Encode(folder / "bounded.banyan", grid, steps, options);
  const auto file = SeriesFile::Open(folder / "bounded.banyan");
  for (int s = 0; s < 3; ++s)
  {
    const double step = file->StepOfValues({ s, 0, 0, 0 });
    ASSERT_GT(step, 0.0);
    const std::vector<float> values = ReadAll<float>(*file, { s, 0, 0, 0 });
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      if (s == 1 && i == 777)
      {
        EXPECT_TRUE(std::isnan(values[i]));
        continue;
      }
      ASSERT_EQ(values[i], static_cast<float>(std::round(values[i] / step) * step)) << i;
    }
  }
  options.ErrorBound = 0;
  Encode(folder / "lossless.banyan", grid, steps, options);
  EXPECT_EQ(SeriesFile::Open(folder / "lossless.banyan")->StepOfValues({ 0, 0, 0, 0 }), 0.0);
}

} // namespace
} // namespace banyan::testing
