// SPDX-License-Identifier: BSD-3-Clause
#include "OwnedSpans.h"

#include <algorithm>

namespace banyan::bench
{
namespace
{

/// Which rank owns each row: strips of whole rows, balanced by the pixels that may be drawn in
/// them.
std::vector<int> OwnersOfRows(const std::vector<Footprint>& footprints, const PixelRect& viewport)
{
  const std::size_t rows = static_cast<std::size_t>(viewport.Size().y);
  std::vector<long long> until(rows + 1, 0);
  for (std::size_t row = 0; row < rows; ++row)
  {
    until[row + 1] = until[row];
    for (const Footprint& footprint : footprints)
    {
      const Footprint::Interval drawn = footprint.Row(viewport.Lo.y + static_cast<int>(row));
      until[row + 1] += std::max(0, drawn.Hi - drawn.Lo);
    }
  }
  std::vector<int> owners(rows, 0);
  const long long ranks = static_cast<long long>(footprints.size());
  for (std::size_t row = 0; row < rows && until.back() > 0; ++row)
  {
    owners[row] = static_cast<int>(std::min(ranks - 1, until[row] * ranks / until.back()));
  }
  return owners;
}

} // namespace

FloatImage CompositeDirectSend(
  Communicator& communicator, const PeerFrame& frame, CompositeStatistics& statistics)
{
  const std::vector<int> owners = OwnersOfRows(frame.Footprints, frame.Viewport);
  std::vector<OwnedSpan> spans;
  for (std::size_t row = 0; row < owners.size(); ++row)
  {
    const int y = frame.Viewport.Lo.y + static_cast<int>(row);
    OwnedSpan span{ y, frame.Viewport.Hi.x, frame.Viewport.Lo.x, owners[row] };
    for (const Footprint& footprint : frame.Footprints)
    {
      const Footprint::Interval drawn = footprint.Row(y);
      span.Lo = drawn.Lo < drawn.Hi ? std::min(span.Lo, drawn.Lo) : span.Lo;
      span.Hi = drawn.Lo < drawn.Hi ? std::max(span.Hi, drawn.Hi) : span.Hi;
    }
    if (span.Lo < span.Hi)
    {
      spans.push_back(span);
    }
  }
  return CompositeOwnedSpans(communicator, frame, spans, false, statistics);
}

} // namespace banyan::bench
