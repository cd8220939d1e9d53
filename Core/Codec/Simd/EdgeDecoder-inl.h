// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_EdgeDecoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_EdgeDecoder_inl_h
#undef banyan_Codec_EdgeDecoder_inl_h
#else
#define banyan_Codec_EdgeDecoder_inl_h
#endif

#include "Codec/Simd/Contexts-inl.h"
#include "Codec/Simd/SliceContexts-inl.h"
#include "Codec/Simd/SymbolRun-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Decodes a pass of the three edges of a block: one slice of three rows.
template <class P, int B, class Number>
class EdgeDecoder
{
public:
  /// @param reader null: all residuals are zero
  EdgeDecoder(Unit<Number, 1>& unit, Interpolation by, SymbolReader* reader, Number bin)
    : Of(unit)
    , By(by)
    , Reader(reader)
    , Bin(bin)
  {
  }

  HWY_INLINE void Run()
  {
    RowPlace rows[3];
    for (int row = 0; row < 3; ++row)
    {
      rows[row] = PlaceOf<P, B>(this->Of, 0, row);
    }
    if (this->Reader != nullptr)
    {
      this->ReadSymbols(rows);
    }
    const std::int8_t* next = this->Symbols;
    for (int row = 0; row < 3; ++row)
    {
      if (this->HasSymbols[row])
      {
        this->PlaceResiduals(rows[row], next);
        next += rows[row].Coded;
      }
      else
      {
        this->Place(rows[row], nullptr);
      }
    }
  }

private:
  static constexpr int Most = 3 * P::LanesOf(B); ///< symbols

  HWY_INLINE void ReadSymbols(const RowPlace (&rows)[3])
  {
    std::uint8_t rowClass[Width] = {};
    if (this->Of.Any)
    {
      RowClasses<P, B>(this->Of, 0, rowClass);
    }
    constexpr int flagBand = residual::Bands + P::Band;
    const std::uint8_t* const flagTables = this->Reader->BandOf(flagBand).Tables;
    std::uint16_t flagPlaces[3];
    std::int8_t flags[Width];
    int flagCount = 0;
    for (int row = 0; row < 3; ++row)
    {
      if (rows[row].Coded > 0 && rowClass[row] < residual::RowClasses)
      {
        flagPlaces[flagCount++] =
          static_cast<std::uint16_t>(flagTables[rowClass[row]] << tans::TableBits);
      }
    }
    if (flagCount > 0)
    {
      ReadRun(*this->Reader, this->Reader->TablesOf(flagBand), flagPlaces, flagCount, flags);
    }
    std::uint16_t places[Most + 2 * Width];
    int count = 0;
    int flag = 0;
    for (int row = 0; row < 3; ++row)
    {
      this->HasSymbols[row] =
        rows[row].Coded > 0 && (rowClass[row] >= residual::RowClasses || flags[flag++] == 0);
      if (this->HasSymbols[row])
      {
        this->TakePlaces(rows[row], places + count);
        count += rows[row].Coded;
      }
    }
    if (count > 0)
    {
      ReadRun(*this->Reader, this->Reader->TablesOf(P::Band), places, count, this->Symbols);
      this->Of.Any = true;
    }
  }

  /// Where the tables of a row's symbols lie.
  HWY_INLINE void TakePlaces(const RowPlace& row, std::uint16_t* to) const
  {
    const std::uint8_t* const tables = this->Reader->BandOf(P::Band).Tables;
    if (!this->Of.Any)
    {
      std::fill_n(to, row.Coded, static_cast<std::uint16_t>(tables[0] << tans::TableBits));
      return;
    }
    const Bytes byClass = Bytes::Load(tables);
    ForEachPart<B>(
      [&](auto at)
      {
        const Bytes classes = ActivityClasses(
          LocalActivity<P, B>(this->Of.Magnitudes + row.Magnitude + P::First + at(), row));
        StorePlaces(Picked<0, P::Step, 1>(LookUp(byClass, classes)), to + at() / P::Step);
      });
  }

  /// Predicts a row and adds its residuals.
  /// @param symbols as many as the row has
  HWY_INLINE void PlaceResiduals(const RowPlace& row, const std::int8_t* symbols) const
  {
    Number residuals[B] = {};
    std::uint8_t* const m = this->Of.Magnitudes + row.Magnitude + P::First;
    unsigned sum = 0;
    for (int k = 0; k < row.Coded; ++k)
    {
      const std::int8_t symbol = symbols[k];
      residuals[k * P::Step] = symbol < residual::EscapeSymbol
                                 ? Number{ symbol }
                                 : static_cast<Number>(this->Reader->Long(
                                     static_cast<std::uint32_t>(symbol - residual::EscapeSymbol)));
      m[k * P::Step] = residual::MagnitudeOf(symbol);
      sum += m[k * P::Step];
    }
    this->Of.RowSums[row.Row] = static_cast<std::uint16_t>(this->Of.RowSums[row.Row] + sum);
    this->Place(row, residuals);
  }

  /// @param residuals of all lanes from the first one on; null: all are zero
  HWY_INLINE void Place(const RowPlace& row, const Number* residuals) const
  {
    ForEachPart<B>(
      [&](auto at)
      {
        using V = Samples<Number>;
        V value = Predict<P, B, at()>(this->Of.Samples, row, this->By);
        if (residuals != nullptr)
        {
          value += V::Load(residuals + at()) * V::Set(this->Bin);
        }
        SetLanes<P, B, at()>(value, this->Of.Samples + row.Sample + P::First + at());
      });
  }

  Unit<Number, 1>& Of;
  Interpolation By;
  SymbolReader* Reader;
  Number Bin;
  bool HasSymbols[3] = {};
  std::int8_t Symbols[Most + Width]; ///< of the rows that have some, side by side
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
