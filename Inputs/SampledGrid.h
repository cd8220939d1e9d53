// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_SampledGrid_h
#define banyan_Inputs_SampledGrid_h

#include "BanyanInputsModule.h"

#include "Base/Hash.h"
#include "Mesh/Sampling/SampledMesh.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>

class vtkDataSetAttributes;
class vtkUnstructuredGrid;

namespace banyan
{

/// Grids of general hexahedra as grids of the boxes that they are sampled at (see SampledMesh),
/// with values at their points: what is drawn of such a mesh, as something that can be kept.
///
/// Point arrays of numbers are sampled; cell arrays are made nodal first (see CellMeans), where no
/// point array has the name. Float32 where that holds all values of the type, otherwise float64.
class BANYANINPUTS_EXPORT SampledGrid
{
public:
  /// The boxes are found once for a mesh and these options; later grids of the same content touch
  /// values only. Throws Error: see SampledMesh::Of, as for Interruption.
  /// @return voxels, with points in float64
  vtkSmartPointer<vtkUnstructuredGrid> Of(vtkUnstructuredGrid* grid, const MeshSampling& sampling);

  /// Returns what is to be said of the last grid: cells that are left out, places that stayed
  /// coarse; or nothing.
  const std::string& Note() const { return this->NoteText; }

private:
  void Find(const HexMesh& mesh, const MeshSampling& sampling);
  void AddArrays(
    vtkUnstructuredGrid* grid, int where, const HexMesh& mesh, vtkDataSetAttributes* to) const;

  std::shared_ptr<const SampledMesh> Sampled;
  HexMesh Renumbered; ///< the mesh where its points coincide; without points
  MeshSampling Sampling;
  Hash128 PointHash, CellHash; ///< of the mesh
  vtkSmartPointer<vtkUnstructuredGrid> Boxes;
  std::string NoteText;
};

} // namespace banyan

#endif
