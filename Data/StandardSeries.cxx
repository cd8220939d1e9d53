// SPDX-License-Identifier: BSD-3-Clause
#include "StandardSeries.h"

#include "StandardField.h"

#include "Base/ThreadPool.h"

#include <algorithm>

namespace banyan
{

namespace
{

/// As many slices at a time as take 64 MiB, but at least one.
int SlicesAtOnce(int size)
{
  constexpr std::int64_t values = std::int64_t{ 1 } << 24;
  const std::int64_t slices = values / (std::int64_t{ size } * size);
  return static_cast<int>(std::clamp<std::int64_t>(slices, 1, size));
}

void FillSlices(
  const StandardFieldSlices& field, int size, int first, int count, ThreadPool& pool, float* values)
{
  pool.ParallelFor(count, [&](std::int64_t i)
    { field.Slice(first + static_cast<int>(i), values + i * std::int64_t{ size } * size); });
}

/// The field does not change: all steps are the same.
void GenerateSlabs(const GenerateOptions& options, ThreadPool& pool, const SlabSink& sink)
{
  const int size = options.Size;
  const StandardFieldSlices field(size);
  std::vector<float> values;
  for (int step = 0; step < options.Steps; ++step)
  {
    for (int first = 0; first < size; first += SlicesAtOnce(size))
    {
      const int count = std::min(SlicesAtOnce(size), size - first);
      values.resize(static_cast<std::size_t>(count) * size * size);
      FillSlices(field, size, first, count, pool, values.data());
      sink(values);
    }
  }
}

void Generate(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  const int size = options.Size;
  const StandardFieldSlices field(size);
  std::vector<ImageArray> arrays(1);
  arrays[0].Name = options.Arrays.at(0);
  arrays[0].Values.resize(static_cast<std::size_t>(size) * size * size);
  FillSlices(field, size, 0, size, pool, arrays[0].Values.data());
  for (int step = 0; step < options.Steps; ++step)
  {
    sink(TimeOfStep(options, step), arrays);
  }
}

} // namespace

SeriesKind StandardSeries()
{
  SeriesKind kind;
  kind.Name = "standard";
  kind.FileName = "standard";
  kind.Description = "blobs and waves, the field of the ray caster's standard scenes; unit spacing";
  kind.Arrays = { "value" };
  kind.DefaultSize = 256;
  kind.DefaultSteps = 1;
  kind.Edge = 0.0;
  kind.Steady = true;
  kind.Generate = Generate;
  kind.GenerateSlabs = GenerateSlabs;
  return kind;
}

} // namespace banyan
