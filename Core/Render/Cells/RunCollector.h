// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_RunCollector_h
#define banyan_Render_Cells_RunCollector_h

#include "Render/Cells/RayRuns.h"
#include "Render/Cells/SampleSlab.h"
#include "Render/Cells/TileRows.h"

#include <cstdint>
#include <vector>

namespace banyan
{

struct DrawnCells;

/// Whose the values of a slab are; set where there are values.
struct SlabOwners
{
  /// Other ranks' cells may hold the sample, too: it is next to a face that no other cell of the
  /// piece has.
  static constexpr std::uint32_t Contested = 1U << 31;

  alignas(64) std::uint32_t Of[RayTile::Slots * SampleSlab::Rows]; ///< places in the order of cells
};

/// Takes the runs of a tile's rays from the kernel that blends slabs.
class RunCollector
{
public:
  static constexpr std::int32_t None = -1;

  /// @param asked null, or what is asked of the tile: other pixels are left out
  /// @param single whether each interval is a run of its own
  void Begin(const TileRows& rows, const AskedTile* asked, bool single = false);

  bool IsSingle() const { return this->Single; }

  bool IsAsked() const { return this->Asked != nullptr; }
  /// Whether an interval is to be given raw.
  /// @param row of the tile
  bool AsksFor(const RayTile& tile, int slot, int row) const;

  /// Ends the runs of some rays; what they have met becomes nothing.
  /// @param lanes bits of slots from the first one on
  void Close(std::uint64_t lanes, int slot, RayTile& tile);

  /// @param row of the slab
  void AddRaw(const SampleSlab& slab, const SlabOwners& owners, const TileRows& rows, int firstRow,
    int slot, int row, bool shaded, const RayTile& tile);

  /// Ends all runs, and adds what the tile has.
  void Finish(RayTile& tile, const DrawnCells& cells, TileRuns& found);

  // By slot. A ray has a run while Last is not None: rows of the tile. Its colours are in the tile.
  alignas(64) std::int32_t First[RayTile::Slots];
  alignas(64) std::int32_t Last[RayTile::Slots];
  /// What runs that have ended let through; 0 when the ray has ended.
  alignas(64) float Through[RayTile::Slots];

private:
  /// @return false when the pixel is not wanted
  bool Wants(std::uint16_t pixel) const;

  std::int64_t FirstNumber = 0;
  const AskedTile* Asked = nullptr;
  bool Single = false;
  std::vector<RayRun> Runs;
  std::vector<RawInterval> Raw; ///< places in the order stand in for keys
};

} // namespace banyan

#endif
