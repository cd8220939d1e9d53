// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_GroupReader_h
#define banyan_Series_GroupReader_h

#include "Codec/DecodeTables.h"
#include "Codec/GroupOrder.h"
#include "Codec/MemoryAhead.h"
#include "Series/GroupFormat.h"
#include "Series/Hash.h"
#include "Series/LatticeCache.h"
#include "Series/PayloadPages.h"
#include "Series/SegmentFormat.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>
#include <vector>

namespace banyan
{

/// One segment. Every access is checked against the index that names it; may be used
/// from any thread.
class GroupReader
{
public:
  /// @param components of all arrays of the series
  GroupReader(const std::string& folder, const SegmentIndex& index, std::uint32_t components);
  /// @param file of several readers, where the index names it for several groups
  GroupReader(
    std::shared_ptr<const SegmentFile> file, const SegmentIndex& index, std::uint32_t components);

  const std::string& Path() const { return this->File->Path(); }
  int FirstStep() const { return this->Index.FirstStep; }
  int Steps() const { return this->Index.Steps; }

  /// Unpacks a section: 0 holds the hashes of pages, then come the heads, then the steps' tables.
  Bytes Section(std::uint32_t number);
  std::uint32_t HeadSection(std::uint32_t component) const { return 1 + component; }
  std::uint32_t StepSection(int step, std::uint32_t component) const
  {
    return 1 + this->Components + static_cast<std::uint32_t>(step) * this->Components + component;
  }
  std::uint64_t PayloadEnd();

  /// The payloads of the segment, read and checked as they are needed. Throws Error when the table
  /// of their checksums is damaged.
  PayloadPages& Payloads();

  const Hash128& HeaderHash() const { return this->Expected; }

private:
  void Check();

  std::shared_ptr<const SegmentFile> File;
  SegmentIndex Index;
  std::uint32_t Components;
  Hash128 Expected;
  std::mutex Mutex;
  bool Checked = false;
  segment::Header Head;
  Bytes Directory;
  std::unique_ptr<PayloadPages> Pages;
  std::once_flag PagesOnce;
};

/// One component in one segment, opened.
class GroupField
{
public:
  /// @param before gives the same component in the segment before; called without any lock, when a
  /// box is predicted from there. Must not be kept: each would keep the one before it.
  GroupField(GroupReader& segment, std::uint64_t series, std::uint32_t component,
    const glm::ivec3& samples, int brickCells, int levels,
    std::function<std::shared_ptr<GroupField>()> before);

  const group::FieldHead& Head() const { return this->FieldHead; }
  GroupReader& Segment() const { return this->File; }
  int Edge() const { return this->BrickCells; }
  /// Samples and blocks of each plane, axes in the codec's order.
  const std::vector<glm::ivec3>& Planes() const { return this->Shape.Planes; }
  glm::ivec3 BlocksOf(int plane) const
  {
    return this->Shape.Blocks[static_cast<std::size_t>(plane)];
  }

  /// The table of a step of the segment (0 is its first).
  const group::StepTable& Step(int step);

  /// Decodes the box of a block: (edge + 1)^3 lattice numbers.
  /// @param passing whether all of a region is read, which hardly comes back to boxes that are no
  /// references
  LatticeCache::Box Box(int step, int plane, const glm::ivec3& block, bool passing = false);

  /// Notes what decoding the box will read, boxes of other steps that usually are in memory only:
  /// while the next box is decoded the caches of the processor are asked for it. Decodes nothing.
  void Prefetch(int step, int plane, const glm::ivec3& block);

  /// Checks the pages of everything that decoding the box reads.
  void Verify(int step, int plane, const glm::ivec3& block);

  std::uint64_t MemoryBytes() const { return this->Memory; }
  std::uint64_t TakeBytesRead() { return this->BytesRead.exchange(0); }

private:
  using Visited = std::set<std::tuple<int, int, std::size_t>>; ///< steps of the series

  /// The same under the lock. Loads the table's references as well.
  const group::StepTable& Load(int step);
  std::size_t IndexOf(int plane, const glm::ivec3& block) const;
  LatticeCache::Key KeyOf(int step, int plane, const glm::ivec3& block) const;
  void Verify(int step, int plane, const glm::ivec3& block, Visited& visited);
  bool NeedsReferences(int step, int plane, const glm::ivec3& block);
  StepReferences ReferencesOf(int step) const;
  template <class Body>
  auto InSegmentBefore(Body&& body);
  LatticeCache::Box ReferenceBox(int step, int plane, const glm::ivec3& block);
  template <class Number>
  const Number* Coarse(int step, int plane, const glm::ivec3& block);
  void CheckNumbers(const group::StepTable& table) const;
  LatticeCache::Box Decode(int step, int plane, const glm::ivec3& block);
  template <class Number>
  LatticeCache::Box DecodeAs(int step, int plane, const glm::ivec3& block);
  /// What the calling thread asks for.
  static MemoryAhead& Ahead();

  GroupReader& File;
  std::uint64_t Series;
  std::uint32_t Component;
  int BrickCells;
  std::function<std::shared_ptr<GroupField>()> Before;
  std::atomic<bool> BeforeFits{ false }; ///< it was seen to have the same lattice
  group::FieldHead FieldHead;
  group::TableShape Shape;
  DecodeTables Tables[2];
  std::mutex Mutex;
  std::vector<std::unique_ptr<group::StepTable>> StepTables;
  std::vector<std::atomic<const group::StepTable*>> Loaded; ///< the same, without the lock
  std::atomic<std::uint64_t> Memory{ 0 };
  std::atomic<std::uint64_t> BytesRead{ 0 };
};

} // namespace banyan

#endif
