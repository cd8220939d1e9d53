// SPDX-License-Identifier: BSD-3-Clause
// One of four sources for the same kernels: together they would take minutes to compile.
#include "Codec/Simd/BlockKernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/Simd/EncodeNarrow16.cxx"
#include <hwy/foreach_target.h>

#include "Codec/Simd/BlockCoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

void EncodeNarrow16(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  EncodeBlockOf<16, std::int16_t>(job, position, phase);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(EncodeNarrow16);

void EncodeBlockNarrow16(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  HWY_DYNAMIC_DISPATCH(EncodeNarrow16)(job, position, phase);
}

} // namespace banyan
#endif
