// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_DrawPieces_h
#define banyan_Parallel_Cells_DrawPieces_h

#include "Parallel/Composite/TilePicture.h"
#include "Render/Cells/CellSource.h"
#include "Render/Levels/RayCaster.h"
#include "Render/Scene/FloatImage.h"

#include <cstdint>

namespace banyan
{

class Communicator;
class ThreadPool;

/// What a picture of pieces took on this rank.
struct PieceStatistics
{
  RayStatistics Rays;
  std::int64_t Runs = 0; ///< drawn here, in the first round
  std::int64_t Raw = 0;
  std::int64_t Asked = 0; ///< intervals that this rank had to give raw in the second round
  SentBytes Sent;
  double DrawSeconds = 0.0;
  double MergeSeconds = 0.0; ///< without waiting for messages
};

/// Collective: draws a mesh whose cells lie on all ranks, dealt in any way. The picture is the one
/// that a rank with all cells draws, but for rounding.
///
/// Tiles of the picture belong to ranks in turn. Where cells are drawn, all ranks draw their own
/// and send, per tile, what they have along its rays: RayRun, RawInterval. The tile's rank merges
/// them, and asks for intervals raw where one rank's run meets what another one has; then the tile
/// is merged anew. Coarser levels are lattices of the whole mesh: a tile's rank draws it alone.
/// @param scene the same on all ranks
/// @param source of a piece that DrawnPiece has made; the values have the same base on all ranks
/// @param root has the picture, or EveryRank: its pixels are those of the viewport, not finished;
/// others have none. Where the scene wants segments, those of tiles are on the tiles' ranks, and
/// nobody has a picture
///
/// Throws CollectiveError.
FloatImage DrawPieces(Communicator& communicator, const RayScene& scene, CellSource& source,
  ThreadPool& pool, int root, PieceStatistics& statistics);

} // namespace banyan

#endif
