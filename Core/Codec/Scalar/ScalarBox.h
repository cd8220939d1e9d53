// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_ScalarBox_h
#define banyan_Codec_ScalarBox_h

#include "Codec/BlockDecoder.h"
#include "Codec/Scalar/ScalarSymbols.h"

#include <cstdint>
#include <vector>

namespace banyan::scalar
{

/// Properties that all blocks of a plane share, as the head of a field has them.
struct Plane
{
  StateOf States; ///< of all contexts
  std::int32_t CoarseBin = 1, FineBin = 1;
  std::int32_t Least = 0, Greatest = 0;
};

/// Decodes the box of a block as Documentation/format.md says, sample by sample: slow, obvious, and
/// written beside the kernels in Codec/Simd, not from them. It shares no code with them but the
/// descriptions of what it is given. They have to give the same bits, and tests compare both.
///
/// All payloads are read to their ends, those of neighbours too. Throws Error where a payload ends
/// too early or too late, where a reference is missing, and when a prediction would use a sample
/// that is not known yet.
std::vector<std::int32_t> Decode(int edge, const Plane& plane, const BoxCode& code);

/// DecodeBox, for processors without vectors. @param Number as for DecodeBox
template <class Number>
void DecodeBox(int edge, const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box);

} // namespace banyan::scalar

#endif
