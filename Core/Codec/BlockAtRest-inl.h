// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockEncoder.cxx.
#if defined(banyan_Codec_BlockAtRest_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockAtRest_inl_h
#undef banyan_Codec_BlockAtRest_inl_h
#else
#define banyan_Codec_BlockAtRest_inl_h
#endif

#include "Codec/BlockAt-inl.h"

#include <glm/common.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Blocks that cost nothing: of one value, and as their reference.
template <class Edge, class Number>
struct BlockAtRest : BlockAt<Edge, Number>
{
  using V = Numbers<Number>;
  using Signed = typename V::Signed;

  /// Finds out whether the samples of a block are all the same, and places them.
  bool PlaceUniform(BlockTokens& out) const
  {
    const View<const Number> target = this->ViewOf(*this->Plane().Target);
    const std::int64_t next = this->NextBlock();
    const Number value = target.Base[0];
    const int n = this->B();
    const bool uniform = this->ForEachSlice(
      [&](int y, int z)
      {
        const Number* row = target.Row(y, z);
        __builtin_prefetch(row + next);
        return OverRow(
          n, [&](int x) { return LoadVector<Signed>(row + x) != value; },
          [&](int x) { return row[x] != value; });
      });
    if (uniform)
    {
      const View<Number> decoded = this->ViewOf(*this->Job.Decoded);
      for (int z = 0; z < n; ++z)
      {
        for (int y = 0; y < n; ++y)
        {
          std::fill_n(decoded.Row(y, z), n, value);
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
    const int n = this->B();
    // What lies beyond the field's end does not matter.
    const glm::ivec3 end = glm::min(glm::ivec3(n), plane.Target->Samples - this->Position * n);
    const Number most = static_cast<Number>(plane.FineBin / 2), least = static_cast<Number>(-most);
    const bool same = this->ForEachSlice(
      [&](int y, int z)
      {
        if (y >= end.y || z >= end.z)
        {
          return Signed{};
        }
        const Number* row = target.Row(y, z);
        const Number* other = before.Row(y, z);
        __builtin_prefetch(other + next);
        return OverRow(
          end.x,
          [&](int x)
          {
            // Lattices are so small that differences have room.
            const Signed rest = LoadVector<Signed>(row + x) - LoadVector<Signed>(other + x);
            return (rest > most) | (rest < least);
          },
          [&](int x) { return row[x] - other[x] > most || row[x] - other[x] < least; });
      });
    if (same)
    {
      const View<Number> decoded = this->ViewOf(*this->Job.Decoded);
      for (int z = 0; z < n; ++z)
      {
        for (int y = 0; y < n; ++y)
        {
          std::copy_n(before.Row(y, z), n, decoded.Row(y, z));
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
    for (int z = 0; z < this->B(); ++z)
    {
      Signed any{};
      for (int y = 0; y < this->B(); ++y)
      {
        any |= row(y, z);
      }
      if (AnyLane(any))
      {
        return false;
      }
    }
    return true;
  }

  /// Lanes of a row that are not 0: of whole vectors, and of single samples at its end.
  template <class Vector, class Single>
  static HWY_INLINE Signed OverRow(int count, const Vector& vector, const Single& single)
  {
    Signed any{};
    int x = 0;
    for (; x + Width <= count; x += Width)
    {
      any |= reinterpret_cast<Signed>(vector(x));
    }
    for (; x < count; ++x)
    {
      any[0] |= static_cast<Number>(single(x));
    }
    return any;
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
