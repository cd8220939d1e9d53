// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_BrickSummary_h
#define banyan_Render_Bricks_BrickSummary_h

#include "Render/Bricks/SampleReader.h"
#include "Render/Bricks/ValueBins.h"

#include <algorithm>
#include <type_traits>
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
  {
  }

  /// @param samples positions in the array, from 0; not empty
  void Summarize(const Box& samples, ValueRange& range, ValueMask& mask)
  {
    const glm::ivec3 size = samples.Size();
    const auto pitch = static_cast<std::size_t>(BinRowsOut::PitchOf(size.x));
    const std::size_t count = pitch * static_cast<std::size_t>(size.y);
    for (Slice* slice : { &this->Raw, &this->Now, &this->Before })
    {
      slice->Low.assign(count + 1, BinRowsOut::NoBinLow);
      slice->High.assign(count + 1, BinRowsOut::NoBinHigh);
    }
    range = {};
    mask = 0;
    for (int z = 0; z < size.z; ++z)
    {
      this->BinSlice(samples, samples.Lo.z + z, range);
      // Edges of cells: each position takes in its neighbour up in x. There is none behind a row;
      // that place takes in the first sample of the next one, which adds nothing.
      Extremes(this->Raw, this->Raw, 1, count, this->Now);
      std::swap(this->Raw, this->Now);
      // Faces: each takes in its neighbour up in y. The last row stays as it is: edges, which the
      // row before has taken in already.
      const std::size_t faces = count - pitch;
      Extremes(this->Raw, this->Raw, pitch, faces, this->Now);
      if (size.y == 1)
      {
        std::swap(this->Raw, this->Now);
      }
      const std::size_t kept = size.y == 1 ? count : faces;
      if (z > 0 || size.z == 1)
      {
        const Slice& other = z > 0 ? this->Before : this->Now;
        Extremes(this->Now, other, 0, kept, this->Raw);
        mask |= BinsBetween(this->Raw.Low.data(), this->Raw.High.data(), kept);
      }
      std::swap(this->Now, this->Before);
    }
  }

private:
  /// Lowest and highest bin per position, as BinValues has them.
  struct Slice
  {
    std::vector<std::uint8_t> Low;
    std::vector<std::uint8_t> High;
  };

  void BinSlice(const Box& samples, int z, ValueRange& range)
  {
    const glm::ivec3 size = samples.Size();
    const BinRowsOut out{ this->Raw.Low.data(), this->Raw.High.data() };
    if constexpr (std::is_floating_point_v<T>)
    {
      if (this->Reader.IsPlain())
      {
        const ValueRows<T> rows{ this->Reader.At(samples.Lo.x, samples.Lo.y, z),
          this->Reader.RowStride(), size.x, size.y };
        BinValues(rows, this->Over, out, range);
        return;
      }
    }
    this->Values.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    double* row = this->Values.data();
    for (int y = samples.Lo.y; y < samples.Hi.y; ++y, row += size.x)
    {
      this->Reader.Read(samples.Lo.x, samples.Hi.x, y, z, row);
    }
    BinValues(
      ValueRows<double>{ this->Values.data(), size.x, size.x, size.y }, this->Over, out, range);
  }

  // Bytes may alias anything: the loops below work on local copies and restricted pointers, so that
  // the compiler can vectorize them.

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

  SampleReader<T> Reader;
  MaskRange Over;
  std::vector<double> Values;
  Slice Raw;
  Slice Now;
  Slice Before;
};

} // namespace banyan

#endif
