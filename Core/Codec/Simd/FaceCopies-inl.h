// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_FaceCopies_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_FaceCopies_inl_h
#undef banyan_Codec_FaceCopies_inl_h
#else
#define banyan_Codec_FaceCopies_inl_h
#endif

#include "Codec/Simd/Units-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// A face of a box, and those of the references there, on their way to memory of
/// their own and back: LoadUnit and StoreUnit for an edge that is known, a multiple of 16, and with
/// all arrays laid out alike.
template <int B, class Number, class Reference>
struct FaceCopy
{
  using V = Samples<Number>;
  using U = std::make_unsigned_t<Number>;
  static constexpr std::ptrdiff_t Pitch = block::Shape<2>{ B }.Y();

  Number* X; ///< the face's first sample, of the box
  const Number* ReferenceA;
  const Number* ReferenceB;
  std::ptrdiff_t AlongU, AlongV;
  Number* Copy; ///< sample 0 of the face's own memory

  HWY_INLINE U SubtractedAt(std::ptrdiff_t at) const
  {
    return static_cast<U>(Reference::Of(this->ReferenceA[at], this->ReferenceB[at]));
  }
  HWY_INLINE V SubtractedFrom(std::ptrdiff_t at) const
  {
    return Reference::Of(V::Load(this->ReferenceA + at), V::Load(this->ReferenceB + at));
  }

  HWY_INLINE void LoadOne(std::ptrdiff_t at, int u, Number* w) const
  {
    at += u * this->AlongU;
    w[u] = static_cast<Number>(static_cast<U>(this->X[at]) - this->SubtractedAt(at));
  }
  /// Loads all that is known of the face: its borders and every fourth sample.
  HWY_INLINE void Load() const
  {
    for (int v = 0; v <= B; ++v)
    {
      const std::ptrdiff_t at = v * this->AlongV;
      Number* const w = this->Copy + v * Pitch;
      if (this->AlongU == 1)
      {
        for (int u = 0; u < B; u += Width)
        {
          (V::Load(this->X + at + u) - this->SubtractedFrom(at + u)).Store(w + u);
        }
        this->LoadOne(at, B, w);
        continue;
      }
      const int step = v % B == 0 ? 1 : v % 4 == 0 ? 4 : B;
      for (int u = 0; u <= B; u += step)
      {
        this->LoadOne(at, u, w);
      }
    }
  }

  /// The inside, with its reference and within the limits of the lattice. (The border behind it
  /// comes back as it was.)
  HWY_INLINE void Store(Number least, Number greatest) const
  {
    const V low = V::Set(least);
    const V high = V::Set(greatest);
    const auto limited = [&](const V& sum) { return Min(Max(sum, low), high); };
    for (int v = 1; v < B; ++v)
    {
      const std::ptrdiff_t at = v * this->AlongV + this->AlongU;
      const Number* const w = this->Copy + v * Pitch + 1;
      if (this->AlongU == 1)
      {
        for (int u = 0; u < B; u += Width)
        {
          limited(V::Load(w + u) + this->SubtractedFrom(at + u)).Store(this->X + at + u);
        }
        continue;
      }
      Number row[B];
      for (int u = 0; u < B - 1; ++u)
      {
        row[u] = static_cast<Number>(this->SubtractedAt(at + u * this->AlongU));
      }
      row[B - 1] = 0;
      for (int u = 0; u < B; u += Width)
      {
        limited(V::Load(w + u) + V::Load(row + u)).Store(row + u);
      }
      for (int u = 0; u < B - 1; ++u)
      {
        this->X[at + u * this->AlongU] = row[u];
      }
    }
  }
};

/// Calls body(face). @param samples of the face, @param from the references there; strides are the
/// same
template <int B, class Number, class Body>
HWY_INLINE void WithFaceCopy(
  const View<Number>& samples, const References<Number>& from, Number* w, const Body& body)
{
  const bool refers = from.From != block::Reference::None;
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      body(
        FaceCopy<B, Number, decltype(reference)>{ samples.Base, refers ? from.A.Base : samples.Base,
          refers ? from.B.Base : samples.Base, static_cast<std::ptrdiff_t>(samples.Stride.x),
          static_cast<std::ptrdiff_t>(samples.Stride.y), w });
    });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
