// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_DistributedFrame_h
#define banyan_Parallel_Frame_DistributedFrame_h

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Composite/Compositing.h"
#include "Parallel/Composite/PicturePlace.h"
#include "Parallel/Frame/FrameStatistics.h"
#include "Render/Levels/RayCaster.h"

#include <string>
#include <vector>

namespace banyan
{

class CellSource;

/// Holds what a rank brings to a picture of all ranks.
struct RankShare
{
  BrickSource* Source;       ///< this rank's bricks; may be null when its zone is empty
  std::vector<Box> Zones;    ///< cells of each rank, disjoint, the same list on all ranks
  std::uint64_t BudgetBytes; ///< working memory for loaded bricks on this rank
  ThreadPool& Pool;
  /// Where not null, on all ranks: each has a piece of a mesh, and zones do not count.
  CellSource* Piece = nullptr;
  std::string Failure = {}; ///< if not empty, this rank cannot draw: all ranks throw it
  /// Pixels of each rank, disjoint, the same list on all ranks: each draws all cells there, of
  /// which its Source has all bricks. None where each draws the cells of its zone.
  std::vector<PixelRect> Regions = {};
};

/// Draws one picture on all ranks: each casts rays through the cells of its own zone, and the
/// pictures are composited, from the first parts on that are final; with several places, after the
/// last ray. Rays that are reused are neither cast nor sent. Pieces of a mesh are drawn by
/// DrawPieces. Where the scene wants segments, ranks put there what they have, and nothing is
/// composited: no rank has a picture. Collective.
///
/// @param scene the same on all ranks (depths included)
/// @param places where pixels end, disjoint, at most one on a rank; the same on all ranks. None
/// stands for the scene's viewport on rank 0
/// @param compositing how the pictures are put together; the same on all ranks. This function sets
/// the options that follow from the scene, the zones and the places (combination, footprints,
/// brightest colours, root).
/// @return the part of the scene's viewport in this rank's place, premultiplied; empty on ranks
/// without one. The picture does not depend on the number of ranks: within 1e-5 in float when no
/// ray ends early, within 1 - OpacityLimit otherwise; with PixelTransport::WithinOne, 1 of 255
/// more. When a rank fails, all ranks throw the same Error.
FloatImage DrawDistributed(Communicator& communicator, const RayScene& scene,
  const RankShare& share, FrameStatistics& statistics, const CompositeOptions& compositing = {},
  const std::vector<PicturePlace>& places = {});

} // namespace banyan

#endif
