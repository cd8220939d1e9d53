// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockEncoder.cxx.
#if defined(banyan_Codec_SliceTrial_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SliceTrial_inl_h
#undef banyan_Codec_SliceTrial_inl_h
#else
#define banyan_Codec_SliceTrial_inl_h
#endif

#include "Codec/SliceEncoder-inl.h"

#ifndef banyan_Codec_SliceTrial_once
#define banyan_Codec_SliceTrial_once
namespace banyan
{

/// What flags of rows take by the class of the row, in 256ths of a bit, as smooth series have them;
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
template <class P, class Edge, class Number>
struct SliceTrial
{
  using Signed = typename Numbers<Number>::Signed;

  RowQuantizer<P, Edge, Number> Rows;

  /// In 256ths of a bit, about.
  /// @param enough ends where that is reached
  HWY_INLINE std::int64_t Run(std::int64_t enough) const
  {
    const Edge& edge = this->Rows.B;
    std::int64_t cost = 0;
    const int slices = P::EndOfSlices(edge());
    for (int slice = P::FirstSlice; slice < slices && cost < enough; slice += P::SliceStep)
    {
      std::uint8_t rowClasses[64 + Width];
      KnownRowClasses<P>(this->Rows.Of, edge, slice, rowClasses);
      bool anyOfSlice = false;
      for (int row = P::FirstRow; row < P::EndOfRows(edge()); row += P::RowStep)
      {
        const RowPlace place = PlaceOf<P>(this->Rows.Of, edge, slice, row);
        const int rowClass = rowClasses[row];
        std::int64_t symbols = 0;
        const bool any = this->Rows.Row(place, rowClass > 0, rowClass < residual::RowClasses,
          [&](Signed residual, int lane, ByteVector classes, SignedByteVector)
          {
            this->Rows.Keep(place, lane * P::Step, residual);
            symbols += CostOf(residual, classes,
              LaneMask<P, Numbers<std::int16_t>::Signed>((place.Coded - lane) * P::Step));
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
  /// About how many 256ths of a bit residuals take in their classes of roughness: as if they fell
  /// off geometrically, with means from 0.02 to 5. Integers, so that every machine chooses the
  /// same.
  static HWY_INLINE std::int64_t CostOf(
    Signed residual, ByteVector classes, Numbers<std::int16_t>::Signed lanes)
  {
    using Costs = Numbers<std::int16_t>::Signed;
    const Signed most = Signed{} + Number{ 16 }; // residuals beyond cost little more
    Signed size = residual < 0 ? -residual : residual;
    size = size < most ? size : most;
    Costs sizes;
    if constexpr (sizeof(Number) == 2)
    {
      sizes = size;
    }
    else
    {
      sizes = __builtin_convertvector(size, Costs);
    }
    // Quarters of the costs, which bytes hold.
    const ByteVector zero = __builtin_shuffle(
      ByteVector{ 2, 9, 22, 44, 74, 106, 150, 214, 0, 0, 0, 0, 0, 0, 0, 0 }, classes);
    const ByteVector step = __builtin_shuffle(
      ByteVector{ 213, 138, 98, 67, 45, 30, 18, 9, 0, 0, 0, 0, 0, 0, 0, 0 }, classes);
    const Costs cost = (__builtin_convertvector(zero, Costs) * std::int16_t{ 4 } +
                         __builtin_convertvector(step, Costs) * std::int16_t{ 8 } * sizes) &
                       lanes;
    std::int32_t sum = 0;
    for (int x = 0; x < Width; ++x)
    {
      sum += cost[x];
    }
    return sum;
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
