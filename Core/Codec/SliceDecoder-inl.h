// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_SliceDecoder_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SliceDecoder_inl_h
#undef banyan_Codec_SliceDecoder_inl_h
#else
#define banyan_Codec_SliceDecoder_inl_h
#endif

#include "Codec/BlockContexts-inl.h"
#include "Codec/SymbolRun-inl.h"

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Memory for the symbols of a slice.
template <class Number>
struct SliceMemory
{
  static constexpr int MostRows = 64;

  explicit SliceMemory(int edge)
    : Tables(static_cast<std::size_t>(edge * std::max(edge, 3) + 2 * Width))
    , Tops(Tables.size())
    , Turned(Tables.size())
    , Long(Tables.size())
  {
  }

  std::vector<std::uint16_t> Tables; ///< of each symbol, as ReadRun takes them
  std::vector<std::int8_t> Tops;     ///< residuals, or escapes
  std::vector<std::int8_t> Turned;   ///< -1 where residuals have the other sign
  std::vector<Number> Long;          ///< residuals, where there are escapes
  RowPlace Rows[MostRows];
  int Begin[MostRows];                        ///< of a row's symbols; -1: it has none
  std::uint8_t RowClass[MostRows + Width];    ///< by number of row
  std::uint16_t FlagTables[MostRows + Width]; ///< of each flag, as ReadRun takes them
  std::int8_t Flags[MostRows + Width];
};

/// Decodes the slices of a pass.
template <class P, class Edge, class Number>
struct SliceDecoder
{
  Unit<Number, P::D>& Of;
  const Edge& B;
  Interpolation By;
  SymbolReader* Symbols; ///< null: all residuals are zero
  Number Bin;
  SliceMemory<Number>& Memory;

  HWY_INLINE void Run() const
  {
    const int slices = P::EndOfSlices(this->B());
    for (int slice = P::FirstSlice; slice < slices; slice += P::SliceStep)
    {
      int rows = 0;
      const int end = P::EndOfRows(this->B());
      for (int row = P::FirstRow; row < end; row += P::RowStep)
      {
        this->Memory.Rows[rows++] = PlaceOf<P>(this->Of, this->B, slice, row);
      }
      const bool any = this->Symbols != nullptr && this->ReadSymbols(slice, rows);
      if (!any)
      {
        this->PlacePredictions(rows);
      }
      else if (this->HasEscapes())
      {
        this->ReadLong();
        this->Place(rows, this->Memory.Long.data());
      }
      else
      {
        this->Place(rows, this->Memory.Tops.data());
      }
    }
  }

private:
  /// @return false when all residuals of the slice are zero
  HWY_INLINE bool ReadSymbols(int slice, int rows) const
  {
    SliceMemory<Number>& memory = this->Memory;
    if (this->Of.Any)
    {
      RowClasses<P>(this->Of, this->B, slice, memory.RowClass);
    }
    else
    {
      std::fill_n(memory.RowClass, P::D > 2 ? this->B() : 3, std::uint8_t{ 0 });
    }
    const int flagBand = residual::Bands + P::Band;
    const std::uint8_t* const flagTables = this->Symbols->BandOf(flagBand).Tables;
    int flags = 0;
    for (int r = 0; r < rows; ++r)
    {
      const RowPlace& place = memory.Rows[r];
      const unsigned rowClass = memory.RowClass[place.Row];
      memory.FlagTables[flags] =
        static_cast<std::uint16_t>(flagTables[rowClass] << tans::TableBits);
      flags += place.Coded > 0 && rowClass < residual::RowClasses ? 1 : 0;
    }
    if (flags > 0)
    {
      ReadRun(
        *this->Symbols, this->Symbols->TablesOf(flagBand), memory.FlagTables, flags, memory.Flags);
    }
    int count = 0;
    int flag = 0;
    for (int r = 0; r < rows; ++r)
    {
      const RowPlace& place = memory.Rows[r];
      memory.Begin[r] = -1;
      if (place.Coded > 0 &&
          (memory.RowClass[place.Row] >= residual::RowClasses || memory.Flags[flag++] == 0))
      {
        memory.Begin[r] = count;
        this->Classify(place, count);
        count += place.Coded;
      }
    }
    if (count == 0)
    {
      return false;
    }
    ReadRun(*this->Symbols, this->Symbols->TablesOf(P::Band), memory.Tables.data(), count,
      memory.Tops.data());
    this->Of.Any = true;
    this->Count = count;
    return true;
  }

