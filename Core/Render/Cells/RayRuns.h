// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_RayRuns_h
#define banyan_Render_Cells_RayRuns_h

#include "Cells/CellOrder.h"
#include "Render/Raycast/RayTile.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace banyan
{

/// Intervals of a ray that follow each other, drawn as if no other rank had anything in them:
/// blended front to back, or projected.
struct RayRun
{
  std::int64_t First = 0; ///< intervals of the ray, counted from t = 0
  std::int64_t Last = 0;
  std::uint16_t Pixel = 0; ///< see TileRuns
  float Color[3] = {};     ///< as RayTile has it
  float Transmittance = 1.0f;

  bool IsEmpty() const
  {
    return this->Color[0] == 0.0f && this->Color[1] == 0.0f && this->Color[2] == 0.0f &&
           this->Transmittance == 1.0f;
  }
};

/// What a ray has crossed of the mesh's border in one interval: the sums of SampleSlab::Cross.
struct CrossingSums
{
  float Change = 0.0f;
  float AtBorder = 0.0f;
  float CosineAtBorder = 0.0f;
  float Count = 0.0f;
  float Before = 0.0f;
  float Behind = 0.0f;
  float Nearest = 1.0f;
  float NearestEnters = 0.0f; ///< 1 or -1; 0 where nothing was crossed

  void Add(const CrossingSums& other)
  {
    this->Change += other.Change;
    this->AtBorder += other.AtBorder;
    this->CosineAtBorder += other.CosineAtBorder;
    this->Count += other.Count;
    this->Before += other.Before;
    this->Behind += other.Behind;
    if (other.Count > 0.0f && std::abs(other.Nearest) < std::abs(this->Nearest))
    {
      this->Nearest = other.Nearest;
      this->NearestEnters = other.NearestEnters;
    }
  }
};

/// What a rank has of an interval in which others may have a say.
struct RawInterval
{
  std::int64_t Number = 0; ///< of the interval along its ray, counted from t = 0
  std::uint16_t Pixel = 0; ///< see TileRuns
  bool Claimed = false;    ///< whether a cell of the rank holds the sample
  float Length = 1.0f;     ///< of the interval: 1, or less at the ends of the ray
  float Value = 0.0f;      ///< set if claimed, as are those that follow
  float Cosine = 0.0f;     ///< set if shaded
  CellKey Key;             ///< of the cell: of several ranks' cells the last one owns the sample
  CrossingSums Crossed;
};

/// What a rank has of a tile of the picture. Each list is sorted by pixel, then along the ray; no
/// interval of a pixel is in it twice.
///
/// Tiles are those of TileSamplings, and pixels are numbered in them, x fastest.
struct TileRuns
{
  glm::ivec2 Position{ 0 };
  std::vector<RayRun> Runs;
  std::vector<RawInterval> Raw;

  static std::uint16_t PixelAt(const glm::ivec2& at)
  {
    return static_cast<std::uint16_t>(at.y % RayTile::Edge * RayTile::Edge + at.x % RayTile::Edge);
  }
};

/// Intervals of a pixel that a rank is asked to give raw.
struct AskedIntervals
{
  std::int64_t First = 0;
  std::int64_t Last = 0;
  std::uint16_t Pixel = 0;
};

/// Of a tile, sorted by pixel, then along the ray. The rank gives all it has of these pixels anew.
struct AskedTile
{
  glm::ivec2 Position{ 0 };
  std::vector<AskedIntervals> Intervals;

  glm::ivec2 PixelOf(std::uint16_t pixel) const
  {
    return this->Position * RayTile::Edge +
           glm::ivec2(pixel % RayTile::Edge, pixel / RayTile::Edge);
  }
};

/// Pixels of a tile that something is asked of.
class AskedPixels
{
public:
  explicit AskedPixels(const AskedTile& asked)
    : Low(asked.Position * RayTile::Edge)
  {
    for (const AskedIntervals& intervals : asked.Intervals)
    {
      const glm::ivec2 at = asked.PixelOf(intervals.Pixel);
      this->Rows[static_cast<std::size_t>(at.y - this->Low.y)] |= 1U << (at.x - this->Low.x);
      this->All = Union(this->All, { at, at + 1 });
    }
  }

  /// The rectangle around all.
  const PixelRect& Rect() const { return this->All; }

  bool AnyIn(const PixelRect& rect) const
  {
    const PixelRect here = Intersection(rect, this->All);
    const int width = here.Size().x;
    std::uint32_t any = 0;
    for (int y = here.Lo.y; y < here.Hi.y && width > 0; ++y)
    {
      any |= this->Rows[static_cast<std::size_t>(y - this->Low.y)];
    }
    return width > 0 &&
           (any >> (here.Lo.x - this->Low.x) & ~std::uint32_t{ 0 } >> (32 - width)) != 0;
  }

private:
  static_assert(RayTile::Edge == 32, "a row has a bit per pixel");
  glm::ivec2 Low;
  PixelRect All;
  std::array<std::uint32_t, RayTile::Edge> Rows{};
};

/// Brings what is asked for into the order of AskedTile.
inline void SortAsked(std::vector<AskedIntervals>& intervals)
{
  std::sort(intervals.begin(), intervals.end(),
    [](const AskedIntervals& a, const AskedIntervals& b)
    { return a.Pixel != b.Pixel ? a.Pixel < b.Pixel : a.First < b.First; });
}

/// Takes out the pixels that a rank is asked to give anew.
inline void RemoveAsked(const AskedTile& asked, TileRuns& runs)
{
  std::vector<bool> gone(RayTile::Slots, false);
  for (const AskedIntervals& intervals : asked.Intervals)
  {
    gone[intervals.Pixel] = true;
  }
  const auto isGone = [&](const auto& element) { return gone[element.Pixel]; };
  runs.Runs.erase(std::remove_if(runs.Runs.begin(), runs.Runs.end(), isGone), runs.Runs.end());
  runs.Raw.erase(std::remove_if(runs.Raw.begin(), runs.Raw.end(), isGone), runs.Raw.end());
}

} // namespace banyan

#endif
