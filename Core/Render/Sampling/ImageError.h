// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_ImageError_h
#define banyan_Render_Sampling_ImageError_h

#include "Render/Levels/RayCaster.h"

namespace banyan
{

/// The largest difference of any channel of any pixel, in units of the channels (1 is full). Pixels
/// that one picture does not have are transparent there. A NaN on either side gives infinity.
double MaxDifference(const FloatImage& a, const FloatImage& b);

/// Peak signal-to-noise ratio in dB over the red, green and blue of all pixels of `area`, with
/// peak 1: 10 log10(1 / mean squared difference). Infinite for equal pictures; minus infinity when
/// either has a NaN; infinite, too, for an empty area.
double Psnr(const FloatImage& a, const FloatImage& b, const PixelRect& area);

} // namespace banyan

#endif
