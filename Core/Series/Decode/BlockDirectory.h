// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_BlockDirectory_h
#define banyan_Series_Decode_BlockDirectory_h

#include "Series/Decode/GroupReader.h"
#include "Series/Format/GroupFormat.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace banyan
{

/// One component in one segment: its head, and the tables of its steps, which say where its blocks
/// are. Tables are loaded when they are needed. Any thread may use it.
class BlockDirectory
{
public:
  /// Throws Error when the head is damaged.
  /// @param segment must outlive this object
  BlockDirectory(GroupReader& segment, std::uint32_t component, const glm::ivec3& samples,
    int brickCells, int levels);

  const group::FieldHead& Head() const { return this->FieldHead; }
  const group::TableShape& Shape() const { return this->FieldShape; }

  /// The table of a step of the segment (0 is its first). Throws Error when it is damaged.
  const group::StepTable& Step(int step)
  {
    const group::StepTable* const table =
      this->Loaded[static_cast<std::size_t>(step)].load(std::memory_order_acquire);
    return table ? *table : this->LoadLocked(step);
  }

  /// The number of a block in its plane.
  std::size_t IndexOf(int plane, const glm::ivec3& block) const
  {
    const glm::ivec3& blocks = this->FieldShape.Blocks[static_cast<std::size_t>(plane)];
    return (static_cast<std::size_t>(block.z) * static_cast<std::size_t>(blocks.y) +
             static_cast<std::size_t>(block.y)) *
             static_cast<std::size_t>(blocks.x) +
           static_cast<std::size_t>(block.x);
  }
  const group::BlockEntry& Entry(int step, int plane, const glm::ivec3& block)
  {
    return this->Step(step).Planes[static_cast<std::size_t>(plane)][this->IndexOf(plane, block)];
  }
  /// The block itself (0), or one of the seven behind it whose first layers its box has.
  /// @param number a bit for each axis along which it is behind
  static glm::ivec3 BlockBehind(const glm::ivec3& block, int number)
  {
    return block + glm::ivec3{ number & 1, number >> 1 & 1, number >> 2 & 1 };
  }
  bool Has(int plane, const glm::ivec3& block) const
  {
    const glm::ivec3& blocks = this->FieldShape.Blocks[static_cast<std::size_t>(plane)];
    return block.x < blocks.x && block.y < blocks.y && block.z < blocks.z;
  }
  /// Whether a block is predicted from other steps.
  static bool Refers(const group::BlockEntry& entry);
  /// Whether any block of a box is.
  bool BoxRefers(int step, int plane, const glm::ivec3& block);

  std::uint64_t MemoryBytes() const { return this->Memory; }
  /// Bytes that were read since the last call.
  std::uint64_t TakeBytesRead() { return this->BytesRead.exchange(0); }

private:
  const group::StepTable& LoadLocked(int step);
  /// The same under the lock. Loads the table's references as well.
  const group::StepTable& Load(int step);
  void CheckNumbers(const group::StepTable& table) const;

  GroupReader& File;
  std::uint32_t Component;
  group::FieldHead FieldHead;
  group::TableShape FieldShape;
  std::mutex Mutex;
  std::vector<std::unique_ptr<group::StepTable>> StepTables;
  std::vector<std::atomic<const group::StepTable*>> Loaded; ///< the same, without the lock
  std::atomic<std::uint64_t> Memory{ 0 };
  std::atomic<std::uint64_t> BytesRead{ 0 };
};

} // namespace banyan

#endif
