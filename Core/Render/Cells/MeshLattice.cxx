// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/MeshLattice.h"

#include "Base/ThreadPool.h"
#include "Render/Scene/RayLattice.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace banyan
{
namespace
{

/// Places around the mesh: rays leave cells of the lattice that have some corners outside.
constexpr int Around = 2;
constexpr std::size_t AtOnce = 65536;

template <class Function>
void ForRuns(std::size_t count, ThreadPool& pool, Function&& function)
{
  pool.ParallelFor(static_cast<std::int64_t>((count + AtOnce - 1) / AtOnce),
    [&](std::int64_t run)
    {
      const std::size_t begin = static_cast<std::size_t>(run) * AtOnce;
      for (std::size_t i = begin; i < std::min(begin + AtOnce, count); ++i)
      {
        function(i);
      }
    });
}

template <class Function>
void ForPlaces(const glm::ivec3& low, const glm::ivec3& high, Function&& function)
{
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      for (int x = low.x; x < high.x; ++x)
      {
        function(glm::ivec3(x, y, z));
      }
    }
  }
}

} // namespace

PlacesInRows MeshLattice::PlacesFor(const DrawnCells& cells, double edge)
{
  // Of the mesh, without the room around it.
  const glm::dvec3 low = cells.ToIndex(cells.Low);
  const glm::dvec3 high = cells.ToIndex(cells.High);
  PlacesInRows places;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double first = std::floor(low[axis] / edge) - Around;
    const double last = std::ceil(high[axis] / edge) + Around;
    const double step = edge * (1 << FractionBits);
    places.Step[axis] = static_cast<std::int64_t>(step);
    places.First[axis] = static_cast<std::int64_t>(first * step);
    places.Count[axis] = static_cast<int>(last - first) + 1;
  }
  return places;
}

MeshLattice::MeshLattice(
  const CellField& field, double edge, const MeshLattice* finer, ThreadPool& pool)
  : At(PlacesFor(*field.Cells, edge))
{
  if (finer)
  {
    this->TakeFrom(*finer, finer->Numbers, this->Numbers, pool);
  }
  else
  {
    SampleField(field, this->At, this->Numbers, pool);
  }
  this->Finish(*field.Cells, pool);
}

MeshLattice::MeshLattice(
  const DrawnCells& cells, double edge, std::vector<float> values, ThreadPool& pool)
  : At(PlacesFor(cells, edge))
  , Numbers(std::move(values))
{
  this->Finish(cells, pool);
}

/// Says in the lowest bits of values what is known of places, and lets values go on.
void MeshLattice::Finish(const DrawnCells& cells, ThreadPool& pool)
{
  std::vector<std::uint8_t> bits(this->Numbers.size(), 1);
  this->FindBorderCells(cells, bits);
  this->Without = this->PlacesWithout(bits);
  ForRuns(bits.size(), pool,
    [&](std::size_t i)
    {
      const bool inside = std::isfinite(this->Numbers[i]);
      const std::uint32_t cell = bits[i] == 0 ? AtBorder : inside ? Inside : Outside;
      bits[i] = static_cast<std::uint8_t>(cell | (inside ? PlaceBit : 0));
    });
  this->Widen(this->Numbers, pool);
  ForRuns(bits.size(), pool,
    [&](std::size_t i)
    {
      std::uint32_t number = 0;
      std::memcpy(&number, &this->Numbers[i], sizeof(number));
      number = (number & ~(CellBits | PlaceBit)) | bits[i];
      std::memcpy(&this->Numbers[i], &number, sizeof(number));
    });
}

CellField MeshLattice::SlopeOf(const CellField& field, std::size_t axis)
{
  CellField slope;
  slope.Cells = field.Cells;
  slope.Values.resize(field.Gradients.size() / 3);
  for (std::size_t i = 0; i < slope.Values.size(); ++i)
  {
    slope.Values[i] = field.Gradients[3 * i + axis];
  }
  return slope;
}

void MeshLattice::AddGradients(const CellField& field, const MeshLattice* finer, ThreadPool& pool)
{
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    std::vector<float> slopes;
    if (finer)
    {
      this->TakeFrom(*finer, finer->Slopes[axis], slopes, pool);
    }
    else
    {
      SampleField(SlopeOf(field, axis), this->At, slopes, pool);
    }
    this->AddSlopes(axis, std::move(slopes), pool);
  }
}

void MeshLattice::AddSlopes(std::size_t axis, std::vector<float> slopes, ThreadPool& pool)
{
  this->Slopes[axis] = std::move(slopes);
  this->Widen(this->Slopes[axis], pool);
}

/// Takes values of places that a finer lattice has, too, and that are in the mesh.
void MeshLattice::TakeFrom(const MeshLattice& finer, const std::vector<float>& from,
  std::vector<float>& values, ThreadPool& pool) const
{
  const PlacesInRows& fine = finer.At;
  const glm::ivec3 size = this->At.Count;
  values.resize(this->At.Size());
  pool.ParallelFor(size.z,
    [&](std::int64_t layer)
    {
      const auto z = static_cast<int>(layer);
      ForPlaces({ 0, 0, z }, { size.x, size.y, z + 1 },
        [&](const glm::ivec3& at)
        {
          glm::ivec3 there;
          bool within = true;
          for (int axis = 0; axis < 3; ++axis)
          {
            const std::int64_t position = this->At.First[axis] + at[axis] * this->At.Step[axis];
            const std::int64_t number = (position - fine.First[axis]) / fine.Step[axis];
            within = within && position >= fine.First[axis] && number < fine.Count[axis];
            there[axis] = static_cast<int>(number);
          }
          float value = std::numeric_limits<float>::quiet_NaN();
          if (within)
          {
            const std::size_t place = fine.IndexOf(there);
            std::uint32_t bits = 0;
            std::memcpy(&bits, &finer.Numbers[place], sizeof(bits));
            value = (bits & PlaceBit) != 0 ? from[place] : value;
          }
          values[this->At.IndexOf(at)] = value;
        });
    });
}

