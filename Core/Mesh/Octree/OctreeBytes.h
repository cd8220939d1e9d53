// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_OctreeBytes_h
#define banyan_Mesh_Octree_OctreeBytes_h

#include "Mesh/Octree/ElementOctree.h"

#include <cstddef>
#include <memory>

namespace banyan
{

/// An octree as one run of bytes that other processes of the machine can have as theirs: nothing in
/// it is an address. Not a file format: all of them run the same program.
class OctreeBytes
{
public:
  /// @param withCells whether the points of cells (HexMesh::Connectivity) come along, for processes
  /// that have no such mesh
  OctreeBytes(std::shared_ptr<const ElementOctree> tree, bool withCells);

  std::size_t Count() const { return this->Bytes; }
  /// @param to aligned as `new` does it
  void WriteTo(char* to) const;

  /// The octree that lies there; nothing is copied.
  /// @param mesh whose octree it is; without effect where the cells came along
  static std::shared_ptr<const ElementOctree> Read(
    const HexMesh& mesh, const std::shared_ptr<const char>& memory);

private:
  struct Header;
  template <class Tree, class Function>
  static void ForArrays(Tree& tree, const Function& function);

  std::shared_ptr<const ElementOctree> Octree;
  std::size_t CellBytes = 0;
  std::size_t Bytes = 0;
};

} // namespace banyan

#endif
