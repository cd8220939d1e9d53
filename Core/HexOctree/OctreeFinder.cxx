#include "HexOctree/OctreeFinder.h"

#include "HexOctree/RadixSort.h"

#include <cmath>

namespace banyan
{
namespace
{

std::atomic<std::int64_t> Found{ 0 };

std::string Text(const glm::dvec3& v)
{
  return std::to_string(v.x) + " x " + std::to_string(v.y) + " x " + std::to_string(v.z);
}

std::string Text(const glm::ivec3& v)
{
  return std::to_string(v.x) + " x " + std::to_string(v.y) + " x " + std::to_string(v.z);
}

std::string CellText(std::int64_t cell)
{
  return "Cell " + std::to_string(cell);
}

/// The level of a size; -1 when it is no power of two.
int LevelOf(int size)
{
  int level = 0;
  while (level < 30 && 1 << level < size)
  {
    ++level;
  }
  return 1 << level == size ? level : -1;
}

} // namespace

/// Puts cells onto the lattice, one after the other.
template <class Real, class Id>
class OctreeFinder::Placer
{
public:
  Placer(const ElementOctree& tree, const Real* points, const Id* ids)
    : Tree(tree)
    , Points(points)
    , Ids(ids)
    , Origin(tree.LatticeOrigin)
    , PerEdge(1.0 / tree.FinestEdge)
    , Allowed(tree.LatticeTolerance / tree.FinestEdge)
  {
  }

  /// @return what is wrong with the cell; empty if nothing is
  std::string Place(std::int64_t cell, Placed& placed) const
  {
    glm::ivec3 corners[8];
    for (int i = 0; i < 8; ++i)
    {
      const Real* point = this->Points + 3 * static_cast<std::int64_t>(this->Ids[8 * cell + i]);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double exact = (point[axis] - this->Origin[axis]) * this->PerEdge[axis];
        // Rounded to a whole number, which takes a function call on processors without SSE4.
        const double whole = (exact + Rounder) - Rounder;
        if (!(std::abs(exact - whole) <= this->Allowed[axis]))
        {
          return this->Off(cell, i, axis, exact - whole);
        }
        corners[i][axis] = static_cast<int>(whole);
      }
    }
    glm::ivec3 low = corners[0];
    glm::ivec3 high = corners[0];
    for (const glm::ivec3& corner : corners)
    {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    return this->Fit(cell, corners, low, high, placed);
  }

private:
  static constexpr double Rounder = 6755399441055744.0; ///< 1.5 * 2^52

  std::string Off(std::int64_t cell, int corner, int axis, double off) const
  {
    return CellText(cell) + " is no box of an octree: its point " +
           std::to_string(static_cast<std::int64_t>(this->Ids[8 * cell + corner])) + " lies " +
           std::to_string(std::abs(off)) + " of the finest edge (" +
           std::to_string(this->Tree.FinestEdge[axis]) +
           ") beside the lattice of the others along " + "xyz"[axis] + ", and " +
           std::to_string(this->Allowed[axis]) + " is allowed (MeshTolerance)";
  }

  std::string Fit(std::int64_t cell, const glm::ivec3 (&corners)[8], const glm::ivec3& low,
    const glm::ivec3& high, Placed& placed) const
  {
    const glm::ivec3 size = high - low;
    placed.Corner = low;
    placed.Level = LevelOf(size.x);
    if (size.y != size.x || size.z != size.x || placed.Level < 0)
    {
      return CellText(cell) + " spans " + Text(size) + " of the finest edges (" +
             Text(this->Tree.FinestEdge) +
             "); in an octree all cells span the same power of two along all axes";
    }
    unsigned seen = 0;
    for (std::size_t i = 0; i < 8; ++i)
    {
      const glm::ivec3 in = corners[i] - low;
      unsigned place = 0;
      for (int axis = 0; axis < 3; ++axis)
      {
        place |= in[axis] == size.x ? 1u << axis : 0u;
        if (in[axis] != 0 && in[axis] != size.x)
        {
          return CellText(cell) + " is not an axis-aligned box: a point of it lies between its " +
                 "corners along " + "xyz"[axis];
        }
      }
      placed.Order[i] = static_cast<std::uint8_t>(place);
      seen |= 1u << place;
    }
    if (seen != 0xff)
    {
      return CellText(cell) + " has two of its points at one corner, and none at another";
    }
    const int mask = size.x - 1;
    if ((low.x & mask) != 0 || (low.y & mask) != 0 || (low.z & mask) != 0)
    {
      return CellText(cell) + ", which is " + std::to_string(size.x) +
             " finest edges long, begins at " + Text(low) +
             " of them: in an octree cells begin at multiples of their size, seen from cell " +
             std::to_string(this->Tree.CellNumbers.front()) + " on, one of the largest";
    }
    return {};
  }

