// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/LatticeSampler.h"

#include "Base/ThreadPool.h"
#include "Render/Cells/CellTile.h"
#include "Render/Cells/RunCollector.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace banyan
{
namespace
{

constexpr std::int64_t CellsAtOnce = 4096;
constexpr std::size_t Ahead = 12; ///< cells that caches are asked for meanwhile
const glm::ivec3 BlockSize(RayTile::Edge, RayTile::Edge, SampleSlab::Rows);

/// Places that may be in a cell: from Lo to Hi, both included.
struct Reach
{
  glm::ivec3 Lo{ 0 };
  glm::ivec3 Hi{ -1 };

  bool Empty() const { return this->Hi.x < this->Lo.x; }
};

class Sampler
{
public:
  Sampler(const CellField& field, const PlacesInRows& places, std::vector<float>& values,
    std::vector<std::uint32_t>* owners, ThreadPool& pool)
    : Field(field)
    , Cells(*field.Cells)
    , Places(places)
    , Values(values)
    , Owners(owners)
    , Pool(pool)
    , Blocks((places.Count + BlockSize - 1) / BlockSize)
  {
  }

  void Sample()
  {
    this->Values.resize(this->Places.Size());
    if (this->Owners)
    {
      this->Owners->resize(this->Places.Size());
    }
    this->FindReaches();
    this->Sort();
    std::vector<std::unique_ptr<Scratch>> scratch(static_cast<std::size_t>(this->Pool.Width()));
    const std::int64_t blocks = std::int64_t{ this->Blocks.x } * this->Blocks.y * this->Blocks.z;
    const std::function<void(std::int64_t, int)> sample = [&](std::int64_t block, int worker)
    {
      std::unique_ptr<Scratch>& mine = scratch[static_cast<std::size_t>(worker)];
      if (!mine)
      {
        mine = std::make_unique<Scratch>();
        mine->Owners = this->Owners ? std::make_unique<SlabOwners>() : nullptr;
      }
      this->SampleBlock(static_cast<std::size_t>(block), *mine);
    };
    this->Pool.ParallelFor(blocks, sample);
  }

private:
  struct Scratch
  {
    RayTile Rays;
    TileRows Rows;
    SampleSlab Slab;
    std::vector<PlacedCell> Placed;
    std::vector<std::uint32_t> Items;
    std::unique_ptr<SlabOwners> Owners; ///< null where they are not wanted
  };

  void FindReaches()
  {
    const std::vector<std::uint32_t>& order = this->Cells.Order;
    this->Reaches.resize(order.size());
    const auto count = static_cast<std::int64_t>(order.size());
    this->Pool.ParallelFor((count + CellsAtOnce - 1) / CellsAtOnce,
      [&](std::int64_t chunk)
      {
        const auto begin = static_cast<std::size_t>(chunk * CellsAtOnce);
        const std::size_t end = std::min(begin + CellsAtOnce, order.size());
        for (std::size_t place = begin; place < end; ++place)
        {
          this->Cells.Mesh.PrefetchPlace(order[std::min(place + 2 * Ahead, order.size() - 1)]);
          this->Cells.Mesh.PrefetchCell(order[std::min(place + Ahead, order.size() - 1)]);
          this->Reaches[place] = this->ReachOf(order[place]);
        }
      });
  }

  Reach ReachOf(std::int64_t number) const
  {
    const MeshCell cell = this->Cells.Mesh.Cell(number);
    float values[8] = {};
    this->Field.CornerValues(number, cell, values);
    glm::dvec3 low(0.0);
    glm::dvec3 high(0.0);
    for (int i = 0; i < CornersOf(cell.Shape); ++i)
    {
      const glm::dvec3 at =
        this->Cells.ToIndex(this->Cells.Mesh.Point(cell.Points[static_cast<std::size_t>(i)]));
      low = i == 0 ? at : glm::min(low, at);
      high = i == 0 ? at : glm::max(high, at);
      if (!std::isfinite(values[i]))
      {
        return {};
      }
    }
    // Places somewhat beyond a cell's faces are its own.
    const glm::dvec3 margin = 0.001 * (high - low);
    Reach reach;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double unit = 1 << FractionBits;
      const auto first = static_cast<double>(this->Places.First[axis]);
      const auto step = static_cast<double>(this->Places.Step[axis]);
      const double most = this->Places.Count[axis];
      const double from = std::ceil(((low[axis] - margin[axis]) * unit - first) / step);
      const double to = std::floor(((high[axis] + margin[axis]) * unit - first) / step);
      reach.Lo[axis] = static_cast<int>(std::clamp(from, 0.0, most));
      reach.Hi[axis] = static_cast<int>(std::clamp(to, -1.0, most - 1.0));
      if (reach.Hi[axis] < reach.Lo[axis])
      {
        return {};
      }
    }
    return reach;
  }

  template <class Function>
  void ForBlocks(const Reach& reach, Function&& function) const
  {
    const glm::ivec3 first = reach.Lo / BlockSize;
    const glm::ivec3 last = reach.Hi / BlockSize;
    for (int z = first.z; z <= last.z; ++z)
    {
      for (int y = first.y; y <= last.y; ++y)
      {
        for (int x = first.x; x <= last.x; ++x)
        {
          const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(this->Blocks.y) +
                           static_cast<std::size_t>(y);
          function(row * static_cast<std::size_t>(this->Blocks.x) + static_cast<std::size_t>(x));
        }
      }
    }
  }

  /// Finds the cells that reach into each block, in the global order.
  void Sort()
  {
    const std::size_t blocks = static_cast<std::size_t>(this->Blocks.x) *
                               static_cast<std::size_t>(this->Blocks.y) *
                               static_cast<std::size_t>(this->Blocks.z);
    this->Begins.assign(blocks + 2, 0);
    const auto forAll = [&](auto&& function)
    {
      for (std::size_t i = 0; i < this->Reaches.size(); ++i)
      {
        if (!this->Reaches[i].Empty())
        {
          this->ForBlocks(this->Reaches[i], [&](std::size_t block) { function(block, i); });
        }
      }
    };
    forAll([&](std::size_t block, std::size_t) { ++this->Begins[block + 2]; });
    for (std::size_t i = 2; i < blocks + 2; ++i)
    {
      this->Begins[i] += this->Begins[i - 1];
    }
    this->Items.resize(this->Begins[blocks + 1]);
    forAll([&](std::size_t block, std::size_t cell)
      { this->Items[this->Begins[block + 1]++] = static_cast<std::uint32_t>(cell); });
  }

  void SampleBlock(std::size_t block, Scratch& scratch)
  {
    const auto number = static_cast<int>(block);
    const glm::ivec3 low =
      BlockSize * glm::ivec3(number % this->Blocks.x, number / this->Blocks.x % this->Blocks.y,
                    number / this->Blocks.x / this->Blocks.y);
    const glm::ivec3 size = glm::min(BlockSize, this->Places.Count - low);
    this->Place(low, size, scratch);
    scratch.Placed.clear();
    scratch.Items.clear();
    for (std::size_t i = this->Begins[block]; i < this->Begins[block + 1]; ++i)
    {
      const Reach& reach = this->Reaches[this->Items[i]];
      const glm::ivec3 first = glm::max(reach.Lo - low, glm::ivec3(0));
      const glm::ivec3 last = glm::min(reach.Hi - low, size - 1);
      PlacedCell placed;
      placed.Low = glm::vec2(first);
      placed.High = glm::vec2(last) + 0.5f;
      placed.Place = this->Items[i];
      placed.Border = this->Cells.BorderBits.empty() ? 0 : this->Cells.BorderBits[placed.Place];
      placed.Near = static_cast<float>(first.z) + 0.25f;
      placed.Far = static_cast<float>(last.z) + 0.75f;
      scratch.Items.push_back(static_cast<std::uint32_t>(scratch.Placed.size()));
      scratch.Placed.push_back(placed);
    }
    // Pixels are places, and so are intervals.
    DrawSlab({ this->Field, scratch.Placed.data(), scratch.Items.data(), scratch.Items.size(),
      glm::vec2(1.0f), 1.0, 0, nullptr, scratch.Rays, scratch.Rows, scratch.Slab,
      scratch.Owners.get() });
    this->Take(low, size, scratch);
  }

  /// Sets the rays of a block, and where their samples are.
  void Place(const glm::ivec3& low, const glm::ivec3& size, Scratch& scratch) const
  {
    RayTile& rays = scratch.Rays;
    TileRows& rows = scratch.Rows;
    rays.Rect = { glm::ivec2(0), glm::ivec2(size) };
    rays.Stride = 1;
    rays.Corner = glm::ivec2(0);
    rows.FirstNumber = 0.0;
    rows.Count = size.z;
    rows.AnyEnds = false;
    const std::int64_t step = this->Places.Step[2];
    for (int y = 0; y < RayTile::Edge; ++y)
    {
      for (int x = 0; x < RayTile::Edge; ++x)
      {
        const int slot = rays.SlotOf(x, y);
        const glm::ivec3 at = low + glm::ivec3(x, y, 0);
        for (int axis = 0; axis < 3; ++axis)
        {
          const std::int64_t position =
            this->Places.First[axis] + at[axis] * this->Places.Step[axis];
          rows.Zero[axis][slot] = static_cast<double>(position);
          rows.ZeroLow[axis][slot] = static_cast<std::uint32_t>(position);
          const std::int64_t along = axis == 2 ? step : 0;
          rows.Step[axis][slot] =
            static_cast<float>(static_cast<double>(along) / (1 << FractionBits));
          rays.WholeStep[axis][slot] = static_cast<double>(along);
          rays.Step[axis][slot] = static_cast<std::uint32_t>(along);
        }
        rows.First[slot] = 0;
        rows.End[slot] = x < size.x && y < size.y ? size.z : 0;
      }
    }
  }

  /// Takes the values out of the slab, and leaves it without.
  void Take(const glm::ivec3& low, const glm::ivec3& size, Scratch& scratch)
  {
    SampleSlab& slab = scratch.Slab;
    for (int z = 0; z < size.z; ++z)
    {
      for (int y = 0; y < size.y; ++y)
      {
        const std::size_t row = this->Places.IndexOf(low + glm::ivec3(0, y, z));
        for (int x = 0; x < size.x; ++x)
        {
          const int index = SampleSlab::IndexOf(scratch.Rays.SlotOf(x, y), z);
          const std::size_t at = row + static_cast<std::size_t>(x);
          this->Values[at] = slab.Value[index];
          slab.Value[index] = SampleSlab::Nothing;
          if (this->Owners)
          {
            (*this->Owners)[at] = scratch.Owners->Of[index] & ~SlabOwners::Contested;
          }
        }
      }
    }
    std::fill_n(slab.Marks, SampleSlab::Packets, std::uint64_t{ 0 });
  }

  const CellField& Field;
  const DrawnCells& Cells;
  const PlacesInRows& Places;
  std::vector<float>& Values;
  std::vector<std::uint32_t>* const Owners; ///< null where they are not wanted
  ThreadPool& Pool;
  const glm::ivec3 Blocks;
  std::vector<Reach> Reaches;       ///< in the global order of cells
  std::vector<std::size_t> Begins;  ///< of blocks, in Items
  std::vector<std::uint32_t> Items; ///< places of cells in the order
};

} // namespace

void SampleField(const CellField& field, const PlacesInRows& places, std::vector<float>& values,
  ThreadPool& pool, std::vector<std::uint32_t>* owners)
{
  Sampler(field, places, values, owners, pool).Sample();
}

} // namespace banyan
