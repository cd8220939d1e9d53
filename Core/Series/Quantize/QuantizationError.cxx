// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/QuantizationError.h"

#include "Base/Error.h"
#include "Base/ForEachScalarType.h"
#include "Series/Quantize/ValueArithmetic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

double PerValue(double sum, std::int64_t count)
{
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// So that a finite value that became NaN is never taken for a small error.
double NotLost(double difference)
{
  return difference == difference ? difference : std::numeric_limits<double>::infinity();
}

} // namespace

double QuantizationError::MeanSquared() const
{
  return PerValue(this->SumSquared, this->Count);
}

double QuantizationError::OpacityWeighted() const
{
  return PerValue(this->SumWeighted, this->Count);
}

double QuantizationError::MeanSquaredTransformed() const
{
  return PerValue(this->SumSquaredTransformed, this->Count);
}

void QuantizationError::Merge(const QuantizationError& other)
{
  this->Count += other.Count;
  this->Greatest = std::max(this->Greatest, other.Greatest);
  this->SumSquared += other.SumSquared;
  this->SumWeighted += other.SumWeighted;
  this->SumOpacity += other.SumOpacity;
  this->GreatestTransformed = std::max(this->GreatestTransformed, other.GreatestTransformed);
  this->SumSquaredTransformed += other.SumSquaredTransformed;
}

template <class T>
void AddErrors(QuantizationError& error, const Transform& transform, const OpacityFunction* opacity,
  const T* original, const T* decoded, std::size_t count)
{
  constexpr std::size_t chunk = 512;
  double before[chunk];
  double after[chunk];
  for (std::size_t start = 0; start < count; start += chunk)
  {
    const std::size_t some = std::min(chunk, count - start);
    transform.ForwardValues(original + start, some, before);
    transform.ForwardValues(decoded + start, some, after);
    for (std::size_t i = 0; i < some; ++i)
    {
      const double value = static_cast<double>(original[start + i]);
      if (!std::isfinite(value))
      {
        continue;
      }
      const double difference = NotLost(Difference(original[start + i], decoded[start + i]));
      const double transformed = NotLost(std::abs(before[i] - after[i]));
      const double weight = opacity != nullptr ? (*opacity)(value) : 1.0;
      ++error.Count;
      error.Greatest = std::max(error.Greatest, difference);
      error.SumSquared += difference * difference;
      error.SumWeighted += weight > 0 ? weight * (difference * difference) : 0.0;
      error.SumOpacity += weight;
      error.GreatestTransformed = std::max(error.GreatestTransformed, transformed);
      error.SumSquaredTransformed += transformed * transformed;
    }
  }
}

double ShareOfSquaredRange(double meanSquared, const ValueRange& range)
{
  const double root = RootShareOfRange(meanSquared, range);
  return root * root;
}

double RootShareOfRange(double meanSquared, const ValueRange& range)
{
  const double width = range.Width();
  return width > 0 ? std::sqrt(meanSquared) / width : 0.0;
}

double UniformQuantizerError(const ValueRange& range, std::int64_t levels)
{
  if (levels < 1)
  {
    throw Error("A quantizer has at least one level");
  }
  const double step = range.Width() / static_cast<double>(levels);
  return step * step / 12.0;
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template void AddErrors<T>(                                                                      \
    QuantizationError&, const Transform&, const OpacityFunction*, const T*, const T*, std::size_t)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
