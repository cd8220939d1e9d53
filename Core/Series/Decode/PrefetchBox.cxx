// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BlockModes.h"
#include "Codec/BlockScratch.h"
#include "Codec/DecodeStages.h"
#include "Codec/GroupOrder.h"
#include "Series/Decode/GroupField.h"

namespace banyan
{

LinePrefetcher& GroupField::Ahead()
{
  thread_local LinePrefetcher ahead;
  return ahead;
}

void GroupField::Prefetch(int step, int plane, const glm::ivec3& block)
{
  const stages::In stage(stages::Prefetch);
  const group::BlockEntry& entry = this->Directory.Entry(step, plane, block);
  const std::size_t number = block::Narrow(this->Head().Least, this->Head().Greatest) ? 2 : 4;
  const std::size_t row = static_cast<std::size_t>(this->BrickCells + 1) * number;
  const std::size_t layer = static_cast<std::size_t>(this->BrickCells + 1) * row;
  const std::size_t whole = static_cast<std::size_t>(this->BrickCells + 1) * layer;
  LinePrefetcher& ahead = Ahead();
  ahead.Clear();
  const auto fetch = [&](int from)
  {
    const void* const numbers = this->Cache.AddressOf(this->KeyOf(from, plane, block));
    if (numbers != nullptr)
    {
      ahead.Add(numbers, whole);
    }
    return numbers != nullptr;
  };
  if (fetch(step))
  {
    return;
  }
  // The first layer along z of the block behind, which was decoded long ago.
  if (block.z + 1 < this->BlocksOf(plane).z)
  {
    const glm::ivec3 behind = block + glm::ivec3{ 0, 0, 1 };
    const group::BlockEntry& other = this->Directory.Entry(step, plane, behind);
    const void* const numbers = other.Uniform || other.Same
                                  ? nullptr
                                  : this->Cache.AddressOf(this->KeyOf(step, plane, behind));
    if (numbers != nullptr)
    {
      ahead.Add(numbers, layer);
    }
  }
  const bool refers = BlockDirectory::Refers(entry);
  const StepReferences references = ReferencesOfStep(step, this->File.Steps(), this->Head().Open);
  if (refers && references.Any())
  {
    fetch(references.A);
    if (references.B != references.A && !entry.Same)
    {
      fetch(references.B);
    }
  }
}

} // namespace banyan
