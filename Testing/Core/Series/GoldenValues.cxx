// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GoldenCases.h"
#include "Series/GoldenCells.h"
#include "Series/GoldenMesh.h"

#include "Series/Quantize/FillValues.h"
#include "Series/SeriesTesting.h"

#include <glm/vector_relational.hpp>

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

/// Independent numbers of some bits; of all that p is made of but the step.
std::int64_t NoiseAt(const GoldenArray& array, Place p, int step, int bits)
{
  p.Step = step + 1; // steps count from -1 here
  return static_cast<std::int64_t>(Mix(array.Seed, NumberOf(p)) & ((1ull << bits) - 1));
}

/// What GoldenPattern::Fates says: for every 16 samples along x another way to follow from the
/// steps around, plus another kind of change from step to step.
std::int64_t FateAt(const GoldenArray& array, const Place& p)
{
  const int kind = p.X / 16;
  const std::int64_t rest =
    kind < 4 ? NoiseAt(array, p, 1000 + p.Step, 4)
             : (2 + 3 * (p.Step % 2)) * (Parabola(p.X + p.Y + p.Step) + Parabola(p.Z + p.Y));
  constexpr int bits = 6;
  const int from = p.Step + 1;
  switch (kind % 4)
  {
    case 0: // on a straight line between every fourth step
      return rest + (NoiseAt(array, p, from / 4, bits) * (4 - from % 4) +
                      NoiseAt(array, p, from / 4 + 1, bits) * (from % 4)) /
                      4;
    case 1: // weaker every other step
      return rest + NoiseAt(array, p, 0, bits) / (1 + from % 2);
    case 2: // much like the step before
      return rest + NoiseAt(array, p, from / 2, bits);
    default: // much like the step after
      return rest + NoiseAt(array, p, p.Step / 2, bits);
  }
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
    case Pattern::Fates:
      return FateAt(array, p);
    case Pattern::Hidden:
      return p.X < 2 + p.Step || random % 9 == 0
               ? (array.Flags == ArrayFlags::OfPoints ? HiddenPointBits
                   : random % 2 == 0                  ? 32
                                                      : 8)
               : 0;
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
    static_cast<std::uint64_t>(array.Factor) * static_cast<std::uint64_t>(PatternAt(array, p)) +
    static_cast<std::uint64_t>(array.Rise) * static_cast<std::uint64_t>(p.Step);
  if (array.SpecialOneIn > 0 &&
      Mix(array.Seed + 77u, NumberOf(p)) % static_cast<std::uint64_t>(array.SpecialOneIn) == 0)
  {
    return static_cast<T>(array.Special);
  }
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

/// Where an array has values, in their order.
std::vector<glm::ivec3> PlacesOf(const GoldenCase& series, const GoldenArray& array)
{
  if (series.OnMesh)
  {
    const GoldenMesh mesh;
    return array.CellArray.empty() ? mesh.Points : mesh.Cells;
  }
  if (series.OnCells)
  {
    const GoldenCells mesh;
    return array.CellArray.empty() ? mesh.Points : mesh.Cells;
  }
  const glm::ivec3 n = series.Domain.Samples();
  std::vector<glm::ivec3> places;
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        places.push_back({ x, y, z });
      }
    }
  }
  return places;
}

template <class T>
std::vector<T> ValuesOf(const GoldenCase& series, const GoldenArray& array, int step)
{
  const glm::ivec3 last = series.Domain.Samples() - 1;
  std::vector<T> values;
  for (const glm::ivec3& p : PlacesOf(series, array))
  {
    const bool noCell = array.Flags == ArrayFlags::OfCells && glm::any(glm::equal(p, last));
    for (int c = 0; c < static_cast<int>(array.Components.size()); ++c)
    {
      values.push_back(noCell ? T{} : ValueAt<T>(array, { p.x, p.y, p.z, step, c }));
    }
  }
  return values;
}

} // namespace

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

namespace
{

void CountHistograms(
  const GoldenCase& series, const GoldenArray& array, ArrayDescription& description)
{
  const int components = static_cast<int>(array.Components.size());
  description.Histograms.resize(array.Components.size());
  for (int step = 0; step < series.Steps; ++step)
  {
    const Bytes values = GoldenValues(series, array, step);
    const auto count = static_cast<std::int64_t>(values.size() / SizeOf(array.Type)) / components;
    for (int c = 0; c < components; ++c)
    {
      CountComponent(array.Type, values.data(), count, components, c,
        series.Options.QuantizerFor(array.Name).FillValues,
        description.Histograms[static_cast<std::size_t>(c)]);
    }
  }
}

} // namespace

ArrayDescription GoldenDescription(const GoldenCase& series, const GoldenArray& array)
{
  if (array.Flags != ArrayFlags::None)
  {
    return DescriptionOfFlags(array.Flags);
  }
  ArrayDescription description;
  description.Name = array.Name;
  description.Type = array.Type;
  description.ComponentNames = array.Components;
  if (series.Options.NeedsHistogram(array.Name))
  {
    CountHistograms(series, array, description);
    return description;
  }
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
