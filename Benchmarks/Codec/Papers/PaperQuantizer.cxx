// SPDX-License-Identifier: BSD-3-Clause
#include "Papers/PaperQuantizer.h"

#include "Base/Box.h"
#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Parts of a level that the origin of a subdomain is told in.
constexpr double OriginParts = 256.0;

/// Subdomains that need more levels than this keep to those of the whole: their voxels fuse little
/// either way.
constexpr double FewLevels = 2.0;

/// Positions of values in levels: 0 is Range.Low, 1 the beginning of the second level.
struct Scale
{
  explicit Scale(const PaperQuantizer& quantizer)
    : HalfLow(0.5 * quantizer.Range.Low)
    , Last(static_cast<double>((1 << quantizer.Bits) - 1))
  {
    const double width = 0.5 * quantizer.LevelWidth();
    this->PerHalf = width > 0.0 ? 1.0 / width : 0.0;
  }

  // Halves, because the width of a range of doubles may overflow.
  double PositionOf(double value) const { return (0.5 * value - this->HalfLow) * this->PerHalf; }

  std::uint16_t CodeAt(double position) const
  {
    // In this order NaN becomes 0.
    const double code = position > 0.0 ? position : 0.0;
    return static_cast<std::uint16_t>(code < this->Last ? code : this->Last);
  }

  double HalfLow;
  double PerHalf = 0.0;
  double Last;
};

/// Where the voxels of a subdomain lie, in levels of the whole.
struct Spread
{
  double Low = 0.0;
  double High = 0.0;

  /// How many levels they need when level 0 begins at `origin`.
  double LevelsFrom(double origin) const
  {
    return std::floor(this->High - origin) - std::floor(this->Low - origin) + 1.0;
  }
};

/// One step's values of one component, with the quantizer of the whole.
template <class T>
struct Field
{
  const T* Values;
  std::size_t Stride;
  glm::ivec3 Samples;
  Scale Levels;

  template <class Body>
  void ForVoxels(const Box& box, Body&& body) const
  {
    for (int z = box.Lo.z; z < box.Hi.z; ++z)
    {
      for (int y = box.Lo.y; y < box.Hi.y; ++y)
      {
        const std::size_t row =
          (static_cast<std::size_t>(z) * static_cast<std::size_t>(this->Samples.y) +
            static_cast<std::size_t>(y)) *
          static_cast<std::size_t>(this->Samples.x);
        for (int x = box.Lo.x; x < box.Hi.x; ++x)
        {
          const std::size_t i = row + static_cast<std::size_t>(x);
          body(i, this->Levels.PositionOf(static_cast<double>(this->Values[i * this->Stride])));
        }
      }
    }
  }

  Spread SpreadOf(const Box& box) const
  {
    Spread spread{ std::numeric_limits<double>::infinity(), 0.0 };
    bool odd = false;
    this->ForVoxels(box,
      [&](std::size_t, double position)
      {
        odd = odd || !std::isfinite(position);
        spread.Low = std::min(spread.Low, position);
        spread.High = std::max(spread.High, position);
      });
    // What is not finite needs the first or last code of the whole, whatever its neighbours need.
    return odd ? Spread{ 0.0, this->Levels.Last } : spread;
  }
};

/// The origin of a subdomain, in `OriginParts` of a level.
std::uint32_t OriginOf(const Spread& spread, std::uint32_t previous)
{
  const double fresh = std::floor(std::max(spread.Low, 0.0) * OriginParts);
  const double whole = spread.LevelsFrom(0.0);
  const double own = spread.LevelsFrom(fresh / OriginParts);
  const double kept = previous / OriginParts;
  if ((previous == 0 || spread.Low >= kept) && spread.LevelsFrom(kept) <= std::min(own, whole))
  {
    return previous;
  }
  return own <= FewLevels && own < whole ? static_cast<std::uint32_t>(fresh) : 0;
}

