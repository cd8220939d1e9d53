// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/FieldQuantizer.h"

#include "Base/ForEachScalarType.h"
#include "Base/ThreadPool.h"
#include "Codec/BlockScratch.h"
#include "Series/Encode/BoundVerifier.h"
#include "Series/Format/FieldLattice.h"
#include "Series/Quantize/GatherTile.h"
#include "Series/Quantize/PlaneFilling.h"
#include "Series/Quantize/TransposedRows.h"

#include <algorithm>
#include <atomic>
#include <type_traits>

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

/// The tile that comes after one.
glm::ivec3 NextTile(const glm::ivec3& low, const glm::ivec3& samples)
{
  return low.x + Tile < samples.x   ? glm::ivec3{ low.x + Tile, low.y, low.z }
         : low.y + Tile < samples.y ? glm::ivec3{ 0, low.y + Tile, low.z }
         : low.z + Tile < samples.z ? glm::ivec3{ 0, 0, low.z + Tile }
                                    : low;
}

/// Whether a type has fast ways to the lattice and back.
template <class T>
constexpr bool IsReal = std::is_floating_point_v<T>;

} // namespace

template <class T>
FieldQuantizer<T>::FieldQuantizer(
  const FieldGroup& field, const group::FieldHead& head, ThreadPool& pool)
  : Field(field)
  , Head(head)
  , Pool(pool)
  , AxisOrder(field.Ablation.SmoothestAxisLast ? SmoothestLast<T>(field, field.Steps.back())
                                               : std::array<std::uint8_t, 3>{ 0, 1, 2 })
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
bool FieldQuantizer<T>::Plain() const
{
  return IsReal<T> && this->Field.Map.IsIdentity() && this->Fills.Empty();
}

template <class T>
LatticeScale FieldQuantizer<T>::Scale() const
{
  return { this->Head.Origin, this->Head.Step, this->Nearest, this->Furthest, this->Head.Least,
    this->Head.Greatest };
}

/// Values, at most a tile's row of them, to numbers one by one.
/// @param hidden of these; may be null
template <class T>
template <class Number>
void FieldQuantizer<T>::FillRow(
  const T* values, const std::uint8_t* hidden, int count, Number* numbers) const
{
  double y[Tile];
  for (int x = 0; x < count; ++x)
  {
    y[x] = static_cast<double>(values[x]);
  }
  if (count > 0 && !this->Field.Map.IsIdentity()) // g++ 16 warns without the first
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
    held[x] = held[x] && !this->Fills.Holds(values[x]) && (hidden == nullptr || hidden[x] == 0);
    all = all && held[x];
    const double number = held[x] ? (y[x] - this->Head.Origin) * inverse : 0.0;
    const double bounded =
      std::min(std::max(number, double(this->Head.Least)), double(this->Head.Greatest));
    numbers[x] = static_cast<Number>(static_cast<std::int32_t>((bounded + rounder) - rounder));
  }
  if (all)
  {
    return;
  }
  FillGaps(held, count, std::min(std::max(0, this->Head.Least), this->Head.Greatest), numbers);
}

