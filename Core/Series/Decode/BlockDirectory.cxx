// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/BlockDirectory.h"

#include "Base/Error.h"
#include "Codec/BlockModes.h"
#include "Codec/DecodeStages.h"
#include "Codec/GroupOrder.h"

#include <algorithm>

namespace banyan
{

BlockDirectory::BlockDirectory(GroupReader& segment, std::uint32_t component,
  const glm::ivec3& samples, int brickCells, int levels)
  : File(segment)
  , Component(component)
  , StepTables(static_cast<std::size_t>(segment.Steps()))
  , Loaded(StepTables.size())
{
  const Bytes head = segment.Section(segment.HeadSection(component));
  this->FieldHead = group::UnpackHead(head.data(), head.size());
  if (this->FieldHead.Open && segment.FirstStep() == 0)
  {
    throw Error("The first segment of a series refers to one before it");
  }
  this->FieldShape = group::ShapeOf(samples, this->FieldHead.Axes, brickCells, levels);
}

const group::StepTable& BlockDirectory::LoadLocked(int step)
{
  const stages::In stage(stages::Tables);
  // Under the lock: threads that start on a new step together then load its table once.
  std::lock_guard<std::mutex> lock(this->Mutex);
  return this->Load(step);
}

const group::StepTable& BlockDirectory::Load(int step)
{
  std::unique_ptr<group::StepTable>& table = this->StepTables[static_cast<std::size_t>(step)];
  if (!table)
  {
    const int reference = ReferencesOfStep(step, this->File.Steps(), this->FieldHead.Open).B;
    const group::TableReference from{ reference, reference < 0 ? nullptr : &this->Load(reference) };
    const Bytes bytes = this->File.Section(this->File.StepSection(step, this->Component));
    table = std::make_unique<group::StepTable>(group::UnpackStep(
      bytes.data(), bytes.size(), this->FieldShape, step, from, this->File.PayloadEnd()));
    this->CheckNumbers(*table);
    this->Memory += table->MemoryBytes();
    this->BytesRead += bytes.size();
    this->Loaded[static_cast<std::size_t>(step)].store(table.get(), std::memory_order_release);
  }
  return *table;
}

bool BlockDirectory::Refers(const group::BlockEntry& entry)
{
  return entry.Same || (!entry.Uniform && block::ModeOf(entry.Mode).From != block::Reference::None);
}

bool BlockDirectory::BoxRefers(int step, int plane, const glm::ivec3& block)
{
  for (int number = 0; number < 8; ++number)
  {
    const glm::ivec3 at = BlockBehind(block, number);
    if (this->Has(plane, at) && Refers(this->Entry(step, plane, at)))
    {
      return true;
    }
  }
  return false;
}

/// Everything that is decoded lies between the head's extremes; so must what is stored as it is.
void BlockDirectory::CheckNumbers(const group::StepTable& table) const
{
  const auto outside = [this](std::int32_t number)
  { return number < this->FieldHead.Least || number > this->FieldHead.Greatest; };
  bool any = std::any_of(table.Top.begin(), table.Top.end(), outside);
  for (const auto& plane : table.Planes)
  {
    for (const group::BlockEntry& block : plane)
    {
      any = any || (block.Uniform && outside(block.Value));
    }
  }
  if (any)
  {
    throw Error("A number in the table of a step lies outside of its lattice");
  }
}

} // namespace banyan
