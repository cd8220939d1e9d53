// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Bricks_PacketVectors_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Bricks_PacketVectors_inl_h
#undef banyan_Render_Bricks_PacketVectors_inl_h
#else
#define banyan_Render_Bricks_PacketVectors_inl_h
#endif

#include "Render/Scene/RayPacket.h"
#include "Render/Scene/TransferFunction.h"

#include <hwy/highway.h>

#include <cstring>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

namespace hn = hwy::HWY_NAMESPACE;

// Sets beyond AVX3 have lower numbers, and are worked with as AVX3.
#if HWY_TARGET <= HWY_AVX3 || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4
using D = hn::ScalableTag<float>; ///< 16, 8 or 4 lanes
#else
using D = hn::CappedTag<float, 4>;
#endif
using DI = hn::Rebind<std::int32_t, D>;
using DU = hn::Rebind<std::uint32_t, D>;
using DWide = hn::Repartition<std::uint64_t, D>;
using VF = hn::Vec<D>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;

/// Distances in bytes per lane, where scalar code can read them.
struct Offsets
{
  HWY_INLINE void Set(VI bytes)
  {
    hn::Store(bytes, DI(), this->Bytes);
#if HWY_COMPILER_GCC || HWY_COMPILER_CLANG
    // Otherwise numbers are taken out of the vector one by one, which is slower than loading them.
    __asm__("" : "+m"(this->Bytes));
#endif
  }

  alignas(64) std::int32_t Bytes[RayPacket::Size];
};

/// Four floats of each lane: lane 4 b + k has those of block b of number k. Blocks of 128 bits are
/// loaded one by one: on many processors a gather takes much longer than its loads.
struct Blocks
{
  VF Of[4];
};

#if HWY_TARGET != HWY_SCALAR
/// Blocks at the first, fifth, ... distance.
HWY_INLINE VF LoadBlocks(const char* base, const std::int32_t* bytes)
{
  const auto at = [&](int i) HWY_ATTR { return reinterpret_cast<const float*>(base + bytes[i]); };
#if HWY_TARGET <= HWY_AVX3
  // Blocks are put in place as they are loaded, which takes no shuffle.
  __m512 v = _mm512_castps128_ps512(_mm_loadu_ps(at(0)));
  v = _mm512_insertf32x4(v, _mm_loadu_ps(at(4)), 1);
  v = _mm512_insertf32x4(v, _mm_loadu_ps(at(8)), 2);
  return VF{ _mm512_insertf32x4(v, _mm_loadu_ps(at(12)), 3) };
#elif HWY_TARGET == HWY_AVX2
  const __m256 v = _mm256_castps128_ps256(_mm_loadu_ps(at(0)));
  return VF{ _mm256_insertf128_ps(v, _mm_loadu_ps(at(4)), 1) };
#else
  static_assert(hn::MaxLanes(D()) == 4, "one block");
  return hn::LoadU(D(), at(0));
#endif
}

/// As LoadBlocks; each block is two floats and the two that lie a row further.
/// @param row bytes
HWY_INLINE VF LoadFaces(const char* base, const std::int32_t* bytes, std::ptrdiff_t row)
{
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128
  const auto at = [&](int i) HWY_ATTR
  {
    const auto* const from = reinterpret_cast<const double*>(base + bytes[i]);
    const auto* const next = reinterpret_cast<const double*>(base + bytes[i] + row);
    return _mm_castpd_ps(_mm_loadh_pd(_mm_load_sd(from), next));
  };
#else
  const auto at = [&](int i) HWY_ATTR
  {
    const hn::Full64<float> two;
    const auto* const from = reinterpret_cast<const float*>(base + bytes[i]);
    const auto* const next = reinterpret_cast<const float*>(base + bytes[i] + row);
    return hn::Combine(D(), hn::LoadU(two, next), hn::LoadU(two, from));
  };
#endif
#if HWY_TARGET <= HWY_AVX3
  __m512 v = _mm512_castps128_ps512(at(0));
  v = _mm512_insertf32x4(v, at(4), 1);
  v = _mm512_insertf32x4(v, at(8), 2);
  return VF{ _mm512_insertf32x4(v, at(12), 3) };
#elif HWY_TARGET == HWY_AVX2
  return VF{ _mm256_insertf128_ps(_mm256_castps128_ps256(at(0)), at(4), 1) };
#elif HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128
  return VF{ at(0) };
#else
  return at(0);
#endif
}

/// Whether 16-bit numbers give the bits of their values: not without fused operations.
#undef BANYAN_HAS_NUMBERS
#define BANYAN_HAS_NUMBERS HWY_NATIVE_FMA

