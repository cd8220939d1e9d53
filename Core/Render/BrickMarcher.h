#ifndef banyan_Render_BrickMarcher_h
#define banyan_Render_BrickMarcher_h

#include "Render/BrickSource.h"
#include "Render/RayLattice.h"
#include "Render/TransferFunction.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace banyan
{

/// The rays of a rectangle of pixels while bricks are drawn front to back.
struct RayTile
{
  PixelRect Rect;
  std::vector<RaySamples> Rays; ///< `[y][x]` of Rect
  /// Premultiplied colour so far, and in the fourth component the *transmittance* (1 - opacity), so
  /// that stopping and going on with the next batch changes no bit.
  FloatImage* Picture = nullptr;
  float TransmittanceLimit = 0; ///< a ray ends when its transmittance is not above this
  std::int64_t ActiveRays = 0;  ///< rays with samples that have not ended
  std::int64_t SamplesTaken = 0;
};

/// A brick, or the part of it that is to be drawn.
struct BrickPart
{
  const BrickView& View;
  glm::ivec3 Corner; ///< the sample (index space) that View.Values points at
  Box Cells;         ///< the cells to draw, inside the brick
};

/// Blends the samples that lie in `part` behind what the rays of `tile` have met so far.
///
/// A sample is the trilinear interpolant of the eight corners of its cell, in float, from 24-bit
/// fractions; the result does not depend on the brick around the cell. A sample with a corner that
/// is not finite is transparent.
/// @param pixels those whose rays may meet the part; only these are tried
void MarchBrick(
  const BrickPart& part, const StepTable& table, const PixelRect& pixels, RayTile& tile);

} // namespace banyan

#endif
