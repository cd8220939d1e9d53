// SPDX-License-Identifier: BSD-3-Clause
// Tables of functions are as fine as these demand: random maps against the functions themselves.
#include "Base/Error.h"
#include "Render/RandomMaps.h"
#include "Render/Scene/TabulateFunction.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace banyan;
using scenes::Map;
using scenes::RandomMaps;

constexpr double Infinity = std::numeric_limits<double>::infinity();

double HighestOf(const TransferFunction& table)
{
  double highest = 0.0;
  for (const glm::vec4& entry : table.Entries)
  {
    highest = std::max(highest, double{ entry.a });
  }
  return highest;
}

bool IsWithin(const glm::dvec4& entry, const glm::dvec4& exact, double highest)
{
  const glm::dvec4 error = glm::abs(entry - exact);
  const double colour = std::max({ error.r, error.g, error.b });
  const double opacity = TabulationError::OpacityOfItself * std::max(entry.a, exact.a) +
                         TabulationError::OpacityOfHighest * highest * 1.05;
  return colour <= TabulationError::Colour && error.a <= opacity + 1e-7;
}

/// Floats are exact: no value, however close to a jump, has another's colour.
TEST(TabulateFunction, RandomMapsAreTheirFunctionsForFloats)
{
  RandomMaps random(2027);
  int withEdges = 0;
  for (int round = 0; round < 300; ++round)
  {
    const Map map = random.Any();
    const TransferFunction table = TabulateFunction(map.Of, map.Corners);
    table.Check();
    const double highest = HighestOf(table);
    const StepTable steps(table, 1.0);
    const VisibleValues visible(table);
    withEdges += table.Edges.empty() ? 0 : 1;
    for (int i = 0; i < 200; ++i)
    {
      const auto value = static_cast<float>(random.ValueFor(map));
      const int index = steps.Lookup().IndexOf(value);
      const glm::dvec4 exact = map.Of(value);
      ASSERT_TRUE(IsWithin(table.Entries[static_cast<std::size_t>(index)], exact, highest))
        << "map " << round << ", value " << value << ", entry " << index << " of "
        << table.Entries.size();
      ASSERT_TRUE(visible.Any(value, value) || exact.a <= 1.01 * highest / 4096.0);
      ASSERT_FALSE(visible.All(value, value) && exact.a == 0.0 && !table.Edges.empty() &&
                   table.Entries[static_cast<std::size_t>(index)].a == 0.0f);
    }
  }
  EXPECT_GT(withEdges, 100);
  EXPECT_LT(withEdges, 299);
}

/// Doubles and large integers become float relative to the low end: exact but for that rounding.
TEST(TabulateFunction, RandomMapsAreTheirFunctionsForDoubles)
{
  RandomMaps random(5);
  for (int round = 0; round < 200; ++round)
  {
    const Map map = random.Any();
    const TransferFunction table = TabulateFunction(map.Of, map.Corners);
    const double highest = HighestOf(table);
    const StepTable steps(table, 1.0);
    for (int i = 0; i < 200; ++i)
    {
      const double value = random.ValueFor(map);
      const auto relative = static_cast<float>(value - steps.Low());
      const glm::dvec4 entry =
        table.Entries[static_cast<std::size_t>(steps.RelativeLookup().IndexOf(relative))];
      const double room = 1.3e-7 * std::abs(value - steps.Low());
      const bool isClose = IsWithin(entry, map.Of(value), highest) ||
                           IsWithin(entry, map.Of(value - room), highest) ||
                           IsWithin(entry, map.Of(value + room), highest);
      // A corner may have an entry of its own.
      const bool isCorner = std::any_of(map.Corners.begin(), map.Corners.end(),
        [&](double corner)
        { return std::abs(corner - value) <= room && IsWithin(entry, map.Of(corner), highest); });
      ASSERT_TRUE(isClose || isCorner) << "map " << round << ", value " << value;
    }
  }
}