/// As LoadFaces, of 16-bit numbers, as floats.
HWY_INLINE VF LoadNumberFaces(const char* base, const std::int32_t* bytes, std::ptrdiff_t row)
{
  const auto two = [](const char* from) HWY_ATTR
  {
    std::int32_t numbers;
    std::memcpy(&numbers, from, sizeof(numbers));
    return numbers;
  };
#if HWY_TARGET <= HWY_AVX3 || HWY_TARGET == HWY_AVX2
  const auto faces = [&](int i) HWY_ATTR
  {
    const char* const first = base + bytes[i];
    const char* const second = base + bytes[i + 4];
    __m128i v = _mm_cvtsi32_si128(two(first));
    v = _mm_insert_epi32(v, two(first + row), 1);
    v = _mm_insert_epi32(v, two(second), 2);
    return _mm_insert_epi32(v, two(second + row), 3);
  };
#endif
#if HWY_TARGET <= HWY_AVX3
  const __m256i all = _mm256_inserti128_si256(_mm256_castsi128_si256(faces(0)), faces(8), 1);
  return VF{ _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(all)) };
#elif HWY_TARGET == HWY_AVX2
  return VF{ _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(faces(0))) };
#else
  const char* const from = base + bytes[0];
  const std::int32_t face[2] = { two(from), two(from + row) };
  const hn::Rebind<std::int16_t, D> narrow;
  const auto numbers = hn::LoadU(narrow, reinterpret_cast<const std::int16_t*>(face));
  return hn::ConvertTo(D(), hn::PromoteTo(DI(), numbers));
#endif
}

HWY_INLINE Blocks LoadBlocks(const void* base, const Offsets& offsets)
{
  const auto* from = static_cast<const char*>(base);
  return { { LoadBlocks(from, offsets.Bytes), LoadBlocks(from, offsets.Bytes + 1),
    LoadBlocks(from, offsets.Bytes + 2), LoadBlocks(from, offsets.Bytes + 3) } };
}

#if HWY_TARGET <= HWY_AVX3 || HWY_TARGET == HWY_AVX2
#undef BANYAN_HAS_PAIRS
#define BANYAN_HAS_PAIRS 1
/// Two blocks that lie side by side, of every lane 4 b + k: in two vectors, the first of which has
/// them for the lower half of b. Half as many loads as of blocks.
struct Pairs
{
  VF Of[2];
};

template <int half>
HWY_INLINE VF LoadHalfOfPairs(const char* base, const std::int32_t* bytes)
{
  const auto at = [&](int i) HWY_ATTR { return reinterpret_cast<const float*>(base + bytes[i]); };
#if HWY_TARGET <= HWY_AVX3
  const __m512d v = _mm512_castpd256_pd512(_mm256_castps_pd(_mm256_loadu_ps(at(8 * half))));
  return VF{ _mm512_castpd_ps(
    _mm512_insertf64x4(v, _mm256_castps_pd(_mm256_loadu_ps(at(8 * half + 4))), 1)) };
#else
  return VF{ _mm256_loadu_ps(at(4 * half)) };
#endif
}

/// @param bytes distances; those of numbers 0, 4, 8 ... count
HWY_INLINE Pairs LoadPairs(const char* base, const std::int32_t* bytes)
{
  return { { LoadHalfOfPairs<0>(base, bytes), LoadHalfOfPairs<1>(base, bytes) } };
}

/// A number of each lane 4 b + k in all places of its pair.
template <int k>
HWY_INLINE Pairs ForPairs(VF v)
{
#if HWY_TARGET <= HWY_AVX3
  const __m512 inBlocks = _mm512_permute_ps(v.raw, k * 0x55);
  return { { VF{ _mm512_shuffle_f32x4(inBlocks, inBlocks, _MM_SHUFFLE(1, 1, 0, 0)) },
    VF{ _mm512_shuffle_f32x4(inBlocks, inBlocks, _MM_SHUFFLE(3, 3, 2, 2)) } } };
#else
  const __m256 inBlocks = _mm256_permute_ps(v.raw, k * 0x55);
  return { { VF{ _mm256_permute2f128_ps(inBlocks, inBlocks, 0x00) },
    VF{ _mm256_permute2f128_ps(inBlocks, inBlocks, 0x11) } } };
#endif
}

/// The first (0) or the second (1) blocks of pairs: block b is that of lane 4 b + k.
template <int which>
HWY_INLINE VF BlocksOf(const Pairs& pairs)
{
  const auto low = pairs.Of[0].raw;
  const auto high = pairs.Of[1].raw;
#if HWY_TARGET <= HWY_AVX3
  return VF{ _mm512_shuffle_f32x4(low, high, _MM_SHUFFLE(2 + which, which, 2 + which, which)) };
#else
  return VF{ _mm256_permute2f128_ps(low, high, 0x20 + 0x11 * which) };
#endif
}
#else
#undef BANYAN_HAS_PAIRS
#define BANYAN_HAS_PAIRS 0
#endif

