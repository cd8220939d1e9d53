// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_RowQuantizer_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_RowQuantizer_inl_h
#undef banyan_Codec_RowQuantizer_inl_h
#else
#define banyan_Codec_RowQuantizer_inl_h
#endif

#include "Codec/Simd/Contexts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Nearest multiples of a bin. The bin is odd, so nothing lies half way, and the arithmetic is far
/// more exact than what is left to the next half.
template <int N, bool One>
HWY_INLINE PackOf<std::int32_t, N, One> Quantize(
  const PackOf<std::int32_t, N, One>& rest, std::int32_t bin)
{
  using Reals = Pack<double, N>;
  const Reals rounder = Reals::Set(6755399441055744.0); // 1.5 * 2^52: adding it rounds
  const Reals bins = Widen<double>(rest) * Reals::Set(1.0 / bin);
  return Narrow<std::int32_t>((bins + rounder) - rounder);
}
template <int N, bool One>
HWY_INLINE PackOf<std::int16_t, N, One> Quantize(
  const PackOf<std::int16_t, N, One>& rest, std::int16_t bin)
{
  const auto bins = ToFloats(Widen<std::int32_t>(rest)) * Pack<float, N>::Set(1.0f / bin);
  return Narrow<std::int16_t>(ToNearest(bins));
}

/// Quantizes the residuals of rows, and sets rows and magnitudes to what they decode to.
template <class P, int B, class Number>
struct RowQuantizer
{
  using V = Samples<Number>;

  Unit<Number, P::D>& Of;
  Interpolation By;
  const Number* Target; ///< same layout as the unit's samples, what they are to become
  Number Bin;

  /// Calls body(At, residuals, classes, what residuals before hint at) for each Width lanes from
  /// First + At on; residuals of lanes that the pass does not have are 0.
  /// @param active whether magnitudes around may be other than 0
  /// @param flagged whether nobody asks for the residuals where all of a row are 0; magnitudes must
  /// be 0 already
  /// @return whether some residual is not 0
  template <class Body>
  HWY_INLINE bool Row(const RowPlace& place, bool active, bool flagged, const Body& body) const
  {
    V any = V::Set(0);
    ForEachPart<B>(
      [&](auto at) { any = any | this->template Part<at()>(place, active, flagged, body); });
    return AnyBit(any);
  }

  /// Sets the magnitudes and kept residuals of lanes from First + At on.
  template <int At>
  HWY_INLINE void Keep(const RowPlace& place, const V& residual) const
  {
    const SignedBytes kept = Narrow<std::int8_t>(Limited(residual, Number{ 15 }));
    const Bytes lanes = LanesOfPass<P, B, At, std::uint8_t>();
    const Bytes size = MagnitudesOf(kept) & lanes;
    std::uint8_t* const m = this->Of.Magnitudes + place.Magnitude + P::First + At;
    Select(lanes, size, Bytes::Load(m)).Store(m);
    const int slice = P::D == 3 ? place.Z : P::D == 2 ? place.Y : 0;
    std::uint16_t& sum = this->Of.RowSums[slice * block::Shape<P::D>{ B }.SumPitch() + place.Row];
    sum = static_cast<std::uint16_t>(sum + SumOfBytes(size));
    if constexpr (P::D > 1)
    {
      SetLanes<P, B, At>(kept, this->Of.Residuals + place.Magnitude + P::First + At);
    }
  }

private:
  template <int At, class Body>
  HWY_INLINE V Part(const RowPlace& place, bool active, bool flagged, const Body& body) const
  {
    Number* const w = this->Of.Samples + place.Sample + P::First + At;
    const V prediction = Predict<P, B, At>(this->Of.Samples, place, this->By);
    const int lanes = place.Coded * P::Step - At;
    if (lanes <= 0)
    {
      SetLanes<P, B, At>(prediction, w);
      return V::Set(0);
    }
    V residual = V::Load(this->Target + place.Sample + P::First + At) - prediction;
    residual = residual & LanesOfPassBelow<P, Number>(lanes);
    if (B <= Width && flagged && !this->AnyCoded(residual))
    {
      SetLanes<P, B, At>(prediction, w);
      return V::Set(0);
    }
    residual = Quantize(residual, this->Bin);
    Bytes classes = Bytes::Set(0);
    SignedBytes hint = SignedBytes::Set(0);
    if (active)
    {
      const std::ptrdiff_t from = place.Magnitude + P::First + At;
      const Bytes activity = LocalActivity<P, B>(this->Of.Magnitudes + from, place);
      classes = ActivityClasses(activity);
      hint = HintOf<P, B>(this->Of.Residuals + from, place, activity);
    }
    body(std::integral_constant<int, At>(), residual, classes, hint);
    SetLanes<P, B, At>(prediction + residual * V::Set(this->Bin), w);
    return residual;
  }

  /// Whether some difference is more than half a bin.
  HWY_INLINE bool AnyCoded(const V& difference) const
  {
    const Number half = static_cast<Number>(this->Bin / 2);
    return AnyBit((difference > V::Set(half)) | (V::Set(static_cast<Number>(-half)) > difference));
  }
};

/// Classes of the rows of a slice: all the least where no residual is known yet.
template <class P, int B, class Number>
HWY_INLINE void KnownRowClasses(const Unit<Number, P::D>& unit, int slice, std::uint8_t* to)
{
  if (unit.Any)
  {
    return RowClasses<P, B>(unit, slice, to);
  }
  std::fill_n(to, P::EndOfRows(B), std::uint8_t{ 0 });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
