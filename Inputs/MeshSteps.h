// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_MeshSteps_h
#define banyan_Inputs_MeshSteps_h

#include "BanyanInputsModule.h"

#include "MeshArrays.h"

#include "Base/Hash.h"
#include "Mesh/CellSeries/StoredCells.h"
#include "Mesh/Series/StoredMesh.h"
#include "Series/Encode/SeriesEncoder.h"

#include "vtkSmartPointer.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

class vtkDataArraySelection;
class vtkDataObject;
class vtkImageData;
class vtkUnstructuredGrid;

namespace banyan
{

class AtlasValues;
class Communicator;
class ElementOctree;
class SegmentFolder;

/// The steps of a mesh as images, so that they can be written like those of an image: see
/// AtlasValues. Cell arrays are images of their own. Rank 0 has the whole mesh and makes the
/// images; others have empty ones.
///
/// Hyper trees and AMR are meshes of their leaves, with their data made nodal (see MakeNodal).
///
/// The octree is found once, at the first step; the mesh of later steps must be the same, apart
/// from displacements that it carries and that are named. A mesh that is no octree is kept as it is
/// (see StoredCells), and its points may move.
class BANYANINPUTS_EXPORT MeshSteps
{
public:
  MeshSteps(Communicator& ranks, const EncodeOptions& options, vtkDataArraySelection* points,
    vtkDataArraySelection* cells, std::string displacements)
    : Ranks(ranks)
    , Options(options)
    , Arrays(points, cells)
    , Displacements(std::move(displacements))
  {
  }

  /// Whether steps are those of a mesh. Known after the first Take().
  bool Active() const { return this->Found; }

  /// Collective. Replaces this rank's data by its image when any rank has a mesh. Data stay as they
  /// are where a rank has a problem. Throws CollectiveError.
  /// @param problem of this rank so far, or nothing
  void Take(vtkSmartPointer<vtkDataObject>& data, const std::string& problem);

  /// Sentences about what is not written of the last step, or nothing: of arrays on rank 0 alone.
  std::string Warning() const { return this->LeftOut + this->HiddenParts; }

  /// See StepReport::NotChosen.
  const std::vector<std::string>& NotChosen() const { return this->OthersThere; }

  /// Collective; throws CollectiveError. Rank 0 writes the file of the mesh, and all ranks learn
  /// what encoding must know of it.
  /// @param folder on rank 0
  std::shared_ptr<const MeshPlan> Write(SegmentFolder* folder);

  /// On rank 0, after Write(): writes the points of the step that was taken last, where they are
  /// others than those that were written last. Throws Error.
  std::optional<PointsFile> WriteMoved(int step, SegmentFolder& folder);

private:
  void LookAt(const std::vector<vtkUnstructuredGrid*>& grids);
  vtkSmartPointer<vtkUnstructuredGrid> Merged(std::vector<vtkUnstructuredGrid*> grids);
  vtkSmartPointer<vtkUnstructuredGrid> MergedOfRanks(
    vtkUnstructuredGrid* mine, const std::vector<vtkSmartPointer<vtkDataObject>>& all) const;
  void Remember(vtkUnstructuredGrid* grid);
  std::shared_ptr<const StoredCells> CellsOf(vtkUnstructuredGrid* grid) const;
  vtkSmartPointer<vtkImageData> ImageOf(vtkUnstructuredGrid* grid);

  Communicator& Ranks;
  const EncodeOptions& Options;
  MeshArrays Arrays;
  std::string Displacements; ///< see AtRest()
  bool Found = false;
  bool Leaves = false;                  ///< of hyper trees or AMR
  std::vector<std::string> OthersThere; ///< arrays of this rank's part of the last step
  std::string HiddenParts;              ///< a sentence, if any are hidden
  // On rank 0:
  vtkSmartPointer<vtkUnstructuredGrid> First; ///< the grid of the first step
  vtkSmartPointer<vtkUnstructuredGrid> Now; ///< the one taken last, where its points may have moved
  std::shared_ptr<const StoredMesh> Mesh;   ///< an octree, or
  std::shared_ptr<const StoredCells> Cells; ///< any other mesh
  Hash128 LastPoints;                       ///< those that were written last
  std::map<std::string, std::string> CellArrays; ///< as MeshPlan has them
  /// Says for each array so far, by name, which cell array it is; empty for arrays of points. It is
  /// kept from the first step on.
  std::map<std::string, std::string> Kinds;
  std::string LeftOut;
  std::shared_ptr<const ElementOctree>
    Tree; ///< of hyper trees and AMR only: their data are made nodal
};

} // namespace banyan

#endif
