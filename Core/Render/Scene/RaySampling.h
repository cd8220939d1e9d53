// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_RaySampling_h
#define banyan_Render_Scene_RaySampling_h

#include "Base/Error.h"

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace banyan
{

/// How finely a ray is sampled, and how many there are.
struct RaySampling
{
  int Level = 0;         ///< of the bricks: cells are 2^Level fine ones long; 0 is the finest
  double Distance = 1.0; ///< world length between samples; > 0
  /// Only pixels whose coordinates are multiples of it have rays, InterpolateSkippedPixels makes
  /// the others: 1, 2, 4 or 8. They are counted from the lower left corner of the whole picture.
  int PixelStride = 1;

  static constexpr int LargestStride = 8;

  friend bool operator==(const RaySampling& a, const RaySampling& b)
  {
    return a.Level == b.Level && a.Distance == b.Distance && a.PixelStride == b.PixelStride;
  }
};

/// How finely each tile of a picture is sampled. Tiles are those of the whole picture, cut from its
/// lower left corner on: they are the same for all ranks, zones and viewports. All along its ray a
/// pixel has one sampling, so no value jumps where levels meet, and what bricks and zones add up to
/// is what one brick gives, bit for bit.
class TileSamplings
{
public:
  static constexpr int Edge = 32; ///< pixels
  static constexpr std::size_t MostSamplings = 65536;

  TileSamplings() = default;
  /// All tiles have sampling 0 at first.
  /// @param imageSize pixels of the whole picture
  /// @param samplings at least one and at most 65536; throws Error otherwise
  TileSamplings(const glm::ivec2& imageSize, std::vector<RaySampling> samplings)
    : TileCounts(TilesOf(imageSize))
    , List(std::move(samplings))
    , Numbers(static_cast<std::size_t>(this->TileCounts.x) * this->TileCounts.y, 0)
  {
    if (this->List.empty() || this->List.size() > MostSamplings)
    {
      throw Error("The tiles of a picture have 1 to 65536 samplings to choose from");
    }
  }

  /// How many tiles a picture has per axis.
  static glm::ivec2 TilesOf(const glm::ivec2& imageSize) { return (imageSize + Edge - 1) / Edge; }

  glm::ivec2 Tiles() const { return this->TileCounts; }
  const std::vector<RaySampling>& Samplings() const { return this->List; }
  /// Per sampling, whether a tile has it.
  std::vector<bool> Used() const
  {
    std::vector<bool> used(this->List.size(), false);
    for (const std::uint16_t number : this->Numbers)
    {
      used[number] = true;
    }
    return used;
  }
  /// The levels that tiles are sampled at.
  std::set<int> UsedLevels() const
  {
    std::set<int> levels;
    const std::vector<bool> used = this->Used();
    for (std::size_t i = 0; i < used.size(); ++i)
    {
      if (used[i])
      {
        levels.insert(this->List[i].Level);
      }
    }
    return levels;
  }

  /// The same, but all pixels have rays.
  TileSamplings WithAllPixels() const
  {
    TileSamplings all = *this;
    for (RaySampling& sampling : all.List)
    {
      sampling.PixelStride = 1;
    }
    return all;
  }

  /// The largest stride that a tile has.
  int LargestStride() const
  {
    int largest = 1;
    const std::vector<bool> used = this->Used();
    for (std::size_t i = 0; i < used.size(); ++i)
    {
      largest =
        used[i] && this->List[i].PixelStride > largest ? this->List[i].PixelStride : largest;
    }
    return largest;
  }

  /// @param tile inside Tiles()
  int NumberAt(const glm::ivec2& tile) const { return this->Numbers[this->IndexOf(tile)]; }
  const RaySampling& At(const glm::ivec2& tile) const
  {
    return this->List[static_cast<std::size_t>(this->NumberAt(tile))];
  }
  void SetNumber(const glm::ivec2& tile, int number)
  {
    this->Numbers[this->IndexOf(tile)] = static_cast<std::uint16_t>(number);
  }

private:
  std::size_t IndexOf(const glm::ivec2& tile) const
  {
    return static_cast<std::size_t>(tile.y) * this->TileCounts.x + tile.x;
  }

  glm::ivec2 TileCounts{ 0 };
  std::vector<RaySampling> List;
  std::vector<std::uint16_t> Numbers;
};

} // namespace banyan

#endif
