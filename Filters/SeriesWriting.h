// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_SeriesWriting_h
#define banyan_Filters_SeriesWriting_h

#include "MeshSteps.h"
#include "PipelineInput.h"
#include "RankTalk.h"
#include "SeriesHistograms.h"
#include "StepGathering.h"
#include "StepReport.h"

#include "Series/Encode/BackgroundEncoder.h"
#include "Series/Encode/GroupDeal.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Encode/SeriesAssembly.h"
#include "Series/Encode/SeriesLock.h"

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArraySelection;
class vtkImageData;
class vtkMultiProcessController;

namespace banyan
{

/// Says what is to be written, and how.
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

/// Pulls the steps of a series out of a pipeline, each rank its own piece. Meshes become images
/// (see MeshSteps). Groups of steps are dealt out to the ranks in turn: the pieces of each step are
/// gathered on the rank that has its group, which encodes the group in the background while all
/// ranks go on with the steps that follow. Rank 0 keeps the index. The files are the same, byte for
/// byte, on any number of ranks.
///
/// Memory: each rank holds the values of one group at a time, and of the step before it. A rank
/// whose group is still being encoded when it should receive the next one makes the others wait.
///
/// Everything is decided by all ranks together: a problem of one makes all of them throw the same
/// Error, at the same point, that another save of the series is under way included. With a relative
/// error bound the steps are pulled twice: first for the ranges of the whole series; the same where
/// a transform or a range is chosen from the values. Changes of grid, type or arrays between steps
/// are refused in the first pass. Where it is only found in the second one that points or cells are
/// hidden, all starts anew with a first one.
class SeriesWriting
{
public:
  explicit SeriesWriting(WritingOrder order);
  ~SeriesWriting();

  /// Collective. Throws Error on all ranks; then nothing new is on the disk, and a series that was
  /// there under the same name still is. Only when it was interrupted (see WritingOrder::Aborted)
  /// and no series of the name was there, the groups that were finished stay as a series.
  void Run();

  /// After an interruption: how many steps the series on the disk holds.
  int StepsKept() const { return this->Kept; }

private:
  /// A step hides points or cells, and the files so far say that none does.
  class LateHiding : public AgreedError
  {
  public:
    using AgreedError::AgreedError;
  };

  void Write();
  void TakeLock();
  void AskForTimes();
  vtkSmartPointer<vtkDataObject> PullMine(int step) const;
  void CheckTime(int step, vtkDataObject* data) const;
  StepReport ReportOfMine(bool withRanges) const;
  StepAgreement Pull(int step, bool withRanges);
  void Remember(int step, const StepAgreement& now);
  void CompareWithFirst(int step, const StepAgreement& now) const;
  void WarnOf(int step, const StepAgreement& now);
  void MustHideAlready(int step, const StepAgreement& now) const;
  std::vector<ArrayDescription> DescribeArrays();
  void StartAnew();
  void FirstPass();
  void SecondPass();
  void Open();
  void Collect(int step, const StepAgreement& now);
  void Encode(int group);
  void Exchange(const std::string& at);
  void AddToIndex(const std::string& message, int number);
  void GiveUp(bool interrupted);
  double TimeOf(int step) const;
  int StepsOf(int group) const;
  vtkImageData* Mine() const;
  void Tick();
  void Report();
  std::string Named(int step) const;

  WritingOrder Order;
  RankTalk Talk;
  PipelineInput Input;
  StepGathering Gathering;
  SeriesHistograms Histograms;
  MeshSteps Meshes;
  vtkSmartPointer<vtkDataObject> Data; ///< of this rank: the step under way, as an image
  bool TwoPasses = false;
  bool InSecondPass = false;
  bool HasTimes = false; ///< whether the input has time steps that we go through
  std::vector<double> Times;
  StepAgreement First; ///< of step 0; its Ranges are those of the series after the first pass
  std::vector<WrittenArray>
    Written;                    ///< what hides points and cells, if any is hidden; arrays of First
  std::set<std::string> Warned; ///< what users know already

  std::unique_ptr<SeriesLock> Lock;         ///< on rank 0, for all
  std::unique_ptr<SeriesAssembly> Assembly; ///< on rank 0
  std::unique_ptr<SegmentFolder> Folder;    ///< of this rank's segments
  std::vector<StepValues> Values;           ///< of this rank's group, by step
  StepValues ValuesBefore;                  ///< of the step before them, where another rank has it
  GroupDeal Deal;                           ///< which rank encodes and receives what
  std::unique_ptr<BackgroundEncoder> Encoder; ///< of Values, into Folder
  bool Opened = false;                        ///< all ranks have all that
  std::string IndexProblem;                   ///< of rank 0, to be agreed on
  int Encoded = 0;                            ///< steps, by all ranks
  int Encoding = 0;                           ///< steps, by this rank now
  int Step = 0;                               ///< that is being pulled
  int Kept = 0;
  double Told = 0.0; ///< progress
};

} // namespace banyan

#endif
