// SPDX-License-Identifier: BSD-3-Clause
#include "Cache/BrickCache.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Codec/DecodeStages.h"

#include <algorithm>
#include <cstring>
#include <functional>

namespace banyan
{
namespace
{

/// Where the values of a region go.
template <class T>
struct Target
{
  T* Values; ///< already at the component
  Box Samples;
  std::ptrdiff_t Stride;

  T* RowAt(int x, int y, int z) const
  {
    const glm::ivec3 size = this->Samples.Size();
    const glm::ivec3 p = glm::ivec3(x, y, z) - this->Samples.Lo;
    return this->Values + ((std::ptrdiff_t{ p.z } * size.y + p.y) * size.x + p.x) * this->Stride;
  }
};

/// Calls `row(pointer to the row's first value in the target, x, y, z)` for each row of a part.
template <class T, class Row>
void ForRows(const Target<T>& target, const Box& part, Row&& row)
{
  for (int z = part.Lo.z; z < part.Hi.z; ++z)
  {
    for (int y = part.Lo.y; y < part.Hi.y; ++y)
    {
      row(target.RowAt(part.Lo.x, y, z), part.Lo.x, y, z);
    }
  }
}

template <class T>
void Fill(const Target<T>& target, const Box& part, T value)
{
  const int length = part.Size().x;
  ForRows(target, part,
    [&](T* to, int, int, int)
    {
      if (target.Stride == 1)
      {
        std::fill_n(to, length, value);
        return;
      }
      for (int x = 0; x < length; ++x)
      {
        to[x * target.Stride] = value;
      }
    });
}

/// Fills parts that follow each other against x, those of one value at once: long rows are written
/// in less time than several short ones.
template <class T>
class Filling
{
public:
  explicit Filling(const Target<T>& target)
    : To(target)
  {
  }
  ~Filling() { this->Finish(); }
  Filling(const Filling&) = delete;
  Filling& operator=(const Filling&) = delete;

  /// @param part with the same y and z as those before
  void Add(const Box& part, T value)
  {
    if (!this->Part.Empty() && this->Part.Lo.x == part.Hi.x &&
        std::memcmp(&this->Value, &value, sizeof(value)) == 0)
    {
      this->Part.Lo.x = part.Lo.x;
      return;
    }
    this->Finish();
    this->Part = part;
    this->Value = value;
  }

private:
  void Finish()
  {
    if (!this->Part.Empty())
    {
      const stages::In stage(stages::Copies);
      Fill(this->To, this->Part, this->Value);
    }
  }

  const Target<T>& To;
  Box Part;
  T Value{};
};

/// Decodes bricks that follow each other against x, as many at once as do.
class Decoding
{
public:
  using Body = std::function<void(std::int64_t first, int count, const Box& part)>;
  explicit Decoding(const Body& body)
    : Decode(body)
  {
  }

