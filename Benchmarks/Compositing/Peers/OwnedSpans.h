// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_OwnedSpans_h
#define banyan_Benchmarks_OwnedSpans_h

#include "PeerFrame.h"

#include <vector>

namespace banyan::bench
{

/// Pixels of one row that one rank blends: those that may draw there send it theirs.
struct OwnedSpan
{
  int Y = 0;
  int Lo = 0;
  int Hi = 0;
  int Owner = 0;
};

/// Composites by a list of spans that all ranks have alike: every rank sends the owners its pixels
/// there, owners blend them in visibility order, and their spans go to the root. One message per
/// pair of ranks each time.
/// @param spans disjoint; what lies in none is background
/// @param dense whether all pixels of spans travel, not only drawn ones
FloatImage CompositeOwnedSpans(Communicator& communicator, const PeerFrame& frame,
  const std::vector<OwnedSpan>& spans, bool dense, CompositeStatistics& statistics);

} // namespace banyan::bench

#endif