/// From four floats of a lane side by side to four vectors of them.
HWY_INLINE Blocks Transposed(const Blocks& blocks)
{
  const D d;
  const DWide wide;
  const auto lowAB = hn::BitCast(wide, hn::InterleaveLower(d, blocks.Of[0], blocks.Of[1]));
  const auto lowCD = hn::BitCast(wide, hn::InterleaveLower(d, blocks.Of[2], blocks.Of[3]));
  const auto highAB = hn::BitCast(wide, hn::InterleaveUpper(d, blocks.Of[0], blocks.Of[1]));
  const auto highCD = hn::BitCast(wide, hn::InterleaveUpper(d, blocks.Of[2], blocks.Of[3]));
  return { { hn::BitCast(d, hn::InterleaveLower(wide, lowAB, lowCD)),
    hn::BitCast(d, hn::InterleaveUpper(wide, lowAB, lowCD)),
    hn::BitCast(d, hn::InterleaveLower(wide, highAB, highCD)),
    hn::BitCast(d, hn::InterleaveUpper(wide, highAB, highCD)) } };
}

#endif

// No fused operations: all targets give the same bits, and those of the scalar interpolator.
HWY_INLINE VF Mix(VF a, VF b, VF part)
{
  return hn::Add(a, hn::Mul(part, hn::Sub(b, a)));
}

#if HWY_TARGET != HWY_SCALAR && BANYAN_HAS_PAIRS
HWY_INLINE Pairs Mix(const Pairs& a, const Pairs& b, const Pairs& part)
{
  return { { Mix(a.Of[0], b.Of[0], part.Of[0]), Mix(a.Of[1], b.Of[1], part.Of[1]) } };
}
#endif

/// Numbers that an integer can hold: without what ConvertTo does for others.
HWY_INLINE VI Truncated(VF v)
{
#if HWY_TARGET == HWY_SSE4
  return VI{ _mm_cvttps_epi32(v.raw) };
#elif HWY_TARGET == HWY_AVX2
  return VI{ _mm256_cvttps_epi32(v.raw) };
#elif HWY_TARGET <= HWY_AVX3
  return VI{ _mm512_cvttps_epi32(v.raw) };
#else
  return hn::ConvertTo(DI(), v);
#endif
}

/// The same as TableLookup::IndexOf of a table with edges.
HWY_INLINE VI EntriesOf(const TableLookup& lookup, VI buckets, VF value)
{
  const D d;
  const DI di;
  VI entries = hn::GatherIndex(di, lookup.First, buckets);
  for (int step = 1 << lookup.Steps >> 1; step > 0; step >>= 1)
  {
    const VI last = hn::Add(entries, hn::Set(di, step - 1));
    const auto above = hn::RebindMask(di, hn::Ge(value, hn::GatherIndex(d, lookup.Edges, last)));
    entries = hn::Add(entries, hn::IfThenElseZero(above, hn::Set(di, step)));
  }
  return entries;
}

/// As TableLookup::IndexOf.
/// @tparam Special whether values may not be finite, or the table may have edges
template <bool Special>
HWY_INLINE VI IndicesIn(const TableLookup& lookup, VF value)
{
  const D d;
  const VF position =
    hn::Add(hn::Mul(hn::Sub(value, hn::Set(d, lookup.Low)), hn::Set(d, lookup.Scale)),
      hn::Set(d, lookup.Bias));
  const VF last = hn::Set(d, lookup.Last);
  if (!Special)
  {
    const VF inside = hn::Min(hn::Max(position, hn::Zero(d)), last);
    return Truncated(inside);
  }
  const VF notBelow = hn::IfThenElseZero(hn::Gt(position, hn::Zero(d)), position);
  VI index = Truncated(hn::IfThenElse(hn::Lt(notBelow, last), notBelow, last));
  if (lookup.Edges)
  {
    index = EntriesOf(lookup, index, value);
  }
  const auto finite = hn::Le(hn::Abs(value), hn::Set(d, std::numeric_limits<float>::max()));
  return hn::IfThenElse(hn::RebindMask(DI(), finite), index, hn::Set(DI(), lookup.Transparent));
}

/// As OpacityOfDepth::Of.
HWY_INLINE VF OpacityOf(VF depth)
{
  using C = OpacityOfDepth;
  const D d;
  const DI di;
  const VF x = hn::Sub(hn::Zero(d), hn::Min(depth, hn::Set(d, C::Largest)));
  const VF round = hn::Set(d, C::Round);
  const VF octaves = hn::Sub(hn::Add(hn::Mul(x, hn::Set(d, C::PerOctave)), round), round);
  const VF r = hn::Sub(hn::Sub(x, hn::Mul(octaves, hn::Set(d, C::OctaveHigh))),
    hn::Mul(octaves, hn::Set(d, C::OctaveLow)));
  VF sum = hn::Set(d, C::Terms[0]);
  for (int i = 1; i < 6; ++i)
  {
    sum = hn::Add(hn::Mul(sum, r), hn::Set(d, C::Terms[i]));
  }
  const VF less = hn::Add(hn::Mul(hn::Mul(sum, r), r), r);
  const VF scale = hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(Truncated(octaves), hn::Set(di, 127))));
  const VF one = hn::Set(d, 1.0f);
  return hn::Sub(hn::Sub(one, scale), hn::Mul(scale, less));
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
