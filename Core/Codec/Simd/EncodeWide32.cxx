// SPDX-License-Identifier: BSD-3-Clause
// One of four sources for the same kernels: together they would take minutes to compile.
#include "Codec/Simd/BlockKernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/Simd/EncodeWide32.cxx"
#include <hwy/foreach_target.h>

#include "Codec/Simd/BlockCoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

void EncodeWide32(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  EncodeBlockOf<32, std::int32_t>(job, position, phase);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(EncodeWide32);

void EncodeBlockWide32(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  HWY_DYNAMIC_DISPATCH(EncodeWide32)(job, position, phase);
}

} // namespace banyan
#endif
