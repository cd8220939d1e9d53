// Tables of functions are as fine as these demand: random maps against the functions themselves.
#include "Base/Error.h"
#include "Render/TabulateFunction.h"
#include "Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace banyan;

constexpr double Infinity = std::numeric_limits<double>::infinity();

/// A function of the kinds that ParaView has, with what the test has to know of it.
struct Map
{
  FunctionOfValue Of;
  std::vector<double> Corners;
  bool Jumps = false;
};

class RandomMaps
{
public:
  explicit RandomMaps(unsigned seed)
    : Random(seed)
  {
  }

  double Unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }
  int Below(int n) { return static_cast<int>(this->Random() % static_cast<unsigned>(n)); }

  glm::dvec4 Entry()
  {
    const double opacity = this->Below(3) == 0 ? 0.0 : std::pow(10.0, -3.0 * this->Unit());
    return { this->Unit(), this->Unit(), this->Unit(), opacity };
  }

  /// Entries at nodes, linear between them (or in their logarithm), or steps that begin at nodes.
  Map Nodes(std::vector<double> at, bool steps, bool logarithmic)
  {
    std::sort(at.begin(), at.end());
    std::vector<glm::dvec4> entries;
    for (std::size_t i = 0; i < at.size(); ++i)
    {
      entries.push_back(this->Entry());
    }
    Map map;
    map.Corners = at;
    map.Jumps = steps;
    map.Of = [=](double value)
    {
      const auto above = std::upper_bound(at.begin(), at.end(), value);
      const auto i = static_cast<std::size_t>(above - at.begin());
      if (i == 0 || i == at.size() || steps)
      {
        return entries[i == 0 ? 0 : i - 1];
      }
      const double part = logarithmic ? std::log(value / at[i - 1]) / std::log(at[i] / at[i - 1])
                                      : (value - at[i - 1]) / (at[i] - at[i - 1]);
      return glm::mix(entries[i - 1], entries[i], part);
    };
    return map;
  }

  /// Colours of their own below and above the corners.
  Map Beyond(Map map)
  {
    const glm::dvec4 below = this->Entry();
    const glm::dvec4 above = this->Entry();
    const double low = *std::min_element(map.Corners.begin(), map.Corners.end());
    const double high = *std::max_element(map.Corners.begin(), map.Corners.end());
    const FunctionOfValue inside = map.Of;
    map.Of = [=](double value) {
      return value < low ? below : value > high ? above : inside(value);
    };
    map.Jumps = true;
    return map;
  }

  /// Whole numbers with an entry each, and one for all other values.
  Map Labels(int count, int gap)
  {
    std::vector<double> labels;
    double label = this->Below(2) * -1000.0;
    for (int i = 0; i < count; ++i)
    {
      labels.push_back(label);
      label += 1 + (gap > 1 ? this->Below(gap) : 0);
    }
    std::vector<glm::dvec4> entries;
    for (int i = 0; i <= count; ++i)
    {
      entries.push_back(this->Entry());
    }
    Map map;
    map.Corners = labels;
    map.Jumps = true;
    map.Of = [=](double value)
    {
      const auto at = std::lower_bound(labels.begin(), labels.end(), value);
      return at != labels.end() && *at == value
               ? entries[static_cast<std::size_t>(at - labels.begin())]
               : entries.back();
    };
    return map;
  }

  Map Any()
  {
    std::vector<double> at;
    const int nodes = 2 + this->Below(12);
    const double low = (this->Unit() - 0.5) * std::pow(10.0, this->Below(9) - 2);
    const double width = std::pow(10.0, this->Below(8) - 3);
    const double decades = 1 + this->Below(12);
    const int kind = this->Below(6);
    for (int i = 0; i < nodes; ++i)
    {
      // Some are close to each other.
      const double part = this->Below(3) == 0 && i > 0 ? 1e-6 * this->Unit() : this->Unit();
      at.push_back(
        kind < 4 ? static_cast<float>(low + width * part) : std::pow(10.0, decades * (part - 0.5)));
    }
    switch (kind)
    {
      case 0:
        return this->Nodes(at, false, false);
      case 1:
        return this->Nodes(at, true, false);
      case 2:
        return this->Beyond(this->Nodes(at, this->Below(2) == 0, false));
      case 3:
        return this->Labels(1 + this->Below(60), 1 + this->Below(1000));
      case 4:
        return this->Nodes(at, false, true);
      default:
        return this->Beyond(this->Nodes(at, false, true));
    }
  }

  /// Values near and on the corners, between and beyond them.
  double ValueFor(const Map& map)
  {
    const auto count = static_cast<int>(map.Corners.size());
    const double corner = map.Corners[static_cast<std::size_t>(this->Below(count))];
    const double other = map.Corners[static_cast<std::size_t>(this->Below(count))];
    switch (this->Below(6))
    {
      case 0:
        return corner;
      case 1:
        return std::nextafter(static_cast<float>(corner), this->Below(2) == 0 ? -1e30f : 1e30f);
      case 2:
        return corner + (other - corner) * this->Unit();
      case 3:
        return corner * (1.0 + 1e-3 * (this->Unit() - 0.5));
      case 4:
        return std::round(corner + 3.0 * (this->Unit() - 0.5));
      default:
        return corner + (other - corner) * (3.0 * this->Unit() - 1.5);
    }
  }

private:
  std::mt19937 Random;
};

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
