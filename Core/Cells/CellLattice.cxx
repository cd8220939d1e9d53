// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellLattice.h"

#include "Base/FirstFailure.h"
#include "Base/ThreadPool.h"
#include "Cells/CellCorners.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

struct CellEdges
{
  int Count = 0;
  std::array<std::pair<int, int>, 12> Ends{};
};

const CellEdges& EdgesOf(CellShape shape)
{
  static const CellEdges tetrahedron{ 6,
    { { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } } } };
  static const CellEdges pyramid{ 8,
    { { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 }, { 1, 4 }, { 2, 4 }, { 3, 4 } } } };
  static const CellEdges wedge{ 9, { { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 },
                                     { 0, 3 }, { 1, 4 }, { 2, 5 } } } };
  static const CellEdges hexahedron{ 12,
    { { { 0, 1 }, { 2, 3 }, { 4, 5 }, { 6, 7 }, { 0, 2 }, { 1, 3 }, { 4, 6 }, { 5, 7 }, { 0, 4 },
      { 1, 5 }, { 2, 6 }, { 3, 7 } } } };
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return tetrahedron;
    case CellShape::Pyramid:
      return pyramid;
    case CellShape::Wedge:
      return wedge;
    default:
      return hexahedron;
  }
}

/// Adds the lengths of a cell's edges. No logarithm is needed: the exponent of a square is twice
/// that of the length, and where it is odd the length lies above the middle.
void CountEdges(CellShape shape, const CellPlaces& places, CellExtent& extent)
{
  const CellEdges& edges = EdgesOf(shape);
  for (std::size_t i = 0; i < static_cast<std::size_t>(edges.Count); ++i)
  {
    const glm::dvec3 along = places[static_cast<std::size_t>(edges.Ends[i].first)] -
                             places[static_cast<std::size_t>(edges.Ends[i].second)];
    const double square = along.x * along.x + along.y * along.y + along.z * along.z;
    if (square > 0.0)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &square, sizeof(bits));
      const int exponent = static_cast<int>(bits >> 52) - 1023;
      ++extent.Edges[static_cast<std::size_t>(((exponent + 1) >> 1) - CellExtent::LowestExponent)];
    }
  }
}

void AddCells(const CellMesh& mesh, const CellFacts& facts, std::int64_t begin, std::int64_t end,
  CellExtent& extent)
{
  WithCorners(mesh,
    [&](const auto& reader)
    {
      for (std::int64_t cell = begin; cell < end; ++cell)
      {
        if (!facts.Draws(cell))
        {
          continue;
        }
        const MeshCell is = mesh.Cell(cell);
        const CellPlaces places = reader.At(cell, is);
        for (std::size_t i = 0; i < static_cast<std::size_t>(CornersOf(is.Shape)); ++i)
        {
          extent.Low = glm::min(extent.Low, places[i]);
          extent.High = glm::max(extent.High, places[i]);
        }
        CountEdges(is.Shape, places, extent);
      }
    });
}

/// The power of two next to the median length.
int MedianExponent(const CellExtent& extent)
{
  const std::int64_t all =
    std::accumulate(extent.Edges.begin(), extent.Edges.end(), std::int64_t{ 0 });
  std::int64_t below = 0;
  for (std::size_t i = 0; i < extent.Edges.size(); ++i)
  {
    below += extent.Edges[i];
    if (below > 0 && 2 * below >= all)
    {
      return static_cast<int>(i) + CellExtent::LowestExponent;
    }
  }
  throw Error("The mesh has no cells that can be drawn");
}

} // namespace

void CellExtent::Include(const CellExtent& other)
{
  this->Low = glm::min(this->Low, other.Low);
  this->High = glm::max(this->High, other.High);
  for (std::size_t i = 0; i < this->Edges.size(); ++i)
  {
    this->Edges[i] += other.Edges[i];
  }
}

CellExtent ExtentOf(const CellMesh& mesh, const CellFacts& facts, ThreadPool& pool)
{
  std::vector<CellExtent> parts(static_cast<std::size_t>(pool.Width()));
  FirstFailure none;
  ForRuns(mesh.CellCount, pool, none,
    [&](std::int64_t begin, std::int64_t end, int worker)
    { AddCells(mesh, facts, begin, end, parts[static_cast<std::size_t>(worker)]); });
  CellExtent whole;
  for (const CellExtent& part : parts)
  {
    whole.Include(part);
  }
  return whole;
}

CellLattice LatticeOf(const CellExtent& extent)
{
  CellLattice lattice;
  lattice.Edge = std::ldexp(1.0, MedianExponent(extent));
  glm::dvec3 size(0.0);
  while (true)
  {
    lattice.Origin = glm::floor(extent.Low / lattice.Edge) * lattice.Edge;
    size = glm::max(glm::ceil(lattice.ToLattice(extent.High)), glm::dvec3(1.0));
    if (std::max({ size.x, size.y, size.z }) <= CellLattice::MostEdges)
    {
      break;
    }
    lattice.Edge *= 2.0;
  }
  lattice.Size = glm::ivec3(size);
  return lattice;
}

} // namespace banyan
