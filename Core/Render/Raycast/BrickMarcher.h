// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_BrickMarcher_h
#define banyan_Render_Raycast_BrickMarcher_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Bricks/PackedBrick.h"
#include "Render/Raycast/RayTile.h"
#include "Render/Scene/ShadingTable.h"
#include "Render/Scene/TransferFunction.h"

namespace banyan
{

/// A brick, or the part of it that is to be drawn.
struct BrickPart
{
  const BrickView& View;
  glm::ivec3 Corner; ///< the sample (index space) that View.Values points at
  Box Cells;         ///< the cells to draw, inside the brick; see RayTile::CellShift
  const HiddenInBrick* Hidden = nullptr; ///< of all cells from Corner on; null for none
};

/// Blends the samples that lie in `part` behind what the rays of `tile` have met so far: one sample
/// after the other, for any type, strides, size and step.
///
/// A sample is the trilinear interpolant of the eight corners of its cell, in float, from 24-bit
/// fractions; the result does not depend on the brick around the cell. A sample with a corner that
/// is not finite is transparent. With nearest interpolation a sample has the value of the nearest
/// corner, and is transparent when that is not finite. So is a sample in a hidden cell.
/// @param pixels those whose rays may meet the part; only these are tried
void MarchBrick(const BrickPart& part, const StepTable& table, const PixelRect& pixels,
  RayTile& tile, SampleInterpolation interpolation = SampleInterpolation::Linear);

/// The same for a packed brick, all of `seen.Cells` (see RayTile::CellShift); the reference for
/// MarchPacked. Where the brick has colours, those of the table are multiplied by them.
/// @param shading null for none; otherwise the brick HasGradients
void MarchUnpacked(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const ShadingTable* shading, const PixelRect& pixels, RayTile& tile,
  SampleInterpolation interpolation = SampleInterpolation::Linear);

/// The same picture, bit for bit and on every processor, by packets of rays. Space that cannot be
/// seen takes no samples, and is not counted in `tile.SamplesTaken`.
/// @param tile PacketsFit
void MarchPacked(const PackedBrick& brick, const BrickVisibility& seen, const StepTable& table,
  const ShadingTable* shading, const PixelRect& pixels, RayTile& tile,
  SampleInterpolation interpolation = SampleInterpolation::Linear);

/// The same for a brick of which all samples, at most PackedBrick::LargestEdge cells per axis, have
/// one entry of the table: the samples that lie in `cells` are known from where rays enter and
/// leave, and none is taken (equation 4 of "Rendering time-varying data with octrees and difference
/// encoding" sums them up; here they are added one by one, which changes no bit of the picture).
/// Without shading. `tile.SamplesTaken` stays as it is.
/// @param tile PacketsFit
void MarchUniform(
  const Box& cells, const StepTable& table, int entry, const PixelRect& pixels, RayTile& tile);

/// The same, one ray after the other, for any tile and size.
void MarchUniformPlain(
  const Box& cells, const StepTable& table, int entry, const PixelRect& pixels, RayTile& tile);

} // namespace banyan

#endif
