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
  static constexpr int MostSymbols = 64 * 64;

  explicit SliceMemory(int edge)
    : Classes(static_cast<std::size_t>(edge * std::max(edge, 3) + 2 * Width))
    , Tops(Classes.size())
    , Long(Classes.size())
  {
  }

  std::vector<std::uint16_t> Classes; ///< of each symbol, times tans::TableSize
  std::vector<std::int8_t> Tops;      ///< residuals, or escapes
  std::vector<Number> Long;           ///< residuals, where there are escapes
  RowPlace Rows[MostRows];
  int Begin[MostRows]; ///< of a row's symbols; -1: it has none
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
      const bool any = this->Symbols != nullptr && this->ReadSymbols(rows);
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
  HWY_INLINE bool ReadSymbols(int rows) const
  {
    SliceMemory<Number>& memory = this->Memory;
    int count = 0;
    int smooth = 0;
    bool rough[SliceMemory<Number>::MostRows];
    for (int r = 0; r < rows; ++r)
    {
      const int coded = memory.Rows[r].Coded;
      memory.Begin[r] = coded > 0 ? count : -1;
      rough[r] = false;
      if (coded > 0)
      {
        rough[r] = this->Of.Any && this->Classify(memory.Rows[r], memory.Classes.data() + count);
        smooth += rough[r] ? 0 : 1;
        count += coded;
      }
    }
    if (smooth > 0)
    {
      count = this->ReadFlags(rows, rough, smooth);
    }
    if (count == 0)
    {
      return false;
    }
    ReadRun(*this->Symbols, P::Band * residual::Classes, memory.Classes.data(), count,
      memory.Tops.data());
    this->Of.Any = true;
    this->Count = count;
    return true;
  }

  /// Writes down the classes of a row's symbols. Returns whether any is not 0.
  HWY_INLINE bool Classify(const RowPlace& place, std::uint16_t* classes) const
  {
    ByteVector any{};
    const std::uint8_t* m = this->Of.M + place.M + P::First;
    const int lanes = place.Coded * P::Step;
    for (int at = 0; at < lanes; at += Width, classes += Width / P::Step)
    {
      ByteVector sum = RoughnessOf<P>(m + at, this->B, place);
      sum &= LaneMask<P, ByteVector>(lanes - at);
      any |= sum;
      typedef std::uint16_t Classes16 __attribute__((vector_size(32)));
      const Classes16 wide =
        __builtin_convertvector(Compressed<P::Step>(ClassesOf(sum)), Classes16);
      StoreVector(wide << tans::TableBits, classes);
    }
    return AnyOf(any);
  }

  /// Rows without anything around begin with a flag: whether all is zero. Leaves the symbols of the
  /// others, one after the other.
  /// @return how many there are
  HWY_NOINLINE int ReadFlags(int rows, const bool* rough, int smooth) const
  {
    SliceMemory<Number>& memory = this->Memory;
    static constexpr std::uint16_t none[SliceMemory<Number>::MostRows] = {};
    ReadRun(*this->Symbols, residual::FlagContext + P::Band, none, smooth, memory.Flags);
    int count = 0;
    int flag = 0;
    for (int r = 0; r < rows; ++r)
    {
      if (memory.Begin[r] < 0)
      {
        continue;
      }
      if (!rough[r] && memory.Flags[flag++] != 0)
      {
        memory.Begin[r] = -1;
        continue;
      }
      std::uint16_t* to = memory.Classes.data() + count;
      const int coded = memory.Rows[r].Coded;
      if (rough[r])
      {
        std::copy_n(memory.Classes.data() + memory.Begin[r], coded, to);
      }
      else
      {
        std::fill_n(to, coded, std::uint16_t{ 0 });
      }
      memory.Begin[r] = count;
      count += coded;
    }
    return count;
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
      this->Memory.Long[static_cast<std::size_t>(k)] = tops[k] < residual::EscapeTop
        ? static_cast<Number>(tops[k])
        : static_cast<Number>(
            this->Symbols->Long(static_cast<std::uint32_t>(tops[k] - residual::EscapeTop)));
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
        this->PlaceRow(place, residuals + begin, this->Memory.Tops.data() + begin);
      }
      else
      {
        // Beyond the field's end there are no residuals.
        Residual some[SliceMemory<Number>::MostRows + Width] = {};
        std::int8_t tops[SliceMemory<Number>::MostRows + Width] = {};
        std::copy_n(residuals + begin, place.Coded, some);
        std::copy_n(this->Memory.Tops.data() + begin, place.Coded, tops);
        this->PlaceRow(place, some, tops);
      }
    }
  }

  template <class Residual>
  HWY_INLINE void PlaceRow(
    const RowPlace& place, const Residual* residuals, const std::int8_t* tops) const
  {
    using V = Numbers<Number>;
    using Vector = typename V::Unsigned;
    const int left = this->B() - P::First;
    Number* w = this->Of.W + place.W + P::First;
    std::uint8_t* m = this->Of.M + place.M + P::First;
    for (int at = 0, k = 0; at < left; at += Width, k += Width / P::Step)
    {
      Vector residual;
      if constexpr (std::is_same_v<Residual, std::int8_t>)
      {
        residual = reinterpret_cast<Vector>(__builtin_convertvector(
          LoadVector<SignedByteVector>(residuals + k), typename V::Signed));
      }
      else
      {
        residual = V::Load(residuals + k);
      }
      const Vector value = Predict<P>(this->Of.W, this->B, place, at, this->By) +
                           Expanded<P::Step>(residual) * static_cast<std::make_unsigned_t<Number>>(this->Bin);
      SetLanes<P>(value, left - at, w + at);
      const ByteVector mask = LaneMask<P, ByteVector>(left - at);
      const ByteVector size = MagnitudesOf(LoadVector<SignedByteVector>(tops + k));
      StoreVector((Expanded<P::Step>(size) & mask) |
                    (LoadVector<ByteVector>(m + at) & ~mask),
        m + at);
    }
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
