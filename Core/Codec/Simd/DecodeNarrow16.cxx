// SPDX-License-Identifier: BSD-3-Clause
// One of four sources for the same kernels: together they would take minutes to compile.
#include "Codec/Simd/BlockKernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/Simd/DecodeNarrow16.cxx"
#include <hwy/foreach_target.h>

#include "Codec/Simd/BoxDecoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

void DecodeNarrow16(const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box)
{
  DecodeBoxOf<16>(plane, code, box);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(DecodeNarrow16);

void DecodeBox16(const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box)
{
  HWY_DYNAMIC_DISPATCH(DecodeNarrow16)(plane, code, box);
}

} // namespace banyan
#endif
