// SPDX-License-Identifier: BSD-3-Clause
// One of two sources for the same kernels, for numbers of 16 bits.
#include "Codec/BlockJob.h"
#include "Codec/Simd/BoxKernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/Simd/EncodeNarrow.cxx"
#include <hwy/foreach_target.h>

#include "Codec/Simd/BlockCoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

void EncodeNarrow(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  job.Decoded->Edge == 32 ? EncodeBlockOf<32, std::int16_t>(job, position, phase)
                          : EncodeBlockOf<16, std::int16_t>(job, position, phase);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(EncodeNarrow);

void EncodeBlockNarrow(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  HWY_DYNAMIC_DISPATCH(EncodeNarrow)(job, position, phase);
}

} // namespace banyan
#endif
