// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_FieldToEncode_h
#define banyan_Series_Encode_FieldToEncode_h

#include "Series/Encode/FieldGroup.h"
#include "Series/Encode/SeriesEncoder.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// The steps of a component, clamped.
struct ClampedSteps
{
  std::vector<std::vector<std::uint8_t>> Values; ///< kept alive for the field
  std::int64_t Count = 0;
};

/// A component over some steps, with the values that are encoded.
struct FieldToEncode
{
  FieldGroup Field;
  ClampedSteps Clamped;
};

/// Whether the plan fixes the range of a component for all of the series.
inline bool IsPromised(const ComponentIndex& component)
{
  return !component.PromisedRange.Empty();
}

/// Whether values may lie outside of the range that the plan fixes.
inline bool GoesBeyond(const ComponentIndex& component)
{
  return component.RangeFrom != RangeRule::Source::Data && !component.ClampOutside;
}

/// @param steps values by step and array
FieldToEncode MakeField(const SeriesIndex& plan, const EncodeOptions& options, std::size_t array,
  std::size_t component, const std::vector<std::vector<ArrayValues>>& steps, ThreadPool& pool);

} // namespace banyan

#endif
