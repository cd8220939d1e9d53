// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_StepPuller_h
#define banyan_Filters_StepPuller_h

#include "GridSteps.h"
#include "MeshSteps.h"
#include "PipelineInput.h"
#include "StepReport.h"
#include "WritingOrder.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkImageData;

namespace banyan
{

class Communicator;

/// Pulls steps out of a pipeline, each rank its own piece, and lets all ranks agree on each step.
/// Meshes, and grids with points of their own, become images (see MeshSteps, GridSteps).
class StepPuller
{
public:
  enum class Purpose
  {
    Ranges,      ///< the step is looked at, with the ranges of its values
    Values,      ///< the step is encoded
    ValuesAgain, ///< the step is encoded, and was pulled for its ranges before
  };

  /// @param order, ranks must outlive this object
  /// @param tick called again and again while ranks wait for each other
  StepPuller(const WritingOrder& order, Communicator& ranks, std::function<void()> tick);

  /// Collective. Asks for the times of the input; those of rank 0 count. Throws CollectiveError.
  void FindTimes();

  /// Steps of the series, at least 1.
  int Count() const;

  /// Collective. Throws Interruption when a rank was told to stop, else CollectiveError when a rank
  /// has no such step.
  StepAgreement Pull(int step, Purpose purpose);

  /// Time of a step; without times in the input, the time that its present data have, or 0.
  double TimeOf(int step) const;

  /// "step 3 (time 0.5)", for messages.
  std::string Named(int step) const;

  /// This rank's piece of the step that was pulled last, as an image.
  vtkImageData* Mine() const;

  MeshSteps& Meshes() { return this->Mesh; }
  GridSteps& Grids() { return this->Grid; }

private:
  vtkSmartPointer<vtkDataObject> PullMine(int step, bool withFiles) const;
  void CheckTime(int step, vtkDataObject* data) const;
  StepReport ReportOfMine(bool withRanges) const;
  std::vector<StepReport> ReportsOfAll(const StepReport& mine) const;

  const WritingOrder& Order;
  Communicator& Ranks;
  std::function<void()> Tick;
  PipelineInput Input;
  MeshSteps Mesh;
  GridSteps Grid;
  std::vector<double> Times;           ///< none: the input has one step without a time
  vtkSmartPointer<vtkDataObject> Data; ///< of this rank: the last step, as an image
};

} // namespace banyan

#endif
