// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_Footprints_h
#define banyan_Parallel_Composite_Footprints_h

#include "Base/Box.h"
#include "Render/Scene/RayCamera.h"

#include <vector>

namespace banyan
{

/// Where a rank may draw: an interval of pixels per row.
struct Footprint
{
  struct Interval
  {
    int Lo = 0;
    int Hi = 0; ///< half-open; not above Lo if the row is empty

    friend bool operator==(const Interval& a, const Interval& b)
    {
      return a.Lo == b.Lo && a.Hi == b.Hi;
    }
  };
  PixelRect Rect;             ///< around all of it; empty if nothing can be drawn
  std::vector<Interval> Rows; ///< one per row of Rect

  friend bool operator==(const Footprint& a, const Footprint& b)
  {
    return a.Rect == b.Rect && a.Rows == b.Rows;
  }
  bool Empty() const { return this->Rect.Empty(); }
  /// Returns the interval of any row of the picture.
  Interval Row(int y) const
  {
    return y >= this->Rect.Lo.y && y < this->Rect.Hi.y
             ? this->Rows[static_cast<std::size_t>(y - this->Rect.Lo.y)]
             : Interval{};
  }
};

/// The pixels inside `viewport` whose rays may meet a box: the convex hull of its projection (of
/// what lies behind the near clipping plane), with 1/100 of a pixel around it for rounding. The
/// whole viewport when the box cannot be projected because the eye is inside. Depends on its
/// arguments only, so every rank comes to the same for every other one, without a message.
/// @par Source: "A parallel visualization pipeline for terascale earthquake simulations", section
/// 4.2: each processor knows the projection of the blocks of all others.
/// @param low, high corners of the box, in the space of the camera
Footprint FootprintOf(const RayCamera& camera, const glm::dvec3& low, const glm::dvec3& high,
  const PixelRect& viewport);

/// All of a rectangle.
Footprint FootprintOf(const PixelRect& rect, const PixelRect& viewport);

/// One per zone. Cell (i, j, k) spans the samples of index (i, j, k) to (i + 1, j + 1, k + 1).
/// @param camera in world space
std::vector<Footprint> FootprintsOfZones(const RayCamera& camera, const glm::dmat4& indexToWorld,
  const std::vector<Box>& zones, const PixelRect& viewport);

} // namespace banyan

#endif
