// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_DistributedProbe_h
#define banyan_Parallel_Frame_DistributedProbe_h

#include "Parallel/Frame/DistributedFrame.h"

namespace banyan
{

/// Draws a probe of a frame on all ranks, for all ranks. The picture is that of DrawDistributed,
/// but probes are small and many: what compositing costs of a large picture, agreements above all,
/// would be most of their time. So each rank tells all others in one message whether it has failed,
/// what it took, and its pixels, and all of them blend the same picture. The message is as large as
/// the largest footprint of a zone: what ranks receive together grows like the sum of the
/// footprints, with the cube root of the number of ranks.
/// Pieces of a mesh are drawn by DrawPieces, for all ranks.
///
/// Collective; the parameters are those of DrawDistributed.
/// @param scene composited samples only
/// @param share its Failure has been agreed on: it is empty
/// @param statistics SamplesTaken and BytesComposited of all ranks are added; the rest stays
/// @return the scene's viewport, on every rank
/// When a rank fails, all ranks throw the same Error.
FloatImage DrawDistributedProbe(Communicator& communicator, const RayScene& scene,
  const RankShare& share, FrameStatistics& statistics);

} // namespace banyan

#endif
