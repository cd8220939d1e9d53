// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/FieldLattice.h"

#include "Codec/BlockScratch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Bins of the finest plane: fine enough that rounding predictions to the lattice costs nothing.
constexpr std::int32_t FineBin = 31;

bool IsReal(ScalarType type)
{
  return type == ScalarType::Float32 || type == ScalarType::Float64;
}

/// The same range and its width at either end, in the transformed domain; some steps of the lattice
/// when it has no width. Where that leads to infinity the range stays as it is.
ValueRange Widened(const Transform& transform, const ValueRange& range, double bound)
{
  constexpr double leastBounds = 64;
  const double low = transform.Forward(range.Low);
  const double high = transform.Forward(range.High);
  const double width = std::max(high - low, leastBounds * bound);
  const ValueRange wide{ transform.Inverse(low - width), transform.Inverse(high + width) };
  const bool good = std::isfinite(wide.Low) && std::isfinite(wide.High) &&
                    std::isfinite(low - width) && std::isfinite(high + width);
  return good && wide.Low <= range.Low && wide.High >= range.High ? wide : range;
}

/// A lattice of the number 0 alone.
void SetOneNumber(double origin, group::FieldHead& head)
{
  head.Origin = origin;
  head.Step = 1;
  head.Bin = 1;
  head.Least = 0;
  head.Greatest = 0;
}

} // namespace

void ChooseLattice(ScalarType type, const Transform& transform, double bound,
  const ValueRange& expected, bool beyond, group::FieldHead& head)
{
  const ValueRange inner = expected.Empty() ? ValueRange{ 0.0, 0.0 } : expected;
  const ValueRange range = beyond ? Widened(transform, inner, bound) : inner;
  const double low = transform.Forward(range.Low);
  const double high = transform.Forward(range.High);
  head.Exact = false;
  head.Bin = FineBin;
  if (!IsReal(type) && transform.IsIdentity() && bound < 16)
  {
    head.Step = 1.0;
    head.Bin = 2 * static_cast<std::int32_t>(std::floor(bound)) + 1;
  }
  else
  {
    // This is what output rounding leaves of the bound; the relative margin covers the rounding of
    // this very arithmetic. Each value is verified all the same.
    const double usable = bound * (1.0 - 0x1p-20) - transform.OutputRounding(type, range);
    head.Step = 2.0 * usable / FineBin;
    head.Exact = !(usable > 0) || !std::isnormal(head.Step);
  }
  if (low == high)
  {
    // One value: it is the lattice.
    head.Exact = false;
    SetOneNumber(low, head);
    return;
  }
  const double limit = GreatestLatticeNumber / 2;
  const double greatest = std::max(std::abs(low), std::abs(high));
  head.Exact = head.Exact || (high - low) / head.Step > limit;
  if (head.Exact)
  {
    SetOneNumber(0, head);
    return;
  }
  head.Origin = greatest / head.Step < limit ? 0.0 : std::round(low / head.Step) * head.Step;
  if (!std::isfinite(head.Origin))
  {
    head.Origin = low;
  }
  const double first = std::round((low - head.Origin) / head.Step);
  const double last = std::round((high - head.Origin) / head.Step);
  if (last - first < limit && block::Narrow(0, static_cast<std::int32_t>(last - first)) &&
      !block::Narrow(static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)))
  {
    // A short range far from zero: begin with it, so that its numbers are small.
    head.Origin += first * head.Step;
  }
  head.Least = static_cast<std::int32_t>(std::round((low - head.Origin) / head.Step));
  head.Greatest = static_cast<std::int32_t>(std::round((high - head.Origin) / head.Step));
}

} // namespace banyan
