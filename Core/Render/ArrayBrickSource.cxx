#include "Render/ArrayBrickSource.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/BrickSummary.h"

#include <algorithm>
#include <type_traits>

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

glm::ivec3 PositionOf(std::int64_t brick, const glm::ivec3& counts)
{
  return { static_cast<int>(brick % counts.x), static_cast<int>(brick / counts.x % counts.y),
    static_cast<int>(brick / counts.x / counts.y) };
}

ScalarType CopyType(ScalarType type)
{
  return SizeOf(type) <= 2 || type == ScalarType::Float32 ? ScalarType::Float32
                                                          : ScalarType::Float64;
}

/// @param samples of a level: every `every`-th of the array, and the last one
template <class T>
void CopyBrick(
  const SampleArray& array, const Box& samples, int every, void* target, ScalarType type)
{
  const SampleReader<T> reader(array);
  const glm::ivec3 last = array.Samples.Size() - 1;
  const auto fine = [&](int sample, int axis) { return std::min(sample * every, last[axis]); };
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
        if (every == 1)
        {
          reader.Read(begin, end, y, z, out);
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
  this->Held = array.Samples.Size();
  this->CutIntoBricks();
  const auto count = static_cast<std::int64_t>(this->Ranges.size());
  Dispatch(array.Type,
    [&](auto tag)
    {
      using Summary = BrickSummary<typename decltype(tag)::Type>;
      std::vector<Summary> summaries(pool.Width(), Summary(this->Array, this->Over));
      const std::function<void(std::int64_t, int)> summarize = [&](std::int64_t brick, int worker) {
        ValueRange& range = this->Ranges[brick];
        const Box samples = this->SamplesOf(brick);
        summaries[worker].Summarize(samples, range, this->Masks[brick]);
        this->Uniform[brick] = range.Low == range.High && !this->HasSpecial(samples);
      };
      pool.ParallelFor(count, summarize);
    });
}

ArrayBrickSource::ArrayBrickSource(const ArrayBrickSource& finest, int level)
  : Array(finest.Array)
  , Every(1 << level)
  , BrickCells(finest.BrickCells)
  , Over(finest.Over)
{
  this->Cells = { glm::ivec3(0), (finest.Cells.Hi + this->Every - 1) / this->Every };
  this->Held = this->Cells.Hi + 1;
  this->CutIntoBricks();
  std::fill(this->Uniform.begin(), this->Uniform.end(), std::uint8_t{ 1 });
  for (std::size_t fine = 0; fine < finest.Ranges.size(); ++fine)
  {
    const glm::ivec3 position =
      PositionOf(static_cast<std::int64_t>(fine), finest.BrickCounts) / this->Every;
    const std::size_t brick =
      position.x +
      this->BrickCounts.x * (position.y + static_cast<std::size_t>(this->BrickCounts.y) * position.z);
    this->Ranges[brick].Include(finest.Ranges[fine]);
    this->Masks[brick] |= finest.Masks[fine];
    this->Uniform[brick] &= finest.Uniform[fine];
  }
}

std::unique_ptr<BrickSource> ArrayBrickSource::MakeLevel(int level, const Box& domain)
{
  const bool whole = this->Cells == domain && domain.Lo == glm::ivec3(0) && !domain.Empty();
  return whole && level < 30
           ? std::unique_ptr<BrickSource>(new ArrayBrickSource(*this, level))
           : nullptr;
}

void ArrayBrickSource::CutIntoBricks()
{
  this->FirstBrick = this->Cells.Lo / this->BrickCells;
  const glm::ivec3 lastCell = glm::max(this->Cells.Hi - 1, this->Cells.Lo);
  this->BrickCounts = lastCell / this->BrickCells - this->FirstBrick + 1;
  const std::size_t count =
    static_cast<std::size_t>(this->BrickCounts.x) * this->BrickCounts.y * this->BrickCounts.z;
  this->Ranges.resize(count);
  this->Masks.resize(count);
  this->Uniform.resize(count);
}

Box ArrayBrickSource::CellsOf(std::int64_t brick) const
{
  const glm::ivec3 low = (this->FirstBrick + PositionOf(brick, this->BrickCounts)) * this->BrickCells;
  return Intersection(Box{ low, low + this->BrickCells }, this->Cells);
}

/// Positions in the array, from 0, with the layer that neighbours share.
Box ArrayBrickSource::SamplesOf(std::int64_t brick) const
{
  const Box cells = this->CellsOf(brick);
  return { cells.Lo - this->Array.Samples.Lo, cells.Hi + 1 - this->Array.Samples.Lo };
}

bool ArrayBrickSource::HasSpecial(const Box& samples) const
{
  bool found = false;
  Dispatch(this->Array.Type,
    [&](auto tag)
    {
      const SampleReader<typename decltype(tag)::Type> reader(this->Array);
      std::vector<double> row(static_cast<std::size_t>(samples.Size().x));
      for (int z = samples.Lo.z; z < samples.Hi.z && !found; ++z)
      {
        for (int y = samples.Lo.y; y < samples.Hi.y && !found; ++y)
        {
          reader.Read(samples.Lo.x, samples.Hi.x, y, z, row.data());
          found = !std::all_of(
            row.begin(), row.end(), [](double value) { return std::isfinite(value); });
        }
      }
    });
  return found;
}

/// Signs of zeros and the rounding of magnitudes do not matter: zeros find one entry of a table, and
/// magnitudes are not known.
std::optional<UniformValue> ArrayBrickSource::UniformValueOf(std::int64_t brick) const
{
  const ValueRange& range = this->Ranges[brick];
  const bool known = this->Uniform[brick] != 0 && range.Low == range.High;
  if (!known || this->Array.Component == SampleArray::Magnitude)
  {
    return std::nullopt;
  }
  return UniformValue{ range.Low, this->Array.Type };
}

bool ArrayBrickSource::IsCopied(const Box& samples) const
{
  const glm::ivec3 last = (samples.Hi - 1) * this->Every;
  const glm::ivec3 size = this->Array.Samples.Size();
  const bool repeats = last.x >= size.x || last.y >= size.y || last.z >= size.z;
  return this->Array.Component == SampleArray::Magnitude || this->Array.Flags || repeats;
}

std::size_t ArrayBrickSource::LoadBytes(std::int64_t brick) const
{
  const Box samples = this->SamplesOf(brick);
  return this->IsCopied(samples)
           ? static_cast<std::size_t>(samples.Count()) * SizeOf(CopyType(this->Array.Type))
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
    Intersection({ own.Lo - 1, own.Hi + 1 }, { glm::ivec3(0), this->Held });
  samples = { part.Lo + this->Array.Samples.Lo, part.Hi + this->Array.Samples.Lo };
  return this->ViewOf(part);
}

BrickView ArrayBrickSource::ViewOf(const Box& samples) const
{
  BrickView view;
  if (!this->IsCopied(samples))
  {
    std::ptrdiff_t offset = this->Array.Component * this->Array.ComponentStride;
    for (int axis = 0; axis < 3; ++axis)
    {
      view.Stride[axis] = this->Every * this->Array.Stride[axis];
      offset += samples.Lo[axis] * view.Stride[axis];
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
  Dispatch(this->Array.Type,
    [&](auto tag)
    {
      CopyBrick<typename decltype(tag)::Type>(
        this->Array, samples, this->Every, copy->data(), view.Type);
    });
  view.Values = copy->data();
  view.Stride[1] = samples.Size().x;
  view.Stride[2] = std::ptrdiff_t{ samples.Size().x } * samples.Size().y;
  view.Owner = std::shared_ptr<const void>(copy, copy->data());
  return view;
}

} // namespace banyan
