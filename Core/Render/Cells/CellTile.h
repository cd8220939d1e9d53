// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellTile_h
#define banyan_Render_Cells_CellTile_h

#include "Render/Cells/CellField.h"
#include "Render/Cells/SampleSlab.h"
#include "Render/Cells/TileRows.h"
#include "Render/Scene/ProjectionTable.h"
#include "Render/Scene/ShadingTable.h"

#include <cstdint>

namespace banyan
{

/// Where a cell, or a face of its, lies in a picture.
struct PlacedCell
{
  static constexpr std::uint8_t Whole = 255;

  PixelRect Pixels;
  std::uint32_t Place = 0;   ///< of the cell in the order
  std::uint8_t Face = Whole; ///< of its faces, or Whole: the cell itself
  std::uint8_t Border = 0;   ///< bits of its faces at the border
  float Near = 0.0f;         ///< bounds of t, world lengths along all rays
  float Far = 0.0f;
};
static_assert(sizeof(PlacedCell) == 32, "there is one for each cell that is seen");

/// Draws the cells of one slab of a tile.
struct SlabJob
{
  const CellField& Field;
  const PlacedCell* Placed;   ///< of the picture
  const std::uint32_t* Items; ///< those of this slab, in the global order; faces among them
  std::size_t Count;
  double PerDistance;          ///< samples per world length
  int FirstRow;                ///< of the tile, which is row 0 of the slab
  const ShadingTable* Shading; ///< null for none
  const RayTile& Rays;
  const TileRows& Rows;
  SampleSlab& Slab;
};

/// Puts the values of the slab's samples, and what is covered of intervals at the border, into it.
/// Bit for bit the same on all processors.
void DrawSlab(const SlabJob& job);

/// How the samples of a slab become part of pixels.
struct SlabBlend
{
  const StepTable& Table;
  const ProjectionTable* Projection; ///< null where samples are composited
  const ShadingTable* Shading;       ///< null for none
  bool Relative;                     ///< whether the table's low end is to be subtracted
  float Shift;                       ///< is added to values before they are looked up
};

/// Blends a slab front to back over what the rays have met so far, and leaves it without values.
void BlendSlab(
  SampleSlab& slab, const TileRows& rows, int firstRow, const SlabBlend& blend, RayTile& rays);

} // namespace banyan

#endif
