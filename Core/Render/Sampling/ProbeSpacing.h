// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_ProbeSpacing_h
#define banyan_Render_Sampling_ProbeSpacing_h

#include "Render/Scene/RayCamera.h"

namespace banyan
{

struct RayScene;

/// The part of a scene's viewport where its volume may be seen, with a pixel around it; the whole
/// viewport when there is none.
PixelRect VolumeOnScreen(const RayScene& scene);

/// So many probes say enough of how a picture errs.
constexpr int EnoughProbes = 512;

/// How many pixels of a scene's picture are apart of which probes are drawn: 1 to 16. As many as
/// leave about 4096 probes in the picture, unless the volume takes up little of it or is narrow:
/// then fewer, so that EnoughProbes meet the volume and several of them lie side by side across it.
/// All of this goes by where the volume's box is on the screen; how much of it can be seen is not
/// known yet.
int ProbeSpacing(const RayScene& scene);

/// The same once a probe has shown how many of them see something.
/// @param spacing at which it was drawn
/// @param seen how many of its pixels are not empty
/// @return `spacing` when they are enough or cannot be closer, otherwise less
int ProbeSpacingAfter(int spacing, int seen);

} // namespace banyan

#endif
