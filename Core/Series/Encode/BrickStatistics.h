// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_BrickStatistics_h
#define banyan_Series_Encode_BrickStatistics_h

#include "Series/Quantize/ValueRange.h"

#include <cstddef>

namespace banyan
{

/// Holds what a node keeps of a brick's decoded samples.
struct BrickSummary
{
  ValueRange Range; ///< of the finite samples; outward for 64-bit integers
  bool HasNonFinite = false;
  bool Uniform = false; ///< one finite value with one bit pattern, which Range.Low holds exactly
};

template <class T>
BrickSummary Summarize(const T* decoded, std::size_t count);

} // namespace banyan

#endif
