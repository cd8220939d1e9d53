#ifndef banyan_Render_TileGrid_h
#define banyan_Render_TileGrid_h

#include "Render/RayTile.h"

namespace banyan
{

/// A picture cut into tiles, numbered x fastest.
class TileGrid
{
public:
  TileGrid() = default;
  explicit TileGrid(const PixelRect& picture)
    : Picture(picture)
    , Counts((picture.Size() + RayTile::Edge - 1) / RayTile::Edge)
  {
  }

  std::size_t Count() const { return static_cast<std::size_t>(this->Counts.x) * this->Counts.y; }

  PixelRect RectOf(std::int64_t tile) const
  {
    const glm::ivec2 position(
      static_cast<int>(tile % this->Counts.x), static_cast<int>(tile / this->Counts.x));
    const glm::ivec2 low = this->Picture.Lo + position * RayTile::Edge;
    return Intersection({ low, low + RayTile::Edge }, this->Picture);
  }

  /// Calls function(tile) for the tiles under a rectangle inside the picture.
  template <class Function>
  void ForEachUnder(const PixelRect& rect, Function&& function) const
  {
    const glm::ivec2 first = (rect.Lo - this->Picture.Lo) / RayTile::Edge;
    const glm::ivec2 last = (rect.Hi - 1 - this->Picture.Lo) / RayTile::Edge;
    for (int y = first.y; y <= last.y; ++y)
    {
      for (int x = first.x; x <= last.x; ++x)
      {
        function(static_cast<std::size_t>(y) * this->Counts.x + x);
      }
    }
  }

private:
  PixelRect Picture;
  glm::ivec2 Counts{ 0 };
};

} // namespace banyan

#endif
