// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_SegmentLog_h
#define banyan_Render_Raycast_SegmentLog_h

#include "Render/Raycast/RaySegments.h"
#include "Render/Raycast/RayTile.h"

namespace banyan
{

/// Notes what kernels blend into the rays of a tile, sample by sample.
class SegmentLog
{
public:
  /// In place of the number of a whole sample.
  static constexpr std::int32_t Head = -1;
  static constexpr std::int32_t Tail = -2;

  /// @param sample of the ray: whole ones from 0 on, or Head or Tail
  /// @param r premultiplied, as g and b
  void Add(int slot, std::int32_t sample, float r, float g, float b, float transmittance)
  {
    if (transmittance < 1.0f || r > 0.0f || g > 0.0f || b > 0.0f)
    {
      this->Entries.push_back({ slot, sample, { r, g, b }, transmittance });
    }
  }

  /// What has been noted; nothing is left.
  /// @param position of the tile
  /// @param distance world length between samples
  TileSegments Take(const glm::ivec2& position, const RayTile& tile, double distance);

private:
  struct Entry
  {
    std::int32_t Slot;
    std::int32_t Sample;
    float Color[3];
    float Transmittance;
  };
  std::vector<Entry> Entries; ///< along each ray from the eye on
};

} // namespace banyan

#endif
