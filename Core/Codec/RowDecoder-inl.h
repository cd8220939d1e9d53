// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_RowDecoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_RowDecoder_inl_h
#undef banyan_Codec_RowDecoder_inl_h
#else
#define banyan_Codec_RowDecoder_inl_h
#endif

#include "Codec/BlockUnits-inl.h"
#include "Codec/SymbolRow-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Reads the residuals of rows and applies them.
template <int B>
struct RowDecoder
{
  SymbolReader* Symbols; ///< null: all residuals are zero
  std::int32_t CoarseBin, FineBin;

  HWY_INLINE void operator()(const Row& row, std::int32_t* w, const std::int32_t* prediction,
    std::uint8_t* m, const std::uint8_t* classes, bool rough) const
  {
    if (this->Symbols == nullptr || row.Coded == 0 ||
        (!rough && this->Symbols->One(residual::FlagContext + row.Band) >> residual::ResidualShift != 0))
    {
      SetLanes<B>(row.Lanes, prediction, w);
      return;
    }
    alignas(64) std::uint32_t entries[B] = {};
    const int context = row.Band * residual::Classes;
    const int x = row.Lanes.First;
    const bool escapes =
      row.Lanes.Step == 1   ? ReadRow<1>(*this->Symbols, context, classes + x, row.Coded, entries + x)
      : row.Lanes.Step == 2 ? ReadRow<2>(*this->Symbols, context, classes + x, row.Coded, entries + x)
                            : ReadRow<4>(*this->Symbols, context, classes + x, row.Coded, entries + x);
    alignas(64) std::int32_t residuals[B];
    alignas(64) std::uint8_t magnitudes[B];
    for (int i = 0; i < B; ++i)
    {
      residuals[i] = static_cast<std::int32_t>(entries[i]) >> residual::ResidualShift;
    }
    for (int i = 0; i < B; ++i)
    {
      magnitudes[i] = static_cast<std::uint8_t>(
        entries[i] >> residual::MagnitudeShift & residual::MagnitudeMask);
    }
    if (HWY_UNLIKELY(escapes))
    {
      this->ReadLong(row, entries, residuals, magnitudes);
    }
    const std::uint8_t* mask = LaneMask<B, std::uint8_t>(row.Lanes);
    for (int i = 0; i < B; ++i)
    {
      m[i] = static_cast<std::uint8_t>((m[i] & ~mask[i]) | magnitudes[i]);
    }
    SetLanes<B>(
      row.Lanes, prediction, residuals, row.Stride == 2 ? this->CoarseBin : this->FineBin, w);
  }

  /// Residuals with extra bits, which follow those of their row.
  HWY_NOINLINE void ReadLong(const Row& row, const std::uint32_t* entries, std::int32_t* residuals,
    std::uint8_t* magnitudes) const
  {
    for (int k = 0; k < row.Coded; ++k)
    {
      const int x = row.Lanes.First + k * row.Lanes.Step;
      if ((entries[x] & residual::EscapeFlag) != 0)
      {
        residuals[x] = this->Symbols->Long(entries[x]);
        magnitudes[x] = residual::Magnitude(residual::Zigzag(residuals[x]));
      }
    }
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
