// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_RegisterPack_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_RegisterPack_inl_h
#undef banyan_Codec_RegisterPack_inl_h
#else
#define banyan_Codec_RegisterPack_inl_h
#endif

#include <cstdint>
#include <type_traits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

static_assert(!HWY_HAVE_SCALABLE, "vectors of a size that is known: see Core/CMakeLists.txt");

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

/// The first and the second half of the lanes, and back.
template <class T, int N, bool One>
HWY_INLINE Pack<T, N / 2> LowerHalf(const PackOf<T, N, One>& a)
{
  if constexpr (One)
  {
    return { hn::LowerHalf(hn::CappedTag<T, N / 2>(), a.V) };
  }
  else
  {
    return a.Low;
  }
}
template <class T, int N, bool One>
HWY_INLINE Pack<T, N / 2> UpperHalf(const PackOf<T, N, One>& a)
{
  if constexpr (One)
  {
    return { hn::UpperHalf(hn::CappedTag<T, N / 2>(), a.V) };
  }
  else
  {
    return a.High;
  }
}
template <class T, int N, bool One>
HWY_INLINE Pack<T, 2 * N> Join(const PackOf<T, N, One>& low, const PackOf<T, N, One>& high)
{
  if constexpr (2 * N <= RegisterLanes<T>)
  {
    return { hn::Combine(hn::CappedTag<T, 2 * N>(), high.V, low.V) };
  }
  else
  {
    return { low, high };
  }
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
  if constexpr (!One)
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
  if constexpr (One)
  {
    const hn::CappedTag<std::int32_t, N / 2> pairs;
    const auto both = hn::BitCast(pairs, a.V);
    const auto sums = hn::Add(hn::And(both, hn::Set(pairs, 0xffff)), hn::ShiftRight<16>(both));
    return hn::GetLane(hn::SumOfLanes(pairs, sums));
  }
  else
  {
    return SumOfPairs(a.Low) + SumOfPairs(a.High);
  }
}

/// Lanes of a table of 16 bytes, by numbers below 16.
template <int N, bool One>
HWY_INLINE PackOf<std::uint8_t, N, One> LookUp(
  const std::uint8_t (&table)[16], const PackOf<std::uint8_t, N, One>& numbers)
{
  if constexpr (One)
  {
    const hn::CappedTag<std::uint8_t, N> d;
    return { hn::TableLookupBytes(hn::LoadDup128(d, table), numbers.V) };
  }
  else
  {
    return { LookUp(table, numbers.Low), LookUp(table, numbers.High) };
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
