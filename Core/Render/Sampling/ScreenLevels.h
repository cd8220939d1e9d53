// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_ScreenLevels_h
#define banyan_Render_Sampling_ScreenLevels_h

#include "Render/Levels/RayCaster.h"

namespace banyan
{

/// Samplings by what cells measure on the screen, and by nothing else: each tile is drawn from the
/// coarsest level whose cells are at most so many pixels long where the volume is nearest to the
/// eye under that tile, with one sample per edge of such a cell. What the values are has no part in
/// it, so no probes are drawn, and no error is told.
///
/// A cell's length is that of its longest edge, a pixel's that of its shorter side, at the depth
/// that TileDepths has for the tile: an eye inside sees the finest level. All ranks get the same
/// result, since it depends on the camera and on DomainCells only.
///
/// @param scene Samplings have no part in it
/// @param pixels above 0; below what a cell of the finest level measures, that level is taken
/// @param distance world length between samples at the finest level; above 0
/// @param coarsest the coarsest level that may be taken
/// @param distanceGrows whether samples of coarser levels are as much farther apart as their cells
/// are larger
TileSamplings SamplingsByScreen(
  const RayScene& scene, double pixels, double distance, int coarsest, bool distanceGrows);

} // namespace banyan

#endif
