// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_SeriesWriting_h
#define banyan_Filters_SeriesWriting_h

#include "SeriesChanges.h"
#include "SeriesGroups.h"
#include "SeriesHistograms.h"
#include "StepPuller.h"
#include "WritingOrder.h"

#include "Parallel/Communicate/Communicator.h"
#include "Series/Encode/SeriesLock.h"

#include <memory>

namespace banyan
{

/// Writes the steps of a pipeline as a series. The files are the same, byte for byte, on any number
/// of ranks.
///
/// Everything is decided by all ranks together: a problem of one makes all of them throw the same
/// error, at the same point, that another save of the series is under way included. With a relative
/// error bound the steps are pulled twice: first for the ranges of the whole series; the same where
/// a transform or a range is chosen from the values. Changes of grid, type or arrays between steps
/// are refused in the first pass. Where a save in one pass meets the first hidden points or cells
/// late, all starts anew in two passes.
class SeriesWriting
{
public:
  explicit SeriesWriting(WritingOrder order);
  SeriesWriting(const SeriesWriting&) = delete;
  SeriesWriting& operator=(const SeriesWriting&) = delete;

  /// Collective. Throws CollectiveError or Interruption; then nothing new is on the disk, and a
  /// series that was there under the same name still is. Only when it was interrupted (see
  /// WritingOrder::Aborted) and no series of the name was there, the groups that were finished stay
  /// as a series.
  void Run();

  /// After an interruption: how many steps the series on the disk holds.
  int StepsKept() const { return this->Kept; }

private:
  /// What a pass adds to the progress of the whole.
  struct PassProgress
  {
    double Before = 0.0;   ///< the progress that it begins with
    double Pulling = 0.0;  ///< when all steps are pulled
    double Encoding = 0.0; ///< when all steps are encoded
  };

  void Write();
  void WriteInOnePass();
  void WriteInTwoPasses();
  void LookAtAllSteps();
  void EncodeStep(int step, const StepAgreement& now);
  void TakeLock();
  void StartAnew();
  template <class Action>
  void ForEachStep(const PassProgress& pass, const Action& action);
  void Tick();
  void Report();

  WritingOrder Order;
  std::unique_ptr<Communicator> Ranks;
  StepPuller Steps;
  SeriesChanges Changes;
  SeriesHistograms Histograms;
  std::unique_ptr<SeriesLock> Lock; ///< on rank 0, for all
  std::unique_ptr<SeriesGroups> Groups;
  PassProgress Pass; ///< the present one
  int Pulled = 0;    ///< steps of the present pass
  int Kept = 0;
  double Told = 0.0; ///< progress
};

} // namespace banyan

#endif
