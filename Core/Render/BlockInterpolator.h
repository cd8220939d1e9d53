#ifndef banyan_Render_BlockInterpolator_h
#define banyan_Render_BlockInterpolator_h

#include "Render/Interpolators.h"

// Every x86-64 processor has SSE2. Elsewhere the plain way is the only one.
#if defined(__SSE2__)
#define BANYAN_HAS_BLOCKS 1

#include <algorithm>

#include <emmintrin.h>

namespace banyan
{

/// Four positions, relative to the brick's corner.
struct PositionBlock
{
  /// Positions start, start + step, ...; those after the first `count` repeat the last of them.
  PositionBlock(const std::int64_t (&start)[3], const std::int64_t (&step)[3], int count)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto at = [&](int i) { return start[axis] + std::min(i, count - 1) * step[axis]; };
      this->Axis[axis][0] = _mm_set_epi64x(at(1), at(0));
      this->Axis[axis][1] = _mm_set_epi64x(at(3), at(2));
    }
  }

  __m128i Axis[3][2];
};

/// Interpolates at four positions at once: what a sample needs takes about a hundred cycles from
/// position to value, and only work that is independent can hide them. Bit for bit what
/// PlainInterpolator gives: the same operations on the same numbers in the same order.
///
/// @tparam Pairs whether values lie side by side along x and have a type that is not relative:
///         then two corners are one load.
template <class T, bool Pairs>
class BlockInterpolator
{
public:
  /// Whether the strides fit into the 32 bits that products of cells and strides allow.
  static bool CanRead(const BrickView& view)
  {
    constexpr std::ptrdiff_t largest = (std::ptrdiff_t{ 1 } << 32) / Size - 1;
    const auto fits = [](std::ptrdiff_t stride) { return stride >= 0 && stride <= largest; };
    return fits(view.Stride[0]) && fits(view.Stride[1]) && fits(view.Stride[2]) &&
           (!Pairs || view.Stride[0] == 1);
  }

  BlockInterpolator(const BrickView& view, double low)
    : Values(static_cast<const char*>(view.Values))
    , Low(low)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Stride[axis] = view.Stride[axis] * Size;
    }
  }

  __m128 At(const PositionBlock& block) const
  {
    const __m128i first = this->OffsetsOf(block, 0);
    const __m128i second = this->OffsetsOf(block, 1);
    const __m128 z = Fractions(block.Axis[2]);
    __m128 a = this->Edges(_mm_cvtsi128_si64(first), _mm_shuffle_ps(z, z, 0x00));
    __m128 b =
      this->Edges(_mm_cvtsi128_si64(_mm_unpackhi_epi64(first, first)), _mm_shuffle_ps(z, z, 0x55));
    __m128 c = this->Edges(_mm_cvtsi128_si64(second), _mm_shuffle_ps(z, z, 0xAA));
    __m128 d = this->Edges(
      _mm_cvtsi128_si64(_mm_unpackhi_epi64(second, second)), _mm_shuffle_ps(z, z, 0xFF));
    _MM_TRANSPOSE4_PS(a, b, c, d); // now one edge of all four positions each
    const __m128 y = Fractions(block.Axis[1]);
    return Mix(Mix(a, c, y), Mix(b, d, y), Fractions(block.Axis[0]));
  }

