// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_Units_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_Units_inl_h
#undef banyan_Codec_Units_inl_h
#else
#define banyan_Codec_Units_inl_h
#endif

#include "Codec/Simd/Passes-inl.h"

#include <cstring>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Samples in an array of any strides: where a unit lies in a box, or in a whole field.
template <class Sample>
struct View
{
  Sample* Base;
  glm::i64vec3 Stride;

  /// The same array with its axes in another order; see AxesOf.
  View Along(const glm::ivec3& axes) const
  {
    return { this->Base, { this->Stride[axes.x], this->Stride[axes.y], this->Stride[axes.z] } };
  }
  View At(const glm::ivec3& position) const
  {
    return { this->Base + position.x * this->Stride.x + position.y * this->Stride.y +
               position.z * this->Stride.z,
      this->Stride };
  }
  Sample* Row(int y, int z) const { return this->Base + y * this->Stride.y + z * this->Stride.z; }
};

/// Where the samples of references lie; the same place as the unit's own.
template <class Sample>
struct References
{
  block::Reference From = block::Reference::None;
  View<const Sample> A{ nullptr, {} }, B{ nullptr, {} };

  References Along(const glm::ivec3& axes) const
  {
    return { this->From, this->A.Along(axes), this->B.Along(axes) };
  }
  References At(const glm::ivec3& position) const
  {
    return this->From == block::Reference::None
             ? *this
             : References{ this->From, this->A.At(position), this->B.At(position) };
  }
};

/// How many units of D dimensions a block has: three edges, three faces, one interior.
template <int D>
constexpr int UnitsOf = D < 3 ? 3 : 1;

/// The axes of an edge, a face or an interior in the unit's own order: the free ones first. Edges
/// run along x, y, z; faces along x and y, x and z, y and z.
template <int D>
HWY_INLINE glm::ivec3 AxesOf(int number)
{
  if (D == 1)
  {
    return number == 1   ? glm::ivec3{ 1, 0, 2 }
           : number == 2 ? glm::ivec3{ 2, 0, 1 }
                         : glm::ivec3{ 0, 1, 2 };
  }
  if (D == 2)
  {
    return number == 1   ? glm::ivec3{ 0, 2, 1 }
           : number == 2 ? glm::ivec3{ 1, 2, 0 }
                         : glm::ivec3{ 0, 1, 2 };
  }
  return { 0, 1, 2 };
}

/// The free axes as bits.
template <int D>
HWY_INLINE int MaskOf(int number)
{
  const glm::ivec3 axes = AxesOf<D>(number);
  return 1 << axes.x | (D > 1 ? 1 << axes.y : 0) | (D > 2 ? 1 << axes.z : 0);
}

/// A vector in the order of a unit's axes; those that the unit does not have do not limit it.
template <int D>
HWY_INLINE glm::ivec3 InOrderOf(const glm::ivec3& axes, const glm::ivec3& v, int edge)
{
  return { v[axes.x], D > 1 ? v[axes.y] : edge, D > 2 ? v[axes.z] : edge };
}

// Highway includes this as a system header: no compiler warns of a switch that lacks one.
static_assert(block::References == 5, "Subtracted and WithReference lack a reference");

/// A reference as it is subtracted from samples, of a kind that the compiler knows. Arithmetic
/// wraps.
template <class Number, block::Reference From>
struct Subtracted
{
  template <int N, bool One>
  static HWY_INLINE PackOf<Number, N, One> Of(
    const PackOf<Number, N, One>& a, const PackOf<Number, N, One>& b)
  {
    using V = PackOf<Number, N, One>;
    switch (From)
    {
      case block::Reference::Mean:
        return ShiftRight<1>(a + b + V::Set(1));
      case block::Reference::HalfMean:
        return ShiftRight<2>(a + b + V::Set(2));
      case block::Reference::A:
        return a;
      case block::Reference::B:
        return b;
      default:
        return V::Set(0);
    }
  }
  static HWY_INLINE Number Of(Number a, Number b)
  {
    using U = std::make_unsigned_t<Number>;
    const U sum = static_cast<U>(static_cast<U>(a) + static_cast<U>(b));
    switch (From)
    {
      case block::Reference::Mean:
        return static_cast<Number>(static_cast<Number>(sum + 1u) >> 1);
      case block::Reference::HalfMean:
        return static_cast<Number>(static_cast<Number>(sum + 2u) >> 2);
      case block::Reference::A:
        return a;
      case block::Reference::B:
        return b;
      default:
        return 0;
    }
  }
};

template <class Number, class Body>
HWY_INLINE void WithReference(block::Reference from, const Body& body)
{
  using block::Reference;
  switch (from)
  {
    case Reference::Mean:
      return body(Subtracted<Number, Reference::Mean>{});
    case Reference::HalfMean:
      return body(Subtracted<Number, Reference::HalfMean>{});
    case Reference::A:
      return body(Subtracted<Number, Reference::A>{});
    case Reference::B:
      return body(Subtracted<Number, Reference::B>{});
    default:
      return body(Subtracted<Number, Reference::None>{});
  }
}

/// A row of samples and of both references.
template <class Sample, class Number = std::remove_const_t<Sample>>
struct SampleRow
{
  Sample* X;
  const Number* A;
  const Number* B;
  std::int64_t StrideX, StrideA, StrideB;

