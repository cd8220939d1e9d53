// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_DenseLanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_DenseLanes_inl_h
#undef banyan_Codec_DenseLanes_inl_h
#else
#define banyan_Codec_DenseLanes_inl_h
#endif

#include "Codec/DenseContexts-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE

/// The lanes of a slice that carry symbols: from where they are to runs of symbols, and back.
/// @param B edge of the blocks
template <class P, int B>
class DenseLanes
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
  HWY_INLINE int TakePlaces(unsigned rows, DenseMemory<B>& memory) const
  {
    const auto take = [&memory](int row, int begin)
    {
      const std::uint8_t* const from = memory.Tables + row * N;
      StorePlaces(
        __builtin_shuffle(LoadRowOf<N>(from), LanesFrom<1, LaneStep, 1>()), memory.Places + begin);
      if constexpr (N > Width)
      {
        StorePlaces(
          __builtin_shuffle(LoadRowOf<N>(from + Width), LanesFrom<LaneStep - 1, LaneStep, 1>()),
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
  HWY_INLINE ByteVector TopsOf(int row, unsigned rows, const std::int8_t*& next) const
  {
    const int coded = this->Whole ? Full : this->CodedOf(row < RowEnd ? row : 0);
    const unsigned some = rows >> row & 1u;
    // Lane 0 gets anything, which is left out.
    const ByteVector tops = __builtin_shuffle(LoadVector<ByteVector>(next + Part * InFirst),
      LanesFrom < LaneStep == 1 && Part == 0 ? 15 : 0, 1, LaneStep > ());
    next += Part == Parts - 1 && some != 0 ? coded : 0;
    return tops & LanesWith<Part>(coded) & static_cast<std::uint8_t>(0u - some);
  }

  /// The same of as many rows as a vector has. They are put together in registers: what is stored
  /// in pieces is waited for where it is loaded as a whole.
  template <class Bytes>
  HWY_INLINE hn::VFromD<Bytes> TopsFrom(
    Bytes d, int row, unsigned rows, const std::int8_t*& next) const
  {
    constexpr int lanes = static_cast<int>(hn::MaxLanes(Bytes()));
    if constexpr (lanes > std::max(N, Width))
    {
      const hn::Half<Bytes> half;
      const auto low = this->TopsFrom(half, row, rows, next);
      const auto high = this->TopsFrom(half, row + lanes / 2 / N, rows, next);
      return hn::Combine(d, high, low);
    }
    else
    {
      alignas(16) std::uint8_t first[16];
      StoreVector(this->TopsOf<0>(row, rows, next), first);
      if constexpr (N == Width)
      {
        return hn::Load(d, first);
      }
      else if constexpr (N > Width)
      {
        alignas(16) std::uint8_t second[16];
        StoreVector(this->TopsOf<1>(row, rows, next), second);
        const hn::Half<Bytes> half;
        return hn::Combine(d, hn::Load(half, second), hn::Load(half, first));
      }
      else
      {
        alignas(16) std::uint8_t second[16];
        StoreVector(this->TopsOf<0>(row + 1, rows, next), second);
        const hn::Repartition<std::uint64_t, Bytes> words;
        return hn::BitCast(d, hn::InterleaveLower(words, hn::BitCast(words, hn::Load(d, first)),
                                hn::BitCast(words, hn::Load(d, second))));
      }
    }
  }

private:
  static constexpr int Parts = N > Width ? 2 : 1;        ///< of a row, 16 lanes each
  static constexpr int InFirst = LaneStep == 1 ? 15 : 8; ///< symbols of the first one

  int CodedOf(int row) const { return this->Coded[D == 3 ? 0 : row]; }

  template <int Part>
  static HWY_INLINE ByteVector LanesWith(int symbols)
  {
    // Lane 0 has none: its number wraps.
    const ByteVector lanes =
      LaneNumbers<ByteVector>() + static_cast<std::uint8_t>(Part * Width - 1);
    const auto below =
      reinterpret_cast<ByteVector>(lanes < static_cast<std::uint8_t>(symbols * LaneStep));
    return LaneStep == 1
             ? below
             : below & ByteVector{ 0, 255, 0, 255, 0, 255, 0, 255, 0, 255, 0, 255, 0, 255, 0, 255 };
  }

  int Coded[3] = {}; ///< symbols of a row; of each face
  bool Whole = true; ///< rows are inside to their ends
};

#endif
} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
