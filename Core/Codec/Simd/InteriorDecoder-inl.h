// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_InteriorDecoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_InteriorDecoder_inl_h
#undef banyan_Codec_InteriorDecoder_inl_h
#else
#define banyan_Codec_InteriorDecoder_inl_h
#endif

#include "Codec/BlockDecoder.h"
#include "Codec/DecodeStages.h"
#include "Codec/Simd/BoxMemory-inl.h"
#include "Codec/Simd/UnitMagnitudes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Decodes the interior of a block of edge B. Where there are references they are subtracted from
/// the whole box, and added again: borders come back as they were.
/// @param unit its samples are those of the box
/// @param to receives the whole box, `[z][y][x]`
/// @param prefetch asks for a number of lines of the cache that the next block needs
template <int B, class Number, class Prefetch>
void DecodeInterior(Unit<Number, 3>& unit, const block::Mode& mode, const PlaneCode& plane,
  SymbolReader* reader, BoxMagnitudes<B>& magnitudes, BoxMemory<Number, B>& box,
  const Prefetch& prefetch, Number* to)
{
  const bool refers = mode.From != block::Reference::None;
  if (refers)
  {
    box.Subtract();
  }
  ForEachPass<3>(
    [&](auto pass)
    {
      using P = decltype(pass);
      prefetch(P::S == 2 ? 12 : 48);
      const stages::In stage(stages::Passes);
      BeginStride<P>(magnitudes.Interior, reader);
      SliceDecoder<P, B, Number>(unit, magnitudes.Interior.template At<P::S>(), mode.By, reader,
        static_cast<Number>(P::S == 2 ? plane.CoarseBin : plane.FineBin), magnitudes.Slice)
        .Run();
    });
  box.Finish(refers, static_cast<Number>(plane.Least), static_cast<Number>(plane.Greatest), to);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
