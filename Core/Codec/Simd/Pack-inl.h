// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_Pack_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_Pack_inl_h
#undef banyan_Codec_Pack_inl_h
#else
#define banyan_Codec_Pack_inl_h
#endif

#include <cstdint>

#include <hwy/highway.h>

// Where Highway has vectors packs are made of them, elsewhere of arrays.
#if HWY_TARGET == HWY_SCALAR
#include "Codec/Simd/ArrayPack-inl.h"
#else
#include "Codec/Simd/RegisterPack-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Numbers of lanes that the compiler knows: `Of::Value(lane)` for each.
template <class T, int N, class Of>
struct ConstantLanes
{
  struct Array
  {
    alignas(64) T At[N];
  };
  static constexpr Array Make()
  {
    Array array{};
    for (int lane = 0; lane < N; ++lane)
    {
      array.At[lane] = static_cast<T>(Of::Value(lane));
    }
    return array;
  }
  static constexpr Array All = Make();
  static HWY_INLINE Pack<T, N> Get() { return Pack<T, N>::Load(All.At); }
};

/// First, First + 1, ...
template <int First>
struct CountFrom
{
  static constexpr int Value(int lane) { return First + lane; }
};
template <class T, int N, int First = 0>
HWY_INLINE Pack<T, N> LaneNumbers()
{
  return ConstantLanes<T, N, CountFrom<First>>::Get();
}

/// All bits of the lanes that are set: every Step-th one of the first `Left`.
template <int Step, int Left>
struct EveryOf
{
  static constexpr int Value(int lane) { return lane < Left && lane % Step == 0 ? -1 : 0; }
};
/// All bits of one lane, which there need not be.
template <int Lane>
struct OnlyLane
{
  static constexpr int Value(int lane) { return lane == Lane ? -1 : 0; }
};

/// Sixteen bytes: what classes, magnitudes and residuals of a row are worked on in.
using Bytes = Pack<std::uint8_t, 16>;
using SignedBytes = Pack<std::int8_t, 16>;

/// Lanes of a table that the compiler knows, by numbers below 16.
template <int... Values>
struct TableOf
{
  alignas(16) static constexpr std::uint8_t All[16] = { Values... };
};
template <int... Values, int N, bool One>
HWY_INLINE PackOf<std::uint8_t, N, One> LookUp(const PackOf<std::uint8_t, N, One>& numbers)
{
  return LookUp(TableOf<Values...>::All, numbers);
}
/// Lanes of 16 bytes, by numbers below 16.
HWY_INLINE Bytes LookUp(const Bytes& table, const Bytes& numbers)
{
#if HWY_TARGET == HWY_SCALAR
  return LookUp(table.At, numbers);
#else
  return { hn::TableLookupBytes(table.V, numbers.V) };
#endif
}

/// Lane First + i / Repeat * Step for lane i.
template <int First, int Step, int Repeat>
struct LanesFrom
{
  static constexpr int Value(int lane) { return (First + lane / Repeat * Step) & 15; }
};
/// The lanes from `First` on and each `Repeat` times, every Step-th of them.
template <int First, int Step, int Repeat>
HWY_INLINE Bytes Picked(const Bytes& from)
{
  return LookUp(from, ConstantLanes<std::uint8_t, 16, LanesFrom<First, Step, Repeat>>::Get());
}

/// Sum of bytes, which is below 256.
HWY_INLINE std::uint16_t SumOfBytes(const Bytes& bytes)
{
  alignas(16) std::uint64_t words[2];
  static_assert(sizeof(words) == 16, "all of them");
  bytes.Store(reinterpret_cast<std::uint8_t*>(words));
  return static_cast<std::uint16_t>(((words[0] + words[1]) * 0x0101010101010101u) >> 56);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
