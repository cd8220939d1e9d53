#include "Series/FieldEncoder.h"

#include "Base/ThreadPool.h"
#include "Series/NodeTable.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Copies the samples of a brick into one block.
template <class T>
void Gather(const FieldToEncode& field, const Box& box, T* block)
{
  const T* values = static_cast<const T*>(field.Values) + field.Component;
  const glm::ivec3 size = box.Size();
  thread_local std::vector<std::int64_t> columns;
  columns.resize(static_cast<std::size_t>(size.x));
  for (int x = 0; x < size.x; ++x)
  {
    columns[static_cast<std::size_t>(x)] =
      std::int64_t{ field.Components } *
      field.Layout.FineSample({ box.Lo.x + x, box.Lo.y, box.Lo.z }).x;
  }
  for (int z = box.Lo.z; z < box.Hi.z; ++z)
  {
    for (int y = box.Lo.y; y < box.Hi.y; ++y)
    {
      const glm::ivec3 fine = field.Layout.FineSample({ box.Lo.x, y, z });
      const T* row = values + (std::int64_t{ fine.z } * field.FineSamples.y + fine.y) *
                                field.FineSamples.x * field.Components;
      if (field.Components == 1 && field.Layout.Level() == 0)
      {
        std::copy(row + box.Lo.x, row + box.Hi.x, block);
      }
      else
      {
        std::transform(columns.begin(), columns.end(), block,
          [row](std::int64_t column) { return row[column]; });
      }
      block += size.x;
    }
  }
}

/// Samples that a brick owns: the layer that it shares with the next brick belongs to that one.
glm::ivec3 OwnedOf(const BrickLayout& layout, std::int64_t brick, const glm::ivec3& samples)
{
  const glm::ivec3 position = layout.PositionOf(brick);
  const glm::ivec3 bricks = layout.Bricks();
  glm::ivec3 owned = samples;
  for (int axis = 0; axis < 3; ++axis)
  {
    owned[axis] -= position[axis] + 1 < bricks[axis] ? 1 : 0;
  }
  return owned;
}

template <class T>
void EncodeOne(const FieldToEncode& field, std::int64_t brick, FieldBrick& out)
{
  const Box box = field.Layout.SamplesOf(brick);
  const glm::ivec3 samples = box.Size();
  const std::size_t count = static_cast<std::size_t>(box.Count());
  thread_local std::vector<T> original;
  thread_local std::vector<T> decoded;
  thread_local std::vector<LatticeNumber<T>> numbers;
  original.resize(count);
  decoded.resize(count);
  numbers.resize(count);
  Gather(field, box, original.data());
  const bool onLattice =
    Quantize(field.Lattice, original.data(), count, numbers.data(), decoded.data());
  const BrickSummary summary = Summarize(decoded.data(), samples, field.Masks);
  out.Error =
    MeasureError(original.data(), decoded.data(), samples, OwnedOf(field.Layout, brick, samples));
  out.Code = EncodeBrick(
    numbers.data(), decoded.data(), samples, onLattice, summary.Uniform, field.CompressionLevel);
  out.Node.Range = summary.Range;
  out.Node.Mask = summary.Mask;
  out.Node.Uniform = summary.Uniform;
  out.Node.HasNonFinite = summary.HasNonFinite;
  out.Node.PayloadBytes = static_cast<std::uint32_t>(out.Code.Payload.size());
  if (summary.Uniform)
  {
    out.Node.Identity = MacroVoxelIdentity(field.Type, samples, summary.Range.Low);
    return;
  }
  const Hash128 hash = IdentityOf(static_cast<std::uint8_t>(out.Code.Mode), out.Code.Payload.data(),
    out.Code.Payload.size(), field.Lattice, field.Type, samples);
  out.Node.Identity = { hash.Low, hash.High };
}

template <class T>
ValueRange RangeOfTuples(const T* values, std::int64_t first, std::int64_t last, int components)
{
  ValueRange range;
  for (std::int64_t i = first; i < last; ++i)
  {
    const T value = values[i * components];
    if (std::isfinite(static_cast<double>(value)))
    {
      range.Include({ DoubleNotAbove(value), DoubleNotBelow(value) });
    }
  }
  return range;
}

} // namespace

void EncodeBricks(
  const FieldToEncode& field, std::int64_t first, std::vector<FieldBrick>& bricks, ThreadPool& pool)
{
  Dispatch(field.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      pool.ParallelFor(static_cast<std::int64_t>(bricks.size()), [&](std::int64_t i)
        { EncodeOne<T>(field, first + i, bricks[static_cast<std::size_t>(i)]); });
    });
}

ValueRange RangeOfComponent(ScalarType type, const void* values, std::int64_t tuples,
  int components, int component, ThreadPool& pool)
{
  constexpr std::int64_t chunk = 65536;
  std::vector<ValueRange> parts(static_cast<std::size_t>((tuples + chunk - 1) / chunk));
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* start = static_cast<const T*>(values) + component;
      pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
        [&](std::int64_t i)
        {
          parts[static_cast<std::size_t>(i)] =
            RangeOfTuples(start, i * chunk, std::min(tuples, (i + 1) * chunk), components);
        });
    });
  ValueRange range;
  for (const ValueRange& part : parts)
  {
    range.Include(part);
  }
  return range;
}

} // namespace banyan
