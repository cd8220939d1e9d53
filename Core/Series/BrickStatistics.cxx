#include "Series/BrickStatistics.h"

#include "Base/ForEachScalarType.h"
#include "Series/Quantizer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace banyan
{
namespace
{

// Bins of a sample without a finite value: they change neither a minimum nor a maximum.
constexpr std::int8_t NoMinimum = 127;
constexpr std::int8_t NoMaximum = -1;

template <class T>
bool IsFinite(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return std::abs(value) <= std::numeric_limits<T>::max();
  }
  else
  {
    (void)value;
    return true;
  }
}

/// `MaskRange::BinOf` without branches: the same operations, so the same bins. The range is not
/// degenerate: there everything lies in one bin, and nobody asks.
template <class T>
void BinsOf(const T* values, std::size_t count, const MaskRange& masks, std::int8_t* minima,
  std::int8_t* maxima)
{
  const double low = masks.Low;
  const double half = 0.5 * masks.Low;
  const double width = 0.5 * masks.High - half;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double value = static_cast<double>(values[i]);
    const bool finite = IsFinite(values[i]);
    double bin = value > low ? (0.5 * value - half) / width * 64.0 : 0.0;
    bin = bin >= 63.0 ? 63.0 : bin;
    bin = finite ? bin : 0.0;
    const std::int8_t whole = static_cast<std::int8_t>(static_cast<std::int32_t>(bin));
    minima[i] = finite ? whole : NoMinimum;
    maxima[i] = finite ? whole : NoMaximum;
  }
}

/// Replaces samples along an axis by the extremes over each cell.
template <class Extreme>
void Reduce(std::int8_t* bins, glm::ivec3& size, int axis, Extreme extreme)
{
  if (size[axis] == 1)
  {
    return;
  }
  const std::ptrdiff_t stride = axis == 0   ? 1
                                : axis == 1 ? size.x
                                            : std::ptrdiff_t{ size.x } * size.y;
  // In place, front to back: an element is read after it was last needed. Along x and y the last
  // sample of a row holds a value of no meaning afterwards, which the final loop leaves out.
  const std::ptrdiff_t count = std::ptrdiff_t{ size.x } * size.y * size.z;
  for (std::ptrdiff_t i = 0; i + stride < count; ++i)
  {
    bins[i] = extreme(bins[i], bins[i + stride]);
  }
}

ValueMask MaskOfCells(
  std::vector<std::int8_t>& minima, std::vector<std::int8_t>& maxima, glm::ivec3 size)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    Reduce(minima.data(), size, axis, [](std::int8_t a, std::int8_t b) { return a < b ? a : b; });
    Reduce(maxima.data(), size, axis, [](std::int8_t a, std::int8_t b) { return a > b ? a : b; });
  }
  const glm::ivec3 cells = glm::max(size - 1, glm::ivec3(1));
  ValueMask mask = 0;
  for (int z = 0; z < cells.z; ++z)
  {
    for (int y = 0; y < cells.y; ++y)
    {
      const std::size_t row = (static_cast<std::size_t>(z) * size.y + y) * size.x;
      for (int x = 0; x < cells.x; ++x)
      {
        const int first = minima[row + x];
        const int last = maxima[row + x];
        mask |= first <= last ? MaskOfBins(first, last) : 0;
      }
    }
  }
  return mask;
}

template <class T>
bool AllBitsEqual(const T* values, std::size_t count)
{
  return std::memcmp(values, values + 1, (count - 1) * sizeof(T)) == 0;
}

} // namespace

template <class T>
BrickSummary Summarize(const T* decoded, const glm::ivec3& samples, const MaskRange& masks)
{
  const std::size_t count = static_cast<std::size_t>(samples.x) * samples.y * samples.z;
  BrickSummary summary;
  T low = std::numeric_limits<T>::max();
  T high = std::numeric_limits<T>::lowest();
  std::size_t finite = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const bool good = IsFinite(decoded[i]);
    finite += good ? 1 : 0;
    low = good && decoded[i] < low ? decoded[i] : low;
    high = good && decoded[i] > high ? decoded[i] : high;
  }
  summary.HasNonFinite = finite < count;
  if (finite == 0)
  {
    return summary;
  }
  summary.Range = { DoubleNotAbove(low), DoubleNotBelow(high) };
  if (finite == count && summary.Range.Low == summary.Range.High && AllBitsEqual(decoded, count))
  {
    summary.Uniform = true;
    summary.Range.Low = summary.Range.High = static_cast<double>(decoded[0]); // keeps -0
  }
  const int first = masks.BinOf(summary.Range.Low);
  const int last = masks.BinOf(summary.Range.High);
  if (first == last)
  {
    summary.Mask = MaskOfBins(first, last);
    return summary;
  }
  thread_local std::vector<std::int8_t> minima;
  thread_local std::vector<std::int8_t> maxima;
  minima.resize(count);
  maxima.resize(count);
  BinsOf(decoded, count, masks, minima.data(), maxima.data());
  summary.Mask = MaskOfCells(minima, maxima, samples);
  return summary;
}

template <class T>
BrickError MeasureError(
  const T* original, const T* decoded, const glm::ivec3& samples, const glm::ivec3& owned)
{
  BrickError error;
  for (int z = 0; z < owned.z; ++z)
  {
    for (int y = 0; y < owned.y; ++y)
    {
      const std::size_t row = (static_cast<std::size_t>(z) * samples.y + y) * samples.x;
      for (int x = 0; x < owned.x; ++x)
      {
        if (!IsFinite(original[row + x]))
        {
          ++error.NonFinite;
          continue;
        }
        const double difference = Difference(original[row + x], decoded[row + x]);
        error.Maximum = difference > error.Maximum ? difference : error.Maximum;
        error.SumSquared += difference * difference;
      }
    }
  }
  error.Finite = std::int64_t{ owned.x } * owned.y * owned.z - error.NonFinite;
  return error;
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template BrickSummary Summarize<T>(const T*, const glm::ivec3&, const MaskRange&);               \
  template BrickError MeasureError<T>(const T*, const T*, const glm::ivec3&, const glm::ivec3&)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
