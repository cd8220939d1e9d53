#ifndef banyan_Render_TileGrid_h
#define banyan_Render_TileGrid_h

#include "Render/RayTile.h"

namespace banyan
{

/// A part of a picture cut into tiles, numbered x fastest. Tiles are cut from the lower left corner of
/// the whole picture on, as those of TileSamplings.
class TileGrid
{
public:
  TileGrid() = default;
  explicit TileGrid(const PixelRect& part)
    : Part(part)
    , First(part.Lo / RayTile::Edge)
    , Counts(part.Empty() ? glm::ivec2(0)
                          : (part.Hi + RayTile::Edge - 1) / RayTile::Edge - this->First)
  {
  }

  std::size_t Count() const { return static_cast<std::size_t>(this->Counts.x) * this->Counts.y; }

  /// Of a tile, among those of the whole picture.
  glm::ivec2 PositionOf(std::size_t tile) const
  {
    const auto width = static_cast<std::size_t>(this->Counts.x);
    return this->First + glm::ivec2(static_cast<int>(tile % width), static_cast<int>(tile / width));
  }

  PixelRect RectOf(std::size_t tile) const
  {
    const glm::ivec2 low = this->PositionOf(tile) * RayTile::Edge;
    return Intersection({ low, low + RayTile::Edge }, this->Part);
  }

  /// Calls function(tile) for the tiles under a rectangle inside the part.
  template <class Function>
  void ForEachUnder(const PixelRect& rect, Function&& function) const
  {
    const glm::ivec2 first = rect.Lo / RayTile::Edge - this->First;
    const glm::ivec2 last = (rect.Hi - 1) / RayTile::Edge - this->First;
    for (int y = first.y; y <= last.y; ++y)
    {
      for (int x = first.x; x <= last.x; ++x)
      {
        function(static_cast<std::size_t>(y) * this->Counts.x + x);
      }
    }
  }

private:
  PixelRect Part;
  glm::ivec2 First{ 0 };
  glm::ivec2 Counts{ 0 };
};

} // namespace banyan

#endif
