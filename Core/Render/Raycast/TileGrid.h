// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_TileGrid_h
#define banyan_Render_Raycast_TileGrid_h

#include "Render/Raycast/RayTile.h"

namespace banyan
{

/// The tiles of a picture that ranks draw or merge in turn: those of one of them.
struct TileShare
{
  int Rank = 0;
  int Ranks = 1;

  /// @param tile its position
  int OwnerOf(const glm::ivec2& tile) const { return (tile.x + 7 * tile.y) % this->Ranks; }
  bool Has(const glm::ivec2& tile) const { return this->OwnerOf(tile) == this->Rank; }
};

/// A part of a picture cut into tiles, numbered x fastest. Tiles are cut from the lower left corner
/// of the whole picture on, as those of TileSamplings, or are equal parts of those.
class TileGrid
{
public:
  TileGrid() = default;
  /// @param edge pixels: RayTile::Edge, or that divided by a power of 2
  explicit TileGrid(const PixelRect& part, int edge = RayTile::Edge)
    : Part(part)
    , Edge(edge)
    , First(part.Lo / edge)
    , Counts(part.Empty() ? glm::ivec2(0) : (part.Hi + edge - 1) / edge - this->First)
  {
  }

  std::size_t Count() const { return static_cast<std::size_t>(this->Counts.x) * this->Counts.y; }

  /// The tile of TileSamplings that a tile is, or is a part of.
  glm::ivec2 PositionOf(std::size_t tile) const
  {
    return this->At(tile) * this->Edge / RayTile::Edge;
  }

  PixelRect RectOf(std::size_t tile) const
  {
    const glm::ivec2 low = this->At(tile) * this->Edge;
    return Intersection({ low, low + this->Edge }, this->Part);
  }

  /// Calls function(tile) for the tiles under a rectangle inside the part.
  template <class Function>
  void ForEachUnder(const PixelRect& rect, Function&& function) const
  {
    const glm::ivec2 first = rect.Lo / this->Edge - this->First;
    const glm::ivec2 last = (rect.Hi - 1) / this->Edge - this->First;
    for (int y = first.y; y <= last.y; ++y)
    {
      for (int x = first.x; x <= last.x; ++x)
      {
        function(static_cast<std::size_t>(y) * this->Counts.x + x);
      }
    }
  }

private:
  /// Of a tile, among those of the whole picture.
  glm::ivec2 At(std::size_t tile) const
  {
    const auto width = static_cast<std::size_t>(this->Counts.x);
    return this->First + glm::ivec2(static_cast<int>(tile % width), static_cast<int>(tile / width));
  }

  PixelRect Part;
  int Edge = RayTile::Edge;
  glm::ivec2 First{ 0 };
  glm::ivec2 Counts{ 0 };
};

} // namespace banyan

#endif
