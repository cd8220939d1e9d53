// SPDX-License-Identifier: BSD-3-Clause
// Ranges told from the tree, the grids of levels, and the lengths of vectors.
#include "Series/SeriesTesting.h"

#include "Series/Decode/PieceRange.h"
#include "Series/Grid/LevelGrid.h"

#include <limits>

namespace banyan::testing
{
namespace
{

constexpr int Components = 3;

/// Vectors that turn and grow, of length up to about 3, with some components that are not finite.
std::vector<float> Vectors(const Grid& grid, int step)
{
  std::vector<float> values;
  for (int z = 0; z < grid.Samples().z; ++z)
  {
    for (int y = 0; y < grid.Samples().y; ++y)
    {
      for (int x = 0; x < grid.Samples().x; ++x)
      {
        const double angle = 0.2 * x + 0.1 * y + step;
        const double length = 1.0 + 0.02 * z + 0.5 * std::sin(0.05 * y + step);
        values.push_back(static_cast<float>(length * std::cos(angle)));
        values.push_back(static_cast<float>(length * std::sin(angle)));
        values.push_back(0.1f * static_cast<float>(step + 1));
      }
    }
  }
  values[Components * 7 + 1] = std::numeric_limits<float>::quiet_NaN();
  values[Components * 8] = std::numeric_limits<float>::infinity();
  return values;
}

class PieceRanges : public ::testing::Test
{
protected:
  void SetUp() override
  {
    EncodeOptions options;
    options.BrickCells = 16;
    options.KeyframeInterval = 2;
    options.ErrorBound = 0.01;
    options.Mode = ErrorBoundMode::Absolute;
    ArrayDescription array;
    array.Name = "v";
    array.ComponentNames = { "", "", "" };
    array.SeriesRanges.resize(Components);
    ThreadPool pool(2);
    SeriesEncoder encoder(this->Folder / "v.banyan", this->Domain, { array }, options, pool);
    for (int step = 0; step < 3; ++step)
    {
      const std::vector<float> values = Vectors(this->Domain, step);
      encoder.AddStep(step, { { values.data() } });
    }
    encoder.Finish();
    this->Series = SeriesFile::Open(this->Folder / "v.banyan");
  }

  /// The truth, from decoded values.
  PieceRange Decoded(int step, int level, const Box& box) const
  {
    std::vector<float> values(static_cast<std::size_t>(box.Count()) * Components);
    BrickCache cache(1 << 24);
    for (int c = 0; c < Components; ++c)
    {
      ReadRegion(cache, *this->Series, { step, 0, c, level }, box, values.data(), Components, c);
    }
    PieceRange truth;
    truth.Components.resize(Components);
    for (std::size_t i = 0; i < values.size(); i += Components)
    {
      double square = 0.0;
      for (std::size_t c = 0; c < Components; ++c)
      {
        const double value = values[i + c];
        square += value * value;
        if (std::isfinite(value))
        {
          truth.Components[c].Include(value);
        }
      }
      if (std::isfinite(square))
      {
        truth.Magnitude.Include(std::sqrt(square));
      }
    }
    return truth;
  }

  static void ExpectContains(const ValueRange& outer, const ValueRange& inner)
  {
    EXPECT_LE(outer.Low, inner.Low);
    EXPECT_GE(outer.High, inner.High);
  }

  static void ExpectEqual(const ValueRange& a, const ValueRange& b)
  {
    EXPECT_EQ(a.Low, b.Low);
    EXPECT_EQ(a.High, b.High);
  }

