// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_ZfpSeries_h
#define banyan_Benchmarks_ZfpSeries_h

#include "CodecMethod.h"

#include <zfp.h>
#include <zfp/bitstream.h>

#include <vector>

namespace banyan::bench
{

/// One step in zfp's accuracy mode: the blocks of 4^3 that `zfp_compress` would code, in the order
/// of bricks of 16^3, so that one brick is one piece of the stream. Of one row of values (those of
/// an unstructured mesh in the order of its points) the blocks of 4 of a one-dimensional field.
struct ZfpStep
{
  std::vector<std::uint64_t> Words;      ///< the stream, as zfp reads it
  std::vector<std::uint64_t> BitOffsets; ///< of each brick in the stream, x fastest, and of its end
  std::uint64_t Bytes() const;           ///< the stream and a table of the lengths of its bricks
};

/// zfp on one thread, with memory of its own that is used again from step to step.
///
/// zfp rounds a tolerance down to a power of two, because it codes whole bit planes. To make use of
/// any other, the values are multiplied by a factor in [1, 2) that turns it into a power of two.
class ZfpCoder
{
public:
  /// @param tolerance > 0, or 0 for the smallest that zfp knows
  /// @param exact whether values are scaled so that the tolerance is used as it is
  ZfpCoder(const glm::ivec3& samples, double tolerance, bool exact);
  ~ZfpCoder();
  ZfpCoder(const ZfpCoder&) = delete;
  ZfpCoder& operator=(const ZfpCoder&) = delete;

  /// Whether these are coded as a field of one dimension.
  static bool IsLine(const glm::ivec3& samples) { return samples.y == 1 && samples.z == 1; }

  ZfpStep Encode(const float* values);
  void Decode(const ZfpStep& step, float* values);
  /// Not of lines.
  void DecodeBrick(const ZfpStep& step, const Box& samples, float* values);

private:
  std::int64_t BrickCount() const;
  Box BrickSamples(std::int64_t brick) const;
  void Scale(float* values, std::int64_t count) const;
  bitstream* OpenStream(const std::vector<std::uint64_t>& words);

  glm::ivec3 Samples;
  glm::ivec3 BrickSize;
  glm::ivec3 Bricks; ///< how many
  double Factor = 1.0;
  zfp_stream* Zfp = nullptr;
  bitstream* Stream = nullptr;
  std::vector<std::uint64_t> Buffer;
  std::vector<float> Scaled;
};

} // namespace banyan::bench

#endif
