// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/PackedNumbers.h"
#include "Render/Raycast/BrickMarcher.h"
#include "Render/Raycast/BrickProjector.h"
#include "Render/Scenes.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace
{

using namespace banyan;

/// Whether packing takes numbers on a set of instructions, of those that are compiled.
bool Fuses(std::int64_t target)
{
#if HWY_ARCH_X86
  return target <= HWY_AVX2 && (target & HWY_TARGETS) != 0; // later ones have lower numbers
#else
  return target != HWY_SCALAR && target != HWY_EMU128;
#endif
}

bool FusesHere()
{
  const std::vector<std::int64_t> all = targets::OfThisMachine();
  return std::any_of(all.begin(), all.end(), Fuses);
}

std::vector<float> Multiples(double step, int first, int last)
{
  std::vector<float> values;
  for (int n = first; n <= last; ++n)
  {
    values.push_back(static_cast<float>(step * n));
  }
  return values;
}

TEST(PackedNumbers, StandForTheirValuesBitByBit)
{
  for (const double step : { 1.0, 0.5, 2.0 / 31 / 512, 3.0e-7, 0.1, 1e-20, 7e25 })
  {
    const std::vector<float> values = Multiples(step, -32768, 32767);
    for (const std::int64_t target : targets::OfThisMachine())
    {
      SCOPED_TRACE(hwy::TargetName(target));
      const targets::OnlyTarget only(target);
      for (const std::size_t count :
        { std::size_t{ 65536 }, std::size_t{ 65521 }, std::size_t{ 3 } })
      {
        std::vector<std::int16_t> numbers(count);
        NumberScale scale;
        const std::size_t first = values.size() - count;
        ASSERT_EQ(
          NumbersOfValues(values.data() + first, count, step, scale, numbers.data()), Fuses(target))
          << step;
        for (std::size_t i = 0; i < count && Fuses(target); ++i)
        {
          ASSERT_EQ(ValueOfNumber(numbers[i], scale), values[first + i]) << step;
        }
      }
    }
  }
}

TEST(PackedNumbers, OtherValuesHaveNone)
{
  const auto has = [](const std::vector<float>& values, double step)
  {
    std::vector<std::int16_t> numbers(values.size());
    NumberScale scale;
    return NumbersOfValues(values.data(), values.size(), step, scale, numbers.data());
  };
  std::vector<float> values = Multiples(0.1, 0, 100);
  EXPECT_EQ(has(values, 0.1), FusesHere());
  for (const float odd :
    { 0.15f, std::nextafter(0.7f, 1.0f), 3276.8f, -3276.9f, 1e30f, NAN, INFINITY })
  {
    for (const std::size_t place : { 0, 50, 100 })
    {
      const float before = values[place];
      values[place] = odd;
      EXPECT_FALSE(has(values, 0.1)) << odd << " at " << place;
      values[place] = before;
    }
  }
  for (const double step : { 0.0, -0.1, 0.3, 1e-40, 1e40, double(NAN), double(INFINITY) })
  {
    EXPECT_FALSE(has(values, step)) << step;
  }
}

/// Decoded values are rounded twice, to float64 and to float32: 500 steps are 6172839, so that some
/// multiples lie in the middle of two floats.
TEST(PackedNumbers, ValuesThatWereRoundedTwiceMayHaveNone)
{
  const double step = 12345.678;
  const std::vector<float> values = Multiples(step, -32768, 32767);
  std::vector<std::int16_t> numbers(values.size());
  NumberScale scale;
  EXPECT_FALSE(NumbersOfValues(values.data(), values.size(), step, scale, numbers.data()));
}

constexpr glm::ivec3 N{ 33, 29, 31 };

BrickView ViewOf(const std::vector<float>& values)
{
  return { values.data(), ScalarType::Float32, { 1, N.x, std::ptrdiff_t{ N.x } * N.y }, {} };
}

/// Multiples of 0.001 in [0, 1].
std::vector<float> Thousandths()
{
  std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  for (float& value : values)
  {
    value = static_cast<float>(std::round(value * 1000.0) * 0.001);
  }
  return values;
}

/// What `draw(brick, tile)` makes of the picture's first tile.
template <class DrawBrick>
FloatImage DrawTile(const RayScene& scene, const PackedBrick& brick, DrawBrick&& draw)
{
  FloatImage picture;
  picture.Rect = { { 16, 8 }, { 48, 40 } };
  picture.Pixels.assign(picture.Rect.Count(), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  const auto tile = std::make_unique<RayTile>();
  tile->Open(RayLattice(scene), picture.Rect, picture, 0.0f);
  draw(brick, picture.Rect, *tile);
  EXPECT_GT(tile->SamplesTaken, 1000);
  tile->Close(picture);
  return picture;
}

/// Of a brick packed with numbers, and of one without, on all sets of instructions.
template <class DrawBrick>
void ExpectSamePictures(const RayScene& scene, DrawBrick&& draw)
{
  const std::vector<float> values = Thousandths();
  const Box cells{ glm::ivec3(0), N - 1 };
  const PackedBrick plain(ViewOf(values), glm::ivec3(0), cells, 0.0);
  const PackedBrick packed(ViewOf(values), glm::ivec3(0), cells, 0.0, 0.001);
  ASSERT_FALSE(plain.HasNumbers());
  ASSERT_EQ(packed.HasNumbers(), FusesHere());
  EXPECT_EQ(plain.Bytes(), PackedBrick::BytesFor(cells, false));
  EXPECT_LT(packed.Bytes(), FusesHere() ? plain.Bytes() * 3 / 5 : plain.Bytes() + 1);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    EXPECT_EQ(MaxDifference(DrawTile(scene, packed, draw), DrawTile(scene, plain, draw)), 0.0);
  }
}

TEST(PackedNumbers, CompositesHaveTheSameBits)
{
  for (const bool sparse : { false, true })
  {
    RayScene scene = scenes::Scene(N, { 64, 48 });
    scene.Transfer = scenes::Tabulate(sparse ? scenes::Sparse : scenes::Smooth);
    scene.SampleDistance = 0.7;
    const StepTable table(scene.Transfer, scene.SampleDistance);
    const VisibleValues visible(scene.Transfer);
    for (const SampleInterpolation interpolation :
      { SampleInterpolation::Linear, SampleInterpolation::Nearest })
    {
      ExpectSamePictures(scene,
        [&](const PackedBrick& brick, const PixelRect& rect, RayTile& tile)
        {
          const BrickVisibility seen(brick, { 0.0, 1.0 }, visible);
          EXPECT_EQ(seen.Holes, sparse);
          MarchPacked(brick, seen, table, nullptr, rect, tile, interpolation);
        });
    }
  }
}

TEST(PackedNumbers, ProjectionsHaveTheSameBits)
{
  for (const BlendMode mode : { BlendMode::Maximum, BlendMode::Minimum, BlendMode::Average })
  {
    for (const SampleInterpolation interpolation :
      { SampleInterpolation::Linear, SampleInterpolation::Nearest })
    {
      RayScene scene = scenes::Scene(N, { 64, 48 });
      scene.Blend.Mode = mode;
      scene.Interpolation = interpolation;
      const StepTable steps(scene.Transfer, scene.SampleDistance);
      const ProjectionTable table(scene, steps);
      ExpectSamePictures(scene,
        [&](const PackedBrick& brick, const PixelRect& rect, RayTile& tile) {
          ProjectPacked(brick, brick.Cells(), { 0.0, 1.0 }, table, rect, tile);
        });
    }
  }
}

/// A brick keeps its values as they are where one of them is no multiple.
TEST(PackedNumbers, BricksWithExceptionsKeepValues)
{
  std::vector<float> values = Thousandths();
  values[values.size() / 2] = 0.12345f;
  const Box cells{ glm::ivec3(0), N - 1 };
  const PackedBrick packed(ViewOf(values), glm::ivec3(0), cells, 0.0, 0.001);
  EXPECT_FALSE(packed.HasNumbers());
  EXPECT_EQ(packed.Values()[values.size() / 2], 0.12345f);
  values[values.size() / 2] = NAN;
  EXPECT_FALSE(PackedBrick(ViewOf(values), glm::ivec3(0), cells, 0.0, 0.001).HasNumbers());
}

/// Samples of a rule, in bricks of 32^3 cells that are made when they are loaded.
template <class T>
class Ruled : public BrickSource
{
public:
  Ruled(int bricks, double step)
    : Counts(bricks)
    , Step(step)
  {
  }
  glm::ivec3 Bricks() const override { return this->Counts; }
  Box CellsOf(std::int64_t brick) const override
  {
    const auto number = static_cast<int>(brick);
    const glm::ivec3 p(number % this->Counts.x, number / this->Counts.x % this->Counts.y,
      number / this->Counts.x / this->Counts.y);
    return { p * 32, (p + 1) * 32 };
  }
  ValueRange RangeOf(std::int64_t) const override { return { 0.0, 200.0 }; }
  ValueMask MaskOf(std::int64_t) const override { return ~ValueMask{ 0 }; }
  MaskRange MasksAreOver() const override { return { 0.0, 200.0 }; }
  std::size_t LoadBytes(std::int64_t) const override { return 0; }
  double StepOfValues() const override { return this->Step; }
  BrickView Load(std::int64_t brick) override
  {
    const glm::ivec3 low = this->CellsOf(brick).Lo;
    const auto values = std::make_shared<std::vector<T>>(33 * 33 * 33);
    for (int i = 0; i < 33 * 33 * 33; ++i)
    {
      const glm::ivec3 p = low + glm::ivec3(i % 33, i / 33 % 33, i / 33 / 33);
      (*values)[static_cast<std::size_t>(i)] =
        static_cast<T>((p.x * p.y / 8 + 3 * p.z + p.x / 5) % 200);
    }
    BrickView view{ values->data(), ScalarTypeOf<T>(), { 1, 33, 33 * 33 }, values };
    return view;
  }

private:
  glm::ivec3 Counts;
  double Step;
};

/// Draws 64^3 cells of many. @param bytes that are kept of them
FloatImage DrawPartOf(BrickSource& source, std::uint64_t& bytes)
{
  RayScene scene = scenes::Scene({ 65, 65, 65 }, { 90, 70 });
  scene.Transfer.High = 200.0;
  scene.DomainCells = { glm::ivec3(0), source.Bricks() * 32 };
  ThreadPool pool(2);
  RayStatistics statistics;
  const FloatImage image = CastRays(
    scene, source, { glm::ivec3(0), glm::ivec3(64) }, std::uint64_t{ 1 } << 30, pool, statistics);
  EXPECT_GT(statistics.SamplesTaken, 10000);
  bytes = source.Kept().Bytes();
  return image;
}

TEST(PackedNumbers, LargeVolumesOfMultiplesTakeHalfTheMemoryAndGiveTheSameBits)
{
  std::uint64_t bytes[5] = {};
  Ruled<float> plain(11, 0.0);
  const FloatImage image = DrawPartOf(plain, bytes[0]);
  Ruled<float> encoded(11, 0.25);
  EXPECT_EQ(MaxDifference(DrawPartOf(encoded, bytes[1]), image), 0.0);
  Ruled<std::uint8_t> codes(11, 0.0);
  EXPECT_EQ(MaxDifference(DrawPartOf(codes, bytes[2]), image), 0.0);
  // A smaller volume, whose bricks the caches of the processor hold, keeps its values.
  Ruled<std::uint8_t> small(2, 0.0);
  (void)DrawPartOf(small, bytes[3]);
  Ruled<float> smallPlain(2, 0.0);
  (void)DrawPartOf(smallPlain, bytes[4]);
  EXPECT_EQ(bytes[3], bytes[4]);
  const std::uint64_t expected = FusesHere() ? bytes[0] * 3 / 5 : bytes[0] + 1;
  EXPECT_LT(bytes[1], expected);
  EXPECT_LT(bytes[2], expected);
}

} // namespace
