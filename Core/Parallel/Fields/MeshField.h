// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_MeshField_h
#define banyan_Parallel_Fields_MeshField_h

#include "Base/Hash.h"
#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Fields/DrawnField.h"
#include "Parallel/Fields/SharedMesh.h"

#include <memory>
#include <string>

namespace banyan
{

/// A field on a hexahedral mesh that lies in pieces on the ranks. The octree is found once per
/// mesh, however often a reader makes new objects of the same points and cells: new values touch
/// values only. Every rank has the whole mesh and the values of one component of it, and draws a
/// zone; ranks of a machine have them together (SharedMesh).
class MeshField final : public DrawnField
{
public:
  /// This rank's part. Values belong to the caller, until Take returns.
  struct Piece
  {
    HexMesh Mesh;     ///< without cells on ranks that have none
    NodeArray Values; ///< of its points or cells; anything on ranks without cells
    ValuesOn Where = ValuesOn::Points;
    std::string OtherCells; ///< that are left out, as a user reads it; empty if none
  };

  /// Collective: takes the pieces of all ranks.
  /// @param tolerance see ElementOctree::Find; the same on all ranks, as is the balancing
  /// Throws CollectiveError when the mesh is no octree, or one rank cannot read it.
  void Take(Communicator& communicator, Piece piece, double tolerance, LoadBalancing balancing);

  /// Of the last Take.
  FieldPlace Place() const;

  void BeginFrame(Communicator& communicator, RayScene& scene) override;
  /// One rank of each machine makes them.
  void BringLevels(Communicator& communicator, const RayScene& scene, int coarsest) override;
  void EndFrame(Communicator& communicator) override { this->Balancer.EndFrame(communicator); }
  void Clear() override { this->Bricks.reset(); }
  BrickSource* Source() override { return this->Bricks.get(); }
  const std::vector<Box>& Zones() const override { return this->ZoneCells; }
  /// One hash of all values, which counts for all levels: elements of coarser ones span bricks.
  std::vector<Hash128> VisibleContent(const RayScene& scene) override;
  bool IsMesh() const override { return true; }
  bool IsOnEachRank() const override { return true; }
  /// Cells that were left out, say.
  std::string Note() const override { return this->NoteText; }
  MeshBytes Bytes() const override;

private:
  bool SameMesh(Communicator& communicator, const HexMesh& piece);
  void Describe(Communicator& communicator, const std::string& otherCells);

  std::unique_ptr<SharedMesh> Mesh; ///< null when the last one cannot be drawn
  std::string NoteText;
  Hash128 PieceHash;      ///< of this rank's points and cells
  double Tolerance = 0.0; ///< that the octree was found with
  std::unique_ptr<HexBrickSource> Bricks;
  FrameBalancer Balancer;
  std::vector<Box> ZoneCells;
};

} // namespace banyan

#endif
