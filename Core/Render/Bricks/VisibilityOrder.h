// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_VisibilityOrder_h
#define banyan_Render_Bricks_VisibilityOrder_h

#include "Base/Box.h"
#include "Render/Scene/Viewpoint.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class BrickSource;

/// A number by which the boxes of one grid (cut by whole planes, as bricks are) sort front to back:
/// when box a can hide box b, a's number is smaller. Exact, for the eye inside a box too.
///
/// Why: on a ray from a to b, each axis either stays in one slab of the grid or moves on to a slab
/// that is farther away on the same side of the eye. The squared distance of a box from the eye
/// (perspective) and the depth of its low corner (parallel; boxes of one slab share it) grow
/// strictly with each such move.
/// @param view in the space of the boxes: index space
double VisibilityKey(const Viewpoint& view, const Box& cells);

/// Bricks of `source` with cells in `cells` in front-to-back order. Exact for bricks that are cut
/// from a grid by whole planes; the eye may be inside.
/// @param view in index space
std::vector<std::int64_t> VisibilityOrder(
  const Viewpoint& view, const BrickSource& source, const Box& cells);

} // namespace banyan

#endif
