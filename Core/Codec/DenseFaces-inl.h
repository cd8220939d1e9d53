// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_DenseFaces_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_DenseFaces_inl_h
#undef banyan_Codec_DenseFaces_inl_h
#else
#define banyan_Codec_DenseFaces_inl_h
#endif

#include "Codec/BlockUnits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// A face of a box, and those of the references there, on their way to memory of
/// their own and back: LoadUnit and StoreUnit for an edge that is known, a multiple of 16, and with
/// all arrays laid out alike.
template <int Edge, class Number, class Reference>
struct DenseFace
{
  using V = Numbers<Number>;
  using U = std::make_unsigned_t<Number>;
  static constexpr std::ptrdiff_t Pitch = 3 * (Edge + 8); // block::Shape<2>: rows of three faces

  Number* X; ///< the face's first sample, of the box
  const Number* A;
  const Number* B;
  std::ptrdiff_t AlongU, AlongV;
  Number* W;

  HWY_INLINE U SubtractedAt(std::ptrdiff_t at) const
  {
    return static_cast<U>(Reference::Of(this->A[at], this->B[at]));
  }
  HWY_INLINE typename V::Unsigned SubtractedFrom(std::ptrdiff_t at) const
  {
    return Reference::Of(V::Load(this->A + at), V::Load(this->B + at));
  }

  HWY_INLINE void LoadOne(std::ptrdiff_t at, int u, Number* w) const
  {
    at += u * this->AlongU;
    w[u] = static_cast<Number>(static_cast<U>(this->X[at]) - this->SubtractedAt(at));
  }
  /// What is known of the face: its borders and every fourth sample.
  HWY_INLINE void Load() const
  {
    for (int v = 0; v <= Edge; ++v)
    {
      const std::ptrdiff_t at = v * this->AlongV;
      Number* const w = this->W + v * Pitch;
      if (this->AlongU == 1)
      {
        for (int u = 0; u < Edge; u += Width)
        {
          StoreVector(V::Load(this->X + at + u) - this->SubtractedFrom(at + u), w + u);
        }
        this->LoadOne(at, Edge, w);
        continue;
      }
      const int step = v % Edge == 0 ? 1 : v % 4 == 0 ? 4 : Edge;
      for (int u = 0; u <= Edge; u += step)
      {
        this->LoadOne(at, u, w);
      }
    }
  }

  /// The inside, with its reference and within the limits of the lattice. (The border behind it
  /// comes back as it was.)
  HWY_INLINE void Store(Number least, Number greatest) const
  {
    using Signed = typename V::Signed;
    const Signed low = Signed{} + least;
    const Signed high = Signed{} + greatest;
    const auto limited = [&](typename V::Unsigned sum)
    {
      Signed value = reinterpret_cast<Signed>(sum);
      value = value < low ? low : value;
      return value > high ? high : value;
    };
    for (int v = 1; v < Edge; ++v)
    {
      const std::ptrdiff_t at = v * this->AlongV + this->AlongU;
      const Number* const w = this->W + v * Pitch + 1;
      if (this->AlongU == 1)
      {
        for (int u = 0; u < Edge; u += Width)
        {
          StoreVector(limited(V::Load(w + u) + this->SubtractedFrom(at + u)), this->X + at + u);
        }
        continue;
      }
      Number row[Edge];
      for (int u = 0; u < Edge - 1; ++u)
      {
        row[u] = static_cast<Number>(this->SubtractedAt(at + u * this->AlongU));
      }
      row[Edge - 1] = 0;
      for (int u = 0; u < Edge; u += Width)
      {
        StoreVector(limited(V::Load(w + u) + V::Load(row + u)), row + u);
      }
      for (int u = 0; u < Edge - 1; ++u)
      {
        this->X[at + u * this->AlongU] = row[u];
      }
    }
  }
};

/// Calls body(face). @param samples of the face, @param from the references there; strides are the
/// same
template <int Edge, class Number, class Body>
HWY_INLINE void WithDenseFace(
  const View<Number>& samples, const References<Number>& from, Number* w, const Body& body)
{
  const bool refers = from.From != block::Reference::None;
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      body(DenseFace<Edge, Number, decltype(reference)>{ samples.Base,
        refers ? from.A.Base : samples.Base, refers ? from.B.Base : samples.Base,
        static_cast<std::ptrdiff_t>(samples.Stride.x),
        static_cast<std::ptrdiff_t>(samples.Stride.y), w });
    });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