  /// Writes down the tables of a row's symbols.
  HWY_INLINE void Classify(const RowPlace& place, int begin) const
  {
    typedef std::uint16_t Tables16 __attribute__((vector_size(32)));
    std::uint16_t* tables = this->Memory.Tables.data() + begin;
    std::int8_t* turned = this->Memory.Turned.data() + begin;
    const std::uint8_t* const tablesOf = this->Symbols->BandOf(P::Band).Tables;
    if (!this->Of.Any)
    {
      std::fill_n(tables, place.Coded, static_cast<std::uint16_t>(tablesOf[0] << tans::TableBits));
      std::fill_n(turned, place.Coded, std::int8_t{ 0 });
      return;
    }
    const ByteVector byClass = LoadVector<ByteVector>(tablesOf);
    const std::uint8_t* m = this->Of.M + place.M + P::First;
    const std::int8_t* r = this->Of.R + place.M + P::First;
    const int lanes = place.Coded * P::Step;
    for (int at = 0; at < lanes; at += Width, tables += Width / P::Step, turned += Width / P::Step)
    {
      const ByteVector sum = RoughnessOf<P>(m + at, this->B, place);
      const SignedByteVector hint = HintOf<P>(r + at, this->B, place, sum);
      const ByteVector hinted = reinterpret_cast<ByteVector>(hint != std::int8_t{ 0 });
      const ByteVector classes = ClassesOf(sum) + (hinted & std::uint8_t{ residual::Signed });
      const Tables16 wide =
        __builtin_convertvector(Compressed<P::Step>(__builtin_shuffle(byClass, classes)), Tables16);
      StoreVector(
        Compressed<P::Step>(reinterpret_cast<ByteVector>(hint < std::int8_t{ 0 })), turned);
      StoreVector(wide << tans::TableBits, tables);
    }
  }

  HWY_INLINE bool HasEscapes() const
  {
    SignedByteVector most{};
    int k = 0;
    const std::int8_t* tops = this->Memory.Tops.data();
    for (; k + Width <= this->Count; k += Width)
    {
      const auto each = LoadVector<SignedByteVector>(tops + k);
      most = each > most ? each : most;
    }
    std::int8_t greatest = 0;
    for (; k < this->Count; ++k)
    {
      greatest = std::max(greatest, tops[k]);
    }
    const auto escapes =
      reinterpret_cast<ByteVector>(most >= static_cast<std::int8_t>(residual::EscapeTop));
    return greatest >= residual::EscapeTop || AnyOf(escapes);
  }

  /// Residuals with extra bits, which follow those of their run.
  HWY_NOINLINE void ReadLong() const
  {
    const std::int8_t* tops = this->Memory.Tops.data();
    for (int k = 0; k < this->Count; ++k)
    {
      const std::int32_t residual =
        tops[k] < residual::EscapeTop
          ? tops[k]
          : this->Symbols->Long(static_cast<std::uint32_t>(tops[k] - residual::EscapeTop));
      // Wraps where a file of ill intent makes it.
      const std::uint32_t turned = static_cast<std::uint32_t>(
        std::int32_t{ this->Memory.Turned[static_cast<std::size_t>(k)] });
      this->Memory.Long[static_cast<std::size_t>(k)] =
        static_cast<Number>((static_cast<std::uint32_t>(residual) ^ turned) - turned);
    }
  }

  HWY_INLINE void PlacePredictions(int rows) const
  {
    for (int r = 0; r < rows; ++r)
    {
      this->PlacePrediction(this->Memory.Rows[r]);
    }
  }

  HWY_INLINE void PlacePrediction(const RowPlace& place) const
  {
    for (int at = 0; at < this->B() - P::First; at += Width)
    {
      SetLanes<P>(Predict<P>(this->Of.W, this->B, place, at, this->By), this->B() - P::First - at,
        this->Of.W + place.W + P::First + at);
    }
  }

