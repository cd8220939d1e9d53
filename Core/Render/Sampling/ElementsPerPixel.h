// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_ElementsPerPixel_h
#define banyan_Render_Sampling_ElementsPerPixel_h

#include "Render/Scene/RayScene.h"

#include <vector>

namespace banyan
{

/// The finest level that shows at most so many elements in a pixel: those of one layer, side by
/// side, as small as the level has them, in the place of the scene's DomainCells that is nearest to
/// the eye and so shows fewest. With a as the area that a pixel covers there, and h the shortest
/// edge of a finest cell, it is the smallest level with a / (h 2^level)^2 <= most.
///
/// 0 when the nearest place is behind the eye's plane: the eye may then touch an element.
/// @par Source: section 4.1 of "Visualizing Very Large-Scale Earthquake Simulations" computes the
/// level from the resolutions of image and data and "a user-specified number that limits the number
/// of elements allowed to be projected into a pixel", and leaves open how.
/// @param most above 0; 0 or less for any number, which is level 0
/// @param coarsest the result is at most that
int FinestLevelFor(const RayScene& scene, double most, int coarsest);

/// The same for each tile of the picture, row by row, with what is nearest to the eye under that
/// tile (TileDepths): near parts stay fine, far parts get coarser. None is finer than what
/// FinestLevelFor has for all of the picture. All ranks get the same.
std::vector<int> FinestLevelsOfTiles(const RayScene& scene, double most, int coarsest);

} // namespace banyan

#endif
