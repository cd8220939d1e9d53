// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BlockDecoder.h"

#include "Base/Error.h"
#include "Codec/Simd/BlockKernels.h"

namespace banyan
{
namespace
{

template <class Number>
void DecodeBoxOf(int edge, const PlaneCode& plane, const BoxCodeOf<Number>& code, Number* box)
{
  if (edge != 16 && edge != 32)
  {
    throw Error("A block must have an edge of 16 or 32 samples");
  }
  edge == 16 ? DecodeBox16(plane, code, box) : DecodeBox32(plane, code, box);
}

} // namespace

void DecodeBox(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box)
{
  DecodeBoxOf(edge, plane, code, box);
}

void DecodeBox(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box)
{
  DecodeBoxOf(edge, plane, code, box);
}

} // namespace banyan
