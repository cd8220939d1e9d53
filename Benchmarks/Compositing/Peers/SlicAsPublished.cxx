// SPDX-License-Identifier: BSD-3-Clause
#include "OwnedSpans.h"

#include <algorithm>

namespace banyan::bench
{
namespace
{

/// Cuts one row where the set of ranks that may draw changes, and gives each span to one of them.
void CutRow(const std::vector<Footprint>& footprints, int y, std::vector<int>& cuts,
  std::vector<int>& present, std::vector<OwnedSpan>& spans)
{
  cuts.clear();
  present.clear();
  for (std::size_t rank = 0; rank < footprints.size(); ++rank)
  {
    const Footprint::Interval row = footprints[rank].Row(y);
    if (row.Lo < row.Hi)
    {
      cuts.push_back(row.Lo);
      cuts.push_back(row.Hi);
      present.push_back(static_cast<int>(rank));
    }
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::vector<int> here;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
  {
    here.clear();
    for (const int rank : present)
    {
      const Footprint::Interval row = footprints[rank].Row(y);
      if (row.Lo <= cuts[i] && cuts[i + 1] <= row.Hi)
      {
        here.push_back(rank);
      }
    }
    if (here.empty())
    {
      continue;
    }
    OwnedSpan span{ y, cuts[i], cuts[i + 1], 0 };
    if (here.size() > 1)
    {
      // Multiplicative hashing (Knuth) of where the span begins.
      const std::uint32_t hash =
        (static_cast<std::uint32_t>(y) * 4099u + static_cast<std::uint32_t>(span.Lo)) * 2654435761u;
      span.Owner = here[(hash >> 8) % here.size()];
    }
    spans.push_back(span);
  }
}

} // namespace

FloatImage CompositeSlicAsPublished(
  Communicator& communicator, const PeerFrame& frame, CompositeStatistics& statistics)
{
  std::vector<OwnedSpan> spans;
  std::vector<int> cuts;
  std::vector<int> present;
  for (int y = frame.Viewport.Lo.y; y < frame.Viewport.Hi.y; ++y)
  {
    CutRow(frame.Footprints, y, cuts, present, spans);
  }
  return CompositeOwnedSpans(communicator, frame, spans, true, statistics);
}

} // namespace banyan::bench