  /// @param part with the same y and z as those before
  void Add(std::int64_t brick, const Box& part)
  {
    if (this->Count > 0 && (this->First != brick + 1 || this->Part.Lo.x != part.Hi.x))
    {
      this->Finish();
    }
    this->Part = this->Count > 0 ? Box{ part.Lo, this->Part.Hi } : part;
    this->First = brick;
    ++this->Count;
  }
  /// To be called at the end.
  void Finish()
  {
    if (this->Count > 0)
    {
      this->Decode(this->First, this->Count, this->Part);
      this->Count = 0;
    }
  }

private:
  const Body& Decode;
  std::int64_t First = 0;
  int Count = 0;
  Box Part;
};

template <class T>
void Copy(const Target<T>& target, const Box& part, const BrickValues& brick)
{
  const int length = part.Size().x;
  const glm::ivec3 size = brick.Samples.Size();
  ForRows(target, part,
    [&](T* to, int x0, int y, int z)
    {
      const glm::ivec3 p = glm::ivec3(x0, y, z) - brick.Samples.Lo;
      const T* from = brick.As<T>() + (std::ptrdiff_t{ p.z } * size.y + p.y) * size.x + p.x;
      if (target.Stride == 1)
      {
        std::copy(from, from + length, to);
        return;
      }
      for (int x = 0; x < length; ++x)
      {
        to[x * target.Stride] = from[x];
      }
    });
}

/// The part of the region that a brick writes: what several bricks hold (equal in all of them) is
/// written by one, so that threads never meet.
Box PartOf(
  const BrickLayout& layout, const Box& bricks, const glm::ivec3& position, const Box& region)
{
  Box part = layout.SamplesOf(layout.IndexOf(position));
  for (int axis = 0; axis < 3; ++axis)
  {
    part.Hi[axis] -= position[axis] + 1 < bricks.Hi[axis] ? 1 : 0;
  }
  return Intersection(part, region);
}

/// Whether bricks are decoded to where they are wanted instead of into the cache.
/// @param bytes of the part
bool GoesPast(
  const BrickCache& cache, const SeriesFile& series, const FieldKey& field, std::uint64_t bytes)
{
  // Lattice numbers are kept where they are decoded (QuantizedBlockCache), and values are soon made
  // of them again, while bricks of the cache need memory, which the system clears, and are copied.
  constexpr std::uint64_t some = std::uint64_t{ 1 } << 20;
  return bytes >= cache.Budget() / 6 || (bytes >= some && series.StepOfValues(field) > 0);
}

/// How many bricks a thread reads at once: a row of them where that leaves enough for all threads.
int BricksTogether(std::int64_t bricks, int inRow)
{
  const std::int64_t enough = std::min(32, 4 * ThreadPool::Process().Width());
  return bricks / inRow >= enough ? inRow : 1;
}

template <class T>
void Read(
  BrickCache& cache, const SeriesFile& series, const FieldKey& field, const Target<T>& target)
{
  const BrickLayout layout = series.Layout(field.Level);
  const auto nodes = series.Nodes(field);
  const Box bricks = layout.BricksCovering(target.Samples);
  const glm::ivec3 size = bricks.Size();
  const std::int64_t count = bricks.Count();
  const bool past =
    GoesPast(cache, series, field, static_cast<std::uint64_t>(target.Samples.Count()) * sizeof(T));
  const Decoding::Body decode = [&](std::int64_t brick, int bricksInRow, const Box& part)
  {
    const glm::ivec3 length = target.Samples.Size();
    series.DecodeRow(field, brick, bricksInRow, part,
      { target.Stride, target.Stride * length.x,
        target.Stride * std::ptrdiff_t{ length.x } * length.y },
      target.RowAt(part.Lo.x, part.Lo.y, part.Lo.z));
  };
  const auto read = [&](const glm::ivec3& position, Filling<T>& filling, Decoding& decoding)
  {
    const std::int64_t brick = layout.IndexOf(position);
    const Box part = PartOf(layout, bricks, position, target.Samples);
    const BrickNode& node = (*nodes)[static_cast<std::size_t>(brick)];
    if (part.Empty())
    {
      return;
    }
    if (node.Uniform)
    {
      filling.Add(part, static_cast<T>(node.Range.Low));
    }
    else if (const auto held =
               past ? cache.GetIfHeld(series, field, node, brick) : cache.Get(series, field, brick))
    {
      Copy(target, part, *held);
    }
    else
    {
      decoding.Add(brick, part);
    }
  };
  const int together = BricksTogether(count, size.x);
  ThreadPool::Process().ParallelFor(count / together,
    [&](std::int64_t fromLast)
    {
      Filling<T> filling(target);
      Decoding decoding(decode);
      for (int k = 0; k < together; ++k)
      {
        // The last one first: a brick then finds the layers that it shares with others decoded.
        const std::int64_t i = count - 1 - (fromLast * together + k);
        read(bricks.Lo + glm::ivec3(static_cast<int>(i % size.x),
                           static_cast<int>(i / size.x % size.y),
                           static_cast<int>(i / size.x / size.y)),
          filling, decoding);
      }
      decoding.Finish();
    });
}

} // namespace

void ReadRegion(BrickCache& cache, const SeriesFile& series, const FieldKey& field,
  const Box& samples, void* values, int stride, int component)
{
  const Box whole = { glm::ivec3(0), series.Layout(field.Level).Samples() };
  if (!whole.Contains(samples))
  {
    throw Error("The region reaches beyond the samples of its level", { series.Path() });
  }
  if (component < 0 || component >= stride)
  {
    throw Error("The receiving array has no component " + std::to_string(component));
  }
  (void)series.Nodes(field); // checks the field, even for an empty region
  if (samples.Empty())
  {
    return;
  }
  Dispatch(series.Index().Arrays[static_cast<std::size_t>(field.Array)].Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      Read(cache, series, field, Target<T>{ static_cast<T*>(values) + component, samples, stride });
    });
}

} // namespace banyan
