// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellBins_h
#define banyan_Render_Cells_CellBins_h

#include "Base/RecycledMemory.h"
#include "Render/Cells/CellTile.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/RayScene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// One for each cell that is seen: as much memory again for the next camera.
using PlacedCells = std::vector<PlacedCell, RecycledMemory<PlacedCell, LargeMemory::Smallest>>;

/// The cells of a field that can be seen by a camera, with their places in its pictures: the same
/// for pictures of any size and viewport, and for any distance between samples.
class SeenCells
{
public:
  /// What is looked for.
  enum class Kind
  {
    All,    ///< cells, and their faces at the border
    Borders ///< only these faces, of all cells that are drawn
  };

  /// Looks at each cell once: its values, and where its corners are.
  /// @param visible null where all values count
  SeenCells(const RayScene& scene, const CellField& field, Kind kind,
    std::shared_ptr<const VisibleValues> visible, ThreadPool& pool);

  /// Whether they are those of another scene, too.
  bool AreOf(const RayScene& scene, const VisibleValues* visible) const;

  /// In the global order of cells: each before its faces at the border.
  const PlacedCells& Placed() const { return this->All; }
  /// All of them together.
  const PlacedCell& Around() const { return this->Bounds; }
  /// Cells that cannot be seen, or are off screen.
  std::int64_t Skipped() const { return this->NotSeen; }
  std::size_t Bytes() const { return this->All.capacity() * sizeof(PlacedCell); }

private:
  // What they follow from.
  glm::dmat4 WorldToClip;
  glm::dvec3 Anchor;
  glm::dmat4 IndexToWorld;
  std::shared_ptr<const VisibleValues> Visible;

  PlacedCells All;
  PlacedCell Bounds;
  std::int64_t NotSeen = 0;
};

/// Which of the cells lie over each tile of a picture.
class CellBins
{
public:
  CellBins(const RayScene& scene, std::shared_ptr<const SeenCells> cells);

  /// Pixels inside the viewport that cells may touch.
  const PixelRect& Rect() const { return this->Touched; }

  const PlacedCell* Placed() const { return this->Cells->Placed().data(); }
  /// Cells that cannot be seen, are off screen, or lie over no pixel's centre. After Sort.
  std::int64_t Skipped() const { return this->NotDrawn; }
  /// Pixels of the whole picture.
  const glm::vec2& PictureSize() const { return this->Size; }

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
  std::shared_ptr<const SeenCells> Cells;
  glm::vec2 Size;
  std::vector<std::uint32_t, RecycledMemory<std::uint32_t, LargeMemory::Smallest>> Items;
  std::vector<std::size_t> Begins; ///< of tiles, in Items
  PixelRect Touched;
  std::int64_t NotDrawn = 0;
};

} // namespace banyan

#endif
