// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_Histogram_h
#define banyan_Series_Quantize_Histogram_h

#include "Series/Quantize/ValueRange.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

/// How many values lie between Low and High; the end nearer to zero is part of the bin, the other
/// is part of the next one. Low == High == 0: zeros.
struct HistogramBin
{
  double Low = 0.0;
  double High = 0.0;
  std::uint64_t Count = 0;
};

struct HistogramEntry
{
  std::uint32_t Bin = 0;
  std::uint64_t Count = 0;
};

/// All that a histogram knows, for messages between ranks.
struct HistogramMessage
{
  std::vector<HistogramEntry> Entries; ///< of the bins that are not empty
  std::uint64_t NonFinite = 0;
  ValueRange Range;
};

/// A streaming histogram of any numbers, no range needed beforehand: bins over the ordered bit
/// patterns of doubles, 2048 per power of two, so that a bin is at most 1/2048 of its values wide.
/// Zero (of either sign) has a bin of its own.
///
/// Integer counts: the same result in whatever order values are added and histograms merged.
/// Memory: 16 KiB per power of two and sign that occurs, 64 MiB at the very most.
class ValueHistogram
{
public:
  static constexpr int BinsPerOctave = 2048;

  ValueHistogram();
  ValueHistogram(const ValueHistogram& other);
  ValueHistogram& operator=(const ValueHistogram& other);
  ValueHistogram(ValueHistogram&&) noexcept = default;
  ValueHistogram& operator=(ValueHistogram&&) noexcept = default;

  /// Counts values, each as the double next to it. NaN and infinities are only counted as such.
  /// For all types of ScalarType.
  template <class T>
  void Add(const T* values, std::size_t count);

  void Merge(const ValueHistogram& other);
  /// Adds what another histogram's Message gave. Throws Error for a bin that does not exist; the
  /// histogram is then not to be used.
  void Merge(const HistogramMessage& message);
  HistogramMessage Message() const;

  std::uint64_t FiniteCount() const { return this->Finite; }
  std::uint64_t NonFiniteCount() const { return this->NonFinite; }
  /// Exact least and greatest finite value; empty when there is none.
  const ValueRange& Range() const { return this->Extremes; }

  /// Bins that are not empty, from the least values to the greatest.
  std::vector<HistogramBin> Bins() const;

  /// The value that `share` of the values lie at or below, sorted from the least: that of rank
  /// ceil(share * count) (in double precision), rank 1 at least.
  /// @param share 0 to 1. Throws Error otherwise, and when there is no finite value.
  /// @return `Low`: not above that value, `High`: not below it, less than 1/2048 of it apart; equal
  /// to it where it is zero, the least or the greatest value.
  ValueRange Percentile(double share) const;

  /// At least so many finite values lie outside of a range: bins that straddle an end, and those
  /// that touch it, count as inside. None for an empty range.
  std::uint64_t CountOutside(const ValueRange& range) const;

private:
  using Page = std::array<std::uint64_t, BinsPerOctave>;

  std::uint64_t& CountOf(std::uint32_t bin);

  /// Negative exponents downwards, zero, positive exponents upwards; null: nothing counted.
  std::vector<std::unique_ptr<Page>> Pages;
  std::uint64_t Finite = 0;
  std::uint64_t NonFinite = 0;
  ValueRange Extremes;
};

} // namespace banyan

#endif
