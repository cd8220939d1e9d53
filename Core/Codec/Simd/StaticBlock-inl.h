// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_StaticBlock_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_StaticBlock_inl_h
#undef banyan_Codec_StaticBlock_inl_h
#else
#define banyan_Codec_StaticBlock_inl_h
#endif

#include "Codec/Simd/BlockAt-inl.h"

#include <glm/common.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Blocks that cost nothing: of one value, and as their reference.
template <int B, class Number>
struct StaticBlock : BlockAt<B, Number>
{
  using V = Samples<Number>;

  /// Finds out whether the samples of a block are all the same, and places them.
  bool PlaceUniform(BlockTokens& out) const
  {
    const View<const Number> target = this->ViewOf(*this->Plane().Target);
    const std::int64_t next = this->NextBlock();
    const Number value = target.Base[0];
    const bool uniform = this->ForEachSlice(
      [&](int y, int z)
      {
        const Number* row = target.Row(y, z);
        __builtin_prefetch(row + next);
        const V all = V::Set(value);
        return OverRow(
          B, [&](int x) { return V::Load(row + x) ^ all; }, [&](int x) { return row[x] != value; });
      });
    if (uniform)
    {
      const View<Number> decoded = this->ViewOf(*this->Job.Decoded);
      for (int z = 0; z < B; ++z)
      {
        for (int y = 0; y < B; ++y)
        {
          std::fill_n(decoded.Row(y, z), B, value);
        }
      }
      out.Uniform = true;
      out.Value = value;
    }
    return uniform;
  }

  /// Finds out whether a block may stay as it is in reference A, and places it.
  bool PlaceSame(BlockTokens& out) const
  {
    const PlaneToEncode& plane = this->Plane();
    const View<const Number> target = this->ViewOf(*plane.Target);
    const View<const Number> before = this->ViewOf(*plane.A);
    const std::int64_t next = this->NextBlock();
    // Samples beyond the field's end do not matter.
    const glm::ivec3 end = glm::min(glm::ivec3(B), plane.Target->Samples - this->Position * B);
    const Number most = static_cast<Number>(plane.FineBin / 2), least = static_cast<Number>(-most);
    const bool same = this->ForEachSlice(
      [&](int y, int z)
      {
        if (y >= end.y || z >= end.z)
        {
          return V::Set(0);
        }
        const Number* row = target.Row(y, z);
        const Number* other = before.Row(y, z);
        __builtin_prefetch(other + next);
        const V high = V::Set(most), low = V::Set(least);
        return OverRow(
          end.x,
          [&](int x)
          {
            // Lattices are so small that differences have room.
            const V rest = V::Load(row + x) - V::Load(other + x);
            return (rest > high) | (low > rest);
          },
          [&](int x) { return row[x] - other[x] > most || row[x] - other[x] < least; });
      });
    if (same)
    {
      const View<Number> decoded = this->ViewOf(*this->Job.Decoded);
      for (int z = 0; z < B; ++z)
      {
        for (int y = 0; y < B; ++y)
        {
          std::copy_n(before.Row(y, z), B, decoded.Row(y, z));
        }
      }
      out.Same = true;
    }
    return same;
  }

private:
  /// Calls row(y, z), which returns lanes, slice by slice until some lane is not 0.
  /// @return whether none is
  template <class Row>
  HWY_INLINE bool ForEachSlice(const Row& row) const
  {
    for (int z = 0; z < B; ++z)
    {
      V any = V::Set(0);
      for (int y = 0; y < B; ++y)
      {
        any = any | row(y, z);
      }
      if (AnyBit(any))
      {
        return false;
      }
    }
    return true;
  }

  /// Bits of a row that are set: of whole packs, and of single samples at its end.
  template <class Whole, class Single>
  static HWY_INLINE V OverRow(int count, const Whole& whole, const Single& single)
  {
    V any = V::Set(0);
    int x = 0;
    for (; x + Width <= count; x += Width)
    {
      any = any | whole(x);
    }
    bool some = false;
    for (; x < count; ++x)
    {
      some = some || single(x);
    }
    return some ? V::Set(1) : any;
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
