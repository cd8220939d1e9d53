// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_ScalarBlock_h
#define banyan_Testing_ScalarBlock_h

#include "Codec/BlockDecoder.h"

#include <cstdint>
#include <vector>

namespace banyan::testing
{

/// What the blocks of a plane share, as the head of a field says it.
struct ScalarPlane
{
  std::vector<tans::Frequencies> Frequencies; ///< of all contexts
  std::int32_t CoarseBin = 1, FineBin = 1;
  std::int32_t Least = 0, Greatest = 0;
};

/// Decodes the box of a block as Documentation/format.md says, sample by sample: slow, obvious, and
/// written beside DecodeBox, not from it. It shares no code with Core but the descriptions of what
/// it is given.
///
/// All payloads are read to their ends, those of neighbours too. Throws std::runtime_error where a
/// payload ends too early or too late, and std::logic_error when a prediction would use a sample
/// that is not known yet.
std::vector<std::int32_t> DecodeBoxSlowly(int edge, const ScalarPlane& plane, const BoxCode& code);

} // namespace banyan::testing

#endif
