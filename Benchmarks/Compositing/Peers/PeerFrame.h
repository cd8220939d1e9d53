// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PeerFrame_h
#define banyan_Benchmarks_PeerFrame_h

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Composite/CompositeStatistics.h"
#include "Parallel/Composite/Footprints.h"
#include "Parallel/Composite/FragmentFormat.h"
#include "Render/Scene/FloatImage.h"

#include <vector>

namespace banyan::bench
{

/// What a rank brings to a peer of the compositor. All but `Mine` are the same on all ranks.
struct PeerFrame
{
  const FloatImage& Mine;       ///< this rank's pixels, anywhere inside the viewport; may be empty
  std::vector<int> FrontToBack; ///< ranks in visibility order
  PixelRect Viewport;
  std::vector<Footprint> Footprints; ///< where each rank may draw
  FragmentFormat Format;             ///< of all pixels that travel: floats, or bytes as of others
};

/// The methods: each makes one picture of those of all ranks, by the over operator. Collective.
/// @param statistics is added to
/// @return on rank 0 the whole viewport (0 where nothing was drawn); elsewhere empty
/// @{

/// Spans of pixels with the same set of ranks go to one of these, dense; the root composites, too.
/// @par Source: "A parallel visualization pipeline for terascale earthquake simulations",
/// section 4.2
FloatImage CompositeSlicAsPublished(
  Communicator& communicator, const PeerFrame& frame, CompositeStatistics& statistics);

/// A strip of rows per rank. Floats are blended as one rank blends them, to the last bit.
FloatImage CompositeDirectSend(
  Communicator& communicator, const PeerFrame& frame, CompositeStatistics& statistics);

/// Pairs exchange halves. For numbers of ranks that are no powers of two, some first give theirs to
/// a neighbour.
/// @par Source: "Dynamic load balancing for parallel volume rendering", section 3 (compositing)
FloatImage CompositeBinarySwap(
  Communicator& communicator, const PeerFrame& frame, CompositeStatistics& statistics);
/// @}

} // namespace banyan::bench

#endif
