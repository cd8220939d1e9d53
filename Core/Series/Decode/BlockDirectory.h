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
