#include "Series/Quantizer.h"

#include "Base/Error.h"
#include "Base/ForEachScalarType.h"
#include "Series/Bytes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

bool IsReal(ScalarType type)
{
  return type == ScalarType::Float32 || type == ScalarType::Float64;
}

/// Half the distance of two neighbours of a type around a magnitude: what output rounding may add.
double HalfUlp(ScalarType type, double magnitude)
{
  const double next = type == ScalarType::Float32
                        ? static_cast<double>(std::nextafter(
                            static_cast<float>(magnitude), std::numeric_limits<float>::infinity()))
                        : std::nextafter(magnitude, std::numeric_limits<double>::infinity());
  const double ulp =
    next -
    (type == ScalarType::Float32 ? static_cast<double>(static_cast<float>(magnitude)) : magnitude);
  return std::isfinite(ulp) ? 0.5 * ulp : 0.5 * std::numeric_limits<double>::epsilon() * magnitude;
}

/// The multiple of the step next to an origin: 0 then lies on the lattice and decodes to 0. Many
/// fields are 0 almost everywhere; a constant error there would be the most visible of all.
double OriginThroughZero(double origin, double step)
{
  const double multiple = std::round(origin / step);
  return step > 0 && std::abs(multiple) < 0x1p52 ? multiple * step : origin;
}

Quantizer MakeReal(ScalarType type, double bound, const ValueRange& expected)
{
  Quantizer quantizer;
  quantizer.Bound = bound;
  if (bound > 0)
  {
    quantizer.Origin = expected.Empty() ? 0.0 : expected.Low;
    const double magnitude =
      expected.Empty() ? 0.0 : std::max(std::abs(expected.Low), std::abs(expected.High));
    // The lattice may use what output rounding leaves of the bound; the relative margin covers the
    // rounding of this very arithmetic. Each value is verified all the same.
    const double usable = bound * (1.0 - 0x1p-20) - HalfUlp(type, magnitude);
    quantizer.Step = usable > 0 ? 2.0 * usable : 0.0;
    if (!std::isfinite(quantizer.Step))
    {
      quantizer.Step = std::numeric_limits<double>::max() / 4;
    }
    quantizer.Origin = OriginThroughZero(quantizer.Origin, quantizer.Step);
  }
  return quantizer;
}

Quantizer MakeInteger(double bound)
{
  Quantizer quantizer;
  quantizer.Bound = bound;
  const double limit = 0x1p62; // beyond, every 64-bit value would decode to 0 or the type's ends
  const std::uint64_t half = static_cast<std::uint64_t>(std::floor(std::min(bound, limit)));
  quantizer.IntegerStep = 2 * half + 1;
  return quantizer;
}

/// Magnitudes of the greatest and least value of a type.
template <class T>
constexpr std::uint64_t MagnitudeLimit(bool negative)
{
  return static_cast<std::uint64_t>(std::numeric_limits<T>::max()) + (negative ? 1 : 0);
}

template <class T>
struct IntegerLattice
{
  using Number = LatticeNumber<T>;
  std::uint64_t Step;
  std::uint64_t Half = Step / 2;
  std::uint64_t LastPositive = MagnitudeLimit<T>(false) / Step;
  std::uint64_t LastNegative = MagnitudeLimit<T>(true) / Step;

  std::uint64_t Nearest(std::uint64_t magnitude) const
  {
    return magnitude / this->Step + (magnitude % this->Step > this->Half ? 1 : 0);
  }

  Number NumberOf(T value) const
  {
    if (value < 0)
    {
      const std::uint64_t number = this->Nearest(0 - static_cast<std::uint64_t>(value));
      return static_cast<Number>(0 - number);
    }
    return static_cast<Number>(this->Nearest(static_cast<std::uint64_t>(value)));
  }

  T ValueOf(Number number) const
  {
    if (number < 0)
    {
      const std::uint64_t magnitude = 0 - static_cast<std::uint64_t>(number);
      return magnitude > this->LastNegative ? std::numeric_limits<T>::min()
                                            : static_cast<T>(0 - magnitude * this->Step);
    }
    const std::uint64_t magnitude = static_cast<std::uint64_t>(number);
    return magnitude > this->LastPositive ? std::numeric_limits<T>::max()
                                          : static_cast<T>(magnitude * this->Step);
  }
};

