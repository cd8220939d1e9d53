// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_WallRanks_h
#define banyan_Benchmarks_WallRanks_h

#include "Wall.h"

#include "Base/ThreadPool.h"
#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Balance/PictureRegions.h"

#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace banyan::bench
{

/// A brick of the encoded series that a volume would be: level and place.
using BrickName = std::array<int, 4>;

/// What one frame took.
struct WallFrame
{
  std::vector<double> RankSeconds; ///< processor time of casting
  /// The same until the last tile, if ranks waited for nothing but this: who shows a tile goes on
  /// to the next one when all that draw there have cast it.
  double Seconds = 0.0;
  std::vector<std::set<BrickName>> Bricks; ///< of each rank, that it drew
};

/// Ranks that draw a wall, balanced as the plugin balances them; each one's part is cast after the
/// other's, on this thread.
class WallRanks
{
public:
  /// @param source of the whole volume, for all ranks; must stay
  /// @param byPicture what ranks divide
  WallRanks(BrickSource& source, int ranks, bool byPicture);

  /// Moves zones or regions, and casts.
  /// @param scene of the whole wall
  /// @param folder for what was drawn, a file for each tile (WriteFrame), and a file of zones and
  /// regions; none where it is empty
  /// @param every only a part of each tile of samplings is cast, one row in so many: 1, 2 or 4
  /// (pictures with rays missing, which are not for a folder)
  WallFrame Draw(const RayScene& scene, const Wall& wall, const std::string& folder, int every = 1);

private:
  struct Part
  {
    BrickWork* Work = nullptr; ///< the balancer's, or Own
    BrickWork Own;
    double Seconds = 0.0;
  };
  FloatImage CastTile(int rank, const RayScene& ofTile, int every);
  void DrawTile(
    const RayScene& scene, const PicturePlace& tile, const std::string& folder, int every);
  void BeginFrame(const RayScene& scene, const Wall& wall);
  void WriteShares(const std::string& path) const;

  BrickSource& Source;
  const bool ByPicture;
  ThreadPool Pool{ 1 };
  std::vector<std::unique_ptr<PictureRegions>> OfPicture; ///< of each rank
  std::vector<std::unique_ptr<FrameBalancer>> OfData;     ///< of each rank
  std::vector<Part> Parts;                                ///< of the frame
  std::vector<Box> Zones;
  std::vector<PixelRect> Regions;
};

} // namespace banyan::bench

#endif
