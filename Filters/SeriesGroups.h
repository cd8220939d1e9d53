// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_SeriesGroups_h
#define banyan_Filters_SeriesGroups_h

#include "SeriesHistograms.h"
#include "StepGathering.h"
#include "StepPuller.h"
#include "StepReport.h"
#include "WritingOrder.h"

#include "Base/Bytes.h"
#include "Series/Encode/BackgroundEncoder.h"
#include "Series/Encode/GroupSchedule.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Encode/SeriesAssembly.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// Encodes groups of steps, which are dealt out to the ranks in turn: the pieces of each step are
/// gathered on the rank that has its group, which encodes the group in the background while all
/// ranks go on with the steps that follow. Rank 0 keeps the index.
///
/// Memory: each rank holds the values of one group at a time, and of the step before it. A rank
/// whose group is still being encoded when it should receive the next one makes the others wait.
///
/// One object writes one series once. All public methods but Share() and Interrupt() are
/// collective. They throw CollectiveError; Interruption when a rank was told to stop.
class SeriesGroups
{
public:
  /// @param order, ranks, steps must outlive this object
  /// @param tick called again and again while ranks wait
  SeriesGroups(
    const WritingOrder& order, Communicator& ranks, StepPuller& steps, std::function<void()> tick);

  /// Makes the folder, the file of the mesh, and the index. Needs the first step pulled.
  /// @param series grid, arrays, ranges, and what is hidden
  void Open(const StepAgreement& series, const SeriesHistograms& histograms);

  /// Takes the values of the step that was pulled last, and begins to encode the group that it
  /// ends. Steps come in order.
  void Add(int step, const StepAgreement& now);

  /// After the last step: the series is on the disk, and what it replaces is gone.
  void Finish();

  /// What is not in the index file goes. After an interruption, the groups in it stay as a series.
  /// Never throws what was going wrong in encoding.
  /// @return how many steps the series on the disk holds
  int GiveUp(bool interrupted);

  /// How much of the series is encoded, in [0, 1].
  double Share() const;

  /// Makes encoding end soon, with an error.
  void Interrupt();

private:
  std::vector<ArrayDescription> DescribeArrays(
    const StepAgreement& series, const SeriesHistograms& histograms);
  void OpenIndex(const StepAgreement& series, const SeriesIndex& plan);
  void OpenEncoder(SeriesIndex plan);
  void WritePointsOf(int step, const StepAgreement& now);
  void Encode(int group);
  void Exchange(const std::string& at);
  void TakeEncoded(int& number, Bytes& group);
  void AddToIndex(const Bytes& group, int number);
  int StepsOf(int group) const;

  const WritingOrder& Order;
  Communicator& Ranks;
  StepPuller& Steps;
  std::function<void()> Tick;
  StepGathering Gathering;
  EncodeOptions Options;             ///< those of Order, with mesh and points
  std::vector<WrittenArray> Written; ///< what hides points and cells, if any; arrays of the series

  std::unique_ptr<SeriesAssembly> Assembly; ///< on rank 0
  std::unique_ptr<SegmentFolder> Folder;    ///< of this rank's segments
  std::vector<StepValues> Values;           ///< of this rank's group, by step
  StepValues ValuesBefore;                  ///< of the step before them, where another rank has it
  GroupSchedule Schedule;                   ///< which rank encodes and receives what
  std::unique_ptr<BackgroundEncoder> Encoder; ///< of Values, into Folder
  bool Opened = false;                        ///< all ranks have all that
  std::string IndexProblem;                   ///< of rank 0, to be agreed on
  int Encoded = 0;                            ///< steps, by all ranks
  int Encoding = 0;                           ///< steps, by this rank now
};

} // namespace banyan

#endif
