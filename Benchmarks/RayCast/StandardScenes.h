// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_StandardScenes_h
#define banyan_Benchmarks_StandardScenes_h

#include "BenchScene.h"

namespace banyan
{
class ThreadPool;
}

namespace banyan::bench
{

/// The field of the standard scenes (Data/StandardField.h), n^3 samples, unit spacing.
/// @param thinner only so many slices are taken, evenly, and lie side by side: a flat volume
std::shared_ptr<const Volume> StandardVolume(int n, ThreadPool& pool, int thinner = 1);

/// The transfer functions of the standard scenes, 256 nodes over [0, 1].
enum class StandardFunction
{
  S1, ///< everything is faintly visible: hardly any ray ends early
  S2  ///< nine voxels in ten are invisible
};

/// The standard scene of a standard volume: named S1-256, S2-256-shaded and so on. Opacities are
/// those of 256^3 samples, corrected for other sizes, so that all sizes give one picture.
BenchScene StandardScene(
  std::shared_ptr<const Volume> volume, StandardFunction function, bool shaded, int picture);

} // namespace banyan::bench

#endif
