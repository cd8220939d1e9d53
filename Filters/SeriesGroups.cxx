// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesGroups.h"

#include "vtkMultiProcessStream.h"

#include "Base/ThreadPool.h"
#include "Series/Encode/EncodePlan.h"
#include "Series/Encode/GroupMessage.h"

#include <algorithm>

namespace banyan
{

SeriesGroups::SeriesGroups(const WritingOrder& order, const RankTalk& talk, const StepPuller& steps,
  std::function<void()> tick)
  : Order(order)
  , Talk(talk)
  , Steps(steps)
  , Tick(std::move(tick))
  , Gathering(talk, order.Controller)
  , Options(order.Options)
{
}

/// Sets `Written`, too.
std::vector<ArrayDescription> SeriesGroups::DescribeArrays(
  const StepAgreement& series, const SeriesHistograms& histograms)
{
  std::vector<ArrayDescription> descriptions;
  for (const ArrayFlags flags : { ArrayFlags::OfPoints, ArrayFlags::OfCells })
  {
    if (flags == ArrayFlags::OfPoints ? series.HidesPoints : series.HidesCells)
    {
      this->Written.push_back(HiddenFlags(flags));
      descriptions.push_back(DescriptionOfFlags(flags));
    }
  }
  for (const WrittenArray& array : series.Arrays)
  {
    this->Written.push_back(array);
    descriptions.push_back(
      { array.Name, array.Type, array.Components, array.Ranges, histograms.Of(array.Name) });
  }
  return descriptions;
}

void SeriesGroups::Open(const StepAgreement& series, const SeriesHistograms& histograms)
{
  const std::vector<ArrayDescription> descriptions = this->DescribeArrays(series, histograms);
  if (this->Steps.Meshes().Active())
  {
    this->Talk.OnRank(
      0, [&] { this->Folder = std::make_unique<SegmentFolder>(this->Order.FileName); });
    this->Options.Mesh = this->Steps.Meshes().Write(this->Folder.get());
  }
  const auto plan = [&] { return PlanSeries(series.Whole, descriptions, this->Options); };
  this->Talk.OnRank(0, [&] { this->OpenIndex(series, plan()); });
  ThreadPool::SetRanksOnThisNode(this->Talk.RanksOnThisNode());
  this->Talk.Together([&] { this->OpenEncoder(plan()); });
  this->Opened = true;
}

/// On rank 0.
void SeriesGroups::OpenIndex(const StepAgreement& series, const SeriesIndex& plan)
{
  this->Assembly = std::make_unique<SeriesAssembly>(this->Order.FileName, plan);
  for (const WrittenArray& array : series.Arrays)
  {
    if (array.Name == series.ActiveScalars)
    {
      this->Assembly->SetActiveScalars(array.Name);
    }
  }
  if (!this->Folder)
  {
    this->Folder = std::make_unique<SegmentFolder>(this->Order.FileName);
  }
}

void SeriesGroups::OpenEncoder(SeriesIndex plan)
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
  this->Schedule = GroupSchedule(plan, this->Options, this->Steps.Count(), this->Talk.Ranks());
  this->Encoder = std::make_unique<BackgroundEncoder>(
    std::move(plan), this->Options, *this->Folder, ThreadPool::DefaultWidth());
}

void SeriesGroups::Add(int step, const StepAgreement& now)
{
  const int group = this->Schedule.GroupOf(step);
  const int place = this->Schedule.PlaceOf(step);
  const int owner = this->Schedule.OwnerOf(group);
  const int next = this->Schedule.NeedsBefore(step);
  const bool receives = this->Talk.Rank() == owner;
  const bool receivesForNext = this->Talk.Rank() == next;
  if ((place == 0 && receives) || receivesForNext)
  {
    // Its values are those of the group before until that is encoded.
    this->Encoder->Wait(this->Tick);
  }
  this->Exchange("at " + this->Steps.Named(step));
  StepValues none;
  if (receives)
  {
    this->Values.resize(std::max<std::size_t>(this->Values.size(), place + 1));
  }
  this->Gathering.Gather(
    this->Steps.Mine(), now, this->Written, owner, receives ? this->Values[place] : none);
  if (next >= 0)
  {
    this->Gathering.Gather(
      this->Steps.Mine(), now, this->Written, next, receivesForNext ? this->ValuesBefore : none);
  }
  if (this->Schedule.EndsGroup(step))
  {
    this->Talk.OnRank(owner, [this, group] { this->Encode(group); });
  }
}