  const ElementOctree& Tree;
  const Real* Points;
  const Id* Ids;
  glm::dvec3 Origin;
  glm::dvec3 PerEdge;
  glm::dvec3 Allowed;
};

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
      throw Error(std::string("The mesh spans more of its finest edges along ") + "xyz"[axis] +
                  " (" + std::to_string(tree.FinestEdge[axis]) + ") than an octree can count: " +
                  std::to_string(last[axis]) + ", and 2097152 are allowed");
    }
  }
  tree.CellNumbers = { static_cast<std::uint32_t>(survey.LongestCell) };
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
  tree.Keys.resize(count);
  this->LevelOfCell.resize(count);
  tree.OrderOfCell.resize(count);
  std::vector<OrderMemory> memories(static_cast<std::size_t>(this->Pool.Width()));
  DispatchMesh(tree.Cells,
    [&](const auto* points, const auto* ids)
    {
      const Placer placer(tree, points, ids);
      FirstFailure failure;
      ForRuns(tree.Cells.CellCount, this->Pool, failure,
        [&](std::int64_t begin, std::int64_t end, int worker)
        {
          OrderMemory& memory = memories[static_cast<std::size_t>(worker)];
          for (std::int64_t cell = begin; cell < end; ++cell)
          {
            Placed placed;
            const std::string problem = placer.Place(cell, placed);
            if (!problem.empty())
            {
              failure.Report(cell, problem);
              return;
            }
            const auto index = static_cast<std::size_t>(cell);
            tree.Keys[index] = KeyOf(placed.Corner);
            this->LevelOfCell[index] = static_cast<std::uint8_t>(placed.Level);
            tree.OrderOfCell[index] = this->NumberOfOrder(placed.Order, memory);
          }
        });
    });
  if (tree.CornerOrders.size() == 1)
  {
    tree.OrderOfCell = {};
  }
}

std::uint16_t OctreeFinder::NumberOfOrder(
  const std::array<std::uint8_t, 8>& order, OrderMemory& memory)
{
  if (memory.Number < 0 || memory.Order != order)
  {
    const std::lock_guard<std::mutex> lock(this->OrdersMutex);
    std::vector<std::array<std::uint8_t, 8>>& orders = this->Tree.CornerOrders;
    std::uint32_t bits = 0;
    for (const std::uint8_t place : order)
    {
      bits = bits << 3 | place;
    }
    const auto found = this->NumberOfOrders.emplace(bits, static_cast<int>(orders.size()));
    memory.Number = found.first->second;
    memory.Order = order;
    if (found.second)
    {
      orders.push_back(order);
    }
  }
  return static_cast<std::uint16_t>(memory.Number);
}

void OctreeFinder::SortLeaves()
{
  ElementOctree& tree = this->Tree;
  tree.CellNumbers.resize(tree.Keys.size());
  tree.Levels.resize(tree.Keys.size());
  std::atomic<MortonKey> all{ 1 };
  FirstFailure failure;
  const auto forLeaves = [&](const auto& body)
  { ForRuns(tree.LeafCount(), this->Pool, failure, body); };
  forLeaves(
    [&](std::int64_t begin, std::int64_t end, int)
    {
      MortonKey bits = 0;
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        tree.CellNumbers[i] = static_cast<std::uint32_t>(i);
        bits |= tree.Keys[i];
      }
      all |= bits;
    });
  int bits = 1;
  while (bits < 63 && all >> bits != 0)
  {
    ++bits;
  }
  RadixSort(tree.Keys, tree.CellNumbers, bits, this->Pool);
  forLeaves(
    [&](std::int64_t begin, std::int64_t end, int)
    {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        tree.Levels[i] = this->LevelOfCell[tree.CellNumbers[i]];
      }
    });
  this->LevelOfCell = {};
}

/// Overlaps, the domain, and what is left of it.
void OctreeFinder::CheckLeaves()
{
  struct Sum
  {
    Box Domain;
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
        const glm::ivec3 corner = PositionOfKey(tree.Keys[leaf]);
        sum.Domain = Union(sum.Domain, Box{ corner, corner + (1 << level) });
        sum.Coarsest = std::max(sum.Coarsest, level);
        sum.Covered += static_cast<std::int64_t>(CubeKeys(level));
      }
    });
  std::int64_t covered = 0;
  for (const Sum& sum : sums)
  {
    tree.DomainCells = Union(tree.DomainCells, sum.Domain);
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
    throw Error("The tolerance for points beside the lattice lies between 0 and 1/16");
  }
  const std::shared_ptr<ElementOctree> tree(new ElementOctree());
  tree->Cells = mesh;
  OctreeFinder(*tree, pool, tolerance).Find();
  NodeFinder(*tree, pool).Find();
  ++Found;
  return tree;
}

std::int64_t ElementOctree::FoundSoFar()
{
  return Found;
}

} // namespace banyan
