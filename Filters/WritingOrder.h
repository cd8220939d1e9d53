// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_WritingOrder_h
#define banyan_Filters_WritingOrder_h

#include "Series/Encode/SeriesEncoder.h"

#include <functional>
#include <string>

class vtkAlgorithm;
class vtkDataArraySelection;
class vtkMultiProcessController;

namespace banyan
{

/// What is to be written, and how.
struct WritingOrder
{
  std::string FileName;
  EncodeOptions Options;
  vtkAlgorithm* Producer = nullptr;               ///< of the image data
  int Port = 0;                                   ///< of the producer
  vtkDataArraySelection* Selection = nullptr;     ///< of point arrays
  vtkDataArraySelection* CellSelection = nullptr; ///< of cell arrays of meshes
  std::string Displacements;                      ///< of the points of meshes: see AtRest()
  bool AllSteps = true;
  vtkMultiProcessController* Controller = nullptr; ///< may be nullptr: this rank alone
  std::function<void(double)> Progress;            ///< told a value in [0, 1], never a smaller one
  std::function<bool()> Aborted;                   ///< once true, it stays true
  std::function<void(const std::string&)> Warn;    ///< called on rank 0 only
};

} // namespace banyan

#endif
