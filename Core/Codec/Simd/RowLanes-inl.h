// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_RowLanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_RowLanes_inl_h
#undef banyan_Codec_RowLanes_inl_h
#else
#define banyan_Codec_RowLanes_inl_h
#endif

#include "Codec/Simd/SliceContexts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// The lanes of a slice that carry symbols: from where they are to runs of symbols, and back.
/// @param B edge of the blocks
template <class P, int B>
class RowLanes
{
public:
  static constexpr int D = P::D;
  static constexpr int S = P::S;
  static constexpr int N = B / S;
  static constexpr int LaneStep = P::Step / S;
  static constexpr int RowFirst = D == 3 ? P::FirstRow / S : 0;
  static constexpr int RowStep = D == 3 ? P::RowStep / S : 1;
  static constexpr int RowEnd = D == 3 ? N : 3;
  static constexpr int Full = (B - 1 - P::First) / P::Step + 1; ///< symbols of a row that is inside
  /// The rows that the pass has, as bits.
  static constexpr unsigned AllRows = static_cast<unsigned>(
    ((std::uint64_t{ 1 } << RowEnd) - (std::uint64_t{ 1 } << RowFirst)) &
    (RowStep == 1 ? ~std::uint64_t{ 0 } : std::uint64_t{ 0x55555555 } << RowFirst));

  /// @param last position of a row's lanes within the field
  HWY_INLINE void SetLast(int row, int last)
  {
    int& coded = this->Coded[D == 3 ? 0 : row];
    coded = P::First <= last ? (std::min(last, B - 1) - P::First) / P::Step + 1 : 0;
    this->Whole = this->Whole && coded == Full;
  }

  /// The symbols' places of rows, side by side. @return how many
  HWY_INLINE int TakePlaces(unsigned rows, SliceMemory<B>& memory) const
  {
    const auto take = [&memory](int row, int begin)
    {
      const std::uint8_t* const from = memory.Tables + row * N;
      StorePlaces(Picked<1, LaneStep, 1>(LoadRowOf<N>(from)), memory.Places + begin);
      if constexpr (N > Width)
      {
        StorePlaces(Picked<LaneStep - 1, LaneStep, 1>(LoadRowOf<N>(from + Width)),
          memory.Places + begin + InFirst);
      }
    };
    int count = 0;
    if (this->Whole)
    {
      for (unsigned left = rows; left != 0; left &= left - 1)
      {
        take(__builtin_ctz(left), count);
        count += Full;
      }
      return count;
    }
    for (unsigned left = rows; left != 0; left &= left - 1)
    {
      const int row = __builtin_ctz(left);
      take(row, count);
      count += this->CodedOf(row);
    }
    return count;
  }

  /// Symbols that were read, back to where the lanes of a row are; zeros if it has none.
  /// @param Part of the row: which 16 lanes
  /// @param next of the symbols; rows are taken in order
  template <int Part>
  HWY_INLINE Bytes SymbolsOf(int row, unsigned rows, const std::int8_t*& next) const
  {
    const int coded = this->Whole ? Full : this->CodedOf(row < RowEnd ? row : 0);
    const unsigned some = rows >> row & 1u;
    // Lane 0 gets anything, which is left out.
    const Bytes symbols = Picked<(LaneStep == 1 && Part == 0 ? 15 : 0), 1, LaneStep>(
      BitsAs<std::uint8_t>(SignedBytes::Load(next + Part * InFirst)));
    next += Part == Parts - 1 && some != 0 ? coded : 0;
    return symbols & LanesWith<Part>(coded) & Bytes::Set(static_cast<std::uint8_t>(0u - some));
  }

  /// The same of as many rows as a vector has, or of a part of a row. They are put together in
  /// registers: what is stored in pieces is waited for where it is loaded as a whole.
  template <int Part, class Tag>
  HWY_INLINE hn::VFromD<Tag> SymbolsFrom(
    Tag d, int row, unsigned rows, const std::int8_t*& next) const
  {
    constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
    if constexpr (lanes > std::max(N, Width))
    {
      const hn::Half<Tag> half;
      const auto low = this->template SymbolsFrom<0>(half, row, rows, next);
      const auto high = this->template SymbolsFrom<0>(half, row + lanes / 2 / N, rows, next);
      return hn::Combine(d, high, low);
    }
    else if constexpr (lanes > Width)
    {
      const auto low = this->template SymbolsOf<0>(row, rows, next);
      const auto high = this->template SymbolsOf<1>(row, rows, next);
      return hn::Combine(d, high.V, low.V);
    }
    else if constexpr (N >= Width)
    {
      return this->template SymbolsOf<Part>(row, rows, next).V;
    }
    else
    {
      const auto first = this->template SymbolsOf<0>(row, rows, next);
      const auto second = this->template SymbolsOf<0>(row + 1, rows, next);
      const hn::Repartition<std::uint64_t, Tag> words;
      return hn::BitCast(
        d, hn::InterleaveLower(words, hn::BitCast(words, first.V), hn::BitCast(words, second.V)));
    }
  }

private:
  static constexpr int Parts = N > Width ? 2 : 1;        ///< of a row, 16 lanes each
  static constexpr int InFirst = LaneStep == 1 ? 15 : 8; ///< symbols of the first one

  int CodedOf(int row) const { return this->Coded[D == 3 ? 0 : row]; }

  /// Numbers of symbols that lanes have, and more than there are for those that have none.
  template <int Part>
  struct SymbolNumbers
  {
    static constexpr int Value(int lane)
    {
      const int number = Part * Width + lane - 1;
      return number < 0 || number % LaneStep != 0 ? 127 : number;
    }
  };
  template <int Part>
  static HWY_INLINE Bytes LanesWith(int symbols)
  {
    const auto numbers = ConstantLanes<std::int8_t, Width, SymbolNumbers<Part>>::Get();
    return BitsAs<std::uint8_t>(
      SignedBytes::Set(static_cast<std::int8_t>(symbols * LaneStep)) > numbers);
  }

  int Coded[3] = {}; ///< symbols of a row; of each face
  bool Whole = true; ///< rows are inside to their ends
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
