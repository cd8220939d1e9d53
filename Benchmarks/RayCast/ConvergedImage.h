// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_ConvergedImage_h
#define banyan_Benchmarks_ConvergedImage_h

#include "BenchScene.h"

#include <string>

namespace banyan
{
class ThreadPool;
}

namespace banyan::bench
{

/// What all renderers are measured against: the integral along each pixel's ray, in double, by the
/// midpoint rule. The same as ReferenceImage (a test holds them together), but with shading,
/// without a table (the nodes of the scene are taken as they are) and several times faster. Rays
/// end when less than 1e-7 is left.
/// @param sampleDistance in voxels
FloatImage ConvergedImage(const BenchScene& scene, double sampleDistance, ThreadPool& pool);

/// The same, read from a file in `folder` when an earlier run has left it there. The file's name
/// holds a hash of the scene, values included.
FloatImage CachedConvergedImage(
  const BenchScene& scene, double sampleDistance, const std::string& folder, ThreadPool& pool);

} // namespace banyan::bench

#endif
