// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_SliceDecoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SliceDecoder_inl_h
#undef banyan_Codec_SliceDecoder_inl_h
#else
#define banyan_Codec_SliceDecoder_inl_h
#endif

#include "Codec/DecodeStages.h"
#include "Codec/Simd/SlicePredictions-inl.h"
#include "Codec/Simd/SymbolRun-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Decodes the slices of a pass of faces or of an interior: contexts and magnitudes of whole
/// vectors of rows.
/// @param B edge of the blocks
template <class P, int B, class Number>
class SliceDecoder
{
public:
  using InRows = RowLanes<P, B>;
  static constexpr int D = P::D;
  static constexpr int S = P::S;
  static constexpr int N = InRows::N;
  static constexpr int RowFirst = InRows::RowFirst;
  static constexpr int RowStep = InRows::RowStep;
  static constexpr int RowEnd = InRows::RowEnd;
  using Shape = SliceShape<D, N>;
  using Tag = SliceTag<D, N>;
  static constexpr int Lanes = static_cast<int>(hn::MaxLanes(Tag()));
  using PackedBytes = PackOf<std::uint8_t, Lanes, true>;
  static constexpr int RowsAtOnce = std::max(Lanes / N, 1);

  /// @param reader null: all residuals are zero
  SliceDecoder(Unit<Number, D>& unit, std::uint8_t* magnitudes, Interpolation by,
    SymbolReader* reader, Number bin, SliceMemory<B>& memory)
    : Of(unit)
    , Magnitudes(magnitudes)
    , Reader(reader)
    , Memory(memory)
    , Predictions{ unit.Samples, by, bin }
  {
  }

  HWY_INLINE void Run()
  {
    if (this->Reader != nullptr)
    {
      std::memset(this->Memory.Kept[0], 0, Shape::Slice);
      std::memset(this->Memory.Kept[1], 0, Shape::Slice);
      for (int row = RowFirst; row < RowEnd; row += RowStep)
      {
        const glm::ivec3& limit = this->Of.Limit[D == 3 ? 0 : row];
        const bool inside = P::First <= limit.x && (D < 3 || row * S <= limit.y);
        this->LastSlice[D == 3 ? 0 : row] = D == 3 ? limit.z : limit.y;
        this->InRow.SetLast(row, limit.x);
        this->RowsInside |= inside ? 1u << row : 0u;
      }
    }
    for (int slice = P::FirstSlice / S; slice < N; slice += P::SliceStep / S)
    {
      std::int8_t* const kept = this->Memory.Kept[slice / 2 % 2];
      const unsigned rows = this->Reader != nullptr ? this->RowsWithSymbols(slice) : 0u;
      if (rows == 0)
      {
        if (this->Reader != nullptr)
        {
          std::memset(kept, 0, Shape::Slice);
        }
        this->Predictions.WithoutResiduals(slice);
        continue;
      }
      this->Decode(slice, rows, kept);
    }
  }

private:
  /// Rows of a slice that have symbols, as bits.
  HWY_INLINE unsigned RowsWithSymbols(int slice)
  {
    const stages::In stage(D == 3 ? stages::RowClasses : stages::FaceContexts);
    SliceMemory<B>& memory = this->Memory;
    unsigned rows = this->RowsInside;
    if (D == 3)
    {
      rows = slice * S <= this->LastSlice[0] ? rows : 0u;
    }
    else
    {
      for (int row = 0; row < 3; ++row)
      {
        rows &= slice * S <= this->LastSlice[row] ? ~0u : ~(1u << row);
      }
    }
    if (this->Of.Any)
    {
      RowClasses<P, B>(this->Of, slice * S, memory.RowClass);
    }
    else
    {
      std::memset(memory.RowClass, 0, B);
    }
    const Bytes classes[2] = { this->ClassesFrom(0), this->ClassesFrom(N > Width ? Width : 0) };
    const unsigned flagged =
      (FlaggedOf(classes[0]) | FlaggedOf(classes[1]) << Width) & InRows::AllRows;
    if (flagged == 0)
    {
      return rows;
    }
    const int band = residual::Bands + P::Band;
    if ((flagged & rows) == InRows::AllRows)
    {
      return rows & ~this->RowsOfZeros(band, classes);
    }
    const std::uint8_t* const tables = this->Reader->BandOf(band).Tables;
    int flags = 0;
    for (unsigned left = rows; left != 0; left &= left - 1)
    {
      const unsigned row = static_cast<unsigned>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
      const unsigned rowClass = memory.RowClass[D == 3 ? row * S : row];
      memory.FlagPlaces[flags] =
        static_cast<std::uint16_t>(tables[rowClass & 15u] << tans::TableBits);
      memory.FlagRows[flags] = static_cast<std::uint8_t>(row);
      flags += rowClass < residual::RowClasses ? 1 : 0;
    }
    if (flags > 0)
    {
      ReadRun(*this->Reader, this->Reader->TablesOf(band), memory.FlagPlaces, flags, memory.Flags);
      for (int flag = 0; flag < flags; ++flag)
      {
        rows &= ~((memory.Flags[flag] != 0 ? 1u : 0u) << memory.FlagRows[flag]);
      }
    }
    return rows;
  }

