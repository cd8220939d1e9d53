// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/OctreeBytes.h"

#include <cstring>
#include <type_traits>

namespace banyan
{
namespace
{

/// Arrays begin at multiples of it: a line of the cache, which is enough for any type.
constexpr std::size_t Alignment = 64;

std::size_t Aligned(std::size_t bytes)
{
  return (bytes + Alignment - 1) / Alignment * Alignment;
}

} // namespace

/// Stands before the arrays. It is plain memory.
struct OctreeBytes::Header
{
  glm::dvec3 Origin{ 0.0 };
  glm::dvec3 Edge{ 1.0 };
  glm::dvec3 Tolerance{ 0.0 };
  Box Domain;
  std::int64_t Holes = 0;
  std::int64_t Unbalanced = 0;
  std::int64_t Points = 0;
  std::int64_t Cells = 0;
  std::int32_t Coarsest = 0;
  std::int32_t StartShift = 0;
  ScalarType IdType = ScalarType::Int64;
  std::uint64_t CellBytes = 0;
  std::uint64_t Counts[8] = {}; ///< of ForArrays
};

template <class Tree, class Function>
void OctreeBytes::ForArrays(Tree& tree, const Function& function)
{
  function(0, tree.Keys);
  function(1, tree.CellNumbers);
  function(2, tree.Levels);
  function(3, tree.CornerOrders);
  function(4, tree.OrderOfCell);
  function(5, tree.HangingNodes);
  function(6, tree.TwinNodes);
  function(7, tree.Starts);
}

OctreeBytes::OctreeBytes(std::shared_ptr<const ElementOctree> tree, bool withCells)
  : Octree(std::move(tree))
{
  const HexMesh& mesh = this->Octree->Cells;
  this->CellBytes = withCells ? mesh.ConnectivityBytes() : 0;
  this->Bytes = Aligned(sizeof(Header)) + Aligned(this->CellBytes);
  ForArrays(
    *this->Octree, [this](int, const auto& array) { this->Bytes += Aligned(array.Bytes()); });
}

void OctreeBytes::WriteTo(char* to) const
{
  static_assert(std::is_trivially_copyable_v<Header>);
  const ElementOctree& tree = *this->Octree;
  Header header;
  header.Origin = tree.LatticeOrigin;
  header.Edge = tree.FinestEdge;
  header.Tolerance = tree.LatticeTolerance;
  header.Domain = tree.DomainCells;
  header.Holes = tree.Holes;
  header.Unbalanced = tree.Unbalanced;
  header.Points = tree.Cells.PointCount;
  header.Cells = tree.Cells.CellCount;
  header.Coarsest = tree.CoarsestLeaf;
  header.StartShift = tree.StartShift;
  header.IdType = tree.Cells.IdType;
  header.CellBytes = this->CellBytes;
  ForArrays(tree, [&](int i, const auto& array) { header.Counts[i] = array.size(); });
  const auto put = [&to](const void* from, std::size_t bytes)
  {
    if (bytes > 0)
    {
      std::memcpy(to, from, bytes);
    }
    to += Aligned(bytes);
  };
  put(&header, sizeof(header));
  put(tree.Cells.Connectivity, this->CellBytes);
  ForArrays(tree, [&](int, const auto& array) { put(array.data(), array.Bytes()); });
}

std::shared_ptr<const ElementOctree> OctreeBytes::Read(
  const HexMesh& mesh, const std::shared_ptr<const char>& memory)
{
  Header header;
  std::memcpy(&header, memory.get(), sizeof(header));
  const std::shared_ptr<ElementOctree> tree(new ElementOctree());
  tree->LatticeOrigin = header.Origin;
  tree->FinestEdge = header.Edge;
  tree->LatticeTolerance = header.Tolerance;
  tree->DomainCells = header.Domain;
  tree->Holes = header.Holes;
  tree->Unbalanced = header.Unbalanced;
  tree->CoarsestLeaf = header.Coarsest;
  tree->StartShift = header.StartShift;
  const char* from = memory.get() + Aligned(sizeof(Header));
  if (header.CellBytes > 0)
  {
    tree->Cells.PointCount = header.Points;
    tree->Cells.CellCount = header.Cells;
    tree->Cells.Connectivity = from;
    tree->Cells.IdType = header.IdType;
    tree->Cells.Owner = memory;
    from += Aligned(header.CellBytes);
  }
  else
  {
    tree->Cells = mesh;
    // The hanging nodes are known: nobody asks for coordinates any more.
    tree->Cells.Points = nullptr;
    tree->Cells.PointOwner.reset();
  }
  ForArrays(*tree,
    [&](int i, auto& array)
    {
      using T = std::decay_t<decltype(array[0])>;
      static_assert(std::is_trivially_copyable_v<T>);
      array = HeldArray<T>(
        reinterpret_cast<const T*>(from), static_cast<std::size_t>(header.Counts[i]), memory);
      from += Aligned(array.Bytes());
    });
  return tree;
}

} // namespace banyan
