// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_HexForces_h
#define banyan_Data_HexForces_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

class OctreeMesh;
class ThreadPool;

/// The forces with which the elastic cells of an octree mesh resist a displacement of their nodes:
/// minus the stiffness matrix times the displacement, which is never assembled.
///
/// Cells are worked on in blocks of neighbours on the curve. Which cells form a block, and in which
/// order the forces of several blocks on one node are added, does not depend on threads: the result
/// has the same bits for any number of them. About 30 bytes a cell.
class HexForces
{
public:
  /// @param lambda, mu Lame's moduli of the cells, Pa
  HexForces(const OctreeMesh& mesh, const std::vector<float>& lambda, const std::vector<float>& mu,
    ThreadPool& pool);

  /// @param displacement metres, `[node][3]`
  /// @param force newtons, `[node][3]`; overwritten. Nodes that hang have forces of their own.
  void Apply(const float* displacement, float* force);

private:
  static constexpr std::size_t BlockCells = 2048;
  static constexpr std::size_t Lanes = 4;

  struct Block
  {
    std::size_t FirstGroup, Groups; ///< of `Lanes` cells
    std::size_t FirstNode;          ///< in BlockNodes
    std::uint32_t Nodes, Own;       ///< those that no other block touches come first
    std::size_t FirstShared;        ///< of the others, in SharedForces
  };
  /// Corners (in the nodes of the block) and moduli of cells side by side.
  struct Group
  {
    std::array<std::array<std::uint16_t, Lanes>, 8> Corners;
    std::array<float, Lanes> Lambda, Mu; ///< times -edge / 16; 0 where there is no cell
  };
  void FindBlockNodes(const OctreeMesh& mesh);
  void FindShared(std::size_t nodes);
  void FillGroups(
    const OctreeMesh& mesh, const std::vector<float>& lambda, const std::vector<float>& mu);
  void ApplyBlock(const Block& block, const float* displacement, float* force, int worker);

  ThreadPool& Pool;
  std::vector<Block> Blocks;
  std::vector<Group> Groups;
  std::vector<std::uint32_t> BlockNodes;
  std::vector<float> SharedForces;         ///< `[place][3]`
  std::vector<std::uint32_t> SharedNodes;  ///< nodes that several blocks touch
  std::vector<std::size_t> SharedStart;    ///< their ranges in SharedPlaces
  std::vector<std::uint32_t> SharedPlaces; ///< in SharedForces
  std::vector<std::vector<float>> Scratch; ///< per worker
};

} // namespace banyan

#endif