  /// Classes of 16 rows of a slice, from one on.
  HWY_INLINE Bytes ClassesFrom(int row) const
  {
    const std::uint8_t* const from = this->Memory.RowClass;
    if constexpr (D == 3 && S == 2 && B == 32)
    {
      return Join(LowerHalf(Picked<0, 2, 1>(Bytes::Load(from))),
        LowerHalf(Picked<0, 2, 1>(Bytes::Load(from + Width))));
    }
    return Picked<0, (D == 3 ? S : 1), 1>(Bytes::Load(from + row));
  }
  /// Rows that have flags, as bits.
  static HWY_INLINE unsigned FlaggedOf(const Bytes& classes)
  {
    return BitsOf(BitsAs<std::uint8_t>(
      SignedBytes::Set(std::int8_t{ residual::RowClasses }) > BitsAs<std::int8_t>(classes)));
  }

  /// Reads the flags of all rows of the pass. @return those that are all zero, as bits
  /// @param classes of rows, 16 each
  HWY_INLINE unsigned RowsOfZeros(int band, const Bytes (&classes)[2])
  {
    constexpr int flags = (RowEnd - RowFirst + RowStep - 1) / RowStep;
    constexpr int inFirst = (Width - RowFirst + RowStep - 1) / RowStep;
    SliceMemory<B>& memory = this->Memory;
    const Bytes tables = Bytes::Load(this->Reader->BandOf(band).Tables);
    const auto place = [&tables](const Bytes& rows, std::uint16_t* to)
    { StorePlaces(LookUp(tables, rows), to); };
    place(Picked<RowFirst, RowStep, 1>(classes[0]), memory.FlagPlaces);
    if constexpr (flags > inFirst)
    {
      constexpr int first = RowFirst + inFirst * RowStep - Width;
      place(Picked<first, RowStep, 1>(classes[1]), memory.FlagPlaces + inFirst);
    }
    unsigned zeros =
      ReadFlags<flags>(*this->Reader, this->Reader->TablesOf(band), memory.FlagPlaces);
    if (RowStep == 2)
    {
      zeros = (zeros | zeros << 8) & 0x00ff00ffu;
      zeros = (zeros | zeros << 4) & 0x0f0f0f0fu;
      zeros = (zeros | zeros << 2) & 0x33333333u;
      zeros = (zeros | zeros << 1) & 0x55555555u;
    }
    return zeros << RowFirst;
  }

  /// Tables and signs of the lanes of some rows.
  HWY_INLINE void Classify(int slice, unsigned rows, const std::int8_t* kept) const
  {
    const stages::In stage(D == 3 ? stages::Contexts : stages::FaceContexts);
    const Tag d;
    const hn::RebindToSigned<Tag> s;
    const std::int8_t* const near = this->Memory.Kept[1 - slice / 2 % 2];
    const auto byClass = hn::LoadDup128(d, this->Reader->BandOf(P::Band).Tables);
    constexpr unsigned some = static_cast<unsigned>((std::uint64_t{ 1 } << RowsAtOnce) - 1u);
    for (int at = 0; at < Shape::Slice; at += Lanes)
    {
      const int row = at / N;
      if ((rows >> row & some) == 0)
      {
        continue;
      }
      const auto activity =
        SliceActivity<P, N>{ this->Magnitudes + slice * Shape::Slice + at, row, at % N, slice }
          .Of();
      // The slice before the last one is where this one goes.
      const auto before = hn::Load(s, near + at);
      auto hint = hn::Add(hn::Add(before, before), hn::Load(s, kept + at));
      hint =
        hn::BitCast(s, hn::IfThenZeroElse(hn::Eq(activity, hn::Zero(d)), hn::BitCast(d, hint)));
      const auto hinted = hn::IfThenZeroElse(
        hn::Eq(hint, hn::Zero(s)), hn::Set(s, static_cast<std::int8_t>(residual::Signed)));
      const auto classes =
        hn::Add(ActivityClasses(PackedBytes{ activity }).V, hn::BitCast(d, hinted));
      hn::Store(hn::TableLookupBytes(byClass, classes), d, this->Memory.Tables + at);
      hn::Store(hn::VecFromMask(s, hn::Lt(hint, hn::Zero(s))), s, this->Memory.SignMask + at);
    }
  }

  HWY_INLINE void Decode(int slice, unsigned rows, std::int8_t* kept)
  {
    SliceMemory<B>& memory = this->Memory;
    if (this->Of.Any)
    {
      this->Classify(slice, rows, kept);
    }
    else
    {
      std::memset(memory.Tables, this->Reader->BandOf(P::Band).Tables[0], Shape::Slice);
      std::memset(memory.SignMask, 0, Shape::Slice);
    }
    const int count = this->InRow.TakePlaces(rows, memory);
    ReadRun(*this->Reader, this->Reader->TablesOf(P::Band), memory.Places, count, memory.Read);
    this->Of.Any = true;
    const bool escapes = this->Keep(slice, rows, kept);
    this->Predictions.WithResiduals(slice, rows, memory.Residuals);
    if (escapes)
    {
      this->AddLong(slice, kept);
    }
  }