void SeriesGroups::Encode(int group)
{
  const int first = group * this->Options.KeyframeInterval;
  const auto borrowed = [](const StepValues& step)
  {
    std::vector<ArrayValues> arrays;
    for (const std::vector<unsigned char>& array : step)
    {
      arrays.push_back({ array.data() });
    }
    return arrays;
  };
  std::vector<double> times;
  std::vector<std::vector<ArrayValues>> steps;
  for (int place = 0; place < this->StepsOf(group); ++place)
  {
    times.push_back(this->Steps.TimeOf(first + place));
    steps.push_back(borrowed(this->Values[place]));
  }
  this->Encoding = static_cast<int>(steps.size());
  this->Encoder->Start(group, std::move(times), std::move(steps), borrowed(this->ValuesBefore));
}

void SeriesGroups::Finish()
{
  this->Encoder->Wait(this->Tick);
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

/// @param number of the group that was encoded meanwhile, if one was
/// @param message that group
/// @return what went wrong on this rank, or nothing
std::string SeriesGroups::TakeEncoded(int& number, std::string& message)
{
  try
  {
    if (auto encoded = this->Encoder->Take())
    {
      const Bytes bytes = PackGroup(encoded->second);
      number = encoded->first;
      message.assign(bytes.begin(), bytes.end());
      this->Encoding = 0;
    }
  }
  catch (const std::exception& error)
  {
    return error.what();
  }
  return this->IndexProblem;
}

/// Brings the groups that were encoded meanwhile to rank 0, and the problems to all.
void SeriesGroups::Exchange(const std::string& at)
{
  this->Talk.Meet(this->Tick);
  int number = -1;
  std::string message;
  std::string problem = this->TakeEncoded(number, message);
  vtkMultiProcessStream mine;
  mine << static_cast<int>(this->Order.Aborted()) << problem << number << message;
  bool aborted = false;
  std::string first;
  int rank = 0;
  for (vtkMultiProcessStream& theirs : this->Talk.Exchange(mine))
  {
    int theirAborted = 0;
    theirs >> theirAborted >> problem >> number >> message;
    aborted = aborted || theirAborted != 0;
    if (first.empty() && !problem.empty())
    {
      first = (this->Talk.Ranks() > 1 ? "Rank " + std::to_string(rank) + ": " : "") + problem;
    }
    if (number >= 0)
    {
      this->AddToIndex(message, number);
    }
    ++rank;
  }
  if (aborted)
  {
    throw Interruption("Writing was interrupted " + at + ".");
  }
  if (!first.empty())
  {
    throw AgreedError(first);
  }
}

void SeriesGroups::AddToIndex(const std::string& message, int number)
{
  this->Encoded += this->StepsOf(number);
  if (!this->Assembly)
  {
    return;
  }
  try
  {
    this->Assembly->Add(number, UnpackGroup(Bytes(message.begin(), message.end())));
  }
  catch (const std::exception& error)
  {
    this->IndexProblem = error.what();
  }
}

int SeriesGroups::GiveUp(bool interrupted)
{
  if (this->Opened) // everywhere
  {
    this->Encoder->Interrupt();
    this->Encoder->Wait([] {});
    try
    {
      this->Exchange("");
    }
    catch (const AgreedError&)
    {
      // Errors of encoding after it was interrupted are of no interest.
    }
  }
  std::vector<std::string> keep;
  if (this->Assembly)
  {
    if (!interrupted)
    {
      this->Assembly->Withdraw();
    }
    keep = this->Assembly->SegmentsInFile();
  }
  keep = this->Talk.FromRankZero(keep);
  int steps = 0;
  for (int group = 0; group < static_cast<int>(keep.size()); ++group)
  {
    steps += this->StepsOf(group);
  }
  if (this->Folder && this->Talk.Rank() > 0)
  {
    this->Folder->RemoveOwn(keep);
  }
  this->Talk.Meet([] {});
  if (this->Assembly)
  {
    keep = this->Assembly->FilesInFile();
  }
  if (this->Folder && this->Talk.Rank() == 0)
  {
    this->Folder->RemoveOwn(keep); // and the folder, once the others have removed theirs
  }
  return steps;
}

double SeriesGroups::Share() const
{
  const double encoding = this->Encoder ? this->Encoding * this->Encoder->Share() : 0.0;
  return (this->Encoded + encoding) / this->Steps.Count();
}

void SeriesGroups::Interrupt()
{
  if (this->Encoder)
  {
    this->Encoder->Interrupt();
  }
}

int SeriesGroups::StepsOf(int group) const
{
  const int interval = this->Options.KeyframeInterval;
  return std::min(interval, this->Steps.Count() - group * interval);
}

} // namespace banyan
