#ifndef banyan_Filters_SeriesWriting_h
#define banyan_Filters_SeriesWriting_h

#include "PipelineInput.h"
#include "StepReport.h"

#include "Series/SeriesEncoder.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArraySelection;
class vtkImageData;
class vtkMultiProcessController;

namespace banyan
{

/// What is to be written, and how.
struct WritingOrder
{
  std::string FileName;
  EncodeOptions Options;
  vtkAlgorithm* Producer = nullptr; ///< of the image data
  int Port = 0;                     ///< of the producer
  vtkDataArraySelection* Selection = nullptr;
  bool AllSteps = true;
  vtkMultiProcessController* Controller = nullptr; ///< may be nullptr: this rank alone
  std::function<void(double)> Progress;            ///< told a value in [0, 1]
  std::function<bool()> Aborted;
  std::function<void(const std::string&)> Warn; ///< called on rank 0 only
};

/// Pulls the steps of a series out of a pipeline, each rank its own piece, gathers them on rank 0
/// and encodes them there. Everything is decided by all ranks together: a problem of one makes all
/// of them throw the same Error, at the same point.
///
/// With a relative error bound the steps are pulled twice: first for the ranges of the whole
/// series. Changes of grid, type or arrays between steps are refused in the first pass.
class SeriesWriting
{
public:
  explicit SeriesWriting(WritingOrder order);
  ~SeriesWriting();

  /// Collective. Throws Error on all ranks; then nothing new is on the disk, and a series that was
  /// there under the same name still is.
  void Run();

private:
  void AskForTimes();
  StepReport PullMine(int step, bool withRanges) const;
  StepAgreement Pull(int step, bool withRanges);
  void Remember(int step, const StepAgreement& now);
  void CompareWithFirst(int step, const StepAgreement& now) const;
  void FirstPass();
  void SecondPass();
  void Open();
  void Gather(const StepAgreement& step);
  void Transfer(const StepAgreement& step, std::size_t index);
  bool Borrowed(std::size_t index) const;
  vtkImageData* Mine() const;
  void Encode(int step);
  void OnRankZero(const std::function<void()>& action) const;
  void AgreeOn(const std::string& problem) const;
  void Report(int step, double part) const;
  std::string Named(int step) const;

  WritingOrder Order;
  PipelineInput Input;
  int Rank = 0;
  int Ranks = 1;
  bool TwoPasses = false;
  bool InSecondPass = false;
  bool HasTimes = false; ///< whether the input has time steps that we go through
  std::vector<double> Times;
  StepAgreement First; ///< of step 0; its Ranges are those of the series after the first pass
  std::unique_ptr<SeriesEncoder> Encoder;        ///< on rank 0
  std::vector<std::vector<unsigned char>> Whole; ///< on rank 0: one step, by array
  std::vector<const void*> WholeValues;          ///< into Whole, or the input's own memory
  std::vector<unsigned char> Message;
};

} // namespace banyan

#endif
