// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellOrder.h"

#include "Base/Morton.h"
#include "Base/RadixSort.h"
#include "Base/ThreadPool.h"
#include "Cells/CellCorners.h"
#include "Cells/EqualRuns.h"
#include "Cells/PlaceHash.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

namespace banyan
{
namespace
{

constexpr int KeyBits = 3 * MortonBits;
constexpr std::int64_t RunCells = 16384;

/// Bits of the number of edges along the longest axis.
int SizeBits(const CellLattice& lattice)
{
  int bits = 0;
  while ((std::max({ lattice.Size.x, lattice.Size.y, lattice.Size.z }) - 1) >> bits != 0)
  {
    ++bits;
  }
  return bits;
}

/// Makes keys of cells.
class KeyMaker
{
public:
  explicit KeyMaker(const CellLattice& lattice)
    : Origin(lattice.Origin)
    , PerWorld(1.0 / lattice.Edge * (1 << (MortonBits - SizeBits(lattice) + FractionBits)))
  {
  }

  /// Corners are added up as integers: their order does not matter.
  MortonKey KeyOfCell(CellShape shape, const CellPlaces& places) const
  {
    // What is drawn has corners; nothing else may divide by zero.
    const auto corners = static_cast<std::uint32_t>(std::max(CornersOf(shape), 1));
    std::array<std::uint32_t, 3> sum{};
    for (std::size_t i = 0; i < corners; ++i)
    {
      const glm::dvec3 at = (places[i] - this->Origin) * this->PerWorld;
      sum[0] += static_cast<std::uint32_t>(static_cast<std::int32_t>(at.x));
      sum[1] += static_cast<std::uint32_t>(static_cast<std::int32_t>(at.y));
      sum[2] += static_cast<std::uint32_t>(static_cast<std::int32_t>(at.z));
    }
    MortonKey key = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const std::uint32_t middle = sum[axis] / (corners << FractionBits);
      key |= SpreadBits(std::min(middle, static_cast<std::uint32_t>(MortonEdge - 1))) << axis;
    }
    return key;
  }

private:
  /// More bits of corners than of keys, as many as leave room for the sum of eight.
  static constexpr int FractionBits = 7;
  glm::dvec3 Origin;
  double PerWorld;
};

/// Where the drawn cells of each run of cells begin among all, and their number.
std::vector<std::size_t> BeginsOfRuns(const CellMesh& mesh, const CellFacts& facts)
{
  std::vector<std::size_t> begins{ 0 };
  for (std::int64_t begin = 0; begin < mesh.CellCount; begin += RunCells)
  {
    const std::int64_t end = std::min(begin + RunCells, mesh.CellCount);
    std::size_t drawn = static_cast<std::size_t>(end - begin);
    if (!facts.LeftOut.empty())
    {
      drawn = static_cast<std::size_t>(
        std::count(facts.LeftOut.begin() + begin, facts.LeftOut.begin() + end, 0));
    }
    begins.push_back(begins.back() + drawn);
  }
  return begins;
}

/// The drawn cells with their keys, in the order of the mesh.
KeyedNumbers KeysOfCells(
  const CellMesh& mesh, const CellFacts& facts, const CellLattice& lattice, ThreadPool& pool)
{
  const std::vector<std::size_t> begins = BeginsOfRuns(mesh, facts);
  KeyedNumbers result(begins.back());
  const KeyMaker maker(lattice);
  WithCorners(mesh,
    [&](const auto& reader)
    {
      pool.ParallelFor(static_cast<std::int64_t>(begins.size()) - 1,
        [&](std::int64_t run)
        {
          std::size_t to = begins[static_cast<std::size_t>(run)];
          const std::int64_t end = std::min((run + 1) * RunCells, mesh.CellCount);
          for (std::int64_t cell = run * RunCells; cell < end; ++cell)
          {
            if (facts.Draws(cell))
            {
              const MeshCell is = mesh.Cell(cell);
              result.Keys[to] = maker.KeyOfCell(is.Shape, reader.At(cell, is));
              result.Values[to++] = static_cast<std::uint32_t>(cell);
            }
          }
        });
    });
  return result;
}

/// Stands for a cell that is there once more.
constexpr std::uint32_t Repeated = std::numeric_limits<std::uint32_t>::max();

/// Of the places of a cell's corners, in any order.
std::uint64_t HashOf(const CellMesh& mesh, const MeshCell& cell)
{
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(CornersOf(cell.Shape)); ++i)
  {
    hash += HashOfPlace(mesh.Point(cell.Points[i]));
  }
  return hash;
}

