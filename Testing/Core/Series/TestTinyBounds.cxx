// SPDX-License-Identifier: BSD-3-Clause
// Bounds that are so small that doubles lie as far apart as they are large.
#include "Series/ContainerTesting.h"
#include "Series/SeriesTesting.h"

#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"

#include <limits>
#include <numeric>

namespace banyan::testing
{
namespace
{

TEST(TinyBounds, AreNeverRoundedUp)
{
  constexpr double least = std::numeric_limits<double>::denorm_min();
  std::mt19937_64 random(1);
  const Grid grid = GridOf(9, 6, 5);
  for (int i = 0; i < 100; ++i)
  {
    const double width = std::ldexp(1.0, static_cast<int>(random() % 60));
    auto steps = Sample<double>(
      grid, 2, [&](int, int, int, int) { return least * std::floor(width * (random() % 1000)); });
    EncodeOptions options;
    options.ErrorBound = 1.0 / static_cast<double>(2 + random() % 4000);
    const ValueRange range = Describe(steps).SeriesRanges[0];
    const long double asked = static_cast<long double>(options.ErrorBound) *
                              (static_cast<long double>(range.High) - range.Low);
    const SeriesIndex index = RoundTrip(grid, steps, options);
    const long double stated = index.Arrays[0].Components[0].ErrorBoundAbsolute;
    EXPECT_LE(stated, asked * (1 + 1e-15L))
      << "asked " << options.ErrorBound << " of " << range.High;
    EXPECT_GE(stated + least, asked * (1 - 1e-15L));
  }
}

TEST(TinyBounds, AreTakenAsTheyAreGiven)
{
  constexpr double least = std::numeric_limits<double>::denorm_min();
  const auto steps = Sample<double>(
    GridOf(9, 6, 5), 2, [](int x, int y, int z, int s) { return least * (x * y + z + s); });
  for (const double bound : { least, 3 * least, 100 * least })
  {
    EncodeOptions options;
    options.Mode = ErrorBoundMode::Absolute;
    options.ErrorBound = bound;
    EXPECT_EQ(
      RoundTrip(GridOf(9, 6, 5), steps, options).Arrays[0].Components[0].ErrorBoundAbsolute, bound);
  }
}

TEST(TinyBounds, OfNothingFiniteIsNone)
{
  const auto steps =
    Sample<double>(GridOf(4, 4, 4), 2, [](int, int, int, int) { return std::nan(""); });
  EXPECT_EQ(RoundTrip(GridOf(4, 4, 4), steps, {}).Arrays[0].Components[0].ErrorBoundAbsolute, 0.0);
}

TEST(TinyBounds, ThatAreNoneAreRefused)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bound : { -1e-300, -1.0, infinity, -infinity, std::nan("") })
  {
    EncodeOptions options;
    options.ErrorBound = bound;
    ExpectError([&] { RoundTrip(Small, SmallSteps(1), options); }, "The error bound must be");
  }
}

/// An index whose checksum is right, and whose extent is not that of the segments.
TEST(ForgedExtents, AreErrorsOrChangeNothing)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const SeriesIndex good = Encode(path, Small, SmallSteps(4), TwoPerSegment());
  std::mt19937 random(1);
  int refused = 0, early = 0;
  for (int i = 0; i < 100; ++i)
  {
    SeriesIndex forged = good;
    const int axis = static_cast<int>(random() % 3);
    const int change = static_cast<int>(random() % 80) - 20;
    if (change == 0 || good.Domain.Samples()[axis] + change < 1)
    {
      continue;
    }
    try
    {
      forged.Domain.Extent.Hi[axis] += change;
      forged.Levels = BrickLayout::LevelCount(forged.Domain.Samples(), forged.BrickCells);
      WriteFileAtomically(path, IndexToText(forged));
      const FieldKey field{ static_cast<int>(random() % 4), 0, 0, 0 };
      ++early; // before arrays are handed out that decode later
      const auto file = SeriesFile::Open(path);
      std::vector<std::int64_t> bricks(file->Nodes(field)->size());
      std::iota(bricks.begin(), bricks.end(), 0);
      file->VerifyBricks(field, bricks);
      --early;
      (void)ReadAll<float>(*file, field);
      ADD_FAILURE() << "axis " << axis << " by " << change << ": no error";
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("s.banyan"), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_EQ(early, refused);
}

} // namespace
} // namespace banyan::testing
