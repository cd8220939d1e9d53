// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_HexBricks_h
#define banyan_Mesh_Octree_HexBricks_h

#include "Mesh/Octree/CoarserOctree.h"
#include "Render/Scene/Viewpoint.h"

#include <memory>
#include <mutex>
#include <vector>

namespace banyan
{

/// A box that leaves of an octree fill without a hole.
struct HexBrick
{
  int Level = 0; ///< of its smallest leaf
  Box Cells;     ///< in cells of its own level: 2^Level of the finest ones
  std::int64_t FirstLeaf = 0;
  std::int64_t EndLeaf = 0; ///< the leaves between are its own
  Hash128 Leaves;           ///< ElementOctree::HashOfLeaves

  /// In finest cells.
  Box FinestCells() const
  {
    return { this->Cells.Lo * (1 << this->Level), this->Cells.Hi * (1 << this->Level) };
  }
};

/// The leaves of an octree in bricks of mixed levels: a cube of the octree becomes one brick when
/// the smallest leaf in it leaves it at most `edge` cells per axis. Large leaves become bricks of
/// few cells, then. Cubes with holes are cut until what is left are filled boxes, so that nothing
/// is drawn where no element is.
class HexBricks
{
public:
  /// @param edge largest number of cells of a brick per axis: a power of two
  HexBricks(std::shared_ptr<const ElementOctree> tree, int edge);

  const ElementOctree& Tree() const { return *this->Octree; }
  const std::vector<HexBrick>& List() const { return this->Bricks; }
  int CoarsestLevel() const { return this->Coarsest; }

  /// The bricks of a coarser mesh, on the same lattice.
  struct Level
  {
    std::shared_ptr<const HexBricks> Bricks;
    HeldArray<std::uint32_t> NodeOfPoint; ///< of this mesh, for each point of the coarser one
  };
  /// Elements that are smaller than 2^level finest edges are merged, where they fill cubes. Made
  /// when it is first asked for, from the next finer one, and kept: values have no part in it.
  /// @param level at least 1
  /// May be called from several threads.
  const Level& AtLevel(int level, ThreadPool& pool) const;

  /// For those who have levels from somewhere else: how many there are already, the one that
  /// AtLevel would make next, which does not stay, and what is to stay in its place.
  int LevelCount() const;
  Level NextLevel(ThreadPool& pool) const;
  /// @param bytes what they take of the memory of this process, for Bytes()
  void AddLevel(std::shared_ptr<const ElementOctree> tree, HeldArray<std::uint32_t> nodeOfPoint,
    std::size_t bytes);

  /// Bytes of bricks and coarser meshes, without those of Tree().
  std::size_t Bytes() const;

  /// The place of each brick in visibility order. Exact, for the eye inside too: all bricks of one
  /// octant of a cube hide nothing of the octants that are nearer to the eye.
  /// @param view in the space of the lattice
  std::vector<std::int64_t> RanksFrontToBack(const Viewpoint& view) const;

private:
  struct Cube
  {
    MortonKey Key = 0;
    int Level = 0;
    std::int64_t FirstLeaf = 0;
    std::int64_t EndLeaf = 0;
  };

  Level MakeNext(ThreadPool& pool) const;
  void Keep(Level level, std::size_t bytes) const;
  bool TakeWhole(const Cube& cube);
  void Cut(const Cube& cube);
  void Rank(const Viewpoint& view, MortonKey key, int level, std::size_t first, std::size_t end,
    std::int64_t& next, std::vector<std::int64_t>& ranks) const;

  std::shared_ptr<const ElementOctree> Octree;
  int EdgeLevel;
  int RootLevel = 0;
  int Coarsest = 0;
  std::vector<HexBrick> Bricks; ///< in the order of their first leaves
  mutable std::mutex LevelsMutex;
  /// From level 1 on. Each stays where it is.
  mutable std::vector<std::unique_ptr<const Level>> Levels;
  mutable std::size_t BytesOfLevels = 0;
};

} // namespace banyan

#endif
