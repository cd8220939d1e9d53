// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_Pack_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_Pack_inl_h
#undef banyan_Codec_Pack_inl_h
#else
#define banyan_Codec_Pack_inl_h
#endif

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// How many numbers of a type one register holds.
template <class T>
constexpr int RegisterLanes = static_cast<int>(hn::MaxLanes(hn::ScalableTag<T>()));

/// N numbers in one register, or in two packs of N / 2 where it is too small. Kernels are written
/// for a number of lanes that suits blocks, and every set of instructions runs them. Arithmetic
/// wraps.
template <class T, int N, bool OneRegister>
struct PackOf;
template <class T, int N>
using Pack = PackOf<T, N, N <= RegisterLanes<T>>;

template <class T, int N>
struct PackOf<T, N, true>
{
  using Tag = hn::CappedTag<T, N>;
  hn::VFromD<Tag> V;

  static HWY_INLINE PackOf Load(const T* from) { return { hn::LoadU(Tag(), from) }; }
  static HWY_INLINE PackOf Set(T value) { return { hn::Set(Tag(), value) }; }
  HWY_INLINE void Store(T* to) const { hn::StoreU(this->V, Tag(), to); }
};

template <class T, int N>
struct PackOf<T, N, false>
{
  using Part = Pack<T, N / 2>;
  Part Low, High;

  static HWY_INLINE PackOf Load(const T* from)
  {
    return { Part::Load(from), Part::Load(from + N / 2) };
  }
  static HWY_INLINE PackOf Set(T value) { return { Part::Set(value), Part::Set(value) }; }
  HWY_INLINE void Store(T* to) const
  {
    this->Low.Store(to);
    this->High.Store(to + N / 2);
  }
};

#define BANYAN_PACK_OF_ONE(Name, Operation)                                                        \
  template <class T, int N, bool One>                                                              \
  HWY_INLINE PackOf<T, N, One> Name(const PackOf<T, N, One>& a)                                    \
  {                                                                                                \
    if constexpr (One)                                                                             \
    {                                                                                              \
      return { Operation(a.V) };                                                                   \
    }                                                                                              \
    else                                                                                           \
    {                                                                                              \
      return { Name(a.Low), Name(a.High) };                                                        \
    }                                                                                              \
  }
#define BANYAN_PACK_OF_TWO(Name, Operation)                                                        \
  template <class T, int N, bool One>                                                              \
  HWY_INLINE PackOf<T, N, One> Name(const PackOf<T, N, One>& a, const PackOf<T, N, One>& b)        \
  {                                                                                                \
    if constexpr (One)                                                                             \
    {                                                                                              \
      return { Operation(a.V, b.V) };                                                              \
    }                                                                                              \
    else                                                                                           \
    {                                                                                              \
      return { Name(a.Low, b.Low), Name(a.High, b.High) };                                         \
    }                                                                                              \
  }
/// All bits of lanes where it holds are set, others are 0.
#define BANYAN_PACK_COMPARISON(Name, Operation)                                                    \
  template <class T, int N, bool One>                                                              \
  HWY_INLINE PackOf<T, N, One> Name(const PackOf<T, N, One>& a, const PackOf<T, N, One>& b)        \
  {                                                                                                \
    if constexpr (One)                                                                             \
    {                                                                                              \
      return { hn::VecFromMask(hn::CappedTag<T, N>(), Operation(a.V, b.V)) };                      \
    }                                                                                              \
    else                                                                                           \
    {                                                                                              \
      return { Name(a.Low, b.Low), Name(a.High, b.High) };                                         \
    }                                                                                              \
  }
BANYAN_PACK_OF_TWO(operator+, hn::Add)
BANYAN_PACK_OF_TWO(operator-, hn::Sub)
BANYAN_PACK_OF_TWO(operator*, hn::Mul)
BANYAN_PACK_OF_TWO(operator&, hn::And)
BANYAN_PACK_OF_TWO(operator|, hn::Or)
BANYAN_PACK_OF_TWO(operator^, hn::Xor)
BANYAN_PACK_OF_TWO(Min, hn::Min)
BANYAN_PACK_OF_TWO(Max, hn::Max)
BANYAN_PACK_OF_ONE(Abs, hn::Abs)
BANYAN_PACK_OF_ONE(operator-, hn::Neg)
BANYAN_PACK_COMPARISON(operator>, hn::Gt)
BANYAN_PACK_COMPARISON(operator==, hn::Eq)
BANYAN_PACK_COMPARISON(operator!=, hn::Ne)
#undef BANYAN_PACK_OF_ONE
#undef BANYAN_PACK_OF_TWO
#undef BANYAN_PACK_COMPARISON

