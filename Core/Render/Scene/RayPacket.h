// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_RayPacket_h
#define banyan_Render_Scene_RayPacket_h

namespace banyan
{

/// Rays that are drawn together: those of 4 x 4 pixels that are next to each other.
struct RayPacket
{
  static constexpr int Edge = 4; ///< pixels
  static constexpr int Size = Edge * Edge;
};

} // namespace banyan

#endif
