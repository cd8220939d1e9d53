// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_ArrayPack_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_ArrayPack_inl_h
#undef banyan_Codec_ArrayPack_inl_h
#else
#define banyan_Codec_ArrayPack_inl_h
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// N numbers, without vectors: the packs of RegisterPack-inl.h as plain loops.
template <class T, int N, bool>
struct PackOf
{
  T At[N];

  static HWY_INLINE PackOf Load(const T* from)
  {
    PackOf result;
    std::memcpy(result.At, from, sizeof(result.At));
    return result;
  }
  static HWY_INLINE PackOf Set(T value)
  {
    PackOf result;
    std::fill(result.At, result.At + N, value);
    return result;
  }
  HWY_INLINE void Store(T* to) const { std::memcpy(to, this->At, sizeof(this->At)); }
};
template <class T, int N>
using Pack = PackOf<T, N, true>;

/// Numbers that are computed with: whole ones wrap.
template <class T>
using Wrapping = std::conditional_t<std::is_floating_point_v<T>, T,
  std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>>;

#define BANYAN_PACK(Name, Result)                                                                  \
  template <class T, int N, bool One>                                                              \
  HWY_INLINE PackOf<T, N, One> Name(const PackOf<T, N, One>& a, const PackOf<T, N, One>& b)        \
  {                                                                                                \
    PackOf<T, N, One> result;                                                                      \
    for (int i = 0; i < N; ++i)                                                                    \
    {                                                                                              \
      const T x = a.At[i], y = b.At[i];                                                            \
      result.At[i] = static_cast<T>(Result);                                                       \
    }                                                                                              \
    return result;                                                                                 \
  }
BANYAN_PACK(operator+, static_cast<Wrapping<T>>(x) + static_cast<Wrapping<T>>(y))
BANYAN_PACK(operator-, static_cast<Wrapping<T>>(x) - static_cast<Wrapping<T>>(y))
BANYAN_PACK(operator*, static_cast<Wrapping<T>>(x) * static_cast<Wrapping<T>>(y))
BANYAN_PACK(operator&, x& y)
BANYAN_PACK(operator|, x | y)
BANYAN_PACK(operator^, x ^ y)
BANYAN_PACK(Min, std::min(x, y))
BANYAN_PACK(Max, std::max(x, y))
BANYAN_PACK(operator>, x > y ? -1 : 0)
BANYAN_PACK(operator==, x == y ? -1 : 0)
BANYAN_PACK(operator!=, x != y ? -1 : 0)
#undef BANYAN_PACK

template <class T, int N, bool One>
HWY_INLINE void operator+=(PackOf<T, N, One>& a, const PackOf<T, N, One>& b)
{
  a = a + b;
}
template <class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> operator-(const PackOf<T, N, One>& a)
{
  return PackOf<T, N, One>::Set(0) - a;
}
template <class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> Abs(const PackOf<T, N, One>& a)
{
  const PackOf<T, N, One> sign = PackOf<T, N, One>::Set(0) > a;
  return (a ^ sign) - sign;
}
template <class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> Select(
  const PackOf<T, N, One>& mask, const PackOf<T, N, One>& yes, const PackOf<T, N, One>& no)
{
  return no ^ ((yes ^ no) & mask);
}

/// Lanes from those of another pack.
template <class To, int N, class From, class Of>
HWY_INLINE Pack<To, N> EachLane(const From& from, const Of& of)
{
  Pack<To, N> result;
  for (int i = 0; i < N; ++i)
  {
    result.At[i] = static_cast<To>(of(from, i));
  }
  return result;
}

template <int Bits, class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> ShiftRight(const PackOf<T, N, One>& a)
{
  return EachLane<T, N>(a, [](const auto& from, int i) { return from.At[i] >> Bits; });
}
template <int Bits, class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> ShiftLeft(const PackOf<T, N, One>& a)
{
  return EachLane<T, N>(
    a, [](const auto& from, int i) { return static_cast<Wrapping<T>>(from.At[i]) << Bits; });
}
template <class To, class T, int N, bool One>
HWY_INLINE PackOf<To, N, One> BitsAs(const PackOf<T, N, One>& a)
{
  static_assert(sizeof(To) == sizeof(T), "as many lanes");
  PackOf<To, N, One> result;
  std::memcpy(result.At, a.At, sizeof(a.At));
  return result;
}
template <class T, int N, bool One>
HWY_INLINE Pack<T, N / 2> LowerHalf(const PackOf<T, N, One>& a)
{
  return Pack<T, N / 2>::Load(a.At);
}
template <class To, class T, int N, bool One>
HWY_INLINE Pack<To, N> Widen(const PackOf<T, N, One>& a)
{
  return EachLane<To, N>(a, [](const auto& from, int i) { return from.At[i]; });
}
template <class To, class T, int N, bool One>
HWY_INLINE Pack<To, N> Narrow(const PackOf<T, N, One>& a)
{
  constexpr T least = static_cast<T>(std::numeric_limits<To>::min());
  constexpr T most = static_cast<T>(std::numeric_limits<To>::max());
  return EachLane<To, N>(a,
    [least, most](const auto& from, int i) { return std::min(std::max(from.At[i], least), most); });
}
template <int N, bool One>
HWY_INLINE PackOf<float, N, One> ToFloats(const PackOf<std::int32_t, N, One>& a)
{
  return Widen<float>(a);
}
template <int N, bool One>
HWY_INLINE PackOf<std::int32_t, N, One> ToNearest(const PackOf<float, N, One>& a)
{
  return EachLane<std::int32_t, N>(
    a, [](const auto& from, int i) { return std::nearbyint(from.At[i]); });
}
template <int N, bool One>
HWY_INLINE Pack<std::uint16_t, N / 2> EveryOther(const PackOf<std::uint16_t, N, One>& a)
{
  return EachLane<std::uint16_t, N / 2>(a, [](const auto& from, int i) { return from.At[2 * i]; });
}
template <class T, int N, bool One>
HWY_INLINE bool AnyBit(const PackOf<T, N, One>& a)
{
  T all = 0;
  for (const T lane : a.At)
  {
    all = static_cast<T>(all | lane);
  }
  return all != 0;
}
template <class T, int N, bool One>
HWY_INLINE T SumOfLanes(const PackOf<T, N, One>& a)
{
  Wrapping<T> sum = 0;
  for (const T lane : a.At)
  {
    sum += static_cast<Wrapping<T>>(lane);
  }
  return static_cast<T>(sum);
}
template <int N, bool One>
HWY_INLINE std::int32_t SumOfPairs(const PackOf<std::int16_t, N, One>& a)
{
  return SumOfLanes(Widen<std::int32_t>(a));
}
template <int N, bool One>
HWY_INLINE PackOf<std::uint8_t, N, One> LookUp(
  const std::uint8_t (&table)[16], const PackOf<std::uint8_t, N, One>& numbers)
{
  return EachLane<std::uint8_t, N>(
    numbers, [&table](const auto& from, int i) { return table[from.At[i] & 15]; });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
