#include "Series/LatticeTarget.h"

#include "Base/ForEachScalarType.h"
#include "Base/ThreadPool.h"
#include "Series/FieldLattice.h"
#include "Series/GatherTile.h"
#include "Series/LatticeCheck.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr int Tile = 16;

glm::ivec3 PositionIn(const glm::ivec3& size, std::int64_t index)
{
  return { static_cast<int>(index % size.x), static_cast<int>(index / size.x % size.y),
    static_cast<int>(index / size.x / size.y) };
}

glm::i64vec3 StridesOf(const FieldGroup& field)
{
  const std::int64_t row = std::int64_t{ field.Components } * field.Samples.x;
  return { field.Components, row, row * field.Samples.y };
}

/// Numbers for samples that are not held: on the line between those around, so that predictions
/// cost nothing there.
/// @param otherwise when none is held
void FillGaps(const bool* held, int count, std::int32_t otherwise, std::int32_t* numbers)
{
  int before = -1;
  for (int x = 0; x < count;)
  {
    if (held[x])
    {
      before = x++;
      continue;
    }
    const int after = static_cast<int>(std::find(held + x, held + count, true) - held);
    const std::int64_t right = after < count ? numbers[after] : before >= 0 ? numbers[before] : otherwise;
    const std::int64_t left = before >= 0 ? numbers[before] : right;
    for (; x < after; ++x)
    {
      numbers[x] = static_cast<std::int32_t>(left + (right - left) * (x - before) / (after - before));
    }
  }
}

/// Repeats the last samples beyond the field's end.
void Pad(PlaneNumbers& plane)
{
  const glm::ivec3 n = plane.Samples;
  const auto row = [&plane](int y, int z) {
    return plane.Numbers.data() + plane.IndexOf({ 0, y, z });
  };
  for (int z = 0; z < plane.Padded.z; ++z)
  {
    for (int y = 0; y < plane.Padded.y; ++y)
    {
      std::int32_t* to = row(y, z);
      if (y >= n.y || z >= n.z)
      {
        const std::int32_t* from = row(std::min(y, n.y - 1), std::min(z, n.z - 1));
        std::copy(from, from + plane.Padded.x, to);
      }
      else
      {
        std::fill(to + n.x, to + plane.Padded.x, to[n.x - 1]);
      }
    }
  }
}

/// Every fourth sample.
PlaneNumbers Coarser(const PlaneNumbers& fine)
{
  PlaneNumbers coarse(CoarserSamples(fine.Samples), fine.Edge);
  const glm::ivec3 last = fine.Samples - 1;
  for (int z = 0; z < coarse.Samples.z; ++z)
  {
    for (int y = 0; y < coarse.Samples.y; ++y)
    {
      for (int x = 0; x < coarse.Samples.x; ++x)
      {
        const std::int64_t from = fine.IndexOf(
          { std::min(4 * x, last.x), std::min(4 * y, last.y), std::min(4 * z, last.z) });
        coarse.Numbers[static_cast<std::size_t>(coarse.IndexOf({ x, y, z }))] =
          fine.Numbers[static_cast<std::size_t>(from)];
      }
    }
  }
  Pad(coarse);
  return coarse;
}

} // namespace

template <class T>
std::array<std::uint8_t, 3> SmoothestLast(const FieldGroup& field, const void* step)
{
  const T* values = static_cast<const T*>(step);
  const glm::i64vec3 stride = StridesOf(field);
  // A sparse grid of samples is enough to tell the axes apart.
  glm::ivec3 gap;
  for (int a = 0; a < 3; ++a)
  {
    gap[a] = std::max(1, field.Samples[a] / 24);
  }
  double roughness[3] = {};
  // No outlier decides alone.
  const double most =
    field.Expected.Empty() ? std::numeric_limits<double>::max() : field.Expected.Width();
  for (int a = 0; a < 3; ++a)
  {
    if (field.Samples[a] < 3)
    {
      roughness[a] = std::numeric_limits<double>::infinity();
      continue;
    }
    for (int z = a == 2 ? 1 : 0; z < field.Samples.z - (a == 2 ? 1 : 0); z += gap.z)
    {
      for (int y = a == 1 ? 1 : 0; y < field.Samples.y - (a == 1 ? 1 : 0); y += gap.y)
      {
        for (int x = a == 0 ? 1 : 0; x < field.Samples.x - (a == 0 ? 1 : 0); x += gap.x)
        {
          const T* at = values + x * stride.x + y * stride.y + z * stride.z;
          const double bend = static_cast<double>(at[stride[a]]) +
                              static_cast<double>(at[-stride[a]]) -
                              2.0 * static_cast<double>(at[0]);
          roughness[a] += std::isfinite(bend) ? std::min(std::abs(bend), most) : 0.0;
        }
      }
    }
  }
  std::array<std::uint8_t, 3> axes{ 0, 1, 2 };
  // Only what is clearly smoother goes behind, so that groups that are alike have the same order and
  // may refer to each other.
  constexpr double clearly = 1.125;
  for (const std::size_t a : { 0, 1, 0 })
  {
    if (roughness[axes[a]] * clearly < roughness[axes[a + 1]])
    {
      std::swap(axes[a], axes[a + 1]);
    }
  }
  return axes;
}

