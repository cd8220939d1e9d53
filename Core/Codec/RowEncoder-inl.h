// Included once per SIMD target: see BlockEncoder.cxx.
#if defined(banyan_Codec_RowEncoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_RowEncoder_inl_h
#undef banyan_Codec_RowEncoder_inl_h
#else
#define banyan_Codec_RowEncoder_inl_h
#endif

#include "Codec/BlockEncoder.h"
#include "Codec/BlockUnits-inl.h"
#include "Codec/Residual.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// What is written down of a unit.
template <int B>
struct UnitTokens
{
  // Every sample has a token at most, and every row a flag.
  std::uint16_t Tokens[B * B * B + 3 * B * B];
  std::uint32_t Extra[B * B * B];
  std::uint8_t Rows[6 * B * B];
  std::size_t TokenCount = 0, ExtraCount = 0, RowCount = 0;

  /// To be called first: what came before may have ended early.
  void Clear()
  {
    this->TokenCount = 0;
    this->ExtraCount = 0;
    this->RowCount = 0;
  }

  void AppendTo(BlockTokens& block) const
  {
    block.Tokens.insert(block.Tokens.end(), this->Tokens, this->Tokens + this->TokenCount);
    block.Extra.insert(block.Extra.end(), this->Extra, this->Extra + this->ExtraCount);
    block.Rows.insert(block.Rows.end(), this->Rows, this->Rows + this->RowCount);
  }
};

/// Nearest multiple of the bin. The bin is odd, so nothing lies half way, and double precision is far
/// more exact than what is left to the next half.
template <int B>
HWY_INLINE void Quantize(const std::int32_t* HWY_RESTRICT target,
  const std::int32_t* HWY_RESTRICT prediction, std::int32_t bin,
  std::int32_t* HWY_RESTRICT residuals)
{
  const double inverse = 1.0 / bin;
  constexpr double rounder = 6755399441055744.0; // 1.5 * 2^52: adding it rounds
  for (int x = 0; x < B; ++x)
  {
    const double rest = static_cast<std::int32_t>(U(target[x]) - U(prediction[x]));
    residuals[x] = static_cast<std::int32_t>((rest * inverse + rounder) - rounder);
  }
}

/// Quantizes a row that carries residuals and sets its lanes to what they decode to.
/// @param codes receives the zigzag codes of all lanes, 0 for those that are not coded
/// @param last receives the last lane that is coded
/// @return all codes, or-ed
template <int B>
HWY_INLINE std::uint32_t QuantizeRow(const Row& row, const std::int32_t* target,
  const std::int32_t* prediction, std::int32_t bin, std::int32_t* w,
  std::uint32_t* HWY_RESTRICT codes, int& last)
{
  alignas(64) std::int32_t residuals[B];
  Quantize<B>(target, prediction, bin, residuals);
  last = row.Lanes.First + (row.Coded - 1) * row.Lanes.Step;
  const std::int32_t* mask = LaneMask<B>(row.Lanes);
  std::uint32_t any = 0;
  for (int x = 0; x < B; ++x)
  {
    residuals[x] = x <= last ? residuals[x] & mask[x] : 0;
    codes[x] = residual::Zigzag(residuals[x]);
    any |= codes[x];
  }
  SetLanes<B>(row.Lanes, prediction, residuals, bin, w);
  return any;
}

/// Quantizes the residuals of rows and writes them down.
template <int B>
struct RowEncoder
{
  const std::int32_t* W;      ///< of the unit
  const std::int32_t* Target; ///< same layout, what W is to become
  std::int32_t CoarseBin, FineBin;
  UnitTokens<B>* Out;
  bool* Rough;

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
    UnitTokens<B>& out = *this->Out;
    if (!rough)
    {
      out.Tokens[out.TokenCount++] = static_cast<std::uint16_t>(
        (residual::FlagContext + row.Band) << 8 | (any == 0 ? 1 : 0));
      out.Rows[out.RowCount++] = 1;
      if (any == 0)
      {
        return;
      }
    }
    *this->Rough |= any != 0;
    const int context = row.Band * residual::Classes;
    out.Rows[out.RowCount++] = static_cast<std::uint8_t>(row.Coded);
    std::uint16_t* tokens = out.Tokens + out.TokenCount;
    out.TokenCount += static_cast<std::size_t>(row.Coded);
    if (any < 32) // so is each code then
    {
      for (int x = row.Lanes.First; x <= last; x += row.Lanes.Step)
      {
        m[x] = residual::MagnitudeOf[codes[x]];
        *tokens++ = static_cast<std::uint16_t>(
          static_cast<std::uint32_t>(context + classes[x]) << 8 | codes[x]);
      }
      return;
    }
    for (int x = row.Lanes.First; x <= last; x += row.Lanes.Step)
    {
      std::uint32_t extra = 0;
      const int symbol = residual::SymbolOf(codes[x], extra);
      m[x] = residual::Magnitude(codes[x]);
      *tokens++ = static_cast<std::uint16_t>((context + classes[x]) << 8 | symbol);
      if (symbol >= residual::DirectSymbols)
      {
        out.Extra[out.ExtraCount++] = extra;
      }
    }
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
