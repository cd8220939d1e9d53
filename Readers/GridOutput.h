// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_GridOutput_h
#define banyan_Readers_GridOutput_h

#include "StepRequest.h"

#include "Base/Box.h"

#include "vtkSmartPointer.h"

#include <array>
#include <cstdint>

class vtkDataArray;
class vtkDataSet;

namespace banyan
{

struct SeriesIndex;

/// The samples of a level of a curvilinear or rectilinear grid, as a box: at level 0 the extent of
/// the series. Coarser ones start at 0, and have all samples of the level's BrickLayout: the last
/// one is the last fine one, so that the grid ends where it does.
Box ExtentOfGrid(const SeriesIndex& index, int level);

/// The curvilinear or rectilinear grid of a series with the values of a step. Points are read when
/// they are others than those of the step before.
class GridOutput
{
public:
  /// To be called when a series was opened.
  void Forget();

  /// Points, hidden points and cells, and arrays.
  /// @param wanted the part of ExtentOfGrid() that is wanted; it may go beyond
  /// @param output a vtkStructuredGrid or vtkRectilinearGrid, as the series says
  /// Throws Error.
  void Fill(const StepRequest& request, const Box& wanted, vtkDataSet* output);

private:
  using Points = std::array<vtkSmartPointer<vtkDataArray>, 3>;
  Points Read(const StepRequest& request, int step, const Box& samples) const;
  void TakePoints(const StepRequest& request, const Box& samples);
  void SetPoints(const Box& piece, vtkDataSet* output) const;
  void AddArrays(const StepRequest& request, const Box& samples, vtkDataSet* output) const;

  Points Kept;                   ///< of what follows
  int KeptFiles[2] = { -1, -1 }; ///< first steps of the files of points; the second one between two
  double KeptFraction = 0.0;
  int KeptLevel = 0;
  Box KeptSamples;
};

} // namespace banyan

#endif
