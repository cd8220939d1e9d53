// SPDX-License-Identifier: BSD-3-Clause
// Collects what all ranks know of each other's bricks.
#include "Base/Digest.h"
#include "Base/ThreadPool.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/PieceExchange.h"

#include <algorithm>
#include <cstring>
#include <functional>

namespace banyan
{
namespace
{

/// A brick in a message. Plain memory: it is sent as it is.
struct Entry
{
  double Low;
  double High;
  std::uint64_t Mask;
  std::uint64_t Uniform;
  Hash128 Content;
};

/// Holds what a rank says of its array.
struct ArrayFacts
{
  double Low;
  double High;
  std::int32_t Type;
  std::int32_t ViewType;
  std::int64_t Colours;
};

/// Hashes of samples and places of boxes of an array; as many zeros if nobody wants to know.
std::vector<Hash128> ContentsOf(
  const ArraySamples& array, const std::vector<Box>& boxes, ThreadPool& pool, bool looks)
{
  std::vector<Hash128> contents(boxes.size());
  const auto look = [&](std::int64_t i)
  {
    const Box& box = boxes[static_cast<std::size_t>(i)];
    const glm::ivec3& first = array.Array().Samples.Lo;
    Digest digest;
    digest.Add(HashOfSamples(array.View(box), box.Size()));
    digest.Add(Box{ box.Lo + first, box.Hi + first });
    contents[static_cast<std::size_t>(i)] = digest.Get();
  };
  pool.ParallelFor(
    looks ? static_cast<std::int64_t>(boxes.size()) : 0, std::function<void(std::int64_t)>(look));
  return contents;
}

/// The bricks of a rank, ascending.
std::vector<std::int64_t> BricksOf(const PieceGrid& grid, int rank)
{
  std::vector<std::int64_t> bricks;
  for (std::int64_t brick = 0; brick < grid.Count(); ++brick)
  {
    if (grid.HolderOf(brick) == rank)
    {
      bricks.push_back(brick);
    }
  }
  return bricks;
}

std::string SummarizeOwn(const PieceGrid& grid, int rank, const PieceSamples& mine,
  const MaskRange& masks, ThreadPool& pool, bool looks)
{
  if (!mine.HasData())
  {
    return {};
  }
  const SampleArray& array = mine.Array().Array();
  std::vector<Box> boxes;
  for (const std::int64_t brick : BricksOf(grid, rank))
  {
    const Box samples = grid.BrickSamples(brick, false);
    boxes.push_back({ samples.Lo - array.Samples.Lo, samples.Hi - array.Samples.Lo });
  }
  // The rounding of magnitudes is not known, and colours differ where opacities are equal.
  const bool exact = array.Component >= 0;
  std::string bytes(boxes.size() * sizeof(Entry), '\0');
  char* out = bytes.data();
  const std::vector<Hash128> contents = ContentsOf(mine.Array(), boxes, pool, looks);
  auto content = contents.begin();
  for (const BoxSummary& summary : mine.Array().Summarize(boxes, masks, pool))
  {
    const Entry entry{ summary.Range.Low, summary.Range.High, summary.Mask,
      summary.Uniform && exact ? std::uint64_t{ 1 } : 0, *content++ };
    std::memcpy(out, &entry, sizeof(entry));
    out += sizeof(entry);
  }
  return bytes;
}

/// @param messages from SummarizeOwn of each rank
void ReadAll(const PieceGrid& grid, const std::vector<std::string>& messages, PieceSummaries& known)
{
  std::vector<const char*> next;
  for (const std::string& message : messages)
  {
    next.push_back(message.data());
  }
  known.Bricks.resize(static_cast<std::size_t>(grid.Count()));
  known.Contents.resize(static_cast<std::size_t>(grid.Count()));
  for (std::int64_t brick = 0; brick < grid.Count(); ++brick)
  {
    const int holder = grid.HolderOf(brick);
    if (holder >= 0)
    {
      Entry entry;
      std::memcpy(&entry, next[static_cast<std::size_t>(holder)], sizeof(entry));
      next[static_cast<std::size_t>(holder)] += sizeof(entry);
      known.Bricks[static_cast<std::size_t>(brick)] = { { entry.Low, entry.High }, entry.Mask,
        entry.Uniform != 0 };
      known.Contents[static_cast<std::size_t>(brick)] = entry.Content;
    }
  }
}

} // namespace

PieceSummaries GatherSummaries(Communicator& communicator, const PieceGrid& grid,
  const PieceSamples& mine, ThreadPool& pool, bool looks)
{
  const int self = communicator.Rank();
  std::string failure;
  ValueRange range;
  Attempt(failure,
    [&] { range = mine.HasData() ? FiniteRange(mine.Array().Array(), pool) : ValueRange{}; });
  const ScalarType type = mine.HasData() ? mine.Array().Array().Type : ScalarType::Float32;
  const ArrayFacts facts{ range.Low, range.High, static_cast<std::int32_t>(type),
    static_cast<std::int32_t>(mine.Type()), mine.HasColours() ? 1 : 0 };
  std::vector<ArrayFacts> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&facts, sizeof(facts), all.data());
  PieceSummaries known;
  ValueRange whole;
  for (const ArrayFacts& of : all)
  {
    whole.Include(ValueRange{ of.Low, of.High });
    known.Types.push_back(static_cast<ScalarType>(of.Type));
    known.ViewTypes.push_back(static_cast<ScalarType>(of.ViewType));
    known.Colours = known.Colours || of.Colours != 0;
  }
  known.Masks = whole.Empty() ? MaskRange{} : MaskRange{ whole.Low, whole.High };

  std::string own;
  Attempt(failure, [&] { own = SummarizeOwn(grid, self, mine, known.Masks, pool, looks); });
  ThrowTogether(communicator, failure);
  ReadAll(grid, AllGatherStrings(communicator, own), known);
  if (!looks)
  {
    known.Contents.clear();
  }
  return known;
}

} // namespace banyan
