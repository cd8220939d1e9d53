// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_BrickProjector_h
#define banyan_Render_Raycast_BrickProjector_h

#include "Render/Raycast/BrickMarcher.h"
#include "Render/Scene/ProjectionTable.h"

namespace banyan
{

/// Takes the samples that lie in `part` into what the rays of `tile` have met (ProjectionTable says
/// how pixels hold it): one sample after the other, for any type, strides, size and step. Samples
/// are those of MarchBrick; those that are not finite are none.
/// @param pixels those whose rays may meet the part; only these are tried
void ProjectBrick(
  const BrickPart& part, const ProjectionTable& table, const PixelRect& pixels, RayTile& tile);

/// The same for a packed brick; the reference for ProjectPacked.
/// @param cells the part of it to draw: see RayTile::CellShift
void ProjectUnpacked(const PackedBrick& brick, const Box& cells, const ProjectionTable& table,
  const PixelRect& pixels, RayTile& tile);

/// The same picture, bit for bit and on every processor, by packets of rays. Rays that the brick
/// can change in nothing take no samples.
/// @param range of the brick's finite values
/// @param tile PacketsFit
void ProjectPacked(const PackedBrick& brick, const Box& cells, const ValueRange& range,
  const ProjectionTable& table, const PixelRect& pixels, RayTile& tile);

} // namespace banyan

#endif
