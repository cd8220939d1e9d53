// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PlaybackScene_h
#define banyan_Benchmarks_PlaybackScene_h

#include "PlaybackOptions.h"

#include "Parallel/Fields/DrawnField.h"
#include "Render/Scene/RayScene.h"

namespace banyan::bench
{

/// The scene of a frame: a series from afar, through one of the transfer functions of the options.
/// @param range of all values
RayScene MakePlaybackScene(
  const PlaybackOptions& options, const FieldPlace& place, const ValueRange& range, int frame);

} // namespace banyan::bench

#endif
