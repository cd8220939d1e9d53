// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_TileOwnerMessages_h
#define banyan_Parallel_Composite_TileOwnerMessages_h

#include "Parallel/Composite/CompositePlan.h"

#include <vector>

namespace banyan
{

/// Which message it is; README.md draws them.
enum class TileMessage
{
  Direct, ///< pixels that nobody else but the root draws, to the root
  Shared, ///< to the owner of a tile
  Result  ///< from the owner of a tile to the root
};

/// One per sort of message and chunk.
inline int TagOf(TileMessage sort, int chunk)
{
  constexpr int first = 64; // others use lower ones
  return first + 3 * chunk + static_cast<int>(sort);
}

/// Calls `action(tile, kind, region)` for all parts of a message, in the order in which they are in
/// it, and leaves out the empty ones. Sender and receiver alike.
/// @param region memory to use
template <typename Action>
void ForEachRegion(const CompositePlan& plan, int from, int to, TileMessage sort, int chunk,
  CompositePlan::Region& region, const Action& action)
{
  const bool result = sort == TileMessage::Result;
  for (const int index : result ? plan.TilesOfChunk[chunk] : plan.TilesOfRank[from])
  {
    const CompositePlan::Tile& tile = plan.Tiles[index];
    if (tile.Chunk != chunk || (sort == TileMessage::Shared && tile.Owner != to) ||
        (result && tile.Owner != from))
    {
      continue;
    }
    for (int number = 0; number < CompositePlan::Kinds; ++number)
    {
      const auto kind = static_cast<CompositePlan::Kind>(number);
      if ((tile.Kinds & (1u << static_cast<unsigned>(number))) == 0)
      {
        continue;
      }
      if (result)
      {
        plan.ResultRegion(index, kind, region);
      }
      else if (sort == TileMessage::Direct)
      {
        plan.DirectRegion(from, index, kind, region);
      }
      else
      {
        plan.SharedRegion(from, index, kind, region);
      }
      if (!region.empty())
      {
        action(index, kind, region);
      }
    }
  }
}

} // namespace banyan

#endif
