// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_ReusedRays_h
#define banyan_Render_Scene_ReusedRays_h

#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayPacket.h"
#include "Render/Scene/RaySampling.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

/// Rays of an earlier picture that are taken as they are. A tile of TileSamplings consists of 8 x 8
/// blocks of as many pixels as a packet has rays; a bit of its mask says that rays of a block have
/// to be cast. Others are nothing in what a rank casts, and so travel nowhere; PutBackReused gives
/// them to the picture of all ranks.
struct ReusedRays
{
  static constexpr int BlockEdge = RayPacket::Edge;
  static constexpr int BlocksPerRow = TileSamplings::Edge / BlockEdge;
  static constexpr std::uint64_t All = ~std::uint64_t{ 0 };

  /// @param imageSize pixels of the whole picture
  explicit ReusedRays(const glm::ivec2& imageSize)
    : Tiles(TileSamplings::TilesOf(imageSize))
    , Cast(static_cast<std::size_t>(this->Tiles.x) * this->Tiles.y, 0)
  {
  }

  /// The mask of a tile.
  std::uint64_t& At(const glm::ivec2& tile)
  {
    return this->Cast[static_cast<std::size_t>(tile.y) * this->Tiles.x + tile.x];
  }
  std::uint64_t At(const glm::ivec2& tile) const { return const_cast<ReusedRays*>(this)->At(tile); }

  /// The bit of a pixel's block in the mask of its tile.
  static std::uint64_t BitOf(int x, int y)
  {
    const int column = x % TileSamplings::Edge / BlockEdge;
    const int row = y % TileSamplings::Edge / BlockEdge;
    return std::uint64_t{ 1 } << (row * BlocksPerRow + column);
  }

  std::shared_ptr<const FloatImage> Picture; ///< of all ranks; null but on rank 0
  glm::ivec2 Tiles;
  std::vector<std::uint64_t> Cast; ///< masks, row by row
};

} // namespace banyan

#endif