template <class T, int N, bool One>
HWY_INLINE void operator+=(PackOf<T, N, One>& a, const PackOf<T, N, One>& b)
{
  a = a + b;
}

/// Shifts; of signed numbers to the right the sign comes in.
template <int Bits, class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> ShiftRight(const PackOf<T, N, One>& a)
{
  if constexpr (One)
  {
    return { hn::ShiftRight<Bits>(a.V) };
  }
  else
  {
    return { ShiftRight<Bits>(a.Low), ShiftRight<Bits>(a.High) };
  }
}
template <int Bits, class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> ShiftLeft(const PackOf<T, N, One>& a)
{
  if constexpr (One)
  {
    return { hn::ShiftLeft<Bits>(a.V) };
  }
  else
  {
    return { ShiftLeft<Bits>(a.Low), ShiftLeft<Bits>(a.High) };
  }
}

/// `yes` where all bits of the mask are set, `no` where none is.
template <class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> Select(
  const PackOf<T, N, One>& mask, const PackOf<T, N, One>& yes, const PackOf<T, N, One>& no)
{
  if constexpr (One)
  {
    return { hn::IfVecThenElse(mask.V, yes.V, no.V) };
  }
  else
  {
    return { Select(mask.Low, yes.Low, no.Low), Select(mask.High, yes.High, no.High) };
  }
}

/// Where the mask says no: zero.
template <class T, int N, bool One>
HWY_INLINE PackOf<T, N, One> SelectOrZero(
  const PackOf<T, N, One>& mask, const PackOf<T, N, One>& yes)
{
  return mask & yes;
}

/// The same bits as numbers of another type of the same size.
template <class To, class T, int N, bool One>
HWY_INLINE PackOf<To, N, One> BitsAs(const PackOf<T, N, One>& a)
{
  static_assert(sizeof(To) == sizeof(T), "as many lanes");
  if constexpr (One)
  {
    return { hn::BitCast(hn::CappedTag<To, N>(), a.V) };
  }
  else
  {
    return { BitsAs<To>(a.Low), BitsAs<To>(a.High) };
  }
}

/// The first and the second half of the lanes, and back. (HWY_SCALAR has no halves: each of its
/// registers holds one lane.)
template <class T, int N, bool One>
HWY_INLINE Pack<T, N / 2> LowerHalf(const PackOf<T, N, One>& a)
{
  if constexpr (!One)
  {
    return a.Low;
  }
#if HWY_TARGET != HWY_SCALAR
  else
  {
    return { hn::LowerHalf(hn::CappedTag<T, N / 2>(), a.V) };
  }
#endif
}
template <class T, int N, bool One>
HWY_INLINE Pack<T, N / 2> UpperHalf(const PackOf<T, N, One>& a)
{
  if constexpr (!One)
  {
    return a.High;
  }
#if HWY_TARGET != HWY_SCALAR
  else
  {
    return { hn::UpperHalf(hn::CappedTag<T, N / 2>(), a.V) };
  }
#endif
}
template <class T, int N, bool One>
HWY_INLINE Pack<T, 2 * N> Join(const PackOf<T, N, One>& low, const PackOf<T, N, One>& high)
{
  if constexpr (2 * N > RegisterLanes<T>)
  {
    return { low, high };
  }
#if HWY_TARGET != HWY_SCALAR
  else
  {
    return { hn::Combine(hn::CappedTag<T, 2 * N>(), high.V, low.V) };
  }
#endif
}

/// Numbers as those of a larger type.
template <class To, class T, int N, bool One>
HWY_INLINE Pack<To, N> Widen(const PackOf<T, N, One>& a)
{
  if constexpr (N <= RegisterLanes<To>)
  {
    return { hn::PromoteTo(hn::CappedTag<To, N>(), a.V) };
  }
  else
  {
    return Join(Widen<To>(LowerHalf(a)), Widen<To>(UpperHalf(a)));
  }
}

