// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_DenseInterior_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_DenseInterior_inl_h
#undef banyan_Codec_DenseInterior_inl_h
#else
#define banyan_Codec_DenseInterior_inl_h
#endif

#include "Codec/BlockDecoder.h"
#include "Codec/BlockUnits-inl.h"
#include "Codec/DecodeStages.h"
#include "Codec/DenseWork-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE

/// Calls body(index) for the vectors of a box of 17^3 samples and last(index) for the sample behind
/// them.
template <class Body, class Last>
HWY_INLINE void ForBox(const Body& body, const Last& last)
{
  constexpr int count = 17 * 17 * 17;
  static_assert(count % Width == 1, "one sample is left");
  for (int i = 0; i + Width <= count; i += Width)
  {
    body(i);
  }
  last(count - 1);
}

/// Decodes the interior of a block of 16 in the box itself. Where there are references they are
/// subtracted from the whole box, and added again: borders come back as they were.
/// @param unit its samples are the box, `[z][y][x]`
template <class Number, class Ask>
void DecodeDenseInterior(Unit<Number, 3>& unit, const References<Number>& references,
  Interpolation by, const PlaneCode& plane, SymbolReader* symbols, DenseWork& work, const Ask& ask)
{
  using V = Numbers<Number>;
  using Signed = typename V::Signed;
  using U = std::make_unsigned_t<Number>;
  Number* const w = unit.W;
  const bool refers = references.From != block::Reference::None;
  const Number* const a = refers ? references.A.Base : w;
  const Number* const b = refers ? references.B.Base : w;
  WithReference<Number>(references.From,
    [&](auto reference)
    {
      if (refers)
      {
        ForBox([&](int i)
          { StoreVector(V::Load(w + i) - reference.Of(V::Load(a + i), V::Load(b + i)), w + i); },
          [&](int i) {
            w[i] =
              static_cast<Number>(static_cast<U>(w[i]) - static_cast<U>(reference.Of(a[i], b[i])));
          });
      }
    });
  ForEachPass<3>(
    [&](auto pass)
    {
      using P = decltype(pass);
      ask(P::S == 2 ? 12 : 48);
      const stages::In stage(stages::Passes);
      BeginStride<P>(work.Interior, symbols);
      DenseSliceDecoder<P, Number>(unit, work.Interior.template At<P::S>(), by, symbols,
        static_cast<Number>(P::S == 2 ? plane.CoarseBin : plane.FineBin), work.Slice)
        .Run();
    });
  const Number least = static_cast<Number>(plane.Least);
  const Number greatest = static_cast<Number>(plane.Greatest);
  const Signed low = Signed{} + least;
  const Signed high = Signed{} + greatest;
  WithReference<Number>(references.From,
    [&](auto reference)
    {
      ForBox(
        [&](int i)
        {
          Signed value =
            reinterpret_cast<Signed>(V::Load(w + i) + reference.Of(V::Load(a + i), V::Load(b + i)));
          value = value < low ? low : value;
          value = value > high ? high : value;
          StoreVector(value, w + i);
        },
        [&](int i)
        {
          const Number sum =
            static_cast<Number>(static_cast<U>(w[i]) + static_cast<U>(reference.Of(a[i], b[i])));
          w[i] = std::min(std::max(sum, least), greatest);
        });
    });
}

#else
template <class Number, class... Arguments>
void DecodeDenseInterior(Unit<Number, 3>&, const Arguments&...);
template <class P, class Units>
void BeginStride(Units&, const SymbolReader*);
#endif
} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
