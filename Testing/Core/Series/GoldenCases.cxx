#include "Series/GoldenCases.h"

#include "Series/SeriesTesting.h"

namespace banyan::testing
{
namespace
{

using Pattern = GoldenPattern;

/// A number that depends on nothing but its arguments (the finaliser of SplitMix64).
std::uint64_t Mix(std::uint64_t seed, std::uint64_t place)
{
  std::uint64_t z = seed * 0x9E3779B97F4A7C15u + place * 0xD1B54A32D192ED03u + 1;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

/// A parabola over every 32 numbers, 0 to 256.
std::int64_t Parabola(std::int64_t t)
{
  const std::int64_t u = t & 31;
  return u * (32 - u);
}

struct Place
{
  int X, Y, Z, Step, Component;
};

std::uint64_t NumberOf(const Place& p)
{
  std::uint64_t number = 0;
  for (const int part : { p.X, p.Y, p.Z, p.Step, p.Component })
  {
    number = number * 256 + static_cast<std::uint64_t>(part);
  }
  return number;
}

std::int64_t PatternAt(const GoldenArray& array, const Place& p)
{
  if (p.X < array.QuietBelow)
  {
    return 0;
  }
  const std::uint64_t random = Mix(array.Seed, NumberOf(p));
  switch (array.Pattern)
  {
    case Pattern::Constant:
      return 0;
    case Pattern::Bumps:
      return Parabola(2 * p.X + p.Y + 3 * p.Step + 5 * p.Component) + Parabola(3 * p.Y - p.Z) +
             Parabola(p.Z + p.X + p.Step + static_cast<int>(array.Seed));
    case Pattern::Noise:
      return static_cast<std::int64_t>(
        array.Bits < 64 ? random & ((1ull << array.Bits) - 1) : random);
    case Pattern::Picks:
      return static_cast<std::int64_t>(random % 3 * (random % 3));
  }
  return 0;
}

/// A NaN with a payload of its own, or an infinity.
template <class T>
T NonFinite(std::uint64_t random)
{
  using Word = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
  constexpr int mantissa = std::numeric_limits<T>::digits - 1;
  const Word infinity = BitCast<Word>(std::numeric_limits<T>::infinity());
  const Word sign = static_cast<Word>(Word{ (random & 1) != 0 } << (8 * sizeof(T) - 1));
  const bool nan = (random & 6) != 0;
  const Word payload = (Word{ 1 } << (mantissa - 1)) | static_cast<Word>(random >> 3 & 0xffff);
  return BitCast<T>(static_cast<Word>(infinity | sign | (nan ? payload : 0)));
}

template <class T>
T ValueAt(const GoldenArray& array, Place p)
{
  p.Step /= array.Hold;
  // Unsigned, because noise of 64 bits is meant to wrap around.
  const std::uint64_t number =
    static_cast<std::uint64_t>(array.Low) +
    static_cast<std::uint64_t>(array.Factor) * static_cast<std::uint64_t>(PatternAt(array, p));
  if constexpr (std::is_floating_point_v<T>)
  {
    const std::uint64_t random = Mix(array.Seed + 1000003u, NumberOf(p));
    if (array.NonFiniteOneIn > 0 &&
        random % static_cast<std::uint64_t>(array.NonFiniteOneIn) == 0 && p.X >= array.QuietBelow)
    {
      return NonFinite<T>(random >> 32);
    }
    return static_cast<T>(
      std::ldexp(static_cast<double>(static_cast<std::int64_t>(number)), array.Exponent));
  }
  else
  {
    return static_cast<T>(number);
  }
}

template <class T>
std::vector<T> ValuesOf(const GoldenCase& series, const GoldenArray& array, int step)
{
  const glm::ivec3 n = series.Domain.Samples();
  std::vector<T> values;
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        for (int c = 0; c < static_cast<int>(array.Components.size()); ++c)
        {
          values.push_back(ValueAt<T>(array, { x, y, z, step, c }));
        }
      }
    }
  }
  return values;
}

Grid At(const glm::ivec3& low, const glm::ivec3& samples)
{
  Grid grid;
  grid.Extent = { low, low + samples };
  return grid;
}

EncodeOptions Within(double bound, ErrorBoundMode mode, int brickCells)
{
  EncodeOptions options;
  options.ErrorBound = bound;
  options.Mode = mode;
  options.BrickCells = brickCells;
  return options;
}

