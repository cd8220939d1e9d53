// SPDX-License-Identifier: BSD-3-Clause
// One of four sources for the same kernels: together they would take minutes to compile.
#include "Codec/Simd/BlockKernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Codec/Simd/DecodeWide32.cxx"
#include <hwy/foreach_target.h>

#include "Codec/Simd/BoxDecoder-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

void DecodeWide32(const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box)
{
  DecodeBoxOf<32>(plane, code, box);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(DecodeWide32);

void DecodeBox32(const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box)
{
  HWY_DYNAMIC_DISPATCH(DecodeWide32)(plane, code, box);
}

} // namespace banyan
#endif
