// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_SliceEncoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SliceEncoder_inl_h
#undef banyan_Codec_SliceEncoder_inl_h
#else
#define banyan_Codec_SliceEncoder_inl_h
#endif

#include "Codec/BlockEncoder.h"
#include "Codec/Simd/RowQuantizer-inl.h"

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Tokens of a block's units.
template <int B>
struct UnitTokens
{
  // Every sample has a token at most, and every row a flag.
  std::vector<std::uint16_t> Tokens = std::vector<std::uint16_t>(B * B * B + 6 * B * B + 64);
  std::vector<std::uint32_t> Extra = std::vector<std::uint32_t>(B * B * B + 6 * B * B + 64);
  std::vector<std::uint16_t> Runs;
  std::uint16_t Slice[B * B + 2 * Width]; ///< tokens of a slice
  std::uint8_t RowClass[B + Width];       ///< of the rows of a slice
  std::size_t TokenCount = 0, ExtraCount = 0;

  /// To be called first: what came before may have ended early.
  void Clear()
  {
    this->TokenCount = 0;
    this->ExtraCount = 0;
    this->Runs.clear();
  }

  void AddRun(const std::uint16_t* tokens, std::size_t count)
  {
    if (count > 0)
    {
      std::copy_n(tokens, count, this->Tokens.data() + this->TokenCount);
      this->TokenCount += count;
      this->Runs.push_back(static_cast<std::uint16_t>(count));
    }
  }

  void AppendTo(BlockTokens& block) const
  {
    const auto count = static_cast<std::ptrdiff_t>(this->TokenCount);
    block.Tokens.insert(block.Tokens.end(), this->Tokens.begin(), this->Tokens.begin() + count);
    block.Extra.insert(block.Extra.end(), this->Extra.begin(),
      this->Extra.begin() + static_cast<std::ptrdiff_t>(this->ExtraCount));
    block.Runs.insert(block.Runs.end(), this->Runs.begin(), this->Runs.end());
  }
};

/// Quantizes the residuals of slices and writes them down.
template <class P, int B, class Number>
struct SliceEncoder
{
  RowQuantizer<P, B, Number> Rows;
  UnitTokens<B>& Out;

  HWY_INLINE void Run() const
  {
    for (int slice = P::FirstSlice; slice < P::EndOfSlices(B); slice += P::SliceStep)
    {
      std::uint16_t flags[B];
      std::size_t flagCount = 0;
      std::size_t count = 0;
      bool any = false;
      KnownRowClasses<P, B>(this->Rows.Of, slice, this->Out.RowClass);
      for (int row = P::FirstRow; row < P::EndOfRows(B); row += P::RowStep)
      {
        const RowPlace place = PlaceOf<P, B>(this->Rows.Of, slice, row);
        const int rowClass = this->Out.RowClass[row];
        const bool flagged = place.Coded > 0 && rowClass < residual::RowClasses;
        const bool coded = this->AddRow(place, rowClass > 0, flagged, this->Out.Slice + count);
        any = any || coded;
        if (flagged)
        {
          flags[flagCount++] = residual::TokenOf(
            residual::FlagContext + P::Band * residual::RowClasses + rowClass, coded ? 0 : 1);
        }
        count += !flagged || coded ? static_cast<std::size_t>(place.Coded) : 0;
      }
      this->Rows.Of.Any = this->Rows.Of.Any || any;
      this->Out.AddRun(flags, flagCount);
      this->Out.AddRun(this->Out.Slice, count);
    }
  }

private:
  using V = Samples<Number>;
  using Tokens = Pack<std::uint16_t, Width>;

  /// @return whether some residual is not 0
  HWY_INLINE bool AddRow(
    const RowPlace& place, bool active, bool flagged, std::uint16_t* tokens) const
  {
    return this->Rows.Row(place, active, flagged,
      [&](auto at, const V& residual, const Bytes& classes, const SignedBytes& hint)
      {
        this->Rows.template Keep<at()>(place, residual);
        constexpr int lane = at() / P::Step;
        const V signs = SignsOf(hint);
        const V coded = (residual ^ signs) - signs;
        constexpr int bits = 8 * static_cast<int>(sizeof(Number));
        const V codes = ShiftLeft<1>(coded) ^ ShiftRight<bits - 1>(coded);
        const Bytes hinted = BitsAs<std::uint8_t>(hint != SignedBytes::Set(0)) &
                             Bytes::Set(std::uint8_t{ residual::Signed });
        const Tokens contexts = ShiftLeft<residual::TokenShift>(
          Widen<std::uint16_t>(classes + hinted) +
          Tokens::Set(std::uint16_t{ P::Band * residual::Classes }));
        StoreEveryStep(contexts | Symbols(codes), tokens + lane);
        // Codes of 2^31 and more look negative.
        constexpr Number direct = residual::DirectSymbols - 1;
        const V large = (codes > V::Set(direct)) | (V::Set(0) > codes);
        if (HWY_UNLIKELY(AnyBit(large)))
        {
          this->AddLong(place, coded, contexts, lane, tokens);
        }
      });
  }

  /// -1 where a hint is negative.
  static HWY_INLINE V SignsOf(const SignedBytes& hint)
  {
    return Widen<Number>(SignedBytes::Set(0) > hint);
  }

  /// Codes as symbols, where they are below residual::DirectSymbols; anything else elsewhere.
  static HWY_INLINE Tokens Symbols(const V& codes)
  {
    if constexpr (sizeof(Number) == sizeof(std::uint16_t))
    {
      return BitsAs<std::uint16_t>(codes);
    }
    else
    {
      return BitsAs<std::uint16_t>(Narrow<std::int16_t>(codes));
    }
  }

  /// Stores every Step-th lane side by side, and anything behind.
  static HWY_INLINE void StoreEveryStep(const Tokens& tokens, std::uint16_t* to)
  {
    if constexpr (P::Step == 1)
    {
      tokens.Store(to);
    }
    else if constexpr (P::Step == 2)
    {
      EveryOther(tokens).Store(to);
    }
    else
    {
      EveryOther(EveryOther(tokens)).Store(to);
    }
  }

  /// Tokens of a pack in which some symbols have extra bits.
  HWY_NOINLINE void AddLong(const RowPlace& place, const V& coded, const Tokens& contexts, int lane,
    std::uint16_t* tokens) const
  {
    Number residuals[Width];
    std::uint16_t contextOf[Width];
    coded.Store(residuals);
    contexts.Store(contextOf);
    for (int x = 0; x < Width && lane + x / P::Step < place.Coded; x += P::Step)
    {
      std::uint32_t extra = 0;
      const int symbol = residual::SymbolOf(residual::Zigzag(residuals[x]), extra);
      tokens[lane + x / P::Step] = static_cast<std::uint16_t>(contextOf[x] | symbol);
      if (symbol >= residual::DirectSymbols)
      {
        this->Out.Extra[this->Out.ExtraCount++] = extra;
      }
    }
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
