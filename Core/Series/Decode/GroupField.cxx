// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/GroupField.h"
#include "Base/Error.h"
#include "Codec/BlockDecoder.h"
#include "Codec/BlockEncoder.h"
#include "Codec/BlockModes.h"
#include "Codec/BlockScratch.h"
#include "Codec/DecodeStages.h"
#include "Codec/GroupOrder.h"
#include "Codec/SymbolWriter.h"
#include "Series/Decode/OpenSeries.h"

#include <algorithm>

namespace banyan
{

GroupField::GroupField(GroupReader& segment, std::uint64_t series, std::uint32_t component,
  const glm::ivec3& samples, int brickCells, int levels,
  std::function<std::shared_ptr<GroupField>()> before)
  : File(segment)
  , Cache(segment.Caches().Blocks())
  , Series(series)
  , Component(component)
  , BrickCells(brickCells)
  , Before(std::move(before))
  , Directory(segment, component, samples, brickCells, levels)
{
  for (int set = 0; set < 2; ++set)
  {
    this->Tables[set] = DecodeTablesOf(this->Head().Frequencies[set]);
  }
}

std::uint64_t GroupField::MemoryBytes() const
{
  return this->Directory.MemoryBytes() + this->Tables[0].Bytes() + this->Tables[1].Bytes();
}

StepReferences GroupField::ReferencesOf(int step) const
{
  const StepReferences references = ReferencesOfStep(step, this->File.Steps(), this->Head().Open);
  if (!references.Any())
  {
    throw Error("A block of the key frame of a segment refers to another step");
  }
  return references;
}

/// Calls the body with the same component in the segment before.
template <class Body>
auto GroupField::InSegmentBefore(Body&& body)
{
  const std::shared_ptr<GroupField> before = this->Before();
  if (!group::SameLattice(before->Head(), this->Head()))
  {
    throw Error("A segment refers to the one before it, which is quantized differently");
  }
  this->BeforeFits = true;
  return WithErrorPlace(before->File.Path(), 0,
    [&]
    {
      const auto result = body(*before);
      this->BytesRead += before->TakeBytesRead();
      return result;
    });
}

/// The box of a step that another one refers to.
QuantizedBlockCache::Box GroupField::ReferenceBox(int step, int plane, const glm::ivec3& block)
{
  if (step != StepBefore)
  {
    return this->Box(step, plane, block);
  }
  const stages::In stage(stages::Lookup);
  if (this->BeforeFits)
  {
    if (QuantizedBlockCache::Box found = this->Cache.Find(this->KeyOf(step, plane, block)))
    {
      return found;
    }
  }
  return this->InSegmentBefore(
    [&](GroupField& before) { return before.Box(before.File.Steps() - 1, plane, block); });
}

/// The samples of the next plane that a box is predicted from.
template <class Number>
const Number* GroupField::Coarse(int step, int plane, const glm::ivec3& block)
{
  const int n = this->BrickCells / 4 + 1;
  const glm::ivec3 samples = this->Planes()[static_cast<std::size_t>(plane) + 1];
  const glm::ivec3 first = block * (this->BrickCells / 4);
  const bool top = plane + 2 == static_cast<int>(this->Planes().size());
  const glm::ivec3 coarseBlock = first / this->BrickCells;
  const glm::ivec3 origin = top ? glm::ivec3(0) : coarseBlock * this->BrickCells;
  const glm::ivec3 size = top ? samples : glm::ivec3(this->BrickCells + 1);
  const stages::In stage(stages::Coarse);
  thread_local std::vector<Number> numbers;
  numbers.resize(static_cast<std::size_t>(n * n * n));
  int columns[32 / 4 + 1]; // of the largest blocks
  for (int x = 0; x < n; ++x)
  {
    columns[x] = std::min(first.x + x, samples.x - 1) - origin.x;
  }
  const auto gather = [&](const auto* from)
  {
    Number* to = numbers.data();
    for (int z = 0; z < n; ++z)
    {
      const int sz = std::min(first.z + z, samples.z - 1) - origin.z;
      for (int y = 0; y < n; ++y)
      {
        const int sy = std::min(first.y + y, samples.y - 1) - origin.y;
        const auto* row = from + (sz * size.y + sy) * size.x;
        for (int x = 0; x < n; ++x)
        {
          *to++ = static_cast<Number>(row[columns[x]]);
        }
      }
    }
  };
  if (top)
  {
    gather(this->Step(step).Top.data());
  }
  else
  {
    // The box may decode others on the way, which use the same memory: it comes first.
    gather(this->Box(step, plane + 1, coarseBlock)->Numbers<Number>());
  }
  return numbers.data();
}

QuantizedBlockCache::Box GroupField::Decode(int step, int plane, const glm::ivec3& block)
{
  return block::Narrow(this->Head().Least, this->Head().Greatest)
           ? this->DecodeAs<std::int16_t>(step, plane, block)
           : this->DecodeAs<std::int32_t>(step, plane, block);
}

/// The code of a block and of the seven behind it, whose first layers its box has.
/// @param blocks those eight
GroupField::Kind GroupField::CodeOfBlocks(
  int step, int plane, const glm::ivec3& block, const PayloadPages::Hold& hold, BlockCode* blocks)
{
  const auto& entries = this->Step(step).Planes[static_cast<std::size_t>(plane)];
  const glm::ivec3 samples = this->Planes()[static_cast<std::size_t>(plane)];
  Kind kind;
  for (int bits = 0; bits < 8; ++bits)
  {
    const glm::ivec3 at = BlockDirectory::BlockBehind(block, bits);
    BlockCode& to = blocks[bits];
    to.Exists = this->Directory.Has(plane, at);
    if (!to.Exists)
    {
      kind.Same = false; // what lies beyond the field's end is predicted anew at each step
      continue;
    }
    const group::BlockEntry& entry = entries[this->Directory.IndexOf(plane, at)];
    to.Uniform = entry.Uniform;
    to.Same = entry.Same;
    to.Value = entry.Value;
    to.Mode = entry.Mode;
    to.Limit = samples - 1 - at * this->BrickCells;
    kind.Refers = kind.Refers || BlockDirectory::Refers(entry);
    kind.Same = kind.Same && entry.Same;
    if (entry.Payload.Bytes > 0 && bits != 7)
    {
      to.Data = this->File.Payloads().At(hold, entry.Payload.Offset, entry.Payload.Bytes);
      to.Bytes = entry.Payload.Bytes;
    }
  }
  return kind;
}

template <class Number>
QuantizedBlockCache::Box GroupField::DecodeAs(int step, int plane, const glm::ivec3& block)
{
  PlaneCode shared;
  shared.Tables = &this->Tables[plane > 0 ? 1 : 0];
  shared.CoarseBin = BinOfOctave(this->Head().Bin, 2 * plane + 1);
  shared.FineBin = BinOfOctave(this->Head().Bin, 2 * plane);
  shared.Least = this->Head().Least;
  shared.Greatest = this->Head().Greatest;
  BoxCodeOf<Number> code;
  const PayloadPages::Hold hold = this->File.Payloads().InMemory();
  const auto [refers, same] = this->CodeOfBlocks(step, plane, block, hold, code.Blocks);
  this->BytesRead += code.Blocks[0].Bytes;
  if (same)
  {
    return this->ReferenceBox(this->ReferencesOf(step).A, plane, block);
  }
  QuantizedBlockCache::Box neighbours[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    // Only what would have to be decoded again is worth a look.
    const BlockCode& neighbour = code.Blocks[1 << axis];
    if (neighbour.Exists && !neighbour.Uniform && !neighbour.Same)
    {
      neighbours[axis] =
        this->Cache.Find(this->KeyOf(step, plane, BlockDirectory::BlockBehind(block, 1 << axis)));
      code.Neighbours[axis] = neighbours[axis] ? neighbours[axis]->Numbers<Number>() : nullptr;
    }
  }
  QuantizedBlockCache::Box a, b;
  if (refers)
  {
    const StepReferences references = this->ReferencesOf(step);
    a = this->ReferenceBox(references.A, plane, block);
    b = references.B == references.A ? a : this->ReferenceBox(references.B, plane, block);
    code.A = a->Numbers<Number>();
    code.B = b->Numbers<Number>();
  }
  code.Coarse = this->Coarse<Number>(step, plane, block);
  code.Prefetcher = &Ahead();
  const std::size_t n = static_cast<std::size_t>(this->BrickCells) + 1;
  const auto box =
    std::make_shared<QuantizedBlock>(n * n * n, sizeof(Number) == sizeof(std::int16_t));
  DecodeBox(this->BrickCells, shared, code, box->Numbers<Number>());
  return box;
}

QuantizedBlockCache::Key GroupField::KeyOf(int step, int plane, const glm::ivec3& block) const
{
  return { this->Series, this->Directory.IndexOf(plane, block),
    static_cast<std::uint32_t>(this->File.FirstStep() + step),
    static_cast<std::uint16_t>(this->Component), static_cast<std::uint16_t>(plane) };
}

QuantizedBlockCache::Box GroupField::Box(
  int step, int plane, const glm::ivec3& block, bool streaming)
{
  const stages::In stage(stages::Lookup);
  const QuantizedBlockCache::Key key = this->KeyOf(step, plane, block);
  if (QuantizedBlockCache::Box found = this->Cache.Find(key))
  {
    return found;
  }
  const QuantizedBlockCache::Box box = this->Decode(step, plane, block);
  // Half of all steps are no references. Of these, boxes are needed until the blocks around are
  // decoded.
  const bool lowPriority =
    streaming && plane == 0 && ReferenceDistance(step, this->File.Steps()) == 1;
  this->Cache.Add(key, box, lowPriority);
  return box;
}

void GroupField::Verify(int step, int plane, const glm::ivec3& block)
{
  Visited visited;
  this->Verify(step, plane, block, visited);
}

void GroupField::Verify(int step, int plane, const glm::ivec3& block, Visited& visited)
{
  if (!visited
         .insert({ this->File.FirstStep() + step, plane, this->Directory.IndexOf(plane, block) })
         .second)
  {
    return;
  }
  PayloadPages& payloads = this->File.Payloads();
  const PayloadPages::Hold hold = payloads.InMemory();
  for (int bits = 0; bits < 8; ++bits)
  {
    const glm::ivec3 at = BlockDirectory::BlockBehind(block, bits);
    if (!this->Directory.Has(plane, at))
    {
      continue;
    }
    const group::BlockEntry& entry = this->Directory.Entry(step, plane, at);
    for (const group::Place& place : { entry.Payload, entry.Exceptions })
    {
      if (place.Bytes > 0)
      {
        (void)payloads.At(hold, place.Offset, place.Bytes);
      }
    }
  }
  if (plane + 2 < static_cast<int>(this->Planes().size()))
  {
    this->Verify(step, plane + 1, block / 4, visited);
  }
  if (this->Directory.BoxRefers(step, plane, block))
  {
    const StepReferences references = this->ReferencesOf(step);
    this->Verify(references.B, plane, block, visited);
    if (references.A != StepBefore)
    {
      this->Verify(references.A, plane, block, visited);
      return;
    }
    this->InSegmentBefore(
      [&](GroupField& before)
      {
        before.Verify(before.File.Steps() - 1, plane, block, visited);
        return true;
      });
  }
}

} // namespace banyan
