// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/SegmentLog.h"

#include <algorithm>

namespace banyan
{

TileSegments SegmentLog::Take(const glm::ivec2& position, const RayTile& tile, double distance)
{
  TileSegments result{ position, {} };
  result.Segments.reserve(this->Entries.size());
  for (const Entry& entry : this->Entries)
  {
    const int slot = entry.Slot;
    const double first = tile.Number[slot];
    RaySegment segment;
    if (entry.Sample == Head)
    {
      // It ends where the first whole interval begins.
      const double length = tile.Head.Fraction[slot] * distance;
      segment.Begin = first * distance - length;
      segment.Length = static_cast<float>(length);
    }
    else if (entry.Sample == Tail)
    {
      segment.Begin = (first + tile.Count[slot]) * distance;
      segment.Length = static_cast<float>(tile.Tail.Fraction[slot] * distance);
    }
    else
    {
      segment.Begin = (first + entry.Sample) * distance;
      segment.Length = static_cast<float>(distance);
    }
    std::copy_n(entry.Color, 3, segment.Color);
    segment.Transmittance = entry.Transmittance;
    const glm::ivec2 pixel = tile.PixelAt(slot);
    segment.Pixel =
      static_cast<std::uint32_t>(pixel.y % RayTile::Edge * RayTile::Edge + pixel.x % RayTile::Edge);
    result.Segments.push_back(segment);
  }
  this->Entries.clear();
  return result;
}

} // namespace banyan
