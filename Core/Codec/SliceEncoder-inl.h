// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockEncoder.cxx.
#if defined(banyan_Codec_SliceEncoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SliceEncoder_inl_h
#undef banyan_Codec_SliceEncoder_inl_h
#else
#define banyan_Codec_SliceEncoder_inl_h
#endif

#include "Codec/BlockContexts-inl.h"
#include "Codec/BlockEncoder.h"
#include "Codec/Residual.h"

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Whether some lane is not 0.
template <class Vector>
HWY_INLINE bool AnyLane(const Vector& lanes)
{
  std::uint64_t words[sizeof(lanes) / 8];
  std::memcpy(words, &lanes, sizeof(lanes));
  std::uint64_t all = 0;
  for (const std::uint64_t word : words)
  {
    all |= word;
  }
  return all != 0;
}

/// Nearest multiples of a bin. The bin is odd, so nothing lies half way, and the arithmetic is far
/// more exact than what is left to the next half.
HWY_INLINE Numbers<std::int16_t>::Signed Quantize(
  Numbers<std::int16_t>::Signed rest, std::int16_t bin)
{
  typedef float Floats __attribute__((vector_size(64)));
  constexpr float rounder = 12582912.0f; // 1.5 * 2^23: adding it rounds
  const Floats bins = __builtin_convertvector(rest, Floats) * (1.0f / bin);
  return __builtin_convertvector(
    __builtin_convertvector((bins + rounder) - rounder, Numbers<std::int32_t>::Signed),
    Numbers<std::int16_t>::Signed);
}
HWY_INLINE Numbers<std::int32_t>::Signed Quantize(
  Numbers<std::int32_t>::Signed rest, std::int32_t bin)
{
  typedef double Doubles __attribute__((vector_size(128)));
  constexpr double rounder = 6755399441055744.0; // 1.5 * 2^52
  const Doubles bins = __builtin_convertvector(rest, Doubles) * (1.0 / bin);
  return __builtin_convertvector((bins + rounder) - rounder, Numbers<std::int32_t>::Signed);
}

/// Quantizes the residuals of rows, and sets rows and magnitudes to what they decode to.
template <class P, class Edge, class Number>
struct RowQuantizer
{
  using V = Numbers<Number>;
  using Vector = typename V::Unsigned;
  using Signed = typename V::Signed;

  Unit<Number, P::D>& Of;
  const Edge& B;
  Interpolation By;
  const Number* Target; ///< same layout as the unit's samples, what they are to become
  Number Bin;

  /// Calls body(residuals of Width lanes, others 0; lane of the pass where they begin; classes;
  /// what residuals before hint at).
  /// @param flagged whether nobody asks for the residuals where all of a row are 0; magnitudes must
  /// be 0 already
  /// @return whether some residual is not 0
  template <class Body>
  HWY_INLINE bool Row(const RowPlace& place, bool rough, bool flagged, Body&& body) const
  {
    const int left = this->B() - P::First;
    const int lanes = place.Coded * P::Step;
    Number* w = this->Of.W + place.W + P::First;
    const Number* target = this->Target + place.W + P::First;
    std::uint8_t* m = this->Of.M + place.M + P::First;
    Signed any{};
    for (int at = 0; at < left; at += Width)
    {
      const Vector prediction = Predict<P>(this->Of.W, this->B, place, at, this->By);
      Signed residual{};
      if (at < lanes)
      {
        residual = reinterpret_cast<Signed>(V::Load(target + at) - prediction);
        residual &= LaneMask<P, Signed>(lanes - at);
        if (flagged && left <= Width && !this->AnyCoded(residual))
        {
          SetLanes<P>(prediction, left - at, w + at);
          return false;
        }
        residual = Quantize(residual, this->Bin);
        ByteVector classes{};
        SignedByteVector hint{};
        if (rough)
        {
          const ByteVector sum = RoughnessOf<P>(m + at, this->B, place);
          classes = ClassesOf(sum);
          hint = HintOf<P>(this->Of.R + place.M + P::First + at, this->B, place, sum);
        }
        body(residual, at / P::Step, classes, hint);
      }
      any |= residual;
      SetLanes<P>(prediction + reinterpret_cast<Vector>(residual) *
                                 static_cast<std::make_unsigned_t<Number>>(this->Bin),
        left - at, w + at);
    }
    return AnyLane(any);
  }

  /// Whether some difference is more than half a bin.
  HWY_INLINE bool AnyCoded(Signed difference) const
  {
    using Positive = std::make_unsigned_t<Number>;
    const Positive half = static_cast<Positive>(this->Bin / 2);
    return AnyLane(reinterpret_cast<Vector>(difference) + half > static_cast<Positive>(2 * half));
  }