private:
  static constexpr std::ptrdiff_t Size = sizeof(T);

  static __m128 Mix(__m128 a, __m128 b, __m128 part)
  {
    return _mm_add_ps(a, _mm_mul_ps(part, _mm_sub_ps(b, a)));
  }

  static __m128 Fractions(const __m128i (&position)[2])
  {
    const __m128i first = _mm_srli_epi64(position[0], FractionBits - UsedBits);
    const __m128i second = _mm_srli_epi64(position[1], FractionBits - UsedBits);
    const __m128i low = _mm_castps_si128(
      _mm_shuffle_ps(_mm_castsi128_ps(first), _mm_castsi128_ps(second), _MM_SHUFFLE(2, 0, 2, 0)));
    const __m128i bits = _mm_and_si128(low, _mm_set1_epi32((1 << UsedBits) - 1));
    return _mm_mul_ps(_mm_cvtepi32_ps(bits), _mm_set1_ps(UsedUnit));
  }

  /// Bytes from the brick's corner to the cells of two positions.
  __m128i OffsetsOf(const PositionBlock& block, int half) const
  {
    __m128i sum = _mm_setzero_si128();
    for (int axis = 0; axis < 3; ++axis)
    {
      const __m128i cell = _mm_srli_epi64(block.Axis[axis][half], FractionBits);
      sum = _mm_add_epi64(sum, _mm_mul_epu32(cell, _mm_set1_epi64x(this->Stride[axis])));
    }
    return sum;
  }

  /// The four edges along z of a cell, mixed: (x0 y0, x1 y0, x0 y1, x1 y1).
  __m128 Edges(std::int64_t offset, __m128 z) const
  {
    const char* cell = this->Values + offset;
    const char* upper = cell + this->Stride[2];
    __m128 low;
    __m128 high;
    if constexpr (!Pairs)
    {
      low = this->LoadCorners(cell);
      high = this->LoadCorners(upper);
    }
    else if constexpr (std::is_same_v<T, float>)
    {
      low = this->LoadFloats(cell);
      high = this->LoadFloats(upper);
    }
    else
    {
      this->LoadShorts(cell, upper, low, high);
    }
    return Mix(low, high, z);
  }

  __m128 LoadCorners(const char* cell) const
  {
    const auto at = [&](std::ptrdiff_t offset)
    {
      T value;
      std::memcpy(&value, cell + offset, sizeof(T));
      return CornerValue(value, this->Low);
    };
    return _mm_set_ps(
      at(this->Stride[0] + this->Stride[1]), at(this->Stride[1]), at(this->Stride[0]), at(0));
  }

  __m128 LoadFloats(const char* cell) const
  {
    // Types that may alias and need no alignment.
    const __m128i first = _mm_loadl_epi64(reinterpret_cast<const __m128i_u*>(cell));
    return _mm_loadh_pi(
      _mm_castsi128_ps(first), reinterpret_cast<const __m64*>(cell + this->Stride[1]));
  }

  /// Integers of one or two bytes.
  void LoadShorts(const char* cell, const char* upper, __m128& low, __m128& high) const
  {
    if constexpr (sizeof(T) == 2)
    {
      const auto row = [this](const char* p)
      {
        return _mm_unpacklo_epi32(_mm_cvtsi32_si128(LoadBits<std::int32_t>(p)),
          _mm_cvtsi32_si128(LoadBits<std::int32_t>(p + this->Stride[1])));
      };
      low = Widen<T>(row(cell));
      high = Widen<T>(row(upper));
    }
    else
    {
      static_assert(sizeof(T) == 1);
      __m128i bits = _mm_cvtsi32_si128(LoadBits<std::uint16_t>(cell));
      bits = _mm_insert_epi16(bits, LoadBits<std::uint16_t>(cell + this->Stride[1]), 1);
      bits = _mm_insert_epi16(bits, LoadBits<std::uint16_t>(upper), 2);
      bits = _mm_insert_epi16(bits, LoadBits<std::uint16_t>(upper + this->Stride[1]), 3);
      // A byte in the upper half of 16 bits, shifted down with or without its sign.
      bits = _mm_unpacklo_epi8(_mm_setzero_si128(), bits);
      bits = std::is_signed_v<T> ? _mm_srai_epi16(bits, 8) : _mm_srli_epi16(bits, 8);
      low = Widen<std::int16_t>(bits);
      high = Widen<std::int16_t>(_mm_unpackhi_epi64(bits, bits));
    }
  }

  template <class Bits>
  static Bits LoadBits(const char* address)
  {
    Bits bits;
    std::memcpy(&bits, address, sizeof(bits));
    return bits;
  }

  /// The lower four 16-bit integers as floats.
  template <class Integer>
  static __m128 Widen(__m128i bits)
  {
    const __m128i sign = std::is_signed_v<Integer> ? _mm_srai_epi16(bits, 15) : _mm_setzero_si128();
    return _mm_cvtepi32_ps(_mm_unpacklo_epi16(bits, sign));
  }

  const char* Values;
  std::int64_t Stride[3]; ///< in bytes
  double Low;
};

} // namespace banyan

#endif

#endif
