// SPDX-License-Identifier: BSD-3-Clause
#include "Papers/PaperOctree.h"

#include "Papers/PaperOctreeStream.h"

#include <vector>

namespace banyan
{
namespace
{

using namespace paperoctree;

enum State : std::uint8_t
{
  Fused = 1,
  Same = 2
};

/// Nodes of one level above the voxels.
struct NodeLevel
{
  glm::ivec3 Size{ 1 };
  std::vector<std::uint8_t> States;
  std::vector<std::uint16_t> Codes; ///< of the first voxel below; of all when fused
};

/// Level 1: what the voxels of each block of 2 x 2 x 2 have in common.
NodeLevel JoinVoxels(const std::uint16_t* codes, const std::uint16_t* previous,
  const glm::ivec3& samples, const glm::ivec3& size)
{
  NodeLevel level{ size, {}, {} };
  level.States.reserve(CountOf(size));
  level.Codes.reserve(CountOf(size));
  ForPositions({ glm::ivec3(0), size },
    [&](const glm::ivec3& p)
    {
      const Box box = ChildrenOf(p, samples);
      const std::uint16_t first = codes[IndexIn(samples, box.Lo)];
      unsigned other = 0;
      unsigned changed = 0;
      for (int z = box.Lo.z; z < box.Hi.z; ++z)
      {
        for (int y = box.Lo.y; y < box.Hi.y; ++y)
        {
          const std::size_t row = IndexIn(samples, { box.Lo.x, y, z });
          for (std::size_t i = row; i < row + static_cast<std::size_t>(box.Hi.x - box.Lo.x); ++i)
          {
            other |= static_cast<unsigned>(codes[i] ^ first);
            changed |= previous ? static_cast<unsigned>(codes[i] ^ previous[i]) : 1u;
          }
        }
      }
      level.States.push_back(
        static_cast<std::uint8_t>((other == 0 ? Fused : 0) | (changed == 0 ? Same : 0)));
      level.Codes.push_back(first);
    });
  return level;
}

NodeLevel JoinNodes(const NodeLevel& below, const glm::ivec3& size)
{
  NodeLevel level{ size, {}, {} };
  level.States.reserve(CountOf(size));
  level.Codes.reserve(CountOf(size));
  ForPositions({ glm::ivec3(0), size },
    [&](const glm::ivec3& p)
    {
      const Box box = ChildrenOf(p, below.Size);
      const std::uint16_t first = below.Codes[IndexIn(below.Size, box.Lo)];
      unsigned state = Fused | Same;
      ForPositions(box,
        [&](const glm::ivec3& child)
        {
          const std::size_t i = IndexIn(below.Size, child);
          state &= below.Codes[i] == first ? below.States[i] : below.States[i] & Same;
        });
      level.States.push_back(static_cast<std::uint8_t>(state));
      level.Codes.push_back(first);
    });
  return level;
}

/// Writes one step, and counts.
class OctreeEncoder
{
public:
  OctreeEncoder(
    const std::uint16_t* codes, const std::uint16_t* previous, const glm::ivec3& samples, int bits)
    : Codes(codes)
    , Previous(previous)
    , Samples(samples)
    , BitsPerCode(bits)
  {
    const std::vector<glm::ivec3> sizes = LevelSizes(samples);
    this->Levels.resize(sizes.size());
    this->Levels[1] = JoinVoxels(codes, previous, samples, sizes[1]);
    for (std::size_t l = 2; l < sizes.size(); ++l)
    {
      this->Levels[l] = JoinNodes(this->Levels[l - 1], sizes[l]);
    }
  }

  PaperOctreeStep Encode()
  {
    this->Step.Counts.MacroVoxels = this->CountGreatest(Fused);
    this->Step.Counts.MergedSubtrees = this->CountGreatest(Same);
    this->PutNode(this->Levels.size() - 1, glm::ivec3(0));
    this->Step.Stream = this->Out.Finish();
    return std::move(this->Step);
  }

private:
  CountsBySize CountGreatest(State state) const
  {
    CountsBySize counts(this->Levels.size(), 0);
    for (std::size_t l = this->Levels.size(); l-- > 1;)
    {
      const NodeLevel& level = this->Levels[l];
      const NodeLevel* above = l + 1 < this->Levels.size() ? &this->Levels[l + 1] : nullptr;
      std::size_t i = 0;
      ForPositions({ glm::ivec3(0), level.Size },
        [&](const glm::ivec3& p)
        {
          const bool inAbove = above && (above->States[IndexIn(above->Size, p / 2)] & state) != 0;
          const bool has = (level.States[i] & state) != 0;
          counts[l] += has && !inAbove ? 1 : 0;
          counts[0] += !has && l == 1 ? this->VoxelsBelow(p, state) : 0;
          ++i;
        });
    }
    return counts;
  }