  bool SideBySide() const { return this->StrideX == 1 && this->StrideA == 1 && this->StrideB == 1; }

  template <class Reference>
  HWY_INLINE Samples<Number> SubtractedAt(const Reference&, int x) const
  {
    return Reference::Of(Samples<Number>::Load(this->A + x), Samples<Number>::Load(this->B + x));
  }
};

template <class Sample, class Number = std::remove_const_t<Sample>>
HWY_INLINE SampleRow<Sample> RowOf(
  const View<Sample>& samples, const References<Number>& from, int y, int z)
{
  if (from.From == block::Reference::None)
  {
    Sample* row = samples.Row(y, z);
    return { row, row, row, samples.Stride.x, samples.Stride.x, samples.Stride.x };
  }
  return { samples.Row(y, z), from.A.Row(y, z), from.B.Row(y, z), samples.Stride.x, from.A.Stride.x,
    from.B.Stride.x };
}

/// Calls body(x) for Width samples from x on, until all of 0 to `last` were among them: the last
/// ones overlap those before.
template <class Body>
HWY_INLINE void ForEachWidth(int last, const Body& body)
{
  for (int x = 0; x + Width <= last; x += Width)
  {
    body(x);
  }
  body(last - Width + 1);
}

/// Takes samples first to last of a row, less their references.
template <class Number, class Reference>
HWY_INLINE void LoadRow(
  const Reference& reference, const SampleRow<const Number>& row, int first, int last, Number* w)
{
  if (row.SideBySide() && first == 0 && last >= Width)
  {
    return ForEachWidth(last, [&](int x)
      { (Samples<Number>::Load(row.X + x) - row.SubtractedAt(reference, x)).Store(w + x); });
  }
  for (int x = first; x <= last; ++x)
  {
    using U = std::make_unsigned_t<Number>;
    const Number subtracted = Reference::Of(row.A[x * row.StrideA], row.B[x * row.StrideB]);
    w[x] = static_cast<Number>(
      static_cast<U>(static_cast<U>(row.X[x * row.StrideX]) - static_cast<U>(subtracted)));
  }
}

/// Takes a unit with its borders (B + 1 samples per free axis), less its reference.
/// @param all false: what is known before the unit is decoded, its borders and every fourth sample,
/// is enough; the rest is anything
/// @param w its sample 0
template <int D, int B, class Number>
HWY_INLINE void LoadUnit(
  const View<const Number>& samples, const References<Number>& from, bool all, Number* w)
{
  constexpr block::Shape<D> shape{ B };
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      for (int z = 0; z <= (D > 2 ? B : 0); ++z)
      {
        for (int y = 0; y <= (D > 1 ? B : 0); ++y)
        {
          const auto row = RowOf(samples, from, y, z);
          Number* to = w + z * shape.Z() + y * shape.Y();
          const bool border = z % B == 0 && D > 2;
          // Whole rows take no longer than two samples where they lie side by side.
          const bool whole = all || row.StrideX == 1;
          if (whole || border || y % B == 0 || ((y | z) & 3) == 0)
          {
            LoadRow(reference, row, 0, B, to);
            continue;
          }
          LoadRow(reference, row, 0, 0, to);
          LoadRow(reference, row, B, B, to);
        }
      }
    });
}

/// Stores the lanes of a pack from the first one, 0 or 1, on.
template <class Number>
HWY_INLINE void StoreFrom(int first, const Samples<Number>& value, Number* to)
{
  if (first == 0)
  {
    return value.Store(to);
  }
  Number lanes[Width];
  value.Store(lanes);
  std::memcpy(to + 1, lanes + 1, sizeof(lanes) - sizeof(Number));
}

/// Puts the inside of a unit (samples 1 to B - 1 of its free axes) back, with its reference and
/// within the limits of the lattice. Nothing else is written: other threads may read it.
template <int D, int B, class Number>
HWY_INLINE void StoreUnit(const Number* w, const References<Number>& from, std::int32_t least,
  std::int32_t greatest, const View<Number>& samples)
{
  constexpr block::Shape<D> shape{ B };
  using V = Samples<Number>;
  const V low = V::Set(static_cast<Number>(least));
  const V high = V::Set(static_cast<Number>(greatest));
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      for (int z = (D > 2 ? 1 : 0); z < (D > 2 ? B : 1); ++z)
      {
        for (int y = (D > 1 ? 1 : 0); y < (D > 1 ? B : 1); ++y)
        {
          const SampleRow<Number> row = RowOf(samples, from, y, z);
          const Number* in = w + z * shape.Z() + y * shape.Y();
          if (D > 1 && row.SideBySide())
          {
            for (int x = 0; x < B; x += Width)
            {
              const V sum = V::Load(in + x) + row.SubtractedAt(reference, x);
              StoreFrom(x == 0 ? 1 : 0, Min(Max(sum, low), high), row.X + x);
            }
            continue;
          }
          for (int x = 1; x < B; ++x)
          {
            using U = std::make_unsigned_t<Number>;
            const Number subtracted = reference.Of(row.A[x * row.StrideA], row.B[x * row.StrideB]);
            const Number sum = static_cast<Number>(
              static_cast<U>(static_cast<U>(in[x]) + static_cast<U>(subtracted)));
            row.X[x * row.StrideX] =
              std::min(std::max(sum, static_cast<Number>(least)), static_cast<Number>(greatest));
          }
        }
      }
    });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