template <class T>
LatticeTarget<T>::LatticeTarget(
  const FieldGroup& field, const group::FieldHead& head, ThreadPool& pool)
  : Field(field)
  , Head(head)
  , Pool(pool)
  , AxisOrder(SmoothestLast<T>(field, field.Steps.back()))
  , Decoder(field.Map, head.Origin, head.Step, head.Least, head.Greatest)
  , Fills(field.FillValues)
{
  const glm::i64vec3 real = StridesOf(field);
  glm::ivec3 samples;
  for (int a = 0; a < 3; ++a)
  {
    samples[a] = field.Samples[this->AxisOrder[static_cast<std::size_t>(a)]];
    this->Stride[a] = real[this->AxisOrder[static_cast<std::size_t>(a)]];
  }
  this->PlaneSamples = group::PlanesOf(samples);
  // A value further out than the range is wide would spoil the predictions around it.
  const double low = head.Origin + head.Least * head.Step;
  const double high = head.Origin + head.Greatest * head.Step;
  // The lattice of a field with values beyond what is expected is that much wider already.
  const double width = field.Expected.Empty() ? GreatestLatticeNumber * head.Step
                       : field.Beyond         ? 0.0
                                              : high - low;
  this->Nearest = low - width - head.Step;
  this->Furthest = high + width + head.Step;
  auto hidden = std::make_unique<InvisibleBlocks<T>>(
    field, head, this->Decoder, this->PlaneSamples[0], this->Stride);
  if (hidden->Any())
  {
    this->Hidden = std::move(hidden);
  }
}

template <class T>
void LatticeTarget<T>::FillRow(
  const T* values, int count, std::int32_t* numbers) const
{
  double y[Tile];
  for (int x = 0; x < count; ++x)
  {
    y[x] = static_cast<double>(values[x]);
  }
  if (!this->Field.Map.IsIdentity())
  {
    this->Field.Map.Forward(y, static_cast<std::size_t>(count), y);
  }
  const double inverse = 1.0 / this->Head.Step;
  constexpr double rounder = 6755399441055744.0; // 1.5 * 2^52: adding it rounds
  bool held[Tile];
  bool all = true;
  for (int x = 0; x < count; ++x)
  {
    held[x] = y[x] >= this->Nearest && y[x] <= this->Furthest; // not for NaN
    held[x] = held[x] && !this->Fills.Holds(values[x]);
    all = all && held[x];
    const double number = held[x] ? (y[x] - this->Head.Origin) * inverse : 0.0;
    const double bounded =
      std::min(std::max(number, double(this->Head.Least)), double(this->Head.Greatest));
    numbers[x] = static_cast<std::int32_t>((bounded + rounder) - rounder);
  }
  if (all)
  {
    return;
  }
  FillGaps(held, count, std::min(std::max(0, this->Head.Least), this->Head.Greatest), numbers);
}

template <class T>
void LatticeTarget<T>::FillTile(const T* values, const glm::ivec3& low, PlaneNumbers& plane) const
{
  const glm::ivec3 n = glm::min(glm::ivec3(Tile), plane.Samples - low);
  T tile[Tile * Tile * Tile];
  GatherTile(values + low.x * this->Stride.x + low.y * this->Stride.y + low.z * this->Stride.z,
    this->Stride, n, glm::i64vec3{ 1, Tile, Tile * Tile }, tile);
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      this->FillRow(tile + (z * Tile + y) * Tile, n.x,
        plane.Numbers.data() + plane.IndexOf(low + glm::ivec3(0, y, z)));
    }
  }
}

/// Gives invisible blocks the number of their interval.
template <class T>
void LatticeTarget<T>::HideBlocks(const T* values, PlaneNumbers& plane) const
{
  this->Pool.ParallelFor(plane.BlockCount(),
    [&](std::int64_t i)
    {
      const glm::ivec3 position = PositionIn(plane.Blocks, i);
      const int interval = this->Hidden->IntervalOf(values, position);
      if (interval < 0)
      {
        return;
      }
      const glm::ivec3 low = position * plane.Edge;
      for (int z = low.z; z < std::min(low.z + plane.Edge, plane.Samples.z); ++z)
      {
        for (int y = low.y; y < std::min(low.y + plane.Edge, plane.Samples.y); ++y)
        {
          std::int32_t* row = plane.Numbers.data() + plane.IndexOf({ low.x, y, z });
          std::fill(row, row + std::min(plane.Edge, plane.Samples.x - low.x),
            this->Hidden->NumberOf(interval));
        }
      }
    });
}

template <class T>
std::vector<PlaneNumbers> LatticeTarget<T>::Make(const void* values) const
{
  std::vector<PlaneNumbers> planes;
  planes.emplace_back(this->PlaneSamples[0], this->Field.BrickCells);
  const glm::ivec3 tiles = (this->PlaneSamples[0] + Tile - 1) / Tile;
  this->Pool.ParallelFor(std::int64_t{ tiles.x } * tiles.y * tiles.z, [&](std::int64_t i)
    { this->FillTile(static_cast<const T*>(values), PositionIn(tiles, i) * Tile, planes[0]); });
  if (this->Hidden)
  {
    this->HideBlocks(static_cast<const T*>(values), planes[0]);
  }
  Pad(planes[0]);
  while (planes.size() < this->PlaneSamples.size())
  {
    planes.push_back(Coarser(planes.back()));
  }
  return planes;
}

template <class T>
void LatticeTarget<T>::Verify(const void* values, const PlaneNumbers& decoded, int plane,
  std::int64_t block, ExceptionList<T>& list, FieldErrors& errors,
  std::vector<double>* squares) const
{
  LatticeCheck<T> check(this->Field, this->Head, this->Decoder, this->Fills, this->Hidden.get(),
    this->Stride, this->PlaneSamples[0] - 1, static_cast<const T*>(values));
  check.Block(decoded, plane, block, list, errors, squares);
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template std::array<std::uint8_t, 3> SmoothestLast<T>(const FieldGroup&, const void*);           \
  template class LatticeTarget<T>
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
