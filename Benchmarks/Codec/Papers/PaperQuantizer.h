// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PaperQuantizer_h
#define banyan_Benchmarks_PaperQuantizer_h

#include "Base/ScalarType.h"
#include "Series/Format/SeriesIndex.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace banyan
{

/// The study's uniform quantizer: 2^Bits equal levels over the range of a series, each of which
/// stands for the value at its middle. Error of a value in the range: at most half a level, that is
/// (High - Low) / 2^(Bits + 1).
/// @par Source: "A study of time-varying octree and difference encoding", section 3.1.
/// @par Limits: the study has no missing values. NaN becomes code 0; whatever lies outside the
/// range, infinities among them, gets the first or last code. An empty range makes all codes 0.
struct PaperQuantizer
{
  ValueRange Range;
  int Bits = 8; ///< 1 to 16

  double LevelWidth() const; ///< in the units of the data; 0 when the range has no width
  std::uint16_t CodeOf(double value) const;
  /// The middle of a level.
  double ValueOf(std::uint16_t code) const;
};

/// Codes of `count` values of one component.
/// @param values the first value of that component
/// @param stride components per tuple, from one value of the component to the next
std::vector<std::uint16_t> QuantizeUniform(const PaperQuantizer& quantizer, ScalarType type,
  const void* values, std::int64_t count, int stride = 1);

/// Codes of one step, and what they are relative to.
struct AdaptiveCodes
{
  std::vector<std::uint16_t> Codes;
  /// Per subdomain, x fastest: where its level 0 begins, in 1/256 of a level above Range.Low. 0
  /// where the subdomain uses the levels of the whole.
  std::vector<std::uint32_t> Origins;
  /// What it takes to tell `Origins`: a bit per subdomain (as at the step before or not), and 8 +
  /// Bits more for a new one.
  std::uint64_t OriginBits = 0;
};

/// The study's adaptive quantizer as one can read it: "decomposes the spatial domain into
/// subdomains and performs local quantization first to encourage voxel fusing based on local data
/// statistics" (section 5) is all that the paper says. Here a subdomain whose values span no more
/// than two levels, but lie in more of the levels of the whole than they would need, gets levels of
/// the same width that begin at its own least value. It keeps them for as long as its values need
/// no more of them than others would, so that subtrees can still be merged over time. The error is
/// that of the uniform quantizer.
/// @param values `[z][y][x]`, x fastest, of one component; see QuantizeUniform
/// @param subdomain edge of a subdomain in voxels, >= 1
/// @param previous of the step before, or nullptr
/// Throws Error when `previous` has another number of subdomains.
AdaptiveCodes QuantizeAdaptive(const PaperQuantizer& quantizer, ScalarType type, const void* values,
  const glm::ivec3& samples, int subdomain, const AdaptiveCodes* previous, int stride = 1);

/// What a code of subdomain `origin` stands for; see AdaptiveCodes.
double ValueOfAdaptive(const PaperQuantizer& quantizer, std::uint32_t origin, std::uint16_t code);

} // namespace banyan

#endif