  /// Voxels below a node of level 1 that count by themselves.
  std::int64_t VoxelsBelow(const glm::ivec3& p, State state) const
  {
    const Box box = ChildrenOf(p, this->Samples);
    std::int64_t count = 0;
    ForPositions(box, [&](const glm::ivec3& v) { count += state == Fused || this->SameAt(v); });
    return count;
  }

  bool SameAt(const glm::ivec3& voxel) const
  {
    const std::size_t i = IndexIn(this->Samples, voxel);
    return this->Previous && this->Codes[i] == this->Previous[i];
  }

  void PutTag(std::uint32_t tag, int count)
  {
    this->Out.Put(tag, count);
    this->Step.Counts.TagBits += static_cast<std::uint64_t>(count);
  }

  void PutCode(std::uint16_t code)
  {
    this->Out.Put(code, this->BitsPerCode);
    this->Step.Counts.CodeBits += static_cast<std::uint64_t>(this->BitsPerCode);
  }

  void PutNode(std::size_t l, const glm::ivec3& p)
  {
    const std::size_t i = IndexIn(this->Levels[l].Size, p);
    const std::uint8_t state = this->Levels[l].States[i];
    if (state & Same)
    {
      this->PutTag(l == 1 ? SameVoxels : SameAbove, 2);
    }
    else if (state & Fused)
    {
      this->Previous ? this->PutTag(MacroVoxel, 2) : this->PutTag(FirstMacroVoxel, 1);
      this->PutCode(this->Levels[l].Codes[i]);
    }
    else if (l == 1)
    {
      this->PutVoxels(ChildrenOf(p, this->Samples));
    }
    else
    {
      this->PutTag(Children, 1);
      ForPositions(ChildrenOf(p, this->Levels[l - 1].Size),
        [&](const glm::ivec3& child) { this->PutNode(l - 1, child); });
    }
  }

  void PutVoxels(const Box& box)
  {
    std::uint32_t mask = 0;
    int count = 0;
    ForPositions(box, [&](const glm::ivec3& v) { mask |= (this->SameAt(v) ? 1u : 0u) << count++; });
    this->PutTag(mask ? SomeVoxels : Children, this->Previous ? 2 : 1);
    if (mask)
    {
      this->PutTag(mask, count);
    }
    ForPositions(box,
      [&](const glm::ivec3& v)
      {
        if ((mask & 1) == 0)
        {
          this->PutCode(this->Codes[IndexIn(this->Samples, v)]);
        }
        mask >>= 1;
      });
  }

  const std::uint16_t* Codes;
  const std::uint16_t* Previous;
  glm::ivec3 Samples;
  int BitsPerCode;
  std::vector<NodeLevel> Levels; ///< [0] is empty: the voxels themselves
  BitWriter Out;
  PaperOctreeStep Step;
};

} // namespace

PaperOctreeStep EncodePaperOctree(
  const std::uint16_t* codes, const std::uint16_t* previous, const glm::ivec3& samples, int bits)
{
  CheckArguments(samples, bits);
  const std::size_t count = CountOf(samples);
  unsigned all = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    all |= codes[i];
  }
  if (all >> bits != 0)
  {
    throw Error("A code needs more bits than the octree's codes have",
      { {}, {}, all, (std::uint64_t{ 1 } << bits) - 1 });
  }
  return OctreeEncoder(codes, previous, samples, bits).Encode();
}

double SavedShare(std::uint64_t encodedBits, std::int64_t voxels, int bitsPerVoxel)
{
  return 1.0 - static_cast<double>(encodedBits) /
                 (static_cast<double>(voxels) * static_cast<double>(bitsPerVoxel));
}

} // namespace banyan
