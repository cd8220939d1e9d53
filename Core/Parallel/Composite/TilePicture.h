// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_TilePicture_h
#define banyan_Parallel_Composite_TilePicture_h

#include "Base/Bytes.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/FloatImage.h"

#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{

class Communicator;

/// For TilePicture::Gather: all ranks get the picture.
inline constexpr int EveryRank = -1;

/// What messages took on this rank: sent to others.
struct SentBytes
{
  std::uint64_t Bytes = 0;
  std::uint64_t Messages = 0;
};

/// Collective: ExchangeBytes, which counts.
std::vector<Bytes> ExchangeCounted(
  Communicator& communicator, std::vector<Bytes> to, const std::string& failure, SentBytes& sent);

/// A picture whose tiles belong to ranks in turn: those of this rank are in it.
class TilePicture
{
public:
  explicit TilePicture(const Communicator& communicator);

  const TileShare& Share() const { return this->Tiles; }
  FloatImage& Pixels() { return this->Picture; }

  /// Sets all pixels to nothing.
  void Clear(const PixelRect& rect);

  /// The part of a tile that is in the picture.
  PixelRect RectOf(const glm::ivec2& tile) const;

  /// @param pixels of a tile, x fastest; those in the picture are taken
  void Set(const glm::ivec2& tile, const glm::vec4* pixels);

  /// Collective: brings all tiles to the root, or to all ranks.
  /// @return the picture; empty on ranks that do not get it
  /// Throws CollectiveError.
  FloatImage Gather(Communicator& communicator, int root, std::string& failure, SentBytes& sent);

private:
  void PutPixels(Bytes& message, const PixelRect& rect) const;
  void TakePixels(const Bytes& message);
  Bytes PixelsOfMyTiles() const;

  TileShare Tiles;
  FloatImage Picture;
};

} // namespace banyan

#endif