/// Brings cells into order whose keys agree in the bits that were sorted by.
class RunSorter
{
public:
  RunSorter(const CellMesh& mesh, KeyedNumbers& cells)
    : Mesh(mesh)
    , Sorted(cells)
  {
  }

  /// @param begin, end of cells that agree
  void Sort(std::size_t begin, std::size_t end)
  {
    this->Run.clear();
    for (std::size_t i = begin; i < end; ++i)
    {
      this->Run.push_back({ this->Sorted.Keys[i], 0, this->Sorted.Values[i] });
    }
    std::sort(this->Run.begin(), this->Run.end(),
      [](const Entry& a, const Entry& b)
      { return a.Key != b.Key ? a.Key < b.Key : a.Cell < b.Cell; });
    for (auto first = this->Run.begin(); first != this->Run.end();)
    {
      const auto last = std::find_if(
        first, this->Run.end(), [first](const Entry& entry) { return entry.Key != first->Key; });
      if (last - first > 1)
      {
        this->SortByHash(&*first, &*first + (last - first));
      }
      first = last;
    }
    for (std::size_t i = begin; i < end; ++i)
    {
      this->Sorted.Values[i] = this->Run[i - begin].Cell;
    }
  }

private:
  struct Entry
  {
    std::uint64_t Key;
    std::uint64_t Hash;
    std::uint32_t Cell;
  };

  void SortByHash(Entry* first, Entry* last) const
  {
    for (Entry* entry = first; entry != last; ++entry)
    {
      entry->Hash = HashOf(this->Mesh, this->Mesh.Cell(entry->Cell));
    }
    std::sort(first, last,
      [](const Entry& a, const Entry& b)
      { return a.Hash != b.Hash ? a.Hash < b.Hash : a.Cell < b.Cell; });
    for (Entry* entry = first; entry + 1 != last; ++entry)
    {
      if (entry->Hash == (entry + 1)->Hash)
      {
        entry->Cell = Repeated;
      }
    }
  }

  const CellMesh& Mesh;
  KeyedNumbers& Sorted;
  std::vector<Entry> Run;
};

/// Sorts all runs of cells whose keys agree from a bit on.
void SortRuns(const CellMesh& mesh, int firstBit, KeyedNumbers& cells, ThreadPool& pool)
{
  std::vector<RunSorter> sorters(static_cast<std::size_t>(pool.Width()), RunSorter(mesh, cells));
  ForEqualRuns(cells, firstBit, pool,
    [&](std::size_t begin, std::size_t end, int worker)
    {
      if (end - begin > 1)
      {
        sorters[static_cast<std::size_t>(worker)].Sort(begin, end);
      }
    });
}

} // namespace

std::vector<std::uint32_t> OrderOfCells(
  const CellMesh& mesh, const CellFacts& facts, const CellLattice& lattice, ThreadPool& pool)
{
  if (mesh.CellCount >= Repeated)
  {
    throw Error("The mesh has " + std::to_string(mesh.CellCount) +
                " cells, and a process draws fewer than 2^32: divide it among more processes");
  }
  KeyedNumbers cells = KeysOfCells(mesh, facts, lattice, pool);
  // Half an edge parts most cells: sorting by all bits would take longer than sorting the rest.
  // Whole digits take no longer than parts of them.
  const int halfEdges = 3 * (SizeBits(lattice) + 1);
  const int digits = (halfEdges + RadixDigitBits - 1) / RadixDigitBits;
  const int firstBit = std::max(0, KeyBits - digits * RadixDigitBits);
  RadixSort(cells, firstBit, KeyBits, pool);
  SortRuns(mesh, firstBit, cells, pool);
  std::vector<std::uint32_t> order(cells.Values.get(), cells.Values.get() + cells.Count);
  order.erase(std::remove(order.begin(), order.end(), Repeated), order.end());
  return order;
}

CellKey CellKeys::Of(std::int64_t number) const
{
  const MeshCell cell = this->Mesh.Cell(number);
  CellPlaces places{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(CornersOf(cell.Shape)); ++i)
  {
    places[i] = this->Mesh.Point(cell.Points[i]);
  }
  return { KeyMaker(this->Lattice).KeyOfCell(cell.Shape, places), HashOf(this->Mesh, cell) };
}

} // namespace banyan
