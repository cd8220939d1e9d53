// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/OctreeFinder.h"

#include "Base/RadixSort.h"
#include "Mesh/Octree/CellPlacer.h"

#include <cmath>

namespace banyan
{
namespace
{

std::atomic<std::int64_t> Found{ 0 };

} // namespace

/// The order of corners that a thread has met last.
struct OctreeFinder::OrderMemory
{
  std::array<std::uint8_t, 8> Order{};
  int Number = -1;
};

OctreeFinder::OctreeFinder(ElementOctree& tree, ThreadPool& pool, double tolerance)
  : Tree(tree)
  , Pool(pool)
  , Tolerance(tolerance)
{
}

void OctreeFinder::Find()
{
  const MeshSurvey survey = SurveyMesh(this->Tree.Cells, this->Pool);
  this->AlignOrigin(survey);
  this->PlaceCells();
  this->SortLeaves();
  this->CheckLeaves();
  this->Tree.MakeStarts();
}

/// The lattice, moved down so that one of the largest cells begins at a multiple of its size.
void OctreeFinder::AlignOrigin(const MeshSurvey& survey)
{
  ElementOctree& tree = this->Tree;
  glm::dvec3 last;
  for (int axis = 0; axis < 3; ++axis)
  {
    const LatticeAxis lattice = FindLattice(survey, axis, this->Tolerance);
    tree.LatticeOrigin[axis] = lattice.Origin;
    tree.FinestEdge[axis] = lattice.Edge;
    tree.LatticeTolerance[axis] = lattice.Tolerance;
    last[axis] = (survey.Planes[axis].back() - lattice.Origin) / lattice.Edge;
  }
  const double longest = std::floor(survey.LongestEdge / tree.FinestEdge.x + 0.5);
  const double limit = static_cast<double>(MortonEdge);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!(last[axis] + longest < limit))
    {
      throw Error("The mesh is " + std::to_string(last[axis]) + " of its finest edges (" +
                  std::to_string(tree.FinestEdge[axis]) + ") long along " + "xyz"[axis] +
                  ", and an octree has at most 2097152");
    }
  }
  tree.CellNumbers = std::vector<std::uint32_t>{ static_cast<std::uint32_t>(survey.LongestCell) };
  DispatchMesh(tree.Cells,
    [&](const auto* points, const auto* ids)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        double low = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 8; ++i)
        {
          const auto id = static_cast<std::int64_t>(ids[8 * survey.LongestCell + i]);
          low = std::min(low, static_cast<double>(points[3 * id + axis]));
        }
        const double at =
          std::floor((low - tree.LatticeOrigin[axis]) / tree.FinestEdge[axis] + 0.5);
        const double over = std::fmod(at, longest);
        tree.LatticeOrigin[axis] -= over > 0.0 ? (longest - over) * tree.FinestEdge[axis] : 0.0;
      }
    });
}

void OctreeFinder::PlaceCells()
{
  ElementOctree& tree = this->Tree;
  const auto count = static_cast<std::size_t>(tree.Cells.CellCount);
  this->Keys.resize(count);
  this->LevelOfCell.resize(count);
  std::vector<std::uint16_t> orderOfCell(count);
  std::vector<OrderMemory> memories(static_cast<std::size_t>(this->Pool.Width()));
  DispatchMesh(tree.Cells,
    [&](const auto* points, const auto* ids)
    {
      const CellPlacer placer(tree, points, ids);
      FirstFailure failure;
      ForRuns(tree.Cells.CellCount, this->Pool, failure,
        [&](std::int64_t begin, std::int64_t end, int worker)
        {
          OrderMemory& memory = memories[static_cast<std::size_t>(worker)];
          for (std::int64_t cell = begin; cell < end; ++cell)
          {
            LatticeCell placed;
            const std::string problem = placer.Place(cell, placed);
            if (!problem.empty())
            {
              failure.Report(cell, problem);
              return;
            }
            const auto index = static_cast<std::size_t>(cell);
            this->Keys[index] = KeyOf(placed.Corner);
            this->LevelOfCell[index] = static_cast<std::uint8_t>(placed.Level);
            orderOfCell[index] = this->NumberOfOrder(placed.Order, memory);
          }
        });
    });
  tree.CornerOrders = std::move(this->Orders);
  if (tree.CornerOrders.size() > 1)
  {
    tree.OrderOfCell = std::move(orderOfCell);
  }
}

