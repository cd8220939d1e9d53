// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_RateEstimate_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_RateEstimate_inl_h
#undef banyan_Codec_RateEstimate_inl_h
#else
#define banyan_Codec_RateEstimate_inl_h
#endif

#include "Codec/Simd/RowQuantizer-inl.h"

#ifndef banyan_Codec_RateEstimate_once
#define banyan_Codec_RateEstimate_once
namespace banyan
{

/// Costs of flags of rows by the class of the row, in 256ths of a bit, measured on smooth series;
/// rows of the last class have none.
constexpr std::int64_t ZeroRowCosts[residual::RowClasses + 1] = { 11, 19, 31, 56, 78, 101, 137, 171,
  208, 287, 409, 512, 0 };
constexpr std::int64_t OtherRowCosts[residual::RowClasses + 1] = { 1295, 1107, 933, 726, 613, 527,
  432, 367, 312, 228, 148, 106, 0 };

} // namespace banyan
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Encodes slices as SliceEncoder does, and only adds up what they would cost.
template <class P, int B, class Number>
struct RateEstimate
{
  using V = Samples<Number>;

  RowQuantizer<P, B, Number> Rows;

  /// In 256ths of a bit, about.
  /// @param enough ends where that is reached
  HWY_INLINE std::int64_t Run(std::int64_t enough) const
  {
    std::int64_t cost = 0;
    for (int slice = P::FirstSlice; slice < P::EndOfSlices(B) && cost < enough;
         slice += P::SliceStep)
    {
      std::uint8_t rowClasses[B + Width];
      KnownRowClasses<P, B>(this->Rows.Of, slice, rowClasses);
      bool anyOfSlice = false;
      for (int row = P::FirstRow; row < P::EndOfRows(B); row += P::RowStep)
      {
        const RowPlace place = PlaceOf<P, B>(this->Rows.Of, slice, row);
        const int rowClass = rowClasses[row];
        std::int64_t symbols = 0;
        const bool any = this->Rows.Row(place, rowClass > 0, rowClass < residual::RowClasses,
          [&](auto at, const V& residual, const Bytes& classes, const SignedBytes&)
          {
            this->Rows.template Keep<at()>(place, residual);
            symbols += CostOf(
              residual, classes, LanesOfPassBelow<P, std::int16_t>(place.Coded * P::Step - at()));
          });
        anyOfSlice = anyOfSlice || any;
        if (place.Coded > 0)
        {
          const bool coded = any || rowClass == residual::RowClasses;
          cost += coded ? OtherRowCosts[rowClass] + symbols : ZeroRowCosts[rowClass];
        }
      }
      this->Rows.Of.Any = this->Rows.Of.Any || anyOfSlice;
    }
    return cost;
  }

private:
  using Costs = Pack<std::int16_t, Width>;

  /// About how many 256ths of a bit residuals take in their classes of activity: as if they fell
  /// off geometrically, with means from 0.02 to 5. Integers, so that every machine chooses the
  /// same.
  static HWY_INLINE std::int64_t CostOf(const V& residual, const Bytes& classes, const Costs& lanes)
  {
    // Residuals beyond cost little more.
    const V size = Min(Abs(residual), V::Set(Number{ 16 }));
    Costs sizes;
    if constexpr (sizeof(Number) == sizeof(std::int16_t))
    {
      sizes = size;
    }
    else
    {
      sizes = Narrow<std::int16_t>(size);
    }
    // Quarters of the costs, which bytes hold.
    const Costs zero = Widen<std::int16_t>(LookUp<2, 9, 22, 44, 74, 106, 150, 214>(classes));
    const Costs step = Widen<std::int16_t>(LookUp<213, 138, 98, 67, 45, 30, 18, 9>(classes));
    const Costs cost = (ShiftLeft<2>(zero) + ShiftLeft<3>(step) * sizes) & lanes;
    // None is negative: pairs are summed up as numbers of 32 bits.
    return SumOfPairs(cost);
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
