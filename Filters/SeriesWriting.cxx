// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesWriting.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"

#include "Base/ThreadPool.h"
#include "Series/Encode/EncodePlan.h"
#include "Series/Format/SeriesPath.h"

#include <algorithm>
#include <sstream>

namespace banyan
{
SeriesWriting::SeriesWriting(WritingOrder order)
  : Order(std::move(order))
  , Talk(this->Order.Controller)
  , Input(this->Order.Producer, this->Order.Port)
  , Gathering(this->Talk, this->Order.Controller)
  , Histograms(this->Order.Options)
  , Meshes(this->Talk, this->Order.Controller, this->Order.Options, this->Order.Selection,
      this->Order.CellSelection, this->Order.Displacements)
{
  const bool relative = this->Order.Options.Mode == ErrorBoundMode::RelativeToSeriesRange &&
                        this->Order.Options.ErrorBound > 0.0;
  const QuantizerOptions& quantizer = this->Order.Options.Quantizer;
  this->TwoPasses = quantizer.NeedsHistogram(relative) ||
                    (relative && quantizer.Range.From != RangeRule::Source::Given);
}

SeriesWriting::~SeriesWriting() = default;

void SeriesWriting::Run()
{
  try
  {
    this->AskForTimes();
    this->TakeLock();
    try
    {
      this->Write();
    }
    catch (const LateHiding&)
    {
      this->StartAnew();
      this->Write();
    }
  }
  catch (const Interruption&)
  {
    this->GiveUp(true);
    throw;
  }
  catch (const AgreedError&)
  {
    this->GiveUp(false);
    throw;
  }
}

void SeriesWriting::Write()
{
  if (this->TwoPasses)
  {
    this->FirstPass();
  }
  this->SecondPass();
  this->Encoder->Wait([this] { this->Tick(); });
  this->Exchange("at the end");
  this->Talk.OnRank(0,
    [this]
    {
      if (!this->IndexProblem.empty())
      {
        throw Error(this->IndexProblem);
      }
      this->Assembly->Finish();
      this->Folder->RemoveReplaced(this->Assembly->FilesBefore(), this->Assembly->FilesInFile());
    });
}

/// Collective. Before anything is computed: it may take hours.
void SeriesWriting::TakeLock()
{
  std::string path;
  this->Talk.OnRank(0,
    [&]
    {
      path = FollowLinks(this->Order.FileName);
      this->Lock = std::make_unique<SeriesLock>(path);
    });
  this->Order.FileName = this->Talk.FromRankZero({ path })[0];
}

std::string SeriesWriting::Named(int step) const
{
  std::ostringstream text;
  text << "step " << step;
  if (this->HasTimes)
  {
    text << " (time " << this->Times[step] << ")";
  }
  return text.str();
}

void SeriesWriting::Report()
{
  const double steps = static_cast<double>(this->Times.size());
  double done = this->Step / steps;
  if (this->InSecondPass)
  {
    const double encoding = this->Encoder ? this->Encoding * this->Encoder->Share() : 0.0;
    done = (done + (this->Encoded + encoding) / steps) / 2.0;
  }
  if (this->TwoPasses)
  {
    done = (done + (this->InSecondPass ? 1.0 : 0.0)) / 2.0;
  }
  this->Told = std::min(std::max(done, this->Told), 1.0);
  this->Order.Progress(this->Told);
}

void SeriesWriting::Tick()
{
  this->Report();
  if (this->Encoder && this->Order.Aborted())
  {
    this->Encoder->Interrupt();
  }
}

//--------------------------------------------------------------------------------------------------
// Input

void SeriesWriting::AskForTimes()
{
  std::string problem;
  try
  {
    if (this->Order.FileName.empty())
    {
      throw Error("No file name is set for the series.");
    }
    this->Times = this->Input.Times(this->Order.AllSteps);
    this->HasTimes = !this->Times.empty();
    if (!this->HasTimes)
    {
      this->Times.assign(1, 0.0);
    }
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
  this->Talk.AgreeOn(problem);
  if (this->Talk.Ranks() > 1)
  {
    // Every rank asks for the steps of rank 0, so that all go through the same number of them.
    vtkMultiProcessStream stream;
    stream << static_cast<int>(this->HasTimes) << static_cast<int>(this->Times.size());
    for (const double time : this->Times)
    {
      stream << time;
    }
    this->Order.Controller->Broadcast(stream, 0);
    int hasTimes = 0;
    int steps = 0;
    stream >> hasTimes >> steps;
    this->HasTimes = hasTimes != 0;
    this->Times.resize(steps);
    for (double& time : this->Times)
    {
      stream >> time;
    }
  }
}

vtkSmartPointer<vtkDataObject> SeriesWriting::PullMine(int step) const
{
  const bool seenBefore = this->TwoPasses && this->InSecondPass;
  vtkSmartPointer<vtkDataObject> data = this->Input.Pull(this->Talk.Rank(), this->Talk.Ranks(),
    this->HasTimes ? &this->Times[step] : nullptr, !seenBefore);
  this->CheckTime(step, data);
  return data;
}

StepReport SeriesWriting::ReportOfMine(bool withRanges) const
{
  // The images of a mesh are those that are to be written.
  const vtkNew<vtkDataArraySelection> all;
  StepReport report =
    ReportOf(this->Data, this->Meshes.Active() ? *all : *this->Order.Selection, withRanges);
  if (this->Meshes.Active())
  {
    report.Warning += this->Meshes.Warning();
    report.NotChosen = this->Meshes.NotChosen();
  }
  // Values that are decoded or copied on first touch are touched here, where a failure can still
  // be agreed upon.
  for (const WrittenArray& array : report.Arrays)
  {
    ArrayOf(this->Mine(), array.Name)->GetVoidPointer(0);
  }
  return report;
}

StepAgreement SeriesWriting::Pull(int step, bool withRanges)
{
  StepReport mine;
  const auto attempt = [&](const std::function<void()>& action)
  {
    try
    {
      action();
    }
    catch (const std::bad_alloc&)
    {
      mine.Problem = "There is not enough memory for a piece of the input.";
    }
    catch (const std::exception& error)
    {
      mine.Problem = error.what();
    }
  };
  attempt([&] { this->Data = this->PullMine(step); });
  this->Talk.Meet([this] { this->Tick(); });
  mine.Problem = this->Meshes.Take(this->Data, mine.Problem);
  if (mine.Problem.empty())
  {
    attempt([&] { mine = this->ReportOfMine(withRanges); });
  }
  this->Talk.Meet([this] { this->Tick(); });
  mine.Aborted = this->Order.Aborted();

  vtkMultiProcessStream stream;
  mine.Save(stream);
  std::vector<StepReport> reports;
  for (vtkMultiProcessStream& theirs : this->Talk.Exchange(stream))
  {
    reports.emplace_back();
    reports.back().Load(theirs);
  }
  StepAgreement now = Agree(reports);
  if (now.Aborted)
  {
    throw Interruption("Writing was interrupted at " + this->Named(step) + ".");
  }
  if (!now.Problem.empty())
  {
    throw AgreedError("At " + this->Named(step) + ": " + now.Problem);
  }
  return now;
}

//--------------------------------------------------------------------------------------------------
// Passes

void SeriesWriting::FirstPass()
{
  for (int step = 0; step < static_cast<int>(this->Times.size()); ++step)
  {
    this->Step = step;
    this->Report();
    const StepAgreement now = this->Pull(step, true);
    this->Remember(step, now);
    for (WrittenArray& array : this->First.Arrays)
    {
      // The same arrays, but perhaps in another order.
      const auto same = std::find_if(now.Arrays.begin(), now.Arrays.end(),
        [&](const WrittenArray& other) { return other.Name == array.Name; });
      for (std::size_t c = 0; c < array.Ranges.size(); ++c)
      {
        array.Ranges[c].Include(same->Ranges[c]);
      }
    }
    this->Talk.Together([&] { this->Histograms.Count(this->Mine(), now, this->Talk.Rank()); });
  }
  this->Histograms.Merge(this->Talk, this->First.Arrays);
}

void SeriesWriting::SecondPass()
{
  this->InSecondPass = true;
  for (int step = 0; step < static_cast<int>(this->Times.size()); ++step)
  {
    this->Step = step;
    this->Report();
    const StepAgreement now = this->Pull(step, false);
    if (this->TwoPasses)
    {
      this->CompareWithFirst(step, now);
    }
    else
    {
      this->MustHideAlready(step, now);
      this->Remember(step, now);
    }
    if (step == 0)
    {
      this->Open();
    }
    this->Collect(step, now);
  }
  this->Step = static_cast<int>(this->Times.size());
}

void SeriesWriting::Open()
{
  const std::vector<ArrayDescription> descriptions = this->DescribeArrays();
  if (this->Meshes.Active())
  {
    this->Talk.OnRank(
      0, [&] { this->Folder = std::make_unique<SegmentFolder>(this->Order.FileName); });
    this->Order.Options.Mesh = this->Meshes.Write(this->Folder.get());
  }
  this->Talk.OnRank(0,
    [&]
    {
      this->Assembly = std::make_unique<SeriesAssembly>(
        this->Order.FileName, PlanSeries(this->First.Whole, descriptions, this->Order.Options));
      for (const WrittenArray& array : this->First.Arrays)
      {
        if (array.Name == this->First.ActiveScalars)
        {
          this->Assembly->SetActiveScalars(array.Name);
        }
      }
      if (!this->Folder)
      {
        this->Folder = std::make_unique<SegmentFolder>(this->Order.FileName);
      }
    });
  ThreadPool::SetRanksOnThisNode(this->Talk.RanksOnThisNode());
  this->Talk.Together(
    [&]
    {
      if (!this->Folder)
      {
        this->Folder = std::make_unique<SegmentFolder>(this->Order.FileName);
        if (this->Folder->MadeHere())
        {
          throw Error("It does not see the folder that rank 0 has made: the ranks need a file "
                      "system in common.",
            { this->Folder->Path() });
        }
      }
      SeriesIndex plan = PlanSeries(this->First.Whole, descriptions, this->Order.Options);
      this->Deal = GroupDeal(
        plan, this->Order.Options, static_cast<int>(this->Times.size()), this->Talk.Ranks());
      this->Encoder = std::make_unique<BackgroundEncoder>(
        std::move(plan), this->Order.Options, *this->Folder, ThreadPool::DefaultWidth());
    });
  this->Opened = true;
}

double SeriesWriting::TimeOf(int step) const
{
  if (this->HasTimes)
  {
    return this->Times[step];
  }
  vtkInformation* data = this->Input.Data()->GetInformation();
  return data->Has(vtkDataObject::DATA_TIME_STEP()) ? data->Get(vtkDataObject::DATA_TIME_STEP())
                                                    : 0.0;
}

int SeriesWriting::StepsOf(int group) const
{
  const int interval = this->Order.Options.KeyframeInterval;
  return std::min(interval, static_cast<int>(this->Times.size()) - group * interval);
}

vtkImageData* SeriesWriting::Mine() const
{
  return vtkImageData::SafeDownCast(this->Data);
}

} // namespace banyan