template <class T>
bool QuantizeReal(
  const Quantizer& quantizer, const T* values, std::size_t count, std::int32_t* numbers, T* decoded)
{
  if (!(quantizer.Step > 0))
  {
    std::copy(values, values + count, decoded);
    std::fill(numbers, numbers + count, 0);
    return false;
  }
  const double origin = quantizer.Origin;
  const double step = quantizer.Step;
  const double bound = quantizer.Bound;
  // Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, without a library call.
  constexpr double rounder = 6755399441055744.0;
  int left = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double value = static_cast<double>(values[i]);
    double number = ((value - origin) / step + rounder) - rounder;
    number = std::abs(number) <= LatticeLimit ? number : 0.0;
    const T onLattice = static_cast<T>(origin + number * step);
    const bool holds = std::abs(static_cast<double>(onLattice) - value) <= bound;
    decoded[i] = holds ? onLattice : values[i];
    numbers[i] = static_cast<std::int32_t>(holds ? number : 0.0);
    left |= holds ? 0 : 1;
  }
  return left == 0;
}

template <class T>
bool QuantizeInteger(const Quantizer& quantizer, const T* values, std::size_t count,
  LatticeNumber<T>* numbers, T* decoded)
{
  if (quantizer.IntegerStep == 1)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      numbers[i] = static_cast<LatticeNumber<T>>(values[i]);
      decoded[i] = values[i];
    }
    return true;
  }
  const IntegerLattice<T> lattice{ quantizer.IntegerStep };
  for (std::size_t i = 0; i < count; ++i)
  {
    numbers[i] = lattice.NumberOf(values[i]);
    decoded[i] = lattice.ValueOf(numbers[i]);
  }
  return true;
}

} // namespace

std::uint64_t Quantizer::OriginBits(ScalarType type) const
{
  return IsReal(type) ? BitCast<std::uint64_t>(this->Origin) : 0;
}

std::uint64_t Quantizer::StepBits(ScalarType type) const
{
  return IsReal(type) ? BitCast<std::uint64_t>(this->Step) : this->IntegerStep;
}

Quantizer MakeQuantizer(ScalarType type, double bound, const ValueRange& expected)
{
  if (!(bound >= 0) || !std::isfinite(bound))
  {
    throw Error("An error bound must be finite and not negative");
  }
  return IsReal(type) ? MakeReal(type, bound, expected) : MakeInteger(bound);
}

Quantizer QuantizerFromBits(ScalarType type, std::uint64_t origin, std::uint64_t step)
{
  Quantizer quantizer;
  if (IsReal(type))
  {
    quantizer.Origin = BitCast<double>(origin);
    quantizer.Step = BitCast<double>(step);
    if (!std::isfinite(quantizer.Origin) || !std::isfinite(quantizer.Step) || quantizer.Step < 0)
    {
      throw Error("The quantizer of a node table is not valid");
    }
    return quantizer;
  }
  if (step % 2 == 0 || origin != 0)
  {
    throw Error("The quantizer of a node table is not valid");
  }
  quantizer.IntegerStep = step;
  return quantizer;
}

template <class T>
bool Quantize(const Quantizer& quantizer, const T* values, std::size_t count,
  LatticeNumber<T>* numbers, T* decoded)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return QuantizeReal(quantizer, values, count, numbers, decoded);
  }
  else
  {
    return QuantizeInteger(quantizer, values, count, numbers, decoded);
  }
}

template <class T>
void Dequantize(const Quantizer& quantizer, std::int64_t base, const std::uint32_t* offsets,
  std::size_t count, T* decoded)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    const double first = static_cast<double>(base);
    for (std::size_t i = 0; i < count; ++i)
    {
      // Offsets of real types stay below 2^31; the detour over int32 converts eight times faster.
      const double number = first + static_cast<double>(static_cast<std::int32_t>(offsets[i]));
      decoded[i] = static_cast<T>(quantizer.Origin + number * quantizer.Step);
    }
  }
  else
  {
    const std::uint64_t first = static_cast<std::uint64_t>(base);
    if (quantizer.IntegerStep == 1)
    {
      for (std::size_t i = 0; i < count; ++i)
      {
        decoded[i] = static_cast<T>(first + offsets[i]);
      }
      return;
    }
    const IntegerLattice<T> lattice{ quantizer.IntegerStep };
    for (std::size_t i = 0; i < count; ++i)
    {
      decoded[i] = lattice.ValueOf(static_cast<LatticeNumber<T>>(first + offsets[i]));
    }
  }
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template bool Quantize<T>(const Quantizer&, const T*, std::size_t, LatticeNumber<T>*, T*);       \
  template void Dequantize<T>(const Quantizer&, std::int64_t, const std::uint32_t*, std::size_t, T*)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
