// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/ArraySamples.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/Bricks/BrickSummary.h"
#include "Render/Bricks/JoinedComponents.h"
#include "Render/Bricks/SampledBox.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace banyan
{
namespace
{

void CheckArray(const SampleArray& array)
{
  const bool componentExists = array.Component == SampleArray::Magnitude ||
                               array.Component == SampleArray::Colours ||
                               (array.Component >= 0 && array.Component < array.Components);
  if (array.Components < 1 || !componentExists)
  {
    throw Error("The array has no component " + std::to_string(array.Component));
  }
  if (array.Component == SampleArray::Colours && array.Components > 1)
  {
    CheckColours(array.Components);
  }
  const glm::ivec3 lo = array.Samples.Lo;
  if (lo.x < 0 || lo.y < 0 || lo.z < 0)
  {
    throw Error("A piece of a grid starts before the grid");
  }
  if (!array.Values && !array.Samples.Empty())
  {
    throw Error("The array to draw has no values in memory");
  }
}

ScalarType CopyType(const SampleArray& array)
{
  const bool small = SizeOf(array.Type) <= 2 || array.Type == ScalarType::Float32;
  return small && array.Component != SampleArray::Colours ? ScalarType::Float32
                                                          : ScalarType::Float64;
}

/// @param samples of a level: along each axis every `every`-th of the array, and the last one
template <class T>
void CopyBrick(const SampleArray& array, const Box& samples, const glm::ivec3& every, void* target,
  ScalarType type)
{
  const SampleReader<T> reader(array, true);
  const glm::ivec3 last = array.Samples.Size() - 1;
  const auto fine = [&](int sample, int axis)
  { return std::min(sample * every[axis], last[axis]); };
  const auto copy = [&](auto* out)
  {
    using Out = std::remove_pointer_t<decltype(out)>;
    const int begin = fine(samples.Lo.x, 0);
    const int end = fine(samples.Hi.x - 1, 0) + 1;
    std::vector<Out> row(static_cast<std::size_t>(end - begin));
    for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
    {
      for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
      {
        if (every.x == 1)
        {
          reader.Read(begin, end, fine(y, 1), fine(z, 2), out);
          out += end - begin;
          continue;
        }
        reader.Read(begin, end, fine(y, 1), fine(z, 2), row.data());
        for (int x = samples.Lo.x; x < samples.Hi.x; ++x)
        {
          *out++ = row[static_cast<std::size_t>(fine(x, 0) - begin)];
        }
      }
    }
  };
  if (type == ScalarType::Float32)
  {
    copy(static_cast<float*>(target));
  }
  else
  {
    copy(static_cast<double*>(target));
  }
}

} // namespace

ValueRange FiniteRange(const SampleArray& array, ThreadPool& pool)
{
  CheckArray(array);
  const glm::ivec3 size = array.Samples.Size();
  ValueRange total;
  if (array.Samples.Empty())
  {
    return total;
  }
  std::vector<ValueRange> slices(size.z);
  Dispatch(array.Type,
    [&](auto tag)
    {
      const SampleReader<typename decltype(tag)::Type> reader(array);
      pool.ParallelFor(size.z,
        [&](std::int64_t z)
        {
          ValueRange range;
          std::vector<double> row(size.x);
          for (int y = 0; y < size.y; ++y)
          {
            reader.Read(0, size.x, y, static_cast<int>(z), row.data());
            for (const double value : row)
            {
              if (std::isfinite(value))
              {
                range.Include(value);
              }
            }
          }
          slices[z] = range;
        });
    });
  for (const ValueRange& slice : slices)
  {
    total.Include(slice);
  }
  return total;
}

ArraySamples::ArraySamples(const SampleArray& array)
  : Source(array)
{
  CheckArray(array);
}

ScalarType ArraySamples::ViewType() const
{
  return this->AlwaysCopied() ? CopyType(this->Source) : this->Source.Type;
}

bool ArraySamples::IsCopied(const Box& samples, const glm::ivec3& every) const
{
  const glm::ivec3 last = (samples.Hi - 1) * every;
  const glm::ivec3 size = this->Source.Samples.Size();
  return this->AlwaysCopied() || last.x >= size.x || last.y >= size.y || last.z >= size.z;
}

std::size_t ArraySamples::ViewBytes(const Box& samples, const glm::ivec3& every) const
{
  return this->IsCopied(samples, every)
           ? static_cast<std::size_t>(samples.Count()) * SizeOf(CopyType(this->Source))
           : 0;
}

bool ArraySamples::HasSpecial(const Box& samples) const
{
  bool found = false;
  Dispatch(this->Source.Type,
    [&](auto tag)
    {
      const SampleReader<typename decltype(tag)::Type> reader(this->Source);
      std::vector<double> row(static_cast<std::size_t>(samples.Size().x));
      for (int z = samples.Lo.z; z < samples.Hi.z && !found; ++z)
      {
        for (int y = samples.Lo.y; y < samples.Hi.y && !found; ++y)
        {
          reader.Read(samples.Lo.x, samples.Hi.x, y, z, row.data());
          found =
            !std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
        }
      }
    });
  return found;
}

std::vector<BoxSummary> ArraySamples::Summarize(
  const std::vector<Box>& boxes, const MaskRange& over, ThreadPool& pool) const
{
  std::vector<BoxSummary> summaries(boxes.size());
  Dispatch(this->Source.Type,
    [&](auto tag)
    {
      using Summary = BrickSummary<typename decltype(tag)::Type>;
      std::vector<Summary> scratch(
        static_cast<std::size_t>(pool.Width()), Summary(this->Source, over));
      const std::function<void(std::int64_t, int)> summarize = [&](std::int64_t box, int worker)
      {
        BoxSummary& summary = summaries[static_cast<std::size_t>(box)];
        const Box& samples = boxes[static_cast<std::size_t>(box)];
        scratch[static_cast<std::size_t>(worker)].Summarize(samples, summary.Range, summary.Mask);
        summary.Uniform = summary.Range.Low == summary.Range.High && !this->HasSpecial(samples);
      };
      pool.ParallelFor(static_cast<std::int64_t>(boxes.size()), summarize);
    });
  return summaries;
}

BrickView ArraySamples::View(const Box& samples, const glm::ivec3& every) const
{
  BrickView view;
  if (!this->IsCopied(samples, every))
  {
    std::ptrdiff_t offset = this->Source.Component * this->Source.ComponentStride;
    for (int axis = 0; axis < 3; ++axis)
    {
      view.Stride[axis] = every[axis] * this->Source.Stride[axis];
      offset += samples.Lo[axis] * view.Stride[axis];
    }
    const auto bytes = offset * static_cast<std::ptrdiff_t>(SizeOf(this->Source.Type));
    view.Values = static_cast<const char*>(this->Source.Values) + bytes;
    view.Type = this->Source.Type;
    view.Owner = this->Source.Owner;
    return view;
  }
  void* values = nullptr;
  view = AllocateView(samples, CopyType(this->Source), values);
  Dispatch(this->Source.Type, [&](auto tag)
    { CopyBrick<typename decltype(tag)::Type>(this->Source, samples, every, values, view.Type); });
  return view;
}

} // namespace banyan