/// Fills a tile from values that lie side by side where its numbers do.
/// @param next the first sample of the tile that comes next
/// @return false: some value is not held
template <class T>
template <class Number>
bool FieldQuantizer<T>::FillTileFast(const T* values, const glm::ivec3& low, const glm::ivec3& next,
  const glm::ivec3& n, PlaneNumbers& plane) const
{
  if constexpr (IsReal<T>)
  {
    const LatticeScale scale = this->Scale();
    const MemoryOrder order(this->Stride);
    const auto [u, v, w] = order.Axes;
    const bool inPlace = u == 0;
    Number tile[Tile * Tile * Tile];
    Number* const numbers = plane.Data<Number>();
    const glm::i64vec3 gaps{ 1, plane.Padded.x, std::int64_t{ plane.Padded.x } * plane.Padded.y };
    QuantizedRows<T, Number> rows;
    rows.Values = values + this->OffsetOf(low);
    rows.Gap = this->Stride[u];
    rows.ValueRow = this->Stride[v];
    rows.ValueSlice = this->Stride[w];
    rows.Numbers = inPlace ? numbers + plane.IndexOf(low) : tile;
    rows.NumberRow = inPlace ? gaps[v] : Tile;
    rows.NumberSlice = inPlace ? gaps[w] : Tile * Tile;
    rows.Count = n[u];
    rows.Rows = n[v];
    rows.Slices = n[w];
    rows.Next = this->OffsetOf(next) - this->OffsetOf(low);
    const bool all = QuantizeRows(rows, scale);
    // Rows of the tile along axis u become rows along x, for each place along the third one.
    const int third = 3 - u;
    for (int i = 0; !inPlace && i < n[third]; ++i)
    {
      glm::ivec3 slice(0);
      slice[third] = i;
      CopyTransposed<Number>(tile + order.PlaceOf(Tile, slice), order.PlaceOf(Tile, { 1, 0, 0 }),
        n.x, n[u], numbers + plane.IndexOf(low + slice), gaps[u]);
    }
    return all;
  }
  else
  {
    return false;
  }
}

template <class T>
template <class Number>
void FieldQuantizer<T>::FillTile(
  std::size_t step, const glm::ivec3& low, const glm::ivec3& next, PlaneNumbers& plane) const
{
  const T* const values = this->ValuesAt(step);
  const std::uint8_t* const hidden = this->Field.HiddenAt(step);
  const glm::ivec3 n = glm::min(glm::ivec3(Tile), plane.Samples - low);
  if (this->Plain() && hidden == nullptr && this->FillTileFast<Number>(values, low, next, n, plane))
  {
    return;
  }
  T tile[Tile * Tile * Tile];
  GatherTile(
    values + this->OffsetOf(low), this->Stride, n, glm::i64vec3{ 1, Tile, Tile * Tile }, tile);
  std::uint8_t hiddenTile[Tile * Tile * Tile];
  if (hidden != nullptr)
  {
    GatherTile(hidden + this->OffsetOf(low) / this->Field.Components,
      this->Stride / std::int64_t{ this->Field.Components }, n,
      glm::i64vec3{ 1, Tile, Tile * Tile }, hiddenTile);
  }
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      const int row = (z * Tile + y) * Tile;
      this->FillRow(tile + row, hidden != nullptr ? hiddenTile + row : nullptr, n.x,
        plane.Data<Number>() + plane.IndexOf(low + glm::ivec3(0, y, z)));
    }
  }
}

/// Gives invisible blocks the number of their interval.
template <class T>
template <class Number>
void FieldQuantizer<T>::HideBlocks(const T* values, PlaneNumbers& plane) const
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
          Number* row = plane.Data<Number>() + plane.IndexOf({ low.x, y, z });
          std::fill(row, row + std::min(plane.Edge, plane.Samples.x - low.x),
            static_cast<Number>(this->Hidden->NumberOf(interval)));
        }
      }
    });
}

template <class T>
std::vector<PlaneNumbers> FieldQuantizer<T>::NewPlanes() const
{
  std::vector<PlaneNumbers> planes;
  for (const glm::ivec3& samples : this->PlaneSamples)
  {
    planes.emplace_back(
      samples, this->Field.BrickCells, block::Narrow(this->Head.Least, this->Head.Greatest));
  }
  return planes;
}

template <class T>
void FieldQuantizer<T>::Make(std::size_t step, std::vector<PlaneNumbers>& planes) const
{
  const glm::ivec3 tiles = (this->PlaneSamples[0] + Tile - 1) / Tile;
  planes[0].With(
    [&](auto* numbers)
    {
      using Number = std::remove_pointer_t<decltype(numbers)>;
      this->Pool.ParallelFor(std::int64_t{ tiles.x } * tiles.y * tiles.z,
        [&](std::int64_t i)
        {
          const glm::ivec3 low = PositionIn(tiles, i) * Tile;
          this->FillTile<Number>(step, low, NextTile(low, planes[0].Samples), planes[0]);
        });
      if (this->Hidden)
      {
        this->HideBlocks<Number>(this->ValuesAt(step), planes[0]);
      }
      Pad<Number>(planes[0], glm::ivec3(0), planes[0].Samples);
      for (std::size_t p = 1; p < planes.size(); ++p)
      {
        Coarsen<Number>(planes[p - 1], planes[p]);
      }
    });
}

