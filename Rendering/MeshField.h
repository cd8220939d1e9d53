// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_MeshField_h
#define banyan_Rendering_MeshField_h

#include "HexMeshOfGrid.h"

#include "Base/Hash.h"
#include "Parallel/Fields/SharedMesh.h"

#include <memory>
#include <string>

class vtkDataArray;
class vtkUnstructuredGrid;

namespace banyan
{

/// A field on a hexahedral mesh that lies in pieces on the ranks. The octree is found once per
/// mesh, however often the reader makes new objects of the same points and cells: new values touch
/// values only. Every rank has the whole mesh and the values of one component of it, and draws a
/// part; ranks of a machine have them together (SharedMesh).
class MeshField
{
public:
  /// Collective: takes the pieces of all ranks.
  /// @param grid null on ranks without cells
  /// @param values of the points or cells of the grid, as `where` says, which may be anything on
  /// ranks without cells; those of cells are made nodal: see CellNodes
  /// @param component in [0, components), or -1 for the Euclidean norm
  /// @param options the same on all ranks
  /// Throws Error when the mesh cannot be drawn or read; on all ranks, if one cannot.
  void Update(Communicator& communicator, vtkUnstructuredGrid* grid, vtkDataArray* values,
    ValuesOn where, int component, const MeshOptions& options);

  /// What a user should know of the mesh that was found last: cells that were left out, say. Empty
  /// if nothing. The same on all ranks.
  const std::string& Note() const { return this->NoteText; }
  /// CubeDeviation of a mesh that is sampled; 0 of one that is drawn as it is.
  double Deviation() const { return this->Mesh ? this->Mesh->About().Deviation : 0.0; }
  /// What this rank holds of the mesh, and of the values of the last Update.
  MeshBytes Bytes() const { return this->Mesh ? this->Mesh->Bytes() : MeshBytes{}; }

  const ElementOctree& Tree() const { return this->Mesh->Tree(); }

  /// Collective: coarser meshes, made by one rank of each machine.
  void BringLevels(Communicator& communicator, int count)
  {
    if (this->Mesh)
    {
      this->Mesh->BringLevels(communicator, count);
    }
  }

  /// The bricks of the last Update; can be called once for each.
  std::unique_ptr<HexBrickSource> TakeSource() { return std::move(this->Source); }

private:
  bool SameMesh(Communicator& communicator, const HexMesh& piece);
  void Describe(Communicator& communicator, const OtherCells& others);

  std::unique_ptr<SharedMesh> Mesh; ///< null when the last one cannot be drawn
  std::string NoteText;
  std::unique_ptr<HexBrickSource> Source;
  Hash128 PieceHash;   ///< of this rank's points and cells
  MeshOptions Options; ///< that the octree was found with
};

} // namespace banyan

#endif
