// SPDX-License-Identifier: BSD-3-Clause
#include "Deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan::bench
{
namespace
{

double ErrorOf(float original, float decoded)
{
  if (std::isfinite(original) && std::isfinite(decoded))
  {
    return std::abs(static_cast<double>(decoded) - static_cast<double>(original));
  }
  const bool same = original == decoded || (std::isnan(original) && std::isnan(decoded));
  return same ? 0.0 : std::numeric_limits<double>::infinity();
}

} // namespace

void Deviation::Include(const float* original, const float* decoded, std::size_t count)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const double error = ErrorOf(original[i], decoded[i]);
    this->LargestError = std::max(this->LargestError, error);
    this->SumOfSquares += error * error;
  }
  this->Count += count;
}

double Deviation::RootMeanSquare() const
{
  return this->Count == 0 ? 0.0 : std::sqrt(this->SumOfSquares / static_cast<double>(this->Count));
}

double Deviation::SignalToNoiseDecibels(double range) const
{
  const double noise = this->RootMeanSquare();
  return noise == 0 ? std::numeric_limits<double>::infinity() : 20 * std::log10(range / noise);
}

} // namespace banyan::bench
