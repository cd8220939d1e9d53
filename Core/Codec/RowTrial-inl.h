// Included once per SIMD target: see BlockEncoder.cxx.
#if defined(banyan_Codec_RowTrial_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_RowTrial_inl_h
#undef banyan_Codec_RowTrial_inl_h
#else
#define banyan_Codec_RowTrial_inl_h
#endif

#include "Codec/RowEncoder-inl.h"

#ifndef banyan_Codec_RowTrial_once
#define banyan_Codec_RowTrial_once
namespace banyan
{

/// About how many 256ths of a bit a residual takes in a class of roughness: as if residuals fell off
/// geometrically, with means from 0.02 to 5. Integers, so that every machine chooses the same.
constexpr std::int64_t ZeroCost[residual::Classes] = { 7, 37, 89, 178, 296, 425, 599, 855 };
constexpr std::int64_t StepCost[residual::Classes] = { 1700, 1106, 783, 533, 357, 241, 148, 73 };
constexpr std::int64_t LongestStep = 16;      ///< residuals beyond cost little more
constexpr std::int64_t SmoothRowCost = 8;     ///< of the flag of a row of zeros
constexpr std::int64_t UnexpectedRowCost = 1400;

} // namespace banyan
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Encodes rows as RowEncoder does, and only adds up what they would cost.
template <int B>
struct RowTrial
{
  const std::int32_t* W;      ///< of the unit
  const std::int32_t* Target; ///< same layout
  std::int32_t CoarseBin, FineBin;
  std::int64_t* Cost;

  HWY_INLINE void operator()(const Row& row, std::int32_t* w, const std::int32_t* prediction,
    std::uint8_t* m, const std::uint8_t* classes, bool rough) const
  {
    if (row.Coded == 0)
    {
      SetLanes<B>(row.Lanes, prediction, w);
      return;
    }
    alignas(64) std::uint32_t codes[B];
    int last = 0;
    const std::uint32_t any = QuantizeRow<B>(row, this->Target + (w - this->W), prediction,
      row.Stride == 2 ? this->CoarseBin : this->FineBin, w, codes, last);
    if (!rough)
    {
      *this->Cost += any == 0 ? SmoothRowCost : UnexpectedRowCost;
      if (any == 0)
      {
        return;
      }
    }
    std::int64_t cost = 0;
    for (int x = row.Lanes.First; x <= last; x += row.Lanes.Step)
    {
      m[x] = residual::Magnitude(codes[x]);
      const std::int64_t size =
        std::min<std::int64_t>((std::int64_t{ codes[x] } + 1) / 2, LongestStep);
      cost += ZeroCost[classes[x]] + StepCost[classes[x]] * size;
    }
    *this->Cost += cost;
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
