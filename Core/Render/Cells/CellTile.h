// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellTile_h
#define banyan_Render_Cells_CellTile_h

#include "Render/Cells/CellField.h"
#include "Render/Cells/SampleSlab.h"
#include "Render/Cells/TileRows.h"
#include "Render/Scene/ProjectionTable.h"
#include "Render/Scene/ShadingTable.h"

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <cstdint>

namespace banyan
{

class MeshLattice;
class RunCollector;
struct SlabOwners;

/// Where a cell, or a face of its, lies in pictures of a camera, whatever their size.
struct PlacedCell
{
  static constexpr std::uint8_t Whole = 255;

  /// The part of the picture, which goes from 0 to 1; infinite where that is not known.
  glm::vec2 Low{ 0.0f };
  glm::vec2 High{ 0.0f };
  std::uint32_t Place = 0;   ///< of the cell in the order
  std::uint8_t Face = Whole; ///< of its faces, or Whole: the cell itself
  std::uint8_t Border = 0;   ///< bits of its faces at the border
  float Near = 0.0f;         ///< bounds of t, world lengths along all rays
  float Far = 0.0f;

  /// Pixels of a picture, inside a part of it, whose centres it may lie over.
  PixelRect PixelsIn(const glm::vec2& size, const PixelRect& part) const
  {
    // Somewhat more, for centres beside the cell that count as its own.
    constexpr float slack = 0.51f;
    const glm::vec2 first = glm::ceil(this->Low * size - slack);
    const glm::vec2 last = glm::floor(this->High * size + (slack - 1.0f));
    return { glm::ivec2(glm::clamp(first, glm::vec2(part.Lo), glm::vec2(part.Hi))),
      glm::ivec2(glm::clamp(last + 1.0f, glm::vec2(part.Lo), glm::vec2(part.Hi))) };
  }

  /// Whether a sample that stands for a whole interval may be in it.
  bool HoldsSamples(double perDistance) const
  {
    return std::floor(this->Far * perDistance - 0.5) >= std::ceil(this->Near * perDistance - 0.5);
  }
};
static_assert(sizeof(PlacedCell) == 32, "there is one for each cell that is seen");

/// Draws the cells of one slab of a tile.
struct SlabJob
{
  const CellField& Field;
  const PlacedCell* Placed;   ///< of the camera
  const std::uint32_t* Items; ///< those of this slab, in the global order; faces among them
  std::size_t Count;
  glm::vec2 PictureSize;       ///< pixels of the whole picture
  double PerDistance;          ///< samples per world length
  int FirstRow;                ///< of the tile, which is row 0 of the slab
  const ShadingTable* Shading; ///< null for none
  const RayTile& Rays;
  const TileRows& Rows;
  SampleSlab& Slab;
  SlabOwners* Owners = nullptr; ///< set too, where ranks draw pieces of a mesh
};

/// Puts the values of the slab's samples, and what is covered of intervals at the border, into it.
/// Bit for bit the same on all processors.
void DrawSlab(const SlabJob& job);

/// What a slab takes from a lattice in place of cells.
struct LatticeJob
{
  const MeshLattice& Lattice;
  /// Per slot: whether the ray is in the mesh where the slab begins, 1 or 0, below 0 where that is
  /// not known. Set to what is so where it ends.
  float* Inside;
  bool EndsNever; ///< whether rays go on whatever they have met
};

/// The same with values of a lattice. Items are faces at the border.
void DrawLatticeSlab(const SlabJob& job, const LatticeJob& lattice);

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

/// The same into runs, which end where other ranks may have a say.
void BlendSlabInRuns(SampleSlab& slab, const TileRows& rows, int firstRow, const SlabBlend& blend,
  RayTile& rays, const SlabOwners& owners, RunCollector& collector);

} // namespace banyan

#endif