/// Corners are on the right side even where values are relative.
TEST(TabulateFunction, TheEndsOfTheRangeAreInside)
{
  for (const double low : { 0.0, 0.1, -3.7, 1e6, 16777219.0 })
  {
    for (const double width : { 1.0, 0.3, 5000.0 })
    {
      const double high = low + width;
      const auto function = [&](double value)
      { return glm::dvec4(value < low ? 1 : 0, value > high ? 1 : 0, 0, 0.5); };
      const TransferFunction table = TabulateFunction(function, { low, high });
      const StepTable steps(table, 1.0);
      for (const double value : { low, high })
      {
        const auto relative = static_cast<float>(value - steps.Low());
        const glm::vec4 entry =
          table.Entries[static_cast<std::size_t>(steps.RelativeLookup().IndexOf(relative))];
        EXPECT_EQ(entry, glm::vec4(0, 0, 0, 0.5f)) << value;
      }
    }
  }
}

TEST(TabulateFunction, OrdinaryMapsHaveEqualSpaces)
{
  const TransferFunction table = TabulateFunction(scenes::Smooth, { 0.0, 1.0 });
  EXPECT_TRUE(table.Edges.empty());
  ASSERT_EQ(table.Entries.size(), 4096u);
  EXPECT_EQ(table.Entries, scenes::Tabulate(scenes::Smooth).Entries);
  // A narrow peak takes more of them.
  const auto peak = [](double value)
  { return glm::dvec4(1, 1, 1, std::max(0.0, 1.0 - std::abs(value - 0.3) / 0.02)); };
  const TransferFunction finer = TabulateFunction(peak, { 0.0, 0.28, 0.3, 0.32, 1.0 });
  EXPECT_TRUE(finer.Edges.empty());
  EXPECT_EQ(finer.Entries.size(), 16384u);
}

/// ParaView's maps have 256 colours unless told otherwise: equal spaces do, and steps are in place.
TEST(TabulateFunction, SmallStepsFallBetweenEntries)
{
  const double low = -3.25;
  const double width = 17.0;
  for (const int colours : { 256, 255, 1000, 100, 4096 })
  {
    const auto steps = [&](double value)
    {
      const double part = std::clamp((value - low) / width, 0.0, 1.0);
      const double colour = std::min(std::floor(part * colours), colours - 1.0) / (colours - 1.0);
      return glm::dvec4(colour, 1.0 - colour, 0.5, 0.3 * part);
    };
    std::vector<double> corners{ low, low + width };
    for (int i = 1; i < colours; ++i)
    {
      corners.push_back(low + width * i / colours);
    }
    const TransferFunction table = TabulateFunction(steps, corners, colours);
    EXPECT_TRUE(table.Edges.empty()) << colours;
    const StepTable look(table, 1.0);
    for (int i = 0; i < 3 * colours; ++i)
    {
      // Not where rounding decides.
      const auto value =
        static_cast<float>(low + width * (i + 0.01 + 0.98 * (i % 2)) / (3 * colours));
      const glm::vec4 entry = table.Entries[static_cast<std::size_t>(look.Lookup().IndexOf(value))];
      ASSERT_NEAR(entry.r, steps(value).r, 1e-6) << colours << " colours, value " << value;
      ASSERT_NEAR(entry.a, steps(value).a, 1e-4);
    }
  }
}

/// A peak between two entries of an even table is neither lost nor skipped.
TEST(TabulateFunction, APeakInAHugeRangeIsSeen)
{
  const auto peak = [](double value)
  { return glm::dvec4(1, 0, 0, std::max(0.0, 1.0 - std::abs(value - 777.0))); };
  const TransferFunction table = TabulateFunction(peak, { 0.0, 776.0, 777.0, 778.0, 1e7 });
  const StepTable steps(table, 1.0);
  EXPECT_NEAR(steps.At(777.0f).a, 1.0, 0.01);
  EXPECT_NEAR(steps.At(776.5f).a, 0.5, 0.01);
  EXPECT_EQ(steps.At(775.9f).a, 0.0f);
  EXPECT_EQ(steps.At(5000.0f).a, 0.0f);
  EXPECT_TRUE(table.AnyVisible(777.0, 777.0));
  EXPECT_FALSE(table.AnyVisible(780.0, Infinity));
  EXPECT_EQ(table.VisibleBins({ 0.0, 64e5 }), MaskOfBins(0, 0));
  EXPECT_EQ(table.VisibleBins({ 700.0, 764.0 }), MaskOfBins(63, 63));
}

