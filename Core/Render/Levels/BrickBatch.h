// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_BrickBatch_h
#define banyan_Render_Levels_BrickBatch_h

#include "Render/Bricks/PackedBrickCache.h"
#include "Render/Levels/LevelTiles.h"
#include "Render/Levels/PlannedBrick.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A brick of a batch: packed for drawing, or as the source gives it where it cannot be packed, or
/// without values where all samples are known to be equal.
struct LoadedBrick
{
  const PlannedBrick* Planned = nullptr;
  PackedBrickCache::Pointer Packed;     ///< null unless packed
  std::optional<BrickVisibility> Known; ///< Seen, if it was kept with the brick
  BrickVisibility Seen;                 ///< what can be seen of Packed; unset for projections
  PixelRect Footprint;                  ///< of Seen; unset unless packed
  BrickView View;                       ///< of a brick that cannot be packed
  HiddenInBrick Hidden;                 ///< of View

  /// The pixels that it is drawn to.
  const PixelRect& Pixels() const
  {
    return this->Packed ? this->Footprint : this->Planned->Footprint;
  }
};

/// Bricks that are loaded, and then drawn, together.
struct BrickBatch
{
  /// Positions of bricks in the batch.
  struct Positions
  {
    const int* First;
    const int* Last;

    bool Empty() const { return this->First == this->Last; }
    std::size_t Count() const { return static_cast<std::size_t>(this->Last - this->First); }
    int operator[](std::size_t i) const { return this->First[i]; }
    const int* begin() const { return this->First; }
    const int* end() const { return this->Last; }
  };

  /// The bricks over a tile, in the order of the plan.
  Positions Over(std::size_t tile) const
  {
    const int* const all = this->OverTiles.data();
    return { all + this->FirstOver[tile], all + this->FirstOver[tile + 1] };
  }

  std::vector<LoadedBrick> Bricks;    ///< in the order of the plan
  std::size_t End = 0;                ///< bricks of the plan before this one are in no later batch
  std::vector<int> OverTiles;         ///< positions in Bricks, tile by tile
  std::vector<std::size_t> FirstOver; ///< in OverTiles, per tile; and the end
};

/// Deals the bricks of a plan out into batches, in order. It leaves out bricks that no open ray can
/// meet, and that is known best when all batches before have been drawn.
class BatchQueue
{
public:
  /// Looks which bricks are kept from earlier pictures. Everything referred to must stay.
  BatchQueue(const LevelScene& level, const std::vector<PlannedBrick>& bricks,
    std::uint64_t budgetBytes, ThreadPool& pool);

  bool Empty() const { return this->Taken == this->Bricks.size(); }

  /// Takes the next batch: as many bricks as the budget allows, at least one. A batch is empty only
  /// when all bricks that are left were left out.
  /// @param tiles as all batches before have left them
  /// @param batch is overwritten; its bricks are not loaded, but have what is kept of them
  /// @return bricks of the source that were left out
  std::int64_t Take(const LevelTiles& tiles, BrickBatch& batch);

private:
  void FindKept(ThreadPool& pool);
  std::uint64_t BytesLeft() const;

  const LevelScene& Level;
  const std::vector<PlannedBrick>& Bricks;
  std::uint64_t BudgetBytes;
  std::vector<PackedBrickCache::Found> Kept; ///< of Bricks
  std::size_t Taken = 0;                     ///< bricks that were in a batch or were left out
};

} // namespace banyan

#endif
