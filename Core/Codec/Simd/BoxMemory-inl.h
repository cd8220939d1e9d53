// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_BoxMemory_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BoxMemory_inl_h
#undef banyan_Codec_BoxMemory_inl_h
#else
#define banyan_Codec_BoxMemory_inl_h
#endif

#include "Codec/Simd/Units-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Where a block is decoded, and what its references give: memory that is at hand, while that
/// of the box itself usually is not and is written once, from its first sample to its last one.
/// @param B edge of the block
template <class Number, int B>
class BoxMemory
{
public:
  static constexpr int Count = (B + 1) * (B + 1) * (B + 1);

  /// The box, `[z][y][x]`.
  Number* Decoded() { return this->Box; }
  /// The numbers that are subtracted from it.
  const Number* Subtracted() const { return this->FromReferences; }

  /// Takes what two references give.
  void Refer(block::Reference from, const Number* a, const Number* b)
  {
    WithReference<Number>(from,
      [&](auto reference)
      {
        using V = Samples<Number>;
        ForEachWidth(Count - 1, [&](int i)
          { reference.Of(V::Load(a + i), V::Load(b + i)).Store(this->FromReferences + i); });
      });
  }

  /// Subtracts it from all samples.
  HWY_INLINE void Subtract()
  {
    const Tag d;
    for (int i = 0; i < Padded; i += Lanes)
    {
      hn::Store(hn::Sub(hn::Load(d, this->Box + i), hn::Load(d, this->FromReferences + i)), d,
        this->Box + i);
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
          hn::StoreU(hn::Min(hn::Max(hn::Add(hn::LoadU(d, this->Box + i),
                                       hn::LoadU(d, this->FromReferences + i)),
                               low),
                       high),
            d, to + i);
        });
      return;
    }
    ForAll([&](int i)
      { hn::StoreU(hn::Min(hn::Max(hn::LoadU(d, this->Box + i), low), high), d, to + i); });
  }

  /// The samples as they are.
  void Copy(Number* to) const { std::memcpy(to, this->Box, Count * sizeof(Number)); }

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

  alignas(64) Number Box[Padded + 64] = {}; // rows are read beyond their end
  alignas(64) Number FromReferences[Padded + 64] = {};
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