/// Calls function(Field) with the values in their own type.
template <class Function>
void WithField(const PaperQuantizer& quantizer, ScalarType type, const void* values,
  const glm::ivec3& samples, int stride, Function&& function)
{
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      function(Field<T>{ static_cast<const T*>(values), static_cast<std::size_t>(stride), samples,
        Scale(quantizer) });
    });
}

/// Calls body(number, box) for each subdomain, x fastest.
template <class Body>
void ForSubdomains(const glm::ivec3& samples, int edge, Body&& body)
{
  std::size_t number = 0;
  for (int z = 0; z < samples.z; z += edge)
  {
    for (int y = 0; y < samples.y; y += edge)
    {
      for (int x = 0; x < samples.x; x += edge)
      {
        const glm::ivec3 at(x, y, z);
        body(number++, Box{ at, glm::min(at + edge, samples) });
      }
    }
  }
}

} // namespace

double PaperQuantizer::LevelWidth() const
{
  const double half = this->Range.Empty() ? 0.0 : 0.5 * this->Range.High - 0.5 * this->Range.Low;
  return half / static_cast<double>(1 << this->Bits) * 2.0;
}

std::uint16_t PaperQuantizer::CodeOf(double value) const
{
  const Scale scale(*this);
  return scale.CodeAt(scale.PositionOf(value));
}

double PaperQuantizer::ValueOf(std::uint16_t code) const
{
  return ValueOfAdaptive(*this, 0, code);
}

double ValueOfAdaptive(const PaperQuantizer& quantizer, std::uint32_t origin, std::uint16_t code)
{
  const double position = origin / OriginParts + code + 0.5;
  return 2.0 * (0.5 * quantizer.Range.Low + position * (0.5 * quantizer.LevelWidth()));
}

std::vector<std::uint16_t> QuantizeUniform(const PaperQuantizer& quantizer, ScalarType type,
  const void* values, std::int64_t count, int stride)
{
  std::vector<std::uint16_t> codes(static_cast<std::size_t>(count));
  WithField(quantizer, type, values, glm::ivec3(1), stride,
    [&codes](const auto& field)
    {
      for (std::size_t i = 0; i < codes.size(); ++i)
      {
        codes[i] = field.Levels.CodeAt(
          field.Levels.PositionOf(static_cast<double>(field.Values[i * field.Stride])));
      }
    });
  return codes;
}

AdaptiveCodes QuantizeAdaptive(const PaperQuantizer& quantizer, ScalarType type, const void* values,
  const glm::ivec3& samples, int subdomain, const AdaptiveCodes* previous, int stride)
{
  const glm::ivec3 grid = (samples + (subdomain - 1)) / subdomain;
  AdaptiveCodes adaptive;
  adaptive.Codes.resize(static_cast<std::size_t>(Box{ glm::ivec3(0), samples }.Count()));
  adaptive.Origins.resize(static_cast<std::size_t>(Box{ glm::ivec3(0), grid }.Count()), 0);
  if (previous && previous->Origins.size() != adaptive.Origins.size())
  {
    throw Error("The step before has another number of subdomains",
      { {}, {}, previous->Origins.size(), adaptive.Origins.size() });
  }
  WithField(quantizer, type, values, samples, stride,
    [&](const auto& field)
    {
      ForSubdomains(samples, subdomain,
        [&](std::size_t number, const Box& box)
        {
          const std::uint32_t before = previous ? previous->Origins[number] : 0;
          const std::uint32_t origin = OriginOf(field.SpreadOf(box), before);
          adaptive.Origins[number] = origin;
          adaptive.OriginBits +=
            1 + (origin == before ? 0 : 8 + static_cast<std::uint64_t>(quantizer.Bits));
          field.ForVoxels(box, [&](std::size_t i, double position)
            { adaptive.Codes[i] = field.Levels.CodeAt(position - origin / OriginParts); });
        });
    });
  return adaptive;
}

} // namespace banyan