std::size_t MeshLattice::Bytes() const
{
  return (this->Numbers.capacity() + this->Slopes[0].capacity() + this->Slopes[1].capacity() +
           this->Slopes[2].capacity()) *
           sizeof(float) +
         this->Without.capacity() * sizeof(this->Without[0]);
}

/// Sets 0 for cells of the lattice that a face at the border may go through.
void MeshLattice::FindBorderCells(const DrawnCells& cells, std::vector<std::uint8_t>& border) const
{
  for (const BorderFace& face : cells.Border)
  {
    const MeshCell cell = cells.Mesh.Cell(cells.Order[face.Cell]);
    const CellFace& part = FacesOf(cell.Shape).Faces[face.Face];
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high(-low);
    for (int i = 0; i < part.Count; ++i)
    {
      const auto corner = static_cast<std::size_t>(part.Corners[static_cast<std::size_t>(i)]);
      const glm::dvec3 at = cells.ToIndex(cells.Mesh.Point(cell.Points[corner]));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    glm::ivec3 first;
    glm::ivec3 last;
    for (int axis = 0; axis < 3; ++axis)
    {
      // Somewhat more, for rounding.
      constexpr double little = 0.01;
      const auto step = static_cast<double>(this->At.Step[axis]);
      const auto from = static_cast<double>(this->At.First[axis]);
      first[axis] =
        static_cast<int>(std::floor((low[axis] * (1 << FractionBits) - from) / step - little));
      last[axis] =
        static_cast<int>(std::floor((high[axis] * (1 << FractionBits) - from) / step + little));
    }
    ForPlaces(glm::max(first, glm::ivec3(0)), glm::min(last + 1, this->At.Count),
      [&](const glm::ivec3& at) { border[this->At.IndexOf(at)] = 0; });
  }
}

/// Corners of cells at the border that have no value.
std::vector<std::size_t> MeshLattice::PlacesWithout(const std::vector<std::uint8_t>& border) const
{
  std::vector<std::size_t> without;
  const glm::ivec3 size = this->At.Count;
  ForPlaces(glm::ivec3(1), size,
    [&](const glm::ivec3& at)
    {
      const std::size_t place = this->At.IndexOf(at);
      bool beside = false;
      for (int i = 0; i < 8 && !std::isfinite(this->Numbers[place]); ++i)
      {
        beside =
          beside || border[this->At.IndexOf(at - glm::ivec3(i & 1, i >> 1 & 1, i >> 2))] == 0;
      }
      if (beside)
      {
        without.push_back(place);
      }
    });
  return without;
}

/// What goes on at a place: the mean of lines through two places behind each other along axes, or
/// of the nearest values. NaN where there are none.
float MeshLattice::ValueBeside(const std::vector<float>& values, const glm::ivec3& at) const
{
  const auto valueAt = [&](const glm::ivec3& place)
  {
    const bool within = glm::all(glm::greaterThanEqual(place, glm::ivec3(0))) &&
                        glm::all(glm::lessThan(place, this->At.Count));
    return within ? values[this->At.IndexOf(place)] : std::numeric_limits<float>::quiet_NaN();
  };
  float sum = 0.0f;
  float count = 0.0f;
  for (int axes = 1; axes <= 3 && count == 0.0f; ++axes)
  {
    for (int i = 0; i < 27; ++i)
    {
      const glm::ivec3 way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const float near = glm::dot(glm::vec3(way), glm::vec3(way)) == static_cast<float>(axes)
                           ? valueAt(at + way)
                           : std::numeric_limits<float>::quiet_NaN();
      if (std::isfinite(near))
      {
        const float next = valueAt(at + 2 * way);
        sum += std::isfinite(next) ? 2.0f * near - next : near;
        count += 1.0f;
      }
    }
  }
  return count > 0.0f ? sum / count : std::numeric_limits<float>::quiet_NaN();
}

/// Lets values go on at places of Without.
void MeshLattice::Widen(std::vector<float>& values, ThreadPool& pool) const
{
  std::vector<float> found(this->Without.size());
  for (int round = 0; round < Around; ++round)
  {
    ForRuns(found.size(), pool,
      [&](std::size_t i)
      {
        const auto place = static_cast<std::int64_t>(this->Without[i]);
        const glm::ivec3 size = this->At.Count;
        const glm::ivec3 at(static_cast<int>(place % size.x),
          static_cast<int>(place / size.x % size.y), static_cast<int>(place / size.x / size.y));
        const float value = values[this->Without[i]];
        found[i] = std::isfinite(value) ? value : this->ValueBeside(values, at);
      });
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      values[this->Without[i]] = found[i];
    }
  }
}

} // namespace banyan
