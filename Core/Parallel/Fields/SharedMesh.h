// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_SharedMesh_h
#define banyan_Parallel_Fields_SharedMesh_h

#include "Mesh/Octree/CellNodes.h"
#include "Mesh/Octree/HexBrickSource.h"
#include "Mesh/Sampling/MeshOptions.h"
#include "Mesh/Sampling/SampledMesh.h"
#include "Parallel/Communicate/NodeBroadcast.h"
#include "Parallel/Fields/MeshBytes.h"
#include "Parallel/Fields/MeshGathering.h"

#include <cstdint>
#include <memory>
#include <string>

namespace banyan
{

class ThreadPool;

/// A mesh of hexahedra that lies in pieces on the ranks, as the octree that all of them draw. One
/// rank of each machine, its leader, finds the octree (or samples the mesh at the boxes of one) and
/// makes fields of values; the others of the machine wait, and read what it has made. Meanwhile the
/// leader has as many threads as all of them. Ranks that have no memory together (NodeCommunicator)
/// all lead.
class SharedMesh
{
public:
  /// Facts about a mesh, the same on all ranks.
  struct Facts
  {
    std::int32_t IsSampled = 0; ///< at boxes: it is no octree
    std::int32_t Padding = 0;
    double Deviation = 0.0; ///< as in SampledMesh, like all that follows
    std::int64_t Boxes = 0;
    std::int64_t KeptCoarse = 0;
    std::int64_t TangledCells = 0;
    std::int64_t FirstTangledCell = -1;
  };

  /// Collective: takes the pieces of all ranks.
  /// @param where values will be; a mesh with values at CellCorners must be an octree
  /// @param brickCells largest number of cells of a brick per axis: a power of two
  /// @param options the same on all ranks; leaders call MeshSampling::Watch
  /// @param machine of this rank
  /// Throws CollectiveError when the mesh cannot be drawn.
  SharedMesh(Communicator& communicator, const HexMesh& piece, ValuesOn where, int brickCells,
    const MeshOptions& options, const std::string& machine = NodeCommunicator::ThisMachine());
  ~SharedMesh();

  const Facts& About() const { return this->Known; }
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
  std::shared_ptr<const ElementOctree> Find(
    const HexMesh& mesh, ValuesOn where, const MeshOptions& options);
  NodalField MakeField(const NodeArray& values, ValuesOn where, ThreadPool& pool) const;
  ThreadPool& Threads(const NodeCommunicator& machines);
  void BringLevel(Communicator& communicator, NodeCommunicator& machines);

  NodeCommunicator Machines;            ///< as they were when the octree was found
  HexMesh Mesh;                         ///< on leaders that sample it; without points
  std::shared_ptr<SampledMesh> Sampled; ///< null for octrees, and on ranks that do not lead
  Facts Known;
  std::shared_ptr<HexBricks> Cut;
  bool LevelsAlone = false;         ///< whether each rank makes coarser meshes for itself
  std::unique_ptr<ThreadPool> Wide; ///< null where the threads of the process are all there are
  MeshBytes OfMesh;
  MeshBytes OfValues;
};

} // namespace banyan

#endif