std::uint16_t OctreeFinder::NumberOfOrder(
  const std::array<std::uint8_t, 8>& order, OrderMemory& memory)
{
  if (memory.Number < 0 || memory.Order != order)
  {
    const std::lock_guard<std::mutex> lock(this->OrdersMutex);
    std::uint32_t bits = 0;
    for (const std::uint8_t place : order)
    {
      bits = bits << 3 | place;
    }
    const auto found = this->NumberOfOrders.emplace(bits, static_cast<int>(this->Orders.size()));
    memory.Number = found.first->second;
    memory.Order = order;
    if (found.second)
    {
      this->Orders.push_back(order);
    }
  }
  return static_cast<std::uint16_t>(memory.Number);
}

void OctreeFinder::SortLeaves()
{
  ElementOctree& tree = this->Tree;
  std::vector<std::uint32_t> cells(this->Keys.size());
  std::vector<std::uint8_t> levels(this->Keys.size());
  std::atomic<MortonKey> all{ 1 };
  FirstFailure failure;
  const auto forLeaves = [&](const auto& body)
  { ForRuns(tree.Cells.CellCount, this->Pool, failure, body); };
  forLeaves(
    [&](std::int64_t begin, std::int64_t end, int)
    {
      MortonKey bits = 0;
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        cells[i] = static_cast<std::uint32_t>(i);
        bits |= this->Keys[i];
      }
      all |= bits;
    });
  int bits = 1;
  while (bits < 63 && all >> bits != 0)
  {
    ++bits;
  }
  RadixSort(this->Keys, cells, bits, this->Pool);
  forLeaves(
    [&](std::int64_t begin, std::int64_t end, int)
    {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        levels[i] = this->LevelOfCell[cells[i]];
      }
    });
  this->LevelOfCell = {};
  tree.Keys = std::move(this->Keys);
  tree.CellNumbers = std::move(cells);
  tree.Levels = std::move(levels);
}

/// Overlaps, the domain, and what is left of it.
void OctreeFinder::CheckLeaves()
{
  struct Sum
  {
    CubeExtent Domain;
    int Coarsest = 0;
    std::int64_t Covered = 0;
  };
  ElementOctree& tree = this->Tree;
  std::vector<Sum> sums(static_cast<std::size_t>(this->Pool.Width()));
  FirstFailure failure;
  ForRuns(tree.LeafCount(), this->Pool, failure,
    [&](std::int64_t begin, std::int64_t end, int worker)
    {
      Sum& sum = sums[static_cast<std::size_t>(worker)];
      for (auto leaf = static_cast<std::size_t>(begin); leaf < static_cast<std::size_t>(end);
           ++leaf)
      {
        const int level = tree.Levels[leaf];
        if (leaf + 1 < tree.Keys.size() && tree.Keys[leaf + 1] - tree.Keys[leaf] < CubeKeys(level))
        {
          failure.Report(static_cast<std::int64_t>(leaf), this->OverlapAt(leaf));
          return;
        }
        sum.Domain.Include(tree.Keys[leaf], level);
        sum.Coarsest = std::max(sum.Coarsest, level);
        sum.Covered += static_cast<std::int64_t>(CubeKeys(level));
      }
    });
  std::int64_t covered = 0;
  for (const Sum& sum : sums)
  {
    tree.DomainCells = Union(tree.DomainCells, sum.Domain.Around());
    tree.CoarsestLeaf = std::max(tree.CoarsestLeaf, sum.Coarsest);
    covered += sum.Covered;
  }
  tree.Holes = tree.DomainCells.Count() - covered;
}

std::string OctreeFinder::OverlapAt(std::size_t leaf) const
{
  const std::uint32_t a = this->Tree.CellNumbers[leaf];
  const std::uint32_t b = this->Tree.CellNumbers[leaf + 1];
  return "Cells " + std::to_string(std::min(a, b)) + " and " + std::to_string(std::max(a, b)) +
         " overlap: no place may belong to two cells";
}

std::shared_ptr<const ElementOctree> ElementOctree::Find(
  const HexMesh& mesh, ThreadPool& pool, double tolerance)
{
  if (!(tolerance >= 0.0 && tolerance <= LargestTolerance))
  {
    throw Error("'Mesh Tolerance' (MeshTolerance) must be from 0 to 1/16 of the finest edge");
  }
  const std::shared_ptr<ElementOctree> tree(new ElementOctree());
  tree->Cells = mesh;
  OctreeFinder(*tree, pool, tolerance).Find();
  NodeFinder(*tree, pool).Find();
  if (tree->Cells.PointOwner)
  {
    // The hanging nodes are known: nobody asks for coordinates any more.
    tree->Cells.Points = nullptr;
    tree->Cells.PointOwner.reset();
  }
  ++Found;
  return tree;
}

std::int64_t ElementOctree::FoundSoFar()
{
  return Found;
}

} // namespace banyan
