#ifndef banyan_Series_BrickStatistics_h
#define banyan_Series_BrickStatistics_h

#include "Series/SeriesIndex.h"
#include "Series/ValueMask.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace banyan
{

/// What the tree keeps of a brick's decoded samples.
struct BrickSummary
{
  ValueRange Range; ///< of the finite samples; outward for 64-bit integers
  ValueMask Mask = 0;
  bool HasNonFinite = false;
  bool Uniform = false; ///< one finite value with one bit pattern, which Range.Low holds exactly
};

/// What decoding differs from the original, over the samples that a brick owns (each sample of a
/// volume is owned by one brick).
struct BrickError
{
  double Maximum = 0;
  double SumSquared = 0;
  std::int64_t Finite = 0;
  std::int64_t NonFinite = 0;
};

/// @param decoded `[z][y][x]`, x fastest
template <class T>
BrickSummary Summarize(const T* decoded, const glm::ivec3& samples, const MaskRange& masks);

/// @param owned the brick owns samples [0, owned) per axis
template <class T>
BrickError MeasureError(
  const T* original, const T* decoded, const glm::ivec3& samples, const glm::ivec3& owned);

} // namespace banyan

#endif
