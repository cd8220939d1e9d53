// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_MeshOutput_h
#define banyan_Readers_MeshOutput_h

#include "CellsOutput.h"
#include "MeshStepAhead.h"
#include "StepRequest.h"
#include "TreeOutput.h"
#include "vtkBanyanDeferred.h"

#include "vtkSmartPointer.h"

#include "Cache/ChosenSamples.h"

#include <memory>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkHyperTreeGrid;
class vtkUnstructuredGrid;

namespace banyan
{

struct StoredMesh;

/// The mesh of a series as unstructured grids, with the values of a step. The grid is made once for
/// each level and piece: steps share its points and cells.
class MeshOutput
{
public:
  /// Forgets all that was read of another series.
  void Open(std::shared_ptr<const SeriesFile> series);

  /// Levels of the octree; the mesh itself is level 0. Reads the file of the mesh; throws Error.
  int Levels();

  /// Grid or trees of a piece, and the arrays that are wanted. Throws Error.
  /// @param readAhead whether the next step of a series that plays is decoded meanwhile
  /// @param output vtkUnstructuredGrid, or vtkHyperTreeGrid
  void Fill(const StepRequest& request, bool readAhead, vtkDataObject* output);

private:
  /// Points and cells of a piece: a run of the cells, with the points that they use in the order of
  /// the mesh. One piece has all points. Throws Error.
  void FillGrid(const StepRequest& request, vtkUnstructuredGrid* output);
  void FillOctree(int level, int piece, int pieces, vtkUnstructuredGrid* output);
  bool OfCells() const;

  /// The values of an array at the points of the last FillGrid(), or in its cells: at a coarser
  /// level the mean of those that were merged (see MeanOfLeaves). Throws Error.
  /// @param handle of the whole image
  vtkSmartPointer<vtkDataArray> Values(const vtkBanyanDeferred::Handle& handle) const;

  /// The bricks that Values() decodes an array from, or CellValues() where `trees` is set: all of
  /// them there.
  std::vector<std::int64_t> BricksOf(const ArrayIndex& array, bool trees) const;

  /// The mesh as trees in place of a grid, and values in their cells: see TreeOutput. Throws Error.
  void FillTrees(int level, int piece, int pieces, vtkHyperTreeGrid* output);
  vtkSmartPointer<vtkDataArray> CellValues(const vtkBanyanDeferred::Handle& handle) const
  {
    return this->Trees.Values(handle);
  }
  void Load();
  void MakeGrid(int level, int piece, int pieces);
  bool NeedsImage(const ArrayIndex& array) const;
  void FillCells(const vtkBanyanDeferred::Handle& handle, vtkDataArray* values) const;

  std::shared_ptr<const SeriesFile> Series;
  std::shared_ptr<const StoredMesh> Mesh;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  TreeOutput Trees;
  CellsOutput Cells; ///< of a mesh of cells of any type, in place of Mesh and Grid
  MeshStepAhead Ahead;
  int Made[3] = { -1, 0, 0 };        ///< level, piece and pieces of Grid
  ChosenSamples PointSamples;        ///< of its points
  ChosenSamples CellSamples;         ///< of its cells, at level 0
  std::vector<std::uint32_t> Leaves; ///< the first one in each of its cells, and behind the last
};

} // namespace banyan

#endif
