// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_CoveredParts_h
#define banyan_Render_Raycast_CoveredParts_h

#include "Render/Scene/FloatImage.h"

#include <vector>

namespace banyan
{

/// Few rectangles that hold all pixels of a part of a picture that are not quite transparent, and
/// little else: whole tiles, side by side ones as one. They do not overlap.
/// @param all inside the picture
std::vector<PixelRect> CoveredParts(const FloatImage& picture, const PixelRect& all);

} // namespace banyan

#endif