  /// Predicts rows and adds their residuals.
  template <class Residual>
  HWY_INLINE void Place(int rows, const Residual* residuals) const
  {
    for (int r = 0; r < rows; ++r)
    {
      const RowPlace& place = this->Memory.Rows[r];
      const int begin = this->Memory.Begin[r];
      if (begin < 0)
      {
        this->PlacePrediction(place);
      }
      else if (place.Coded == P::LanesOf(this->B()))
      {
        this->PlaceRow(place, residuals + begin, this->Memory.Tops.data() + begin,
          this->Memory.Turned.data() + begin);
      }
      else
      {
        // Beyond the field's end there are no residuals.
        Residual some[SliceMemory<Number>::MostRows + Width] = {};
        std::int8_t tops[SliceMemory<Number>::MostRows + Width] = {};
        std::copy_n(residuals + begin, place.Coded, some);
        std::int8_t turned[SliceMemory<Number>::MostRows + Width] = {};
        std::copy_n(this->Memory.Tops.data() + begin, place.Coded, tops);
        std::copy_n(this->Memory.Turned.data() + begin, place.Coded, turned);
        this->PlaceRow(place, some, tops, turned);
      }
    }
  }

  template <class Residual>
  HWY_INLINE void PlaceRow(const RowPlace& place, const Residual* residuals,
    const std::int8_t* tops, const std::int8_t* turned) const
  {
    using V = Numbers<Number>;
    using Vector = typename V::Unsigned;
    const int left = this->B() - P::First;
    Number* w = this->Of.W + place.W + P::First;
    std::uint8_t* m = this->Of.M + place.M + P::First;
    std::int8_t* r = this->Of.R + place.M + P::First;
    std::uint16_t total = 0;
    for (int at = 0, k = 0; at < left; at += Width, k += Width / P::Step)
    {
      Vector residual;
      SignedByteVector kept;
      if constexpr (std::is_same_v<Residual, std::int8_t>)
      {
        // As unsigned numbers: lanes behind the last symbol hold anything, also what has no
        // opposite.
        const auto turn = LoadVector<ByteVector>(turned + k);
        kept =
          reinterpret_cast<SignedByteVector>((LoadVector<ByteVector>(residuals + k) ^ turn) - turn);
        residual = reinterpret_cast<Vector>(__builtin_convertvector(kept, typename V::Signed));
        kept = Limited(kept, std::int8_t{ 15 });
      }
      else
      {
        residual = V::Load(residuals + k);
        kept = __builtin_convertvector(
          Limited(reinterpret_cast<typename V::Signed>(residual), Number{ 15 }), SignedByteVector);
      }
      const Vector value =
        Predict<P>(this->Of.W, this->B, place, at, this->By) +
        Expanded<P::Step>(residual) * static_cast<std::make_unsigned_t<Number>>(this->Bin);
      SetLanes<P>(value, left - at, w + at);
      const ByteVector mask = LaneMask<P, ByteVector>(left - at);
      const ByteVector size =
        Expanded<P::Step>(MagnitudesOf(LoadVector<SignedByteVector>(tops + k))) & mask;
      total = static_cast<std::uint16_t>(total + SumOf(size));
      StoreVector(size | (LoadVector<ByteVector>(m + at) & ~mask), m + at);
      if (P::D > 1)
      {
        KeepResiduals(
          reinterpret_cast<SignedByteVector>(Expanded<P::Step>(reinterpret_cast<ByteVector>(kept))),
          mask, r + at);
      }
    }
    const int slice = P::D == 3 ? place.Z : P::D == 2 ? place.Y : 0;
    std::uint16_t& sum = this->Of.S[slice * block::Shape<P::D>{ this->B() }.SumPitch() + place.Row];
    sum = static_cast<std::uint16_t>(sum + total);
  }

  mutable int Count = 0;

public:
  SliceDecoder(Unit<Number, P::D>& unit, const Edge& edge, Interpolation by, SymbolReader* symbols,
    Number bin, SliceMemory<Number>& memory)
    : Of(unit)
    , B(edge)
    , By(by)
    , Symbols(symbols)
    , Bin(bin)
    , Memory(memory)
  {
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