TEST(TabulateFunction, AJumpThatNoCornerTellsOfIsFoundToTheLastBit)
{
  const float jump = 0.123456f;
  const auto step = [&](double value) { return glm::dvec4(0, 0, 0, value < jump ? 0.0 : 1.0); };
  const TransferFunction table = TabulateFunction(step, { 0.0, 0.2, 1.0 });
  const StepTable steps(table, 1.0);
  EXPECT_EQ(steps.At(jump).a, 1.0f);
  EXPECT_EQ(steps.At(std::nextafter(jump, 0.0f)).a, 0.0f);
}

TEST(TabulateFunction, NoNumbersAreRefused)
{
  const auto none = [](double value) { return glm::dvec4(0, 0, 0, value > 0.5 ? NAN : 0.5); };
  EXPECT_THROW(TabulateFunction(none, { 0.0, 1.0 }), Error);
  EXPECT_NO_THROW(TabulateFunction(scenes::Smooth, {}).Check());
  EXPECT_NO_THROW(TabulateFunction(scenes::Smooth, { NAN, 3.0, Infinity }).Check());
}

TEST(TransferFunction, RefusesEdgesThatDoNotFit)
{
  TransferFunction table;
  table.Entries.resize(3);
  table.Edges = { { 0.5, false } };
  EXPECT_THROW(table.Check(), Error);
  table.Edges = { { 0.5, false }, { 0.25, false } };
  EXPECT_THROW(table.Check(), Error);
  table.Edges = { { 0.25, false }, { NAN, false } };
  EXPECT_THROW(table.Check(), Error);
  table.Edges = { { 0.25, false }, { 0.25, true } };
  EXPECT_NO_THROW(table.Check());
}

/// Pictures of random maps, of every way that bricks are drawn, against the function itself.
template <class T>
void ExpectPicture(RandomMaps& random, int round, SampleInterpolation interpolation)
{
  const glm::ivec3 n(19, 18, 17);
  const Map map = random.Any();
  const double low = *std::min_element(map.Corners.begin(), map.Corners.end());
  const double high = *std::max_element(map.Corners.begin(), map.Corners.end());
  const double margin = 0.1 * (high - low);
  const double scale = std::is_integral_v<T> ? 100.0 : high - low + 2 * margin;
  const double offset = std::is_integral_v<T> ? std::clamp(low, 0.0, 20000.0) : low - margin;
  const std::vector<T> values = scenes::Sampled<T>(scenes::Standard, n, scale, offset);
  RayScene scene = scenes::Scene(n, { 20, 16 });
  scene.Transfer = TabulateFunction(map.Of, map.Corners);
  scene.Transfer.UnitDistance = 4.0;
  scene.Interpolation = interpolation;
  scene.Blend.Mode = static_cast<BlendMode>(round % 5 == 4 ? 1 + round % 3 : 0);
  scene.Blend.Black = low;
  scene.Blend.White = high;
  const FloatImage picture = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  const FloatImage exact = ReferenceImage(scene, scenes::ValueOf(values, n), map.Of);
  // A sample within rounding of a jump may fall to its other side, but few do.
  int off = 0;
  const PixelRect& drawn = picture.Rect;
  for (int y = scene.Viewport.Lo.y; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = scene.Viewport.Lo.x; x < scene.Viewport.Hi.x; ++x)
    {
      const bool inside = x >= drawn.Lo.x && x < drawn.Hi.x && y >= drawn.Lo.y && y < drawn.Hi.y;
      const glm::vec4 pixel = inside ? picture.At(x, y) : glm::vec4(0.0f);
      const glm::vec4 error = glm::abs(pixel - exact.At(x, y));
      off += std::max({ error.r, error.g, error.b, error.a }) > 3.0f / 255.0f ? 1 : 0;
    }
  }
  EXPECT_LE(off, static_cast<int>(scene.Viewport.Count()) / 50)
    << "map " << round << " with " << scene.Transfer.Edges.size() << " edges";
}

TEST(TabulateFunction, PicturesOfRandomMapsAreThoseOfTheFunctions)
{
  RandomMaps random(11);
  for (int round = 0; round < 100; ++round)
  {
    const auto interpolation =
      round % 2 == 0 ? SampleInterpolation::Linear : SampleInterpolation::Nearest;
    switch (round % 4)
    {
      case 0:
      case 1:
        ExpectPicture<float>(random, round, interpolation);
        break;
      case 2:
        ExpectPicture<double>(random, round, interpolation);
        break;
      default:
        ExpectPicture<std::uint16_t>(random, round, interpolation);
        break;
    }
  }
}

} // namespace
