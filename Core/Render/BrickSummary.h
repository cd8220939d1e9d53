#ifndef banyan_Render_BrickSummary_h
#define banyan_Render_BrickSummary_h

#include "Render/SampleReader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace banyan
{

/// Range and occupancy mask of a brick of a SampleArray, read once, one slice after the other.
/// Keeps its scratch memory from brick to brick; one per thread.
template <class T>
class BrickSummary
{
public:
  BrickSummary(const SampleArray& array, const MaskRange& over)
    : Reader(array)
    , Over(over)
    , BinsPerValue(over.High > over.Low ? 64.0 / (over.High - over.Low) : 0.0)
  {
  }

  /// @param samples positions in the array, from 0; not empty
  void Summarize(const Box& samples, ValueRange& range, ValueMask& mask)
  {
    const glm::ivec3 size = samples.Size();
    const std::size_t width = size.x;
    const std::size_t count = width * size.y;
    for (Slice* slice : { &this->Raw, &this->Now, &this->Before })
    {
      slice->Low.resize(count);
      slice->High.resize(count);
    }
    range = {};
    mask = 0;
    for (int z = 0; z < size.z; ++z)
    {
      this->ReadSlice(samples, samples.Lo.z + z, range);
      // Faces of cells: each position takes in its neighbour up in y (rows did so along x). The
      // last row stays as it is: edges, which the row before has taken in already.
      const std::size_t faces = count - width;
      Extremes(this->Raw, this->Raw, width, faces, this->Now);
      if (size.y == 1)
      {
        std::swap(this->Raw, this->Now);
      }
      const std::size_t kept = size.y == 1 ? count : faces;
      if (z > 0 || size.z == 1)
      {
        const Slice& other = z > 0 ? this->Before : this->Now;
        Extremes(this->Now, other, 0, kept, this->Raw);
        mask |= MaskOf(this->Raw, kept);
      }
      std::swap(this->Now, this->Before);
    }
  }

private:
  /// Lowest and highest bin per position; nothing finite is (255, 0).
  struct Slice
  {
    std::vector<std::uint8_t> Low;
    std::vector<std::uint8_t> High;
  };

  void ReadSlice(const Box& samples, int z, ValueRange& range)
  {
    const int width = samples.Size().x;
    this->Row.resize(width);
    std::size_t at = 0;
    for (int y = samples.Lo.y; y < samples.Hi.y; ++y, at += width)
    {
      this->Reader.Read(samples.Lo.x, samples.Hi.x, y, z, this->Row.data());
      this->BinRow(range, &this->Raw.Low[at], &this->Raw.High[at]);
    }
  }

  // Bytes may alias anything: the loops below work on local copies and restricted pointers, so that
  // the compiler can vectorize them.

  /// Bins of a row of samples; each takes in its neighbour up in x.
  void BinRow(ValueRange& range, std::uint8_t* low, std::uint8_t* high) const
  {
    const std::size_t width = this->Row.size();
    IncludeRow(this->Row.data(), width, range);
    const double* const __restrict row = this->Row.data();
    std::uint8_t* const __restrict lowest = low;
    std::uint8_t* const __restrict highest = high;
    const double base = this->Over.Low;
    const double scale = this->BinsPerValue;
    for (std::size_t x = 0; x < width; ++x)
    {
      // As MaskRange::BinOf but for rounding at the edges of bins, for which VisibleBins has room.
      const double position = (row[x] - base) * scale;
      const double notBelow = position > 0.0 ? position : 0.0;
      const int bin = static_cast<int>(notBelow < 63.0 ? notBelow : 63.0);
      const bool finite = std::abs(row[x]) <= std::numeric_limits<double>::max();
      lowest[x] = static_cast<std::uint8_t>(finite ? bin : 255);
      highest[x] = static_cast<std::uint8_t>(finite ? bin : 0);
    }
    for (std::size_t x = 0; x + 1 < width; ++x)
    {
      lowest[x] = std::min(lowest[x], lowest[x + 1]);
      highest[x] = std::max(highest[x], highest[x + 1]);
    }
  }

  static void IncludeRow(const double* row, std::size_t width, ValueRange& range)
  {
    double low = range.Low;
    double high = range.High;
    for (std::size_t x = 0; x < width; ++x)
    {
      // What is not finite is no value: comparisons with these stand-ins change nothing.
      const bool finite = std::abs(row[x]) <= std::numeric_limits<double>::max();
      const double forLow = finite ? row[x] : std::numeric_limits<double>::infinity();
      const double forHigh = finite ? row[x] : -std::numeric_limits<double>::infinity();
      low = forLow < low ? forLow : low;
      high = forHigh > high ? forHigh : high;
    }
    range.Low = low;
    range.High = high;
  }

  /// @param result another slice than a and b
  static void Extremes(
    const Slice& a, const Slice& b, std::size_t fromB, std::size_t count, Slice& result)
  {
    const std::uint8_t* const __restrict lowA = a.Low.data();
    const std::uint8_t* const __restrict lowB = b.Low.data() + fromB;
    std::uint8_t* const __restrict low = result.Low.data();
    for (std::size_t i = 0; i < count; ++i)
    {
      low[i] = std::min(lowA[i], lowB[i]);
    }
    const std::uint8_t* const __restrict highA = a.High.data();
    const std::uint8_t* const __restrict highB = b.High.data() + fromB;
    std::uint8_t* const __restrict high = result.High.data();
    for (std::size_t i = 0; i < count; ++i)
    {
      high[i] = std::max(highA[i], highB[i]);
    }
  }

  static ValueMask MaskOf(const Slice& slice, std::size_t count)
  {
    const std::uint8_t* const lows = slice.Low.data();
    const std::uint8_t* const highs = slice.High.data();
    ValueMask mask = 0;
    int low = -1;
    int high = -1;
    for (std::size_t i = 0; i < count; ++i)
    {
      // Neighbours mostly lie in the same bins.
      if (lows[i] != low || highs[i] != high)
      {
        low = lows[i];
        high = highs[i];
        mask |= low <= high ? MaskOfBins(low, high) : ValueMask{ 0 };
      }
    }
    return mask;
  }

  SampleReader<T> Reader;
  MaskRange Over;
  double BinsPerValue;
  std::vector<double> Row;
  Slice Raw;
  Slice Now;
  Slice Before;
};

} // namespace banyan

#endif
