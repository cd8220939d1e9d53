// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_GroupField_h
#define banyan_Series_Decode_GroupField_h

#include "Codec/BlockDecoder.h"
#include "Codec/DecodeTables.h"
#include "Codec/GroupOrder.h"
#include "Codec/LinePrefetcher.h"
#include "Series/Decode/BlockDirectory.h"
#include "Series/Decode/GroupReader.h"
#include "Series/Decode/QuantizedBlockCache.h"

#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

namespace banyan
{

/// One component in one segment, opened.
class GroupField
{
public:
  /// @param before gives the same component in the segment before; called without any lock, when a
  /// box is predicted from there. Must not be kept: each would keep the one before it.
  GroupField(GroupReader& segment, std::uint64_t series, std::uint32_t component,
    const glm::ivec3& samples, int brickCells, int levels,
    std::function<std::shared_ptr<GroupField>()> before);

  const group::FieldHead& Head() const { return this->Directory.Head(); }
  GroupReader& Segment() const { return this->File; }
  int Edge() const { return this->BrickCells; }
  /// Samples and blocks of each plane, axes in the codec's order.
  const std::vector<glm::ivec3>& Planes() const { return this->Directory.Shape().Planes; }
  glm::ivec3 BlocksOf(int plane) const
  {
    return this->Directory.Shape().Blocks[static_cast<std::size_t>(plane)];
  }

  /// The table of a step of the segment (0 is its first).
  const group::StepTable& Step(int step) { return this->Directory.Step(step); }

  /// Decodes the box of a block: (edge + 1)^3 lattice numbers.
  /// @param streaming whether all of a region is read, which hardly comes back to boxes that are no
  /// references
  QuantizedBlockCache::Box Box(
    int step, int plane, const glm::ivec3& block, bool streaming = false);

  /// Notes what decoding the box will read, boxes of other steps that usually are in memory only:
  /// while the next box is decoded the caches of the processor are asked for it. Decodes nothing.
  void Prefetch(int step, int plane, const glm::ivec3& block);

  /// Checks the pages of everything that decoding the box reads.
  void Verify(int step, int plane, const glm::ivec3& block);

  std::uint64_t MemoryBytes() const;
  /// Bytes that were read since the last call.
  std::uint64_t TakeBytesRead()
  {
    return this->BytesRead.exchange(0) + this->Directory.TakeBytesRead();
  }

private:
  using Visited = std::set<std::tuple<int, int, std::size_t>>; ///< steps of the series

  QuantizedBlockCache::Key KeyOf(int step, int plane, const glm::ivec3& block) const;
  void Verify(int step, int plane, const glm::ivec3& block, Visited& visited);
  StepReferences ReferencesOf(int step) const;
  template <class Body>
  auto InSegmentBefore(Body&& body);
  QuantizedBlockCache::Box ReferenceBox(int step, int plane, const glm::ivec3& block);
  template <class Number>
  const Number* Coarse(int step, int plane, const glm::ivec3& block);
  QuantizedBlockCache::Box Decode(int step, int plane, const glm::ivec3& block);
  /// What the blocks of a box have in common.
  struct Kind
  {
    bool Refers = false; ///< some are predicted from other steps
    bool Same = true;    ///< all are as in the step before
  };
  Kind CodeOfBlocks(int step, int plane, const glm::ivec3& block, const PayloadPages::Hold& hold,
    BlockCode* blocks);
  template <class Number>
  QuantizedBlockCache::Box DecodeAs(int step, int plane, const glm::ivec3& block);
  /// What the calling thread asks for.
  static LinePrefetcher& Ahead();

  GroupReader& File;
  QuantizedBlockCache& Cache;
  std::uint64_t Series;
  std::uint32_t Component;
  int BrickCells;
  std::function<std::shared_ptr<GroupField>()> Before;
  std::atomic<bool> BeforeFits{ false }; ///< it was seen to have the same lattice
  BlockDirectory Directory;
  DecodeTables Tables[2];
  std::atomic<std::uint64_t> BytesRead{ 0 };
};

} // namespace banyan

#endif
