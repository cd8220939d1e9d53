// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_ComponentRange_h
#define banyan_Series_Quantize_ComponentRange_h

#include "Base/ScalarType.h"
#include "Series/Quantize/ValueRange.h"

#include <cstdint>

namespace banyan
{

class ThreadPool;

/// Extremes of the finite values of a component, outward for 64-bit integers.
/// @param values `[tuples][components]`
/// @param hidden by tuple: those where it is not 0 do not count; may be null
ValueRange RangeOfComponent(ScalarType type, const void* values, std::int64_t tuples,
  int components, int component, ThreadPool& pool, const std::uint8_t* hidden = nullptr);

} // namespace banyan

#endif