  /// Sets the magnitudes and kept residuals of lanes from `First + at` on.
  HWY_INLINE void Keep(const RowPlace& place, int at, Signed residual) const
  {
    const auto kept = __builtin_convertvector(Limited(residual, Number{ 15 }), SignedByteVector);
    const ByteVector size = MagnitudesOf(kept);
    std::uint8_t* m = this->Of.M + place.M + P::First + at;
    const ByteVector mask = LaneMask<P, ByteVector>(this->B() - P::First - at);
    StoreVector((size & mask) | (LoadVector<ByteVector>(m) & ~mask), m);
    const int slice = P::D == 3 ? place.Z : P::D == 2 ? place.Y : 0;
    std::uint16_t& sum = this->Of.S[slice * block::Shape<P::D>{ this->B() }.SumPitch() + place.Row];
    sum = static_cast<std::uint16_t>(sum + SumOf(size & mask));
    if (P::D > 1)
    {
      KeepResiduals(kept, mask, this->Of.R + place.M + P::First + at);
    }
  }
};

/// Classes of the rows of a slice: all the least where no residual is known yet.
template <class P, class Edge, class Number>
HWY_INLINE void KnownRowClasses(
  const Unit<Number, P::D>& unit, const Edge& edge, int slice, std::uint8_t* to)
{
  if (unit.Any)
  {
    return RowClasses<P>(unit, edge, slice, to);
  }
  std::fill_n(to, P::EndOfRows(edge()), std::uint8_t{ 0 });
}

/// What is written down of a block's units.
struct UnitTokens
{
  explicit UnitTokens(int edge)
    : Tokens(static_cast<std::size_t>(edge * edge * edge + 6 * edge * edge + 64))
    , Extra(Tokens.size())
    , Slice(static_cast<std::size_t>(edge * std::max(edge, 3) + 2 * Width))
  {
  }

  // Every sample has a token at most, and every row a flag.
  std::vector<std::uint16_t> Tokens;
  std::vector<std::uint32_t> Extra;
  std::vector<std::uint16_t> Slice; ///< tokens of a slice
  std::vector<std::uint16_t> Runs;
  std::uint8_t RowClass[64 + Width]; ///< of the rows of a slice
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
template <class P, class Edge, class Number>
struct SliceEncoder
{
  using Signed = typename Numbers<Number>::Signed;

  RowQuantizer<P, Edge, Number> Rows;
  UnitTokens& Out;

  HWY_INLINE void Run() const
  {
    const Edge& edge = this->Rows.B;
    const int slices = P::EndOfSlices(edge());
    for (int slice = P::FirstSlice; slice < slices; slice += P::SliceStep)
    {
      std::uint16_t flags[64];
      std::size_t flagCount = 0;
      std::size_t count = 0;
      bool any = false;
      KnownRowClasses<P>(this->Rows.Of, edge, slice, this->Out.RowClass);
      for (int row = P::FirstRow; row < P::EndOfRows(edge()); row += P::RowStep)
      {
        const RowPlace place = PlaceOf<P>(this->Rows.Of, edge, slice, row);
        const int rowClass = this->Out.RowClass[row];
        const bool flagged = place.Coded > 0 && rowClass < residual::RowClasses;
        const bool coded =
          this->AddRow(place, rowClass > 0, flagged, this->Out.Slice.data() + count);
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
      this->Out.AddRun(this->Out.Slice.data(), count);
    }
  }

private:
  /// @return whether some residual is not 0
  HWY_INLINE bool AddRow(
    const RowPlace& place, bool rough, bool flagged, std::uint16_t* tokens) const
  {
    typedef std::uint16_t Tokens __attribute__((vector_size(32)));
    return this->Rows.Row(place, rough, flagged,
      [&](Signed residual, int lane, ByteVector classes, SignedByteVector hint)
      {
        this->Rows.Keep(place, lane * P::Step, residual);
        const Signed turned = __builtin_convertvector(
          reinterpret_cast<SignedByteVector>(hint < std::int8_t{ 0 }), Signed);
        residual = (residual ^ turned) - turned;
        classes +=
          reinterpret_cast<ByteVector>(hint != std::int8_t{ 0 }) & std::uint8_t{ residual::Signed };
        const auto codes = reinterpret_cast<typename Numbers<Number>::Unsigned>(
          (residual << 1) ^ (residual >> (8 * sizeof(Number) - 1)));
        const auto large =
          codes >= static_cast<std::make_unsigned_t<Number>>(residual::DirectSymbols);
        constexpr std::uint16_t context = P::Band * residual::Classes;
        Tokens each;
        if constexpr (sizeof(Number) == 2)
        {
          each = codes;
        }
        else
        {
          each = __builtin_convertvector(codes, Tokens);
        }
        const Tokens contexts = (__builtin_convertvector(classes, Tokens) + context)
                                << residual::TokenShift;
        StoreVector(Compressed<P::Step>(contexts | each), tokens + lane);
        if (HWY_UNLIKELY(AnyLane(large)))
        {
          this->AddLong(place, residual, contexts, lane, tokens);
        }
      });
  }

  /// Tokens of a vector in which some symbols have extra bits.
  template <class Contexts>
  HWY_NOINLINE void AddLong(const RowPlace& place, const Signed& residuals,
    const Contexts& contexts, int lane, std::uint16_t* tokens) const
  {
    for (int x = 0; x < Width && lane + x / P::Step < place.Coded; x += P::Step)
    {
      std::uint32_t extra = 0;
      const int symbol = residual::SymbolOf(residual::Zigzag(residuals[x]), extra);
      tokens[lane + x / P::Step] = static_cast<std::uint16_t>(contexts[x] | symbol);
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