/// Numbers as those of a smaller type, the nearest ones that it has.
template <class To, class T, int N, bool One>
HWY_INLINE Pack<To, N> Narrow(const PackOf<T, N, One>& a)
{
  if constexpr (One)
  {
    return { hn::DemoteTo(hn::CappedTag<To, N>(), a.V) };
  }
  else
  {
    return Join(Narrow<To>(a.Low), Narrow<To>(a.High));
  }
}

/// Whole numbers as reals, and the whole numbers nearest to reals.
template <int N, bool One>
HWY_INLINE PackOf<float, N, One> ToFloats(const PackOf<std::int32_t, N, One>& a)
{
  if constexpr (One)
  {
    return { hn::ConvertTo(hn::CappedTag<float, N>(), a.V) };
  }
  else
  {
    return { ToFloats(a.Low), ToFloats(a.High) };
  }
}
template <int N, bool One>
HWY_INLINE PackOf<std::int32_t, N, One> ToNearest(const PackOf<float, N, One>& a)
{
  if constexpr (One)
  {
    return { hn::NearestInt(a.V) };
  }
  else
  {
    return { ToNearest(a.Low), ToNearest(a.High) };
  }
}

/// Every other lane, from lane 0 on: half as many.
template <int N, bool One>
HWY_INLINE Pack<std::uint16_t, N / 2> EveryOther(const PackOf<std::uint16_t, N, One>& a)
{
  if constexpr (N == 2 && !One)
  {
    return a.Low;
  }
  else if constexpr (!One)
  {
    return Join(EveryOther(a.Low), EveryOther(a.High));
  }
  else
  {
    const hn::CappedTag<std::int32_t, N / 2> pairs;
    const auto low = hn::And(hn::BitCast(pairs, a.V), hn::Set(pairs, 0xffff));
    return { hn::DemoteTo(hn::CappedTag<std::uint16_t, N / 2>(), low) };
  }
}

template <class T, int N, bool One>
HWY_INLINE bool AnyBit(const PackOf<T, N, One>& a)
{
  if constexpr (One)
  {
    constexpr hn::CappedTag<T, N> d;
    return !hn::AllTrue(d, hn::Eq(a.V, hn::Zero(d)));
  }
  else
  {
    return AnyBit(a.Low | a.High);
  }
}

/// Sum of all lanes.
template <class T, int N, bool One>
HWY_INLINE T SumOfLanes(const PackOf<T, N, One>& a)
{
  if constexpr (One)
  {
    return hn::GetLane(hn::SumOfLanes(hn::CappedTag<T, N>(), a.V));
  }
  else
  {
    return SumOfLanes(a.Low + a.High);
  }
}

/// Sum of all lanes, none of which is negative.
template <int N, bool One>
HWY_INLINE std::int32_t SumOfPairs(const PackOf<std::int16_t, N, One>& a)
{
  if constexpr (One && N > 1)
  {
    const hn::CappedTag<std::int32_t, N / 2> pairs;
    const auto both = hn::BitCast(pairs, a.V);
    const auto sums = hn::Add(hn::And(both, hn::Set(pairs, 0xffff)), hn::ShiftRight<16>(both));
    return hn::GetLane(hn::SumOfLanes(pairs, sums));
  }
  else if constexpr (One)
  {
    return hn::GetLane(a.V);
  }
  else
  {
    return SumOfPairs(a.Low) + SumOfPairs(a.High);
  }
}

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

/// Lanes of a table of 16 bytes, by numbers below 16.
template <int N, bool One>
HWY_INLINE PackOf<std::uint8_t, N, One> LookUp(
  const std::uint8_t (&table)[16], const PackOf<std::uint8_t, N, One>& numbers)
{
#if HWY_TARGET == HWY_SCALAR
  if constexpr (N == 1)
  {
    return PackOf<std::uint8_t, N, One>::Set(table[hn::GetLane(numbers.V) & 15]);
  }
#else
  if constexpr (One)
  {
    constexpr hn::CappedTag<std::uint8_t, N> d;
    return { hn::TableLookupBytes(hn::LoadDup128(d, table), numbers.V) };
  }
#endif
  else
  {
    return { LookUp(table, numbers.Low), LookUp(table, numbers.High) };
  }
}
/// The same of a table that the compiler knows.
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
  alignas(16) std::uint8_t from[16];
  table.Store(from);
  return LookUp(from, numbers);
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
