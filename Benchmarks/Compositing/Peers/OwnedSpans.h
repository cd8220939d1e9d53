// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_OwnedSpans_h
#define banyan_Parallel_OwnedSpans_h

#include "Parallel/Compositing.h"

#include <vector>

namespace banyan
{

/// Pixels of one row that one rank blends: those that may draw there send it theirs.
struct OwnedSpan
{
  int Y = 0;
  int Lo = 0;
  int Hi = 0;
  int Owner = 0;
  /// Whether only one rank may draw there: then its pixels are not blended any more.
  bool Sole = false;
};

/// Composites by a list of spans that all ranks have alike: every rank sends the owners its pixels
/// there, owners blend them in visibility order, and their spans go to the root. One message per
/// pair of ranks each time.
/// @param spans disjoint; what lies in none is background
/// @param meeting most fragments that travel for one pixel
/// @param dense whether all pixels of spans travel, not only drawn ones
FloatImage CompositeOwnedSpans(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics, const std::vector<OwnedSpan>& spans, int meeting, bool dense);

} // namespace banyan

#endif
