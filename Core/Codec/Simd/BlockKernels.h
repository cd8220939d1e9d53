// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_BlockKernels_h
#define banyan_Codec_BlockKernels_h

#include "Codec/BlockDecoder.h"
#include "Codec/BlockJob.h"

namespace banyan
{

/// DecodeBox for blocks with an edge of 16 or 32, with the instructions of this processor.
void DecodeBox16(const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box);
void DecodeBox16(const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box);
void DecodeBox32(const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box);
void DecodeBox32(const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box);

/// Runs a phase of the block at a position, for numbers of 16 or 32 bits and blocks with an edge of
/// 16 or 32, with the instructions of this processor. Positions may lie one beyond the last block:
/// what the field's last blocks share with none is predicted only.
void EncodeBlockNarrow16(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase);
void EncodeBlockNarrow32(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase);
void EncodeBlockWide16(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase);
void EncodeBlockWide32(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase);

} // namespace banyan

#endif