GoldenArray Array(const std::string& name, ScalarType type, Pattern pattern, std::int64_t low = 0,
  std::int64_t factor = 1, int exponent = 0)
{
  GoldenArray array;
  array.Name = name;
  array.Type = type;
  array.Pattern = pattern;
  array.Low = low;
  array.Factor = factor;
  array.Exponent = exponent;
  return array;
}

/// Every scalar type on a lattice, by an absolute bound.
GoldenCase Types()
{
  GoldenCase series{ "types", At({ 0, 0, 0 }, { 11, 4, 3 }),
    Within(2.5, ErrorBoundMode::Absolute, 8), 1, {} };
  for (int type = 0; type < 10; ++type)
  {
    const ScalarType scalar = static_cast<ScalarType>(type);
    GoldenArray array = Array(NameOf(scalar), scalar, Pattern::Bumps, -40, 1, -1);
    array.Promised = type % 3 != 0;
    array.Seed = static_cast<unsigned>(type);
    array.Factor = SizeOf(scalar) > 1 ? 40 : 1;
    series.Arrays.push_back(array);
  }
  return series;
}

/// Bit-exact, with numbers as wide as the types and as odd as they come.
GoldenCase Exact()
{
  GoldenCase series{ "exact", At({ 3, -2, 5 }, { 9, 4, 3 }),
    Within(0.0, ErrorBoundMode::RelativeToSeriesRange, 8), 1, {} };
  series.Arrays = {
    Array("not a double", ScalarType::Int64, Pattern::Constant, (std::int64_t{ 1 } << 53) + 1),
    Array("wide", ScalarType::UInt64, Pattern::Noise),
    Array("31 bits", ScalarType::Int64, Pattern::Noise, -(std::int64_t{ 1 } << 40)),
    Array("32 bits", ScalarType::UInt32, Pattern::Noise),
    Array("16 bits", ScalarType::Int16, Pattern::Noise),
    Array("smooth", ScalarType::Int16, Pattern::Bumps, -300, 3),
    Array("real", ScalarType::Float64, Pattern::Bumps, 1, 3, -20),
    Array("small", ScalarType::Float32, Pattern::Noise, -(1 << 18), 1, -149),
    Array("large", ScalarType::Float64, Pattern::Noise, -(std::int64_t{ 1 } << 52), 1, 970),
    Array("holes", ScalarType::Float32, Pattern::Noise, 0, 1, -3),
    Array("nothing finite", ScalarType::Float64, Pattern::Constant),
  };
  const int bits[] = { 0, 64, 31, 32, 16, 0, 0, 19, 53, 24, 0 };
  for (std::size_t i = 0; i < series.Arrays.size(); ++i)
  {
    series.Arrays[i].Bits = bits[i];
    series.Arrays[i].Promised = i % 2 == 0;
  }
  series.Arrays[9].NonFiniteOneIn = 9;
  series.Arrays[10].NonFiniteOneIn = 1;
  return series;
}

/// Steps and segments, vectors, a domain that is neither at the origin nor along the axes; bricks
/// that stay, that are one value, and that two arrays share.
GoldenCase Moving()
{
  GoldenCase series{ "moving", At({ -4, 7, 2 }, { 17, 6, 5 }),
    Within(1.0 / 256, ErrorBoundMode::RelativeToSeriesRange, 8), 5, {} };
  series.Options.KeyframeInterval = 2;
  series.Options.CompressionLevel = 19;
  series.Domain.Origin = { -1.25, 1e6, 3.0 };
  series.Domain.Spacing = { 0.5, 0.125, 3.0 };
  series.Domain.Direction =
    glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-0.6, 0, 0.8), glm::dvec3(0.8, 0, 0.6));
  GoldenArray scalar = Array("temperature", ScalarType::Float32, Pattern::Bumps, 4096, 7, -4);
  scalar.QuietBelow = 9;
  scalar.Hold = 2;
  GoldenArray twin = scalar;
  twin.Name = "twin";
  GoldenArray vector = Array("velocity", ScalarType::Float32, Pattern::Bumps, -300, 1, -6);
  vector.Components = { "x", "y", "z" };
  vector.QuietBelow = 9;
  vector.Hold = 4;
  vector.NonFiniteOneIn = 700;
  series.Arrays = { scalar, vector, twin };
  return series;
}

