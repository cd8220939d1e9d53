// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_OctreeFinder_h
#define banyan_Mesh_Octree_OctreeFinder_h

#include "Base/FirstFailure.h"
#include "Mesh/Octree/ElementOctree.h"

#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace banyan
{

/// Finds the leaves: see ElementOctree::Find.
class OctreeFinder
{
public:
  OctreeFinder(ElementOctree& tree, ThreadPool& pool, double tolerance);
  void Find();

private:
  struct OrderMemory;

  void AlignOrigin(const MeshSurvey& survey);
  void PlaceCells();
  std::uint16_t NumberOfOrder(const std::array<std::uint8_t, 8>& order, OrderMemory& memory);
  void SortLeaves();
  void CheckLeaves();
  /// Returns a sentence that says what is wrong with a leaf that the next one overlaps.
  std::string OverlapAt(std::size_t leaf) const;

  ElementOctree& Tree;
  ThreadPool& Pool;
  double Tolerance;
  std::vector<MortonKey> Keys; ///< of cells
  std::vector<std::array<std::uint8_t, 8>> Orders;
  std::mutex OrdersMutex;
  std::unordered_map<std::uint32_t, int> NumberOfOrders; ///< by their bits
  std::vector<std::uint8_t> LevelOfCell;
};

/// Finds points that hang, and points that are twins.
class NodeFinder
{
public:
  NodeFinder(ElementOctree& tree, ThreadPool& pool);
  void Find();

private:
  struct Found;

  void MarkCorners();
  void Look(std::int64_t node, unsigned mask, Found& found) const;
  glm::ivec3 PositionOf(std::int64_t node) const;

  ElementOctree& Tree;
  ThreadPool& Pool;
  /// A bit per octant around each point that a leaf with this corner covers.
  std::unique_ptr<std::atomic<std::uint8_t>, void (*)(void*)> Octants;
};

} // namespace banyan

#endif
