// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_CellsOutput_h
#define banyan_Readers_CellsOutput_h

#include "StepRequest.h"

#include "vtkSmartPointer.h"

#include "Cache/ChosenSamples.h"

#include <memory>

class vtkPoints;
class vtkUnstructuredGrid;

namespace banyan
{

struct PointsFile;
struct StoredCells;

/// The mesh of a series of cells of any type as unstructured grids. Cells are made once for each
/// piece; points again where they are others than those of the step before.
class CellsOutput
{
public:
  /// To be called when a series was opened.
  void Forget();

  /// Points and cells of a piece: a run of the cells, with the points that they use in the order of
  /// the mesh. One piece has all points. Throws Error.
  void Fill(const StepRequest& request, vtkUnstructuredGrid* output);

  /// Where the values of the last piece are in the image.
  const ChosenSamples& PointSamples() const { return this->SamplesOfPoints; }
  const ChosenSamples& CellSamples() const { return this->SamplesOfCells; }

private:
  void Load(const SeriesFile& series);
  void MakeCells(const StepRequest& request);
  void ChooseSamples(const BrickLayout& layout, std::size_t first, std::size_t end);
  void MakePoints(const StepRequest& request);
  vtkSmartPointer<vtkPoints> PointsOf(const SeriesFile& series, const PointsFile* file) const;

  std::shared_ptr<const StoredCells> Mesh;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  int Made[2] = { -1, 0 };           ///< piece and pieces of Grid
  std::vector<std::uint32_t> Chosen; ///< points of the mesh that Grid has
  bool HasPoints = false;
  const PointsFile* KeptFiles[2] = { nullptr, nullptr }; ///< of its points; the second one between
                                                         ///< two steps
  double KeptFraction = 0.0;
  ChosenSamples SamplesOfPoints;
  ChosenSamples SamplesOfCells;
};

} // namespace banyan

#endif
