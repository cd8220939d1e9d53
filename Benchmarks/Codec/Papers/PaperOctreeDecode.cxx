// SPDX-License-Identifier: BSD-3-Clause
#include "Papers/PaperOctree.h"
#include "Papers/PaperOctreeStream.h"

#include <algorithm>
#include <vector>

namespace banyan
{
namespace
{

using namespace paperoctree;

/// Reads one step.
class OctreeDecoder
{
public:
  OctreeDecoder(const Bytes& stream, const std::uint16_t* previous, const glm::ivec3& samples,
    int bits, std::uint16_t* codes)
    : In(stream)
    , Previous(previous)
    , Sizes(LevelSizes(samples))
    , BitsPerCode(bits)
    , Codes(codes)
  {
  }

  void Decode()
  {
    this->TakeNode(this->Sizes.size() - 1, glm::ivec3(0));
    this->In.Finish();
  }

private:
  std::uint16_t TakeCode() { return static_cast<std::uint16_t>(this->In.Get(this->BitsPerCode)); }

  /// The voxels below a node.
  Box VoxelsOf(std::size_t l, const glm::ivec3& p) const
  {
    const int edge = 1 << l;
    return { p * edge, glm::min(p * edge + edge, this->Sizes[0]) };
  }

  void Fill(const Box& box, std::uint16_t code)
  {
    this->ForRows(box, [this, code](std::size_t at, std::size_t length)
      { std::fill_n(this->Codes + at, length, code); });
  }

  template <class Row>
  void ForRows(const Box& box, Row&& row) const
  {
    const std::size_t length = static_cast<std::size_t>(box.Size().x);
    ForPositions({ box.Lo, { box.Lo.x + 1, box.Hi.y, box.Hi.z } },
      [&](const glm::ivec3& p) { row(IndexIn(this->Sizes[0], p), length); });
  }

  void Keep(const Box& box)
  {
    if (this->Codes != this->Previous)
    {
      this->ForRows(box, [this](std::size_t at, std::size_t length)
        { std::copy_n(this->Previous + at, length, this->Codes + at); });
    }
  }

  void TakeNode(std::size_t l, const glm::ivec3& p)
  {
    if (l == 1 && this->Previous)
    {
      this->TakeSmallNode(p);
    }
    else if (this->In.Get(1) == 0)
    {
      l == 1 ? this->TakeVoxels(ChildrenOf(p, this->Sizes[0]), 0) : this->TakeChildren(l, p);
    }
    else if (this->Previous && this->In.Get(1) == 0)
    {
      this->Keep(this->VoxelsOf(l, p));
    }
    else
    {
      this->Fill(this->VoxelsOf(l, p), this->TakeCode());
    }
  }

  void TakeChildren(std::size_t l, const glm::ivec3& p)
  {
    ForPositions(ChildrenOf(p, this->Sizes[l - 1]),
      [&](const glm::ivec3& child) { this->TakeNode(l - 1, child); });
  }

  /// A node of level 1 with a step before.
  void TakeSmallNode(const glm::ivec3& p)
  {
    const Box box = ChildrenOf(p, this->Sizes[0]);
    switch (this->In.Get(2))
    {
      case Children:
        this->TakeVoxels(box, 0);
        break;
      case SomeVoxels:
        this->TakeVoxels(box, this->In.Get(static_cast<int>(box.Count())));
        break;
      case SameVoxels:
        this->Keep(box);
        break;
      default:
        this->Fill(box, this->TakeCode());
    }
  }

  /// @param kept bit per voxel: as before
  void TakeVoxels(const Box& box, std::uint32_t kept)
  {
    ForPositions(box,
      [&](const glm::ivec3& v)
      {
        const std::size_t i = IndexIn(this->Sizes[0], v);
        this->Codes[i] = (kept & 1) != 0 ? this->Previous[i] : this->TakeCode();
        kept >>= 1;
      });
  }

  BitReader In;
  const std::uint16_t* Previous;
  std::vector<glm::ivec3> Sizes;
  int BitsPerCode;
  std::uint16_t* Codes;
};

} // namespace

void DecodePaperOctree(const Bytes& stream, const std::uint16_t* previous,
  const glm::ivec3& samples, int bits, std::uint16_t* codes)
{
  CheckArguments(samples, bits);
  OctreeDecoder(stream, previous, samples, bits, codes).Decode();
}

} // namespace banyan
