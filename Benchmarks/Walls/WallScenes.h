// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_WallScenes_h
#define banyan_Benchmarks_WallScenes_h

#include "BenchScene.h"
#include "Wall.h"

#include <string>

namespace banyan
{
class ThreadPool;
}

namespace banyan::bench
{

/// A made-up volume of bytes: branches in empty space. Half of its samples are 0.
/// @param name `deep`, 512^2 x 2048 samples; `flat`, 4096 x 2048 x 128
/// @param part of these samples per axis, (0, 1]
/// Throws Error for other names.
BenchScene WallScene(const std::string& name, double part, ThreadPool& pool);

/// The scene from `whole`, where all of it fits the picture; `turned-30` and `turned-80`, about the
/// vertical axis, farther away where need be; `zoomed`, four times as large as `whole`.
/// @param picture pixels
/// @param pan by which part of its width the picture moves
/// Throws Error for other names.
RayScene SeenOnWall(
  const BenchScene& scene, const std::string& view, const glm::ivec2& picture, double pan);

/// The same, sampled as a still picture of an encoded series is.
RayScene PlannedOnWall(const BenchScene& scene, BrickSource& source, const std::string& view,
  const Wall& wall, double pan, ThreadPool& pool);

} // namespace banyan::bench

#endif
