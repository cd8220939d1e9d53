// SPDX-License-Identifier: BSD-3-Clause
// A writer that is told to stop leaves whole steps that open, or what was there before.
#include "WriterRobustness.h"

#include "vtkBanyanSeriesReader.h"

#include "vtkCommand.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <csignal>

namespace
{

/// Calls a function, whatever the event.
class LambdaCommand : public vtkCommand
{
public:
  static LambdaCommand* New() { return new LambdaCommand; }
  void Execute(vtkObject*, unsigned long, void*) override { this->Action(); }
  std::function<void()> Action;
};

int FilesIn(const std::string& folder)
{
  return static_cast<int>(std::distance(
    std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

/// Makes a writer stop as soon as `when` holds; `told` receives the progress.
void StopWhen(vtkBanyanSeriesWriter* writer, const std::function<bool()>& when,
  std::vector<double>* told = nullptr)
{
  vtkNew<LambdaCommand> stop;
  stop->Action = [=]
  {
    writer->SetAbortExecute(writer->GetAbortExecute() || when());
    if (told)
    {
      told->push_back(writer->GetProgress());
    }
  };
  writer->AddObserver(vtkCommand::ProgressEvent, stop);
}

TEST_P(WriterRobustness, AbortedBeforeAnythingIsEncoded)
{
  this->Change = [](vtkBanyanSeriesWriter* w) { StopWhen(w, [] { return true; }); };
  this->ExpectRefused(this->SourceThatChanges([](vtkImageData*) {}), { "interrupted" });
}

TEST_P(WriterRobustness, AbortedInTheMiddleTheSeriesHoldsWhatWasFinished)
{
  const std::string path = this->Folder / "a.banyan";
  const auto source = WaveSource(SimpleGrid({ 12, 11, 10 }), { 0.0, 0.5, 1.5, 2.0, 3.0, 4.0 });
  std::vector<double> told;
  this->Change = [&](vtkBanyanSeriesWriter* w)
  {
    w->SetKeyframeInterval(2);
    StopWhen(
      w, [path] { return std::filesystem::exists(path); }, &told);
  };
  this->Refuse(source, { "interrupted", "holds the first" });
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.back(), 0.0);
  const auto reader = Reader(path);
  reader->UpdateInformation();
  vtkInformation* info = reader->GetOutputInformation(0);
  const int steps = info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  EXPECT_GE(steps, 2);
  EXPECT_LT(steps, 6);
  EXPECT_EQ(steps % 2, 0);
  EXPECT_EQ(FilesIn(path + ".d"), steps / 2);
  for (int step = 0; step < steps; ++step)
  {
    const double time = source->Times[static_cast<std::size_t>(step)];
    EXPECT_LE(LargestDifference(ImageAt(source, time)->GetPointData()->GetScalars(),
                ImageAt(reader, time)->GetPointData()->GetScalars()),
      0.2);
  }
  // What was interrupted can be written again, to its end.
  WriteSeries(source, path);
  EXPECT_EQ(FilesIn(path + ".d"), 1);
}

TEST_P(WriterRobustness, AbortedAnOlderSeriesStays)
{
  const auto good = WaveSource(SimpleGrid({ 7, 7, 7 }), { 0.0, 1.0 });
  WriteSeries(good, this->Folder / "a.banyan");
  const std::string before = SeriesBytes(this->Folder / "a.banyan");
  this->Change = [](vtkBanyanSeriesWriter* w)
  { StopWhen(w, [w] { return w->GetProgress() > 0.4; }); };
  this->Refuse(this->SourceThatChanges([](vtkImageData*) {}), { "interrupted", "was not written" });
  EXPECT_TRUE(SeriesBytes(this->Folder / "a.banyan") == before);
}

TEST_P(WriterRobustness, ASignalInterruptsAndComesAgain)
{
  static int caught = 0;
  caught = 0;
  const auto before = std::signal(SIGTERM, [](int) { ++caught; });
  const std::string path = this->Folder / "a.banyan";
  this->Change = [path](vtkBanyanSeriesWriter* w)
  {
    vtkNew<LambdaCommand> send;
    bool sent = false;
    send->Action = [path, sent]() mutable
    {
      if (!sent && std::filesystem::exists(path))
      {
        sent = true;
        EXPECT_EQ(std::raise(SIGTERM), 0);
        EXPECT_EQ(caught, 0);
      }
    };
    w->AddObserver(vtkCommand::ProgressEvent, send);
  };
  this->Refuse(this->SourceThatChanges([](vtkImageData*) {}), { "interrupted", "holds the first" });
  EXPECT_EQ(caught, 1);
  (void)std::signal(SIGTERM, before);
  const auto reader = Reader(path);
  reader->UpdateInformation();
  EXPECT_GE(
    reader->GetOutputInformation(0)->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 1);
}

} // namespace
