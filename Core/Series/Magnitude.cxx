#include "Series/Magnitude.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

// Small enough for the scratch arrays of a thread to stay in its cache.
constexpr std::int64_t ChunkTuples = 4096;

/// Of the squared lengths of a chunk of tuples.
template <class T>
ValueRange SquaresOfChunk(
  const T* values, std::int64_t tuples, const std::vector<Quantizer>& lattices)
{
  const std::size_t count = static_cast<std::size_t>(tuples);
  const std::size_t components = lattices.size();
  std::vector<T> original(count);
  std::vector<T> decoded(count);
  std::vector<LatticeNumber<T>> numbers(count);
  std::vector<double> squares(count, 0.0);
  for (std::size_t c = 0; c < components; ++c)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      original[i] = values[i * components + c];
    }
    Quantize(lattices[c], original.data(), count, numbers.data(), decoded.data());
    for (std::size_t i = 0; i < count; ++i)
    {
      const double value = static_cast<double>(decoded[i]);
      squares[i] += value * value;
    }
  }
  ValueRange range;
  for (const double square : squares)
  {
    if (std::isfinite(square))
    {
      range.Include(square);
    }
  }
  return range;
}

} // namespace

ValueRange MagnitudeRange(ScalarType type, const void* values, std::int64_t tuples,
  const std::vector<Quantizer>& lattices, ThreadPool& pool)
{
  std::vector<ValueRange> parts(static_cast<std::size_t>((tuples + ChunkTuples - 1) / ChunkTuples));
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* first = static_cast<const T*>(values);
      pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
        [&](std::int64_t chunk)
        {
          const std::int64_t start = chunk * ChunkTuples;
          parts[static_cast<std::size_t>(chunk)] =
            SquaresOfChunk(first + start * static_cast<std::int64_t>(lattices.size()),
              std::min(ChunkTuples, tuples - start), lattices);
        });
    });
  ValueRange squares;
  for (const ValueRange& part : parts)
  {
    squares.Include(part);
  }
  return squares.Empty() ? squares : ValueRange{ std::sqrt(squares.Low), std::sqrt(squares.High) };
}

} // namespace banyan
