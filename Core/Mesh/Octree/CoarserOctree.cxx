// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/CoarserOctree.h"

#include "Mesh/Octree/MergedLeaves.h"
#include "Mesh/Octree/OctreeFinder.h"

#include <algorithm>
#include <limits>

namespace banyan
{

/// Makes the octree: see CoarserOctreeOf.
class OctreeCoarsener
{
public:
  OctreeCoarsener(const ElementOctree& finer, int level)
    : Finer(finer)
    , Level(level)
    , Tree(new ElementOctree())
    , Arrays(std::make_shared<Own>())
  {
  }

  CoarserOctree Run(ThreadPool& pool)
  {
    this->KeepLattice();
    this->MergeLeaves();
    HexMesh& mesh = this->Tree->Cells;
    mesh.Points = this->Arrays->Points.data();
    mesh.PointType = ScalarType::Float64;
    mesh.PointCount = static_cast<std::int64_t>(this->NodeOfPoint.size());
    mesh.Connectivity = this->Arrays->Connectivity.data();
    mesh.IdType = ScalarType::Int32;
    mesh.CellCount = this->Tree->LeafCount();
    mesh.Owner = this->Arrays;
    this->Tree->MakeStarts();
    NodeFinder(*this->Tree, pool).Find();
    // The hanging nodes are known: nobody asks for coordinates any more.
    mesh.Points = nullptr;
    this->Arrays->Points = {};
    return { this->Tree, std::move(this->NodeOfPoint) };
  }

private:
  struct Own
  {
    std::vector<double> Points;
    std::vector<std::int32_t> Connectivity;
  };
  static constexpr std::int32_t Unknown = -1;

  void KeepLattice()
  {
    ElementOctree& tree = *this->Tree;
    tree.LatticeOrigin = this->Finer.LatticeOrigin;
    tree.FinestEdge = this->Finer.FinestEdge;
    tree.LatticeTolerance = this->Finer.LatticeTolerance;
    tree.DomainCells = this->Finer.DomainCells;
    tree.Holes = this->Finer.Holes;
    tree.CornerOrders = std::vector<std::array<std::uint8_t, 8>>{ { 0, 1, 2, 3, 4, 5, 6, 7 } };
  }

  void MergeLeaves()
  {
    ElementOctree& tree = *this->Tree;
    const auto nodes = static_cast<std::size_t>(this->Finer.Mesh().PointCount);
    this->PointOfNode.assign(nodes, Unknown);
    // All points at one place become the one that counts.
    this->Counting.clear();
    if (!this->Finer.Twins().empty())
    {
      this->Counting.resize(nodes);
      for (std::size_t node = 0; node < nodes; ++node)
      {
        this->Counting[node] = static_cast<std::uint32_t>(node);
      }
      for (const TwinNode& twin : this->Finer.Twins())
      {
        this->Counting[static_cast<std::size_t>(twin.Node)] =
          static_cast<std::uint32_t>(twin.First);
      }
    }
    const LeafMerging merging(this->Finer.Keys, this->Finer.Levels);
    std::vector<MortonKey> keys;
    std::vector<std::uint32_t> cells;
    std::vector<std::uint8_t> levels;
    merging.ForEach(this->Level,
      [&](const MergedLeaf& element)
      {
        cells.push_back(static_cast<std::uint32_t>(keys.size()));
        keys.push_back(element.Key);
        levels.push_back(static_cast<std::uint8_t>(element.Level));
        tree.CoarsestLeaf = std::max(tree.CoarsestLeaf, element.Level);
        this->AddCorners(merging, element);
      });
    tree.Keys = std::move(keys);
    tree.CellNumbers = std::move(cells);
    tree.Levels = std::move(levels);
  }

  void AddCorners(const LeafMerging& merging, const MergedLeaf& element)
  {
    const glm::ivec3 low = PositionOfKey(element.Key);
    std::int64_t nodes[8];
    std::size_t known = std::numeric_limits<std::size_t>::max();
    for (int corner = 0; corner < 8; ++corner)
    {
      const std::size_t leaf = merging.LeafAtCorner(element, corner);
      if (leaf != known)
      {
        known = leaf;
        this->Finer.NodesOfLeaf(static_cast<std::int64_t>(leaf), nodes);
      }
      auto node = static_cast<std::size_t>(nodes[corner]);
      node = this->Counting.empty() ? node : this->Counting[node];
      std::int32_t& point = this->PointOfNode[node];
      if (point == Unknown)
      {
        point = this->AddPoint(
          node, low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2) * (1 << element.Level));
      }
      this->Arrays->Connectivity.push_back(point);
    }
  }

  std::int32_t AddPoint(std::size_t node, const glm::ivec3& at)
  {
    if (this->NodeOfPoint.size() > std::size_t{ std::numeric_limits<std::int32_t>::max() } - 1)
    {
      throw Error("A coarser mesh has more than 2147483647 points");
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Arrays->Points.push_back(
        this->Tree->LatticeOrigin[axis] + at[axis] * this->Tree->FinestEdge[axis]);
    }
    this->NodeOfPoint.push_back(static_cast<std::uint32_t>(node));
    return static_cast<std::int32_t>(this->NodeOfPoint.size() - 1);
  }

  const ElementOctree& Finer;
  int Level;
  std::shared_ptr<ElementOctree> Tree;
  std::shared_ptr<Own> Arrays;
  std::vector<std::uint32_t> NodeOfPoint;
  std::vector<std::int32_t> PointOfNode;
  std::vector<std::uint32_t> Counting; ///< empty when no points are twins
};

CoarserOctree CoarserOctreeOf(const ElementOctree& finer, int level, ThreadPool& pool)
{
  if (level < 1)
  {
    throw Error("Coarser levels of a mesh begin at 1");
  }
  return OctreeCoarsener(finer, level).Run(pool);
}

} // namespace banyan
