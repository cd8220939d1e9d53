// SPDX-License-Identifier: BSD-3-Clause
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
  std::uint64_t LastPositive = MagnitudeLimit<T>(false) / Step;
  std::uint64_t LastNegative = MagnitudeLimit<T>(true) / Step;

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

} // namespace

std::uint64_t Quantizer::OriginBits(ScalarType type) const
{
  return IsReal(type) ? BitCast<std::uint64_t>(this->Origin) : 0;
}

std::uint64_t Quantizer::StepBits(ScalarType type) const
{
  return IsReal(type) ? BitCast<std::uint64_t>(this->Step) : this->IntegerStep;
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
  template void Dequantize<T>(const Quantizer&, std::int64_t, const std::uint32_t*, std::size_t, T*)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
