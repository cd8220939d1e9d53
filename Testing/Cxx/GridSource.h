// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GridSource_h
#define banyan_Testing_GridSource_h

#include "VtkIoTesting.h"

#include "vtkDataObjectAlgorithm.h"

class vtkDataSet;

/// A source of curvilinear or rectilinear grids with the array "wave", whose points are made by a
/// function. It knows times, pieces and sub-extents.
class GridSource : public vtkDataObjectAlgorithm
{
public:
  static GridSource* New();
  vtkTypeMacro(GridSource, vtkDataObjectAlgorithm);

  bool Rectilinear = false;
  banyan::Box Extent{ { 0, 0, 0 }, { 20, 18, 9 } };
  std::vector<double> Times{ 0.0, 1.0, 2.5 };
  int TypeOfPoints = VTK_FLOAT; ///< of rectilinear grids: along y
  /// The place of a sample: of rectilinear grids, each axis for itself.
  std::function<glm::dvec3(const glm::ivec3& sample, double time)> Place;
  /// Changes a grid that is complete otherwise.
  std::function<void(vtkDataSet*, double time)> Change;

protected:
  GridSource();
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  void Inform(vtkInformation* info) const;
  void Make(vtkInformation* info) const;
};

/// A source of grids that bend, or whose lines have uneven distances, and do not move.
vtkSmartPointer<GridSource> GridsAtRest(bool rectilinear);

/// A deep copy of what a source or reader gives at a time.
vtkSmartPointer<vtkDataSet> GridAt(vtkAlgorithm* source, double time);

/// Whether two grids have the same extent and points, bit by bit and of the same type.
void ExpectSamePoints(vtkDataSet* a, vtkDataSet* b);

#endif
