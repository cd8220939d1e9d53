// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_OctreeComparison_h
#define banyan_Benchmarks_OctreeComparison_h

#include "Papers/PaperOctree.h"
#include "Series/Decode/SeriesFile.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// What the study's own encoding would take for what a component of a series decodes to.
/// @par Source: "A study of time-varying octree and difference encoding", table 2 and figure 9.
struct OctreeComparison
{
  static constexpr int Bits = 8;
  static constexpr int Subdomain = 16; ///< edge, of the adaptive quantizer

  std::int64_t Voxels = 0;        ///< of the steps that were compared
  std::uint64_t UniformBits = 0;  ///< uniform quantizer, everything counted
  std::uint64_t UniformCodes = 0; ///< of these, the codes alone
  std::uint64_t AdaptiveBits = 0; ///< adaptive quantizer, everything counted
  /// Per step, of the uniform quantizer.
  std::vector<PaperOctreeCounts> Steps;
};

/// Decodes the steps [first, end) of a component, and quantizes and encodes them as the study does.
/// The first of them is encoded after the step before, if there is one. The quantizers take the
/// range of the whole series.
OctreeComparison CompareWithOctree(
  const SeriesFile& file, int array, int component, int first, int end);

} // namespace banyan

#endif
