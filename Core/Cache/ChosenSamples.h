// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cache_ChosenSamples_h
#define banyan_Cache_ChosenSamples_h

#include "Series/Decode/SeriesFile.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class BrickCache;

/// Single samples of an image, in any order, and the bricks that hold them: only these are decoded,
/// and the image is nowhere as a whole. Made once, read for each step. 8 bytes per sample.
class ChosenSamples
{
public:
  ChosenSamples() = default;

  /// @param samples numbers of samples of the layout's level, x fastest, each less than 2^32; the
  /// same one may come several times
  /// Throws Error when there is no such sample.
  ChosenSamples(const BrickLayout& layout, const std::vector<std::uint32_t>& samples);

  std::int64_t Count() const { return static_cast<std::int64_t>(this->Tuples.size()); }

  /// The bricks that hold some of them, in ascending order.
  const std::vector<std::int64_t>& Bricks() const { return this->Holders; }

  /// Decodes one component, in parallel, brick by brick. Bricks come from the cache and go there as
  /// those of ReadRegion() do.
  /// @param field of the layout's level
  /// @param values receives Count() tuples, in the order of `samples`: the value goes to
  /// `values[tuple * stride + component]`, in the array's own type
  /// Throws Error.
  void Read(BrickCache& cache, const SeriesFile& series, const FieldKey& field, void* values,
    int stride, int component) const;

private:
  std::vector<std::int64_t> Holders;
  std::vector<std::size_t> First;    ///< of each holder, in the two below; and the end
  std::vector<std::uint32_t> Tuples; ///< which of `samples`
  std::vector<std::uint32_t> Places; ///< where in the brick
};

} // namespace banyan

#endif
