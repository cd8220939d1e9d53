#include "Render/ArrayBrickSource.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/BrickSummary.h"

#include <algorithm>

namespace banyan
{
namespace
{

void CheckArray(const SampleArray& array)
{
  const bool componentExists = array.Component == SampleArray::Magnitude ||
                               (array.Component >= 0 && array.Component < array.Components);
  if (array.Components < 1 || !componentExists)
  {
    throw Error("The array has no component " + std::to_string(array.Component));
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

bool IsCopied(const SampleArray& array)
{
  return array.Component == SampleArray::Magnitude || array.Flags;
}

ScalarType CopyType(ScalarType type)
{
  return SizeOf(type) <= 2 || type == ScalarType::Float32 ? ScalarType::Float32
                                                          : ScalarType::Float64;
}

template <class T>
void CopyBrick(const SampleArray& array, const Box& samples, void* target, ScalarType type)
{
  const SampleReader<T> reader(array);
  const auto copy = [&](auto* out)
  {
    for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
    {
      for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
      {
        reader.Read(samples.Lo.x, samples.Hi.x, y, z, out);
        out += samples.Size().x;
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

ArrayBrickSource::ArrayBrickSource(
  const SampleArray& array, int brickCells, const MaskRange& masks, ThreadPool& pool)
  : Array(array)
  , BrickCells(brickCells)
  , Over(masks)
{
  CheckArray(array);
  if (brickCells < 1)
  {
    throw Error("A brick needs at least one cell per axis");
  }
  if (array.Samples.Empty())
  {
    this->BrickCounts = glm::ivec3(0);
    return;
  }
  this->Cells = { array.Samples.Lo, array.Samples.Hi - 1 };
  this->FirstBrick = this->Cells.Lo / brickCells;
  const glm::ivec3 lastCell = glm::max(this->Cells.Hi - 1, this->Cells.Lo);
  this->BrickCounts = lastCell / brickCells - this->FirstBrick + 1;
  const std::int64_t count =
    std::int64_t{ this->BrickCounts.x } * this->BrickCounts.y * this->BrickCounts.z;
  this->Ranges.resize(count);
  this->Masks.resize(count);
  Dispatch(array.Type,
    [&](auto tag)
    {
      using Summary = BrickSummary<typename decltype(tag)::Type>;
      std::vector<Summary> summaries(pool.Width(), Summary(this->Array, this->Over));
      const std::function<void(std::int64_t, int)> summarize = [&](std::int64_t brick, int worker) {
        summaries[worker].Summarize(
          this->SamplesOf(brick), this->Ranges[brick], this->Masks[brick]);
      };
      pool.ParallelFor(count, summarize);
    });
}

Box ArrayBrickSource::CellsOf(std::int64_t brick) const
{
  const glm::ivec3 n = this->BrickCounts;
  const glm::ivec3 position(static_cast<int>(brick % n.x), static_cast<int>(brick / n.x % n.y),
    static_cast<int>(brick / n.x / n.y));
  const glm::ivec3 low = (this->FirstBrick + position) * this->BrickCells;
  return Intersection(Box{ low, low + this->BrickCells }, this->Cells);
}

/// Positions in the array, from 0, with the layer that neighbours share.
Box ArrayBrickSource::SamplesOf(std::int64_t brick) const
{
  const Box cells = this->CellsOf(brick);
  return { cells.Lo - this->Array.Samples.Lo, cells.Hi + 1 - this->Array.Samples.Lo };
}

std::size_t ArrayBrickSource::LoadBytes(std::int64_t brick) const
{
  return IsCopied(this->Array) ? static_cast<std::size_t>(this->SamplesOf(brick).Count()) *
                                   SizeOf(CopyType(this->Array.Type))
                               : 0;
}

BrickView ArrayBrickSource::Load(std::int64_t brick)
{
  return this->ViewOf(this->SamplesOf(brick));
}

BrickView ArrayBrickSource::LoadAround(std::int64_t brick, Box& samples)
{
  const Box own = this->SamplesOf(brick);
  const Box part =
    Intersection({ own.Lo - 1, own.Hi + 1 }, { glm::ivec3(0), this->Array.Samples.Size() });
  samples = { part.Lo + this->Array.Samples.Lo, part.Hi + this->Array.Samples.Lo };
  return this->ViewOf(part);
}

BrickView ArrayBrickSource::ViewOf(const Box& samples) const
{
  BrickView view;
  if (!IsCopied(this->Array))
  {
    std::ptrdiff_t offset = this->Array.Component * this->Array.ComponentStride;
    for (int axis = 0; axis < 3; ++axis)
    {
      view.Stride[axis] = this->Array.Stride[axis];
      offset += samples.Lo[axis] * this->Array.Stride[axis];
    }
    const auto bytes = offset * static_cast<std::ptrdiff_t>(SizeOf(this->Array.Type));
    view.Values = static_cast<const char*>(this->Array.Values) + bytes;
    view.Type = this->Array.Type;
    view.Owner = this->Array.Owner;
    return view;
  }
  view.Type = CopyType(this->Array.Type);
  const auto count = static_cast<std::size_t>(samples.Count());
  const auto copy = std::make_shared<std::vector<double>>(
    (count * SizeOf(view.Type) + sizeof(double) - 1) / sizeof(double));
  Dispatch(this->Array.Type, [&](auto tag)
    { CopyBrick<typename decltype(tag)::Type>(this->Array, samples, copy->data(), view.Type); });
  view.Values = copy->data();
  view.Stride[1] = samples.Size().x;
  view.Stride[2] = std::ptrdiff_t{ samples.Size().x } * samples.Size().y;
  view.Owner = std::shared_ptr<const void>(copy, copy->data());
  return view;
}

} // namespace banyan
