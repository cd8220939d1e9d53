// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_SharedMesh_h
#define banyan_Parallel_Fields_SharedMesh_h

#include "Mesh/Octree/CellNodes.h"
#include "Mesh/Octree/HexBrickSource.h"
#include "Parallel/Communicate/NodeBroadcast.h"
#include "Parallel/Fields/MeshBytes.h"
#include "Parallel/Fields/MeshGathering.h"

#include <memory>
#include <string>

namespace banyan
{

class ThreadPool;

/// A mesh of hexahedra that lies in pieces on the ranks, as the octree that all of them draw. One
/// rank of each machine, its leader, finds the octree and makes fields of values; the others of the
/// machine wait, and read what it has made. Meanwhile the leader has as many threads as all of
/// them. Ranks that have no memory together (NodeCommunicator) all lead.
class SharedMesh
{
public:
  /// Collective: takes the pieces of all ranks.
  /// @param brickCells largest number of cells of a brick per axis: a power of two
  /// @param tolerance see ElementOctree::Find; the same on all ranks
  /// @param machine of this rank
  /// Throws CollectiveError when the mesh is no octree.
  SharedMesh(Communicator& communicator, const HexMesh& piece, int brickCells, double tolerance,
    const std::string& machine = NodeCommunicator::ThisMachine());
  ~SharedMesh();

  const HexBricks& Bricks() const { return *this->Cut; }
  const ElementOctree& Tree() const { return this->Cut->Tree(); }
  /// Why ranks of a machine have no memory together although they could; empty if all is well.
  const std::string& WhyNotShared() const { return this->Machines.WhyNot(); }

  /// Collective: bricks of a field on the mesh, which looks at values only.
  /// @param piece values at the points or cells of this rank's piece; one component of them counts,
  /// the same one on all ranks
  /// @param count of points, or cells, of the piece
  /// Throws CollectiveError when one fails.
  std::unique_ptr<HexBrickSource> Field(
    Communicator& communicator, const NodeArray& piece, std::int64_t count, ValuesOn where);

  /// Collective: coarser meshes, for pictures that may be drawn from them: HexBricks::AtLevel has
  /// them then. Where ranks have no memory together, and where there is none left, each rank makes
  /// them for itself when it draws from them.
  /// @param count how many levels: see HexBricks
  void BringLevels(Communicator& communicator, int count);

  /// Returns the bytes of the mesh and of the values of the last Field.
  MeshBytes Bytes() const;

private:
  NodalField MakeField(const NodeArray& values, ValuesOn where, ThreadPool& pool) const;
  ThreadPool& Threads(const NodeCommunicator& machines);
  void BringLevel(Communicator& communicator, NodeCommunicator& machines);

  NodeCommunicator Machines; ///< as they were when the octree was found
  std::shared_ptr<HexBricks> Cut;
  bool LevelsAlone = false;         ///< whether each rank makes coarser meshes for itself
  std::unique_ptr<ThreadPool> Wide; ///< null where the threads of the process are all there are
  MeshBytes OfMesh;
  MeshBytes OfValues;
};

} // namespace banyan

#endif