/// Codes of every width that zstd makes smaller, and three levels of bricks of 16.
GoldenCase Packed()
{
  GoldenCase series{ "packed", At({ 0, 0, 0 }, { 34, 8, 2 }),
    Within(0.5, ErrorBoundMode::Absolute, 16), 1, {} };
  series.Arrays = {
    Array("picks 1", ScalarType::Float32, Pattern::Picks, 5, 40),
    Array("picks 2", ScalarType::Float32, Pattern::Picks, -1000, 10007),
    Array("picks 4", ScalarType::Float64, Pattern::Picks, 77, 1 << 24),
    Array("smooth 1", ScalarType::UInt8, Pattern::Bumps, 3, 1, 0),
    Array("smooth 2", ScalarType::Float32, Pattern::Bumps, 0, 20, 0),
    Array("smooth 4", ScalarType::Float64, Pattern::Bumps, -9, 1 << 16, 0),
  };
  series.Arrays[3].QuietBelow = 20;
  series.Arrays[3].Low = 3;
  return series;
}

/// So few samples that zstd cannot make them smaller: codes of every width as they are.
GoldenCase Tiny()
{
  GoldenCase series{ "tiny", At({ 1, 1, 1 }, { 3, 2, 2 }),
    Within(0.5, ErrorBoundMode::Absolute, 16), 1, {} };
  series.Arrays = {
    Array("picks 1", ScalarType::Float64, Pattern::Picks, 5, 40),
    Array("picks 2", ScalarType::Float64, Pattern::Picks, -1000, 10007),
    Array("picks 4", ScalarType::Float64, Pattern::Picks, 77, 0x01020305),
    Array("smooth 1", ScalarType::Float64, Pattern::Bumps, 0, 1, -3),
    Array("smooth 2", ScalarType::Float64, Pattern::Bumps, 0, 20, 0),
    Array("smooth 4", ScalarType::Float64, Pattern::Bumps, 0, 1 << 20, 0),
    Array("noise 4", ScalarType::Float64, Pattern::Noise, 0, 1, 0),
  };
  series.Arrays[6].Bits = 30;
  return series;
}

/// Axes without cells.
std::vector<GoldenCase> Flat()
{
  const EncodeOptions options = Within(1.0 / 64, ErrorBoundMode::RelativeToSeriesRange, 8);
  GoldenArray plane = Array("plane", ScalarType::UInt16, Pattern::Bumps, 1000, 5);
  GoldenArray line = Array("line", ScalarType::Float32, Pattern::Bumps, 0, 1, -5);
  line.NonFiniteOneIn = 13;
  GoldenArray point = Array("point", ScalarType::Float32, Pattern::Bumps, 12345, 1, -7);
  GoldenArray hole = Array("hole", ScalarType::Float32, Pattern::Constant);
  hole.NonFiniteOneIn = 1;
  return { { "flat", At({ 0, 9, 0 }, { 18, 1, 10 }), options, 1, { plane } },
    { "line", At({ 0, 0, -3 }, { 1, 1, 35 }), options, 2, { line } },
    { "point", At({ 5, 5, 5 }, { 1, 1, 1 }), options, 2, { point, hole } } };
}

} // namespace

std::vector<GoldenCase> GoldenCases()
{
  std::vector<GoldenCase> cases = { Types(), Exact(), Moving(), Packed(), Tiny() };
  for (const GoldenCase& flat : Flat())
  {
    cases.push_back(flat);
  }
  return cases;
}

Bytes GoldenValues(const GoldenCase& series, const GoldenArray& array, int step)
{
  return Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const std::vector<T> values = ValuesOf<T>(series, array, step);
      Bytes bytes(values.size() * sizeof(T));
      std::memcpy(bytes.data(), values.data(), bytes.size());
      return bytes;
    });
}

ArrayDescription GoldenDescription(const GoldenCase& series, const GoldenArray& array)
{
  ArrayDescription description;
  description.Name = array.Name;
  description.Type = array.Type;
  description.ComponentNames = array.Components;
  const bool needed =
    series.Options.Mode == ErrorBoundMode::RelativeToSeriesRange && series.Options.ErrorBound > 0;
  if (!array.Promised && !needed)
  {
    return description;
  }
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const std::size_t components = array.Components.size();
      description.SeriesRanges.resize(components);
      for (int step = 0; step < series.Steps; ++step)
      {
        const std::vector<T> values = ValuesOf<T>(series, array, step);
        for (std::size_t c = 0; c < components; ++c)
        {
          std::vector<T> own;
          for (std::size_t i = c; i < values.size(); i += components)
          {
            own.push_back(values[i]);
          }
          description.SeriesRanges[c].Include(RangeOf(own));
        }
      }
    });
  return description;
}

double GoldenTime(int step)
{
  return std::ldexp(static_cast<double>(step) * (step + 3), -2) - 1.0;
}

} // namespace banyan::testing
