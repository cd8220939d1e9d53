// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_CameraPath_h
#define banyan_Benchmarks_CameraPath_h

#include "BenchScene.h"

#include <string>
#include <vector>

namespace banyan::bench
{

/// Names of the paths: `zoom` (the paper's: from afar into a part of the volume), `rest` (the same
/// camera, close by, all the time), `jumps` (another place every tenth frame), `standard` (the
/// scene's own camera all the time).
const std::vector<std::string>& CameraPaths();

/// The scene as frame `frame` of `frames` sees it. Throws Error for paths that do not exist.
RayScene SceneOnPath(const BenchScene& scene, const std::string& path, int frame, int frames);

} // namespace banyan::bench

#endif
