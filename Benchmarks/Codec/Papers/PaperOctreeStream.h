// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PaperOctreeStream_h
#define banyan_Benchmarks_PaperOctreeStream_h

#include "Base/Box.h"
#include "Base/Bytes.h"
#include "Base/Error.h"

#include <string>
#include <vector>

/// What writing and reading the octrees of PaperOctree.h share.
namespace banyan::paperoctree
{

/// Tags as numbers, their first digit in the lowest bit.
enum Tag : std::uint32_t
{
  Children = 0,       // 1 bit at level 2 and above, 2 at level 1
  SomeVoxels = 1,     // "10", level 1
  SameAbove = 1,      // "10", level 2 and above
  SameVoxels = 2,     // "01", level 1
  MacroVoxel = 3,     // "11"
  FirstMacroVoxel = 1 // "1", without a step before
};

inline std::size_t IndexIn(const glm::ivec3& size, const glm::ivec3& p)
{
  return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(size.y) +
           static_cast<std::size_t>(p.y)) *
           static_cast<std::size_t>(size.x) +
         static_cast<std::size_t>(p.x);
}

inline std::size_t CountOf(const glm::ivec3& size)
{
  return IndexIn(size, { 0, 0, size.z });
}

/// Sizes of all levels, the voxels first.
inline std::vector<glm::ivec3> LevelSizes(const glm::ivec3& samples)
{
  std::vector<glm::ivec3> sizes{ samples };
  do
  {
    sizes.push_back((sizes.back() + 1) / 2);
  } while (sizes.back() != glm::ivec3(1));
  return sizes;
}

/// The children of the node at `p`: a half-open box of positions of the level below.
inline Box ChildrenOf(const glm::ivec3& p, const glm::ivec3& below)
{
  return { 2 * p, glm::min(2 * p + 2, below) };
}

/// Bits from the lowest of each byte on.
class BitWriter
{
public:
  /// @param count at most 32; the bits of `bits` above are 0
  void Put(std::uint32_t bits, int count)
  {
    this->Waiting |= std::uint64_t{ bits } << this->WaitingCount;
    this->WaitingCount += count;
    if (this->WaitingCount >= 32)
    {
      const std::size_t end = this->Stream.size();
      this->Stream.resize(end + 4);
      StoreNumber(this->Stream.data() + end, static_cast<std::uint32_t>(this->Waiting));
      this->Waiting >>= 32;
      this->WaitingCount -= 32;
    }
  }

  Bytes Finish()
  {
    for (; this->WaitingCount > 0; this->WaitingCount -= 8)
    {
      this->Stream.push_back(static_cast<std::uint8_t>(this->Waiting));
      this->Waiting >>= 8;
    }
    return std::move(this->Stream);
  }

private:
  Bytes Stream;
  std::uint64_t Waiting = 0;
  int WaitingCount = 0;
};

/// Gives zeros beyond the end, which `Finish` complains of: how much is read depends on the grid
/// alone, so that checking once is enough.
class BitReader
{
public:
  explicit BitReader(const Bytes& stream)
    : Stream(stream)
  {
  }

  /// @param count at most 32
  std::uint32_t Get(int count)
  {
    if (this->WaitingCount < count)
    {
      this->Refill();
    }
    const std::uint64_t bits = this->Waiting & ((std::uint64_t{ 1 } << count) - 1);
    this->Waiting >>= count;
    this->WaitingCount -= count;
    this->Taken += static_cast<std::uint64_t>(count);
    return static_cast<std::uint32_t>(bits);
  }

  void Finish() const
  {
    const std::uint64_t needed = (this->Taken + 7) / 8;
    if (needed != this->Stream.size())
    {
      throw Error("The octree of a step does not end where its stream of bytes ends",
        { {}, {}, this->Stream.size(), needed });
    }
    if (this->Taken % 8 != 0 && this->Stream.back() >> (this->Taken % 8) != 0)
    {
      throw Error("The stream of an octree does not end with zero bits");
    }
  }

private:
  void Refill()
  {
    std::uint32_t more = 0;
    if (this->Next + 4 <= this->Stream.size())
    {
      more = LoadNumber<std::uint32_t>(this->Stream.data() + this->Next);
    }
    else
    {
      for (std::size_t i = this->Next; i < this->Stream.size(); ++i)
      {
        more |= std::uint32_t{ this->Stream[i] } << (8 * (i - this->Next));
      }
    }
    this->Next += this->Next < this->Stream.size() ? 4 : 0;
    this->Waiting |= std::uint64_t{ more } << this->WaitingCount;
    this->WaitingCount += 32;
  }

  const Bytes& Stream;
  std::size_t Next = 0;
  std::uint64_t Waiting = 0;
  int WaitingCount = 0;
  std::uint64_t Taken = 0;
};

/// Throws Error when they are out of range.
inline void CheckArguments(const glm::ivec3& samples, int bits)
{
  if (glm::any(glm::lessThan(samples, glm::ivec3(1))))
  {
    throw Error("An octree needs at least one voxel along each axis");
  }
  if (glm::any(glm::greaterThan(samples, glm::ivec3(1 << 30))))
  {
    throw Error("An octree can have 2^30 voxels along an axis, not more");
  }
  if (bits < 1 || bits > 16)
  {
    throw Error("The codes of an octree have 1 to 16 bits, not " + std::to_string(bits));
  }
}

} // namespace banyan::paperoctree

#endif
