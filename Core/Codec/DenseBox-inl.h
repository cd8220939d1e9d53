// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_DenseBox_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_DenseBox_inl_h
#undef banyan_Codec_DenseBox_inl_h
#else
#define banyan_Codec_DenseBox_inl_h
#endif

#include "Codec/BlockUnits-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE

/// Where a block is decoded, and what its references give: memory that is at hand, while that
/// of the box itself usually is not and is written once, from its first sample to its last one.
/// @param B edge of the block
template <class Number, int B>
class DenseBox
{
public:
  static constexpr int Count = (B + 1) * (B + 1) * (B + 1);

  /// The box, `[z][y][x]`.
  Number* Samples() { return this->W; }
  /// What is subtracted from it.
  const Number* Subtracted() const { return this->M; }

  /// Takes what two references give.
  void Refer(block::Reference from, const Number* a, const Number* b)
  {
    WithReference<Number>(from,
      [&](auto reference)
      {
        using V = Numbers<Number>;
        const auto take = [&](int i)
        { StoreVector(reference.Of(V::Load(a + i), V::Load(b + i)), this->M + i); };
        for (int i = 0; i + Width <= Count; i += Width)
        {
          take(i);
        }
        take(Count - Width); // the rest, and some once more
      });
  }

  /// Subtracts it from all samples.
  HWY_INLINE void Subtract()
  {
    const Tag d;
    for (int i = 0; i < Padded; i += Lanes)
    {
      hn::Store(hn::Sub(hn::Load(d, this->W + i), hn::Load(d, this->M + i)), d, this->W + i);
    }
  }

  /// The samples within their limits, with what was subtracted.
  /// @param refers whether something was
  HWY_INLINE void Finish(bool refers, Number least, Number greatest, Number* to) const
  {
    const Tag d;
    const auto low = hn::Set(d, least);
    const auto high = hn::Set(d, greatest);
    if (refers)
    {
      ForAll(
        [&](int i)
        {
          hn::StoreU(
            hn::Min(
              hn::Max(hn::Add(hn::LoadU(d, this->W + i), hn::LoadU(d, this->M + i)), low), high),
            d, to + i);
        });
      return;
    }
    ForAll([&](int i)
      { hn::StoreU(hn::Min(hn::Max(hn::LoadU(d, this->W + i), low), high), d, to + i); });
  }

  /// The samples as they are.
  void Copy(Number* to) const { std::memcpy(to, this->W, Count * sizeof(Number)); }

private:
  using Tag = hn::ScalableTag<Number>;
  static constexpr int Lanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int Padded = (Count + Lanes - 1) / Lanes * Lanes;

  template <class Body>
  static HWY_INLINE void ForAll(const Body& body)
  {
    for (int i = 0; i + Lanes <= Count; i += Lanes)
    {
      body(i);
    }
    body(Count - Lanes); // the rest, and some once more
  }

  alignas(64) Number W[Padded + 64] = {}; // rows are read beyond their end
  alignas(64) Number M[Padded + 64] = {};
};

#else
template <class Number, int B>
class DenseBox;
#endif
} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
