// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_SeriesReaderInternals_h
#define banyan_Readers_SeriesReaderInternals_h

#include "MeshOutput.h"
#include "MeshStepAhead.h"
#include "VerifiedBricks.h"
#include "vtkBanyanSeriesReader.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkTimeStamp.h"

#include "Series/Decode/SeriesFile.h"

#include <memory>
#include <string>
#include <vector>

struct vtkBanyanSeriesReader::Internals
{
  std::shared_ptr<const banyan::SeriesFile> Series;
  std::string OpenName; ///< the FileName that Series was opened from
  bool Reopen = false;
  banyan::MeshOutput Mesh;
  banyan::MeshStepAhead Ahead;
  double LoadSeconds = 0; ///< of the last update
  banyan::VerifiedBricks Verified;
  vtkNew<vtkDataArraySelection> Selection;     ///< of point arrays
  vtkNew<vtkDataArraySelection> CellSelection; ///< of cell arrays of meshes
  vtkSmartPointer<vtkMultiProcessController> Controller;
  std::string ErrorMessage;
  bool GaveDeferred = false; ///< whether the output has arrays that decode on first touch
  vtkTimeStamp PlainWanted;  ///< when somebody came who needs plain ones instead
  vtkTimeStamp Executed;
  /// Arrays that plain ones have replaced: ParaView's 2D histogram keeps pointers to arrays that it
  /// saw before the update.
  std::vector<vtkSmartPointer<vtkDataArray>> Replaced;

  /// Whether an array of the series is to be read.
  bool Wants(const banyan::ArrayIndex& array) const
  {
    return array.Flags != banyan::ArrayFlags::None ? false
           : array.CellArray.empty()
             ? this->Selection->ArrayIsEnabled(array.Name.c_str()) != 0
             : this->CellSelection->ArrayIsEnabled(array.CellArray.c_str()) != 0;
  }
};

#endif
