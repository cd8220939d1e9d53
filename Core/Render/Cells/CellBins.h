// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellBins_h
#define banyan_Render_Cells_CellBins_h

#include "Render/Cells/CellTile.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/RayScene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// The cells of a field that can be seen in a picture, and which tiles each lies over.
class CellBins
{
public:
  /// Looks at each cell once: its values, and where its corners are.
  /// @param visible null where all values count
  CellBins(
    const RayScene& scene, const CellField& field, const VisibleValues* visible, ThreadPool& pool);

  /// Pixels inside the viewport that cells may touch.
  const PixelRect& Rect() const { return this->Touched; }

  const PlacedCell* Placed() const { return this->All.data(); }
  /// Cells that cannot be seen, or are off screen.
  std::int64_t Skipped() const { return this->NotSeen; }

  /// Finds what lies over each tile of a grid around Rect().
  void Sort(const TileGrid& grid, ThreadPool& pool);

  /// Numbers of what lies over a tile, rising: in the global order of cells. After Sort.
  struct Span
  {
    const std::uint32_t* Items;
    std::size_t Count;
  };
  Span Over(std::size_t tile) const
  {
    return { this->Items.data() + this->Begins[tile], this->Begins[tile + 1] - this->Begins[tile] };
  }

private:
  std::vector<PlacedCell> All;
  std::vector<std::uint32_t> Items;
  std::vector<std::size_t> Begins; ///< of tiles, in Items
  PixelRect Touched;
  std::int64_t NotSeen = 0;
};

} // namespace banyan

#endif