  /// Residuals, magnitudes, sums of rows and kept residuals of a slice.
  /// @return whether there are escapes
  HWY_INLINE bool Keep(int slice, unsigned rows, std::int8_t* kept) const
  {
    const stages::In stage(D == 3 ? stages::Residuals : stages::FaceContexts);
    const Tag d;
    const hn::RebindToSigned<Tag> s;
    const hn::Repartition<std::uint64_t, Tag> sums;
    constexpr int words = std::min(N, Lanes) / 8; // of a row
    alignas(64) std::uint64_t sum[Lanes / 8];
    const std::int8_t* next = this->Memory.Read;
    auto most = hn::Zero(s);
    std::uint16_t* const to = this->Of.RowSums + slice * S * block::Shape<D>{ B }.SumPitch();
    const auto take = [&](int at, auto part)
    {
      const int row = at / N;
      std::uint8_t* const m = this->Magnitudes + slice * Shape::Slice + at;
      const auto symbols =
        hn::BitCast(s, this->InRow.template SymbolsFrom<part()>(d, row, rows, next));
      most = hn::Max(most, symbols);
      hn::Store(symbols, s, this->Memory.Symbols + at);
      const auto signs = hn::Load(s, this->Memory.SignMask + at);
      const auto residuals = hn::Sub(hn::Xor(symbols, signs), signs);
      const auto limit = hn::Set(s, std::int8_t{ 15 });
      hn::Store(residuals, s, this->Memory.Residuals + at);
      hn::Store(hn::Max(hn::Min(residuals, limit), hn::Neg(limit)), s, kept + at);
      const auto magnitudes = MagnitudesOf(PackOf<std::int8_t, Lanes, true>{ symbols }).V;
      hn::Store(hn::Or(magnitudes, hn::Load(d, m)), d, m);
      hn::Store(hn::SumsOf8(magnitudes), sums, sum);
      for (int r = 0; r < RowsAtOnce; ++r)
      {
        std::uint64_t total = sum[words * r];
        for (int word = 1; word < words; ++word)
        {
          total += sum[words * r + word];
        }
        std::uint16_t& all = to[D == 3 ? (row + r) * S : row + r];
        all = static_cast<std::uint16_t>(all + total);
      }
    };
    for (int at = 0; at < Shape::Slice; at += std::max(Lanes, N))
    {
      take(at, std::integral_constant<int, 0>());
      if constexpr (Lanes < N)
      {
        take(at + Lanes, std::integral_constant<int, 1>());
      }
    }
    const auto direct = hn::Set(s, static_cast<std::int8_t>(residual::EscapeSymbol - 1));
    return !hn::AllFalse(s, hn::Gt(most, direct));
  }

  /// Residuals with extra bits, which follow those of their run, instead of those that were placed.
  HWY_NOINLINE void AddLong(int slice, std::int8_t* kept) const
  {
    constexpr std::uint64_t bit = 0x4040404040404040u; // set in escapes, and where the sign is
    for (int word = 0; word < Shape::Slice; word += 8)
    {
      std::uint64_t symbols;
      std::memcpy(&symbols, this->Memory.Symbols + word, 8);
      for (std::uint64_t left = symbols & ~(symbols >> 1) & bit; left != 0; left &= left - 1)
      {
        const int at = word + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(left)) / 8;
        const int row = at / N;
        const std::int32_t residual = this->Reader->Long(
          static_cast<std::uint32_t>(this->Memory.Symbols[at] - residual::EscapeSymbol));
        // Wraps where a file of ill intent makes it.
        using U = std::uint32_t;
        const U sign = static_cast<U>(std::int32_t{ this->Memory.SignMask[at] });
        const Number value = static_cast<Number>((static_cast<U>(residual) ^ sign) - sign);
        Number& sample = this->Predictions.RowAt(slice, row)[(at % N - 1) * S];
        sample = static_cast<Number>(
          static_cast<U>(sample) +
          (static_cast<U>(value) - static_cast<U>(std::int32_t{ this->Memory.Residuals[at] })) *
            static_cast<U>(this->Predictions.Bin));
        kept[at] = static_cast<std::int8_t>(std::min<Number>(std::max<Number>(value, -15), 15));
      }
    }
  }

  Unit<Number, D>& Of;
  std::uint8_t* Magnitudes;
  SymbolReader* Reader; ///< null: all residuals are zero
  SliceMemory<B>& Memory;
  SlicePredictions<P, B, Number> Predictions;
  unsigned RowsInside = 0; ///< the field
  InRows InRow;            ///< lanes with symbols
  int LastSlice[3] = {};   ///< within the field, as its position
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