  Grid Domain = GridOf(37, 46, 33);
  TemporaryFolder Folder;
  std::shared_ptr<SeriesFile> Series;
};

TEST_F(PieceRanges, OfTheWholeAreExact)
{
  ValueRange all;
  for (int step = 0; step < 3; ++step)
  {
    const Box whole{ glm::ivec3(0), this->Domain.Samples() };
    const PieceRange told = RangeOfPiece(*this->Series, step, 0, 0, whole);
    const PieceRange truth = this->Decoded(step, 0, whole);
    EXPECT_TRUE(told.Exact);
    EXPECT_TRUE(told.HasNonFinite);
    for (int c = 0; c < Components; ++c)
    {
      ExpectEqual(told.Components[c], truth.Components[c]);
    }
    ExpectEqual(told.Magnitude, truth.Magnitude);
    all.Include(truth.Magnitude);
  }
  const PieceRange series = RangeOfSeries(*this->Series, 0);
  ExpectEqual(series.Magnitude, all);
  ExpectEqual(series.Components[2], this->Series->Index().Arrays[0].Components[2].Range);
}

TEST_F(PieceRanges, OfPartsContainTheTruthAndTogetherGiveIt)
{
  const Box whole{ glm::ivec3(0), this->Domain.Samples() };
  const PieceRange step = this->Decoded(1, 0, whole);
  PieceRange together;
  together.Components.resize(Components);
  for (int z = 0; z < 33; z += 10)
  {
    const Box part{ { 0, 0, z }, { 37, 46, std::min(z + 11, 33) } };
    const PieceRange told = RangeOfPiece(*this->Series, 1, 0, 0, part);
    const PieceRange truth = this->Decoded(1, 0, part);
    EXPECT_FALSE(told.Exact);
    ExpectContains(told.Magnitude, truth.Magnitude);
    together.Magnitude.Include(told.Magnitude);
    for (int c = 0; c < Components; ++c)
    {
      ExpectContains(told.Components[c], truth.Components[c]);
      together.Components[c].Include(told.Components[c]);
    }
  }
  ExpectEqual(together.Magnitude, step.Magnitude);
  for (int c = 0; c < Components; ++c)
  {
    ExpectEqual(together.Components[c], step.Components[c]);
  }
}

TEST_F(PieceRanges, OfCoarserLevelsContainTheTruth)
{
  for (int level = 1; level < this->Series->Index().Levels; ++level)
  {
    const Grid grid = GridOfLevel(this->Domain, level);
    const Box whole{ glm::ivec3(0), grid.Samples() };
    const PieceRange told = RangeOfPiece(*this->Series, 2, 0, level, whole);
    const PieceRange truth = this->Decoded(2, level, whole);
    ExpectContains(told.Magnitude, truth.Magnitude);
    ExpectContains(told.Components[0], truth.Components[0]);
  }
}

TEST_F(PieceRanges, OfNothingAreEmpty)
{
  const PieceRange told = RangeOfPiece(*this->Series, 0, 0, 0, Box{});
  EXPECT_TRUE(told.Components[1].Empty());
  EXPECT_TRUE(told.Magnitude.Empty());
}

TEST(LevelGrid, KeepsTheSamplesThatLieOnFineOnes)
{
  Grid domain = GridOf(21, 1, 2);
  domain.Extent = { { -3, 5, 0 }, { 18, 6, 2 } };
  domain.Origin = { 1.0, 2.0, 3.0 };
  domain.Spacing = { 0.5, 2.0, 4.0 };
  domain.Direction = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
  EXPECT_TRUE(GridOfLevel(domain, 0) == domain);
  const Grid coarse = GridOfLevel(domain, 3);
  EXPECT_EQ(coarse.Extent.Lo, glm::ivec3(0));
  EXPECT_EQ(coarse.Extent.Hi, glm::ivec3(3, 1, 1)); // 20 / 8 + 1, 0 / 8 + 1, 1 / 8 + 1
  EXPECT_EQ(coarse.Spacing, glm::dvec3(4.0, 16.0, 32.0));
  // Direction * (spacing * (-3, 5, 0)) = (-10, -1.5, 0).
  EXPECT_EQ(coarse.Origin, glm::dvec3(-9.0, 0.5, 3.0));
  EXPECT_EQ(coarse.Direction, domain.Direction);
  EXPECT_EQ(GridOfLevel(domain, 60).Samples(), glm::ivec3(1));
}

} // namespace
} // namespace banyan::testing