/// The plane after the finest one, straight from values.
/// @return false: some value is not held
template <class T>
template <class Number>
bool FieldQuantizer<T>::FillCoarser(const T* values, PlaneNumbers& coarse) const
{
  constexpr int most = 64;
  const LatticeScale scale = this->Scale();
  const glm::ivec3 last = this->PlaneSamples[0] - 1;
  std::atomic<bool> held{ true };
  this->Pool.ParallelFor(coarse.Samples.z,
    [&](std::int64_t slice)
    {
      const int z = static_cast<int>(slice);
      T some[most];
      QuantizedRows<T, Number> rows;
      rows.Values = some;
      rows.Rows = rows.Slices = 1;
      for (int y = 0; y < coarse.Samples.y; ++y)
      {
        const T* row =
          values + this->OffsetOf({ 0, std::min(4 * y, last.y), std::min(4 * z, last.z) });
        for (int x = 0; x < coarse.Samples.x; x += most)
        {
          rows.Count = std::min(most, coarse.Samples.x - x);
          rows.Numbers = coarse.Data<Number>() + coarse.IndexOf({ x, y, z });
          for (int i = 0; i < rows.Count; ++i)
          {
            some[i] = row[std::min(4 * (x + i), last.x) * this->Stride.x];
          }
          if (!QuantizeRows(rows, scale))
          {
            held = false;
          }
        }
      }
    });
  Pad<Number>(coarse, glm::ivec3(0), coarse.Samples);
  return held;
}

template <class T>
bool FieldQuantizer<T>::MakeCoarser(std::size_t step, std::vector<PlaneNumbers>& planes) const
{
  bool apart =
    this->Plain() && this->Field.HiddenAt(step) == nullptr && !this->Hidden && planes.size() > 1;
  if constexpr (IsReal<T>)
  {
    planes[0].With(
      [&](auto* numbers)
      {
        using Number = std::remove_pointer_t<decltype(numbers)>;
        apart = apart && this->FillCoarser<Number>(this->ValuesAt(step), planes[1]);
        for (std::size_t p = 2; apart && p < planes.size(); ++p)
        {
          Coarsen<Number>(planes[p - 1], planes[p]);
        }
      });
  }
  if (!apart)
  {
    this->Make(step, planes);
  }
  return apart;
}

template <class T>
void FieldQuantizer<T>::MakeBlock(std::size_t step, std::int64_t block, PlaneNumbers& plane) const
{
  const glm::ivec3 position = PositionIn(plane.Blocks, block);
  const glm::ivec3 low = position * plane.Edge;
  const glm::ivec3 high = glm::min(low + plane.Edge, plane.Samples);
  const glm::ivec3 next = plane.BlockBefore(position) * plane.Edge - low;
  plane.With(
    [&](auto* numbers)
    {
      using Number = std::remove_pointer_t<decltype(numbers)>;
      for (int z = low.z; z < high.z; z += Tile)
      {
        for (int y = low.y; y < high.y; y += Tile)
        {
          for (int x = low.x; x < high.x; x += Tile)
          {
            const glm::ivec3 tile{ x, y, z };
            this->FillTile<Number>(step, tile, tile + next, plane);
          }
        }
      }
      Pad<Number>(plane, low, high);
    });
}

template <class T>
void FieldQuantizer<T>::Verify(std::size_t step, const PlaneNumbers& decoded, int plane,
  std::int64_t block, ExceptionList<T>& list, FieldErrors& errors,
  std::vector<double>* squares) const
{
  BoundVerifier<T> check(this->Field, this->Head, this->Decoder, this->Fills, this->Hidden.get(),
    this->Stride, this->PlaneSamples[0] - 1, this->ValuesAt(step), this->Field.HiddenAt(step));
  check.Block(decoded, plane, block, list, errors, squares);
}

#define BANYAN_INSTANTIATE(T) template class FieldQuantizer<T>
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
