// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_BoxPlaces_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BoxPlaces_inl_h
#undef banyan_Codec_BoxPlaces_inl_h
#else
#define banyan_Codec_BoxPlaces_inl_h
#endif

#include "Base/Error.h"
#include "Codec/BlockDecoder.h"
#include "Codec/Simd/Units-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// A box, and what comes to it without residuals: samples of the coarser plane, faces of decoded
/// neighbours, blocks of one number, and those that are the same as in a reference.
template <int B, class Number>
struct BoxPlaces
{
  const BoxCodeOf<Number>& Code;
  View<Number> Box;
  View<const Number> ReferenceA;

  static constexpr int N = B + 1; ///< samples of the box per axis

  glm::ivec3 Corner(int owner) const
  {
    return { owner & 1 ? B : 0, owner & 2 ? B : 0, owner & 4 ? B : 0 };
  }

  void PlaceCoarse() const
  {
    constexpr int n = B / 4 + 1;
    const Number* from = this->Code.Coarse;
    for (int z = 0; z < n; ++z)
    {
      for (int y = 0; y < n; ++y, from += n)
      {
        Number* row = this->Box.Row(4 * y, 4 * z);
        for (int x = 0; x < n; ++x)
        {
          row[4 * x] = from[x];
        }
      }
    }
  }

  /// The decoded box of a neighbour (1, 2 or 4), or null.
  const Number* NeighbourOf(int owner) const
  {
    return owner == 1 || owner == 2 || owner == 4 ? this->Code.Neighbours[owner / 2] : nullptr;
  }

  /// Whether the edge that a block across an edge of the box owns is in a decoded face.
  bool HasEdge(int owner) const
  {
    for (const int neighbour : { 1, 2, 4 })
    {
      if ((neighbour & owner) != 0 && this->NeighbourOf(neighbour) != nullptr)
      {
        return true;
      }
    }
    return false;
  }

  /// The first layer of a decoded neighbour, other owners' edges of it included, is the last one
  /// here.
  void PlaceFace(int owner) const
  {
    const View<const Number> from{ this->NeighbourOf(owner), this->Box.Stride };
    const glm::ivec3 corner = this->Corner(owner);
    const View<Number> to = this->Box.At(corner);
    // Both boxes are without gaps: rows of a layer along z follow each other.
    const std::size_t row = std::size_t{ N } * sizeof(Number);
    if (owner == 1)
    {
      for (int i = 0; i < N * N; ++i)
      {
        to.Base[i * N] = from.Base[i * N];
      }
    }
    else if (owner == 2)
    {
      for (int z = 0; z < N; ++z)
      {
        std::memcpy(to.Row(0, z), from.Row(0, z), row); // of a length that is known: no call
      }
    }
    else
    {
      std::memcpy(to.Base, from.Base, N * row);
    }
  }

  /// Whether a block takes no decoding: it is uniform, the same as in reference A, or decoded.
  bool Plain(int owner) const
  {
    const BlockCode& block = this->Code.Blocks[owner];
    return block.Uniform || block.Same || this->NeighbourOf(owner) != nullptr;
  }

  /// Fills what a plain block owns of the box.
  void PlacePlain(int owner) const
  {
    if (this->NeighbourOf(owner) != nullptr)
    {
      return this->PlaceFace(owner);
    }
    if (this->Code.Blocks[owner].Same && this->Code.A == nullptr)
    {
      throw Error("A block is the same as in a step that its group does not have");
    }
    const glm::ivec3 low = this->Corner(owner);
    const glm::ivec3 high{ owner & 1 ? N : B, owner & 2 ? N : B, owner & 4 ? N : B };
    for (int z = low.z; z < high.z; ++z)
    {
      for (int y = low.y; y < high.y; ++y)
      {
        Number* row = this->Box.Row(y, z);
        if (this->Code.Blocks[owner].Same && (owner & 1) == 0)
        {
          // The length is known: no call.
          std::memcpy(row, this->ReferenceA.Row(y, z), B * sizeof(Number));
        }
        else if (this->Code.Blocks[owner].Same)
        {
          row[low.x] = this->ReferenceA.Row(y, z)[low.x];
        }
        else
        {
          std::fill(row + low.x, row + high.x, static_cast<Number>(this->Code.Blocks[owner].Value));
        }
      }
    }
  }
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
