// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesGroups.h"

#include "Base/Interruption.h"
#include "Base/ThreadPool.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Series/Encode/EncodePlan.h"
#include "Series/Encode/GroupMessage.h"
#include "Series/Points/PointsWriter.h"

#include <algorithm>
#include <cstdint>

namespace banyan
{
namespace
{

constexpr int GroupTag = 2; // beside those of Meet and of StepGathering

/// What a rank tells all others. Plain memory: it is sent as it is.
struct News
{
  std::int32_t Aborted = 0; ///< whether it was told to stop
  std::int32_t Group = -1;  ///< number of the group that it has encoded, if any
  std::uint64_t Bytes = 0;  ///< of that group's message
};

/// Collective: the messages of the groups that ranks have encoded, by rank, on rank 0.
std::vector<Bytes> GroupsOfRanks(
  Communicator& ranks, const std::vector<News>& news, const Bytes& mine)
{
  std::vector<Bytes> groups(news.size());
  if (ranks.Rank() > 0)
  {
    if (!mine.empty())
    {
      ranks.Send(0, GroupTag, mine.data(), mine.size());
    }
    ranks.WaitAll();
    return groups;
  }
  groups.front() = mine;
  for (std::size_t rank = 1; rank < news.size(); ++rank)
  {
    groups[rank].resize(news[rank].Bytes);
    if (!groups[rank].empty())
    {
      ranks.Receive(static_cast<int>(rank), GroupTag, groups[rank].data(), groups[rank].size());
    }
  }
  ranks.WaitAll();
  return groups;
}

} // namespace

SeriesGroups::SeriesGroups(
  const WritingOrder& order, Communicator& ranks, StepPuller& steps, std::function<void()> tick)
  : Order(order)
  , Ranks(ranks)
  , Steps(steps)
  , Tick(std::move(tick))
  , Gathering(ranks)
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
    CollectiveOn(0, this->Ranks,
      [&] { this->Folder = std::make_unique<SegmentFolder>(this->Order.FileName); });
    this->Options.Mesh = this->Steps.Meshes().Write(this->Folder.get());
  }
  this->Options.Points = this->Steps.Grids().Form();
  this->Steps.Grids().Forget(); // another save may have begun, and started anew
  const auto plan = [&] { return PlanSeries(series.Whole, descriptions, this->Options); };
  CollectiveOn(0, this->Ranks, [&] { this->OpenIndex(series, plan()); });
  ThreadPool::SetRanksOnThisNode(this->Ranks.RanksOnThisNode());
  Collective(this->Ranks, [&] { this->OpenEncoder(plan()); });
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
  this->Schedule = GroupSchedule(plan, this->Options, this->Steps.Count(), this->Ranks.Size());
  this->Encoder = std::make_unique<BackgroundEncoder>(
    std::move(plan), this->Options, *this->Folder, ThreadPool::DefaultWidth());
}

void SeriesGroups::Add(int step, const StepAgreement& now)
{
  const int group = this->Schedule.GroupOf(step);
  const int place = this->Schedule.PlaceOf(step);
  const int owner = this->Schedule.OwnerOf(group);
  const int next = this->Schedule.NeedsBefore(step);
  const bool receives = this->Ranks.Rank() == owner;
  const bool receivesForNext = this->Ranks.Rank() == next;
  if ((place == 0 && receives) || receivesForNext)
  {
    // Its values are those of the group before until that is encoded.
    this->Encoder->Wait(this->Tick);
  }
  this->Exchange("at " + this->Steps.Named(step));
  this->WritePointsOf(step, now);
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
    CollectiveOn(
      owner, this->Ranks, [this, group] { this->Encode(group); }, NoMemoryForGroup);
  }
}

/// Collective. Rank 0 writes points that are others than those of the step before.
void SeriesGroups::WritePointsOf(int step, const StepAgreement& now)
{
  if (this->Options.Mesh && this->Options.Mesh->Index.OfCells)
  {
    const auto write = [&]
    {
      if (const auto points = this->Steps.Meshes().WriteMoved(step, *this->Folder))
      {
        this->Assembly->AddPoints(*points);
      }
    };
    CollectiveOn(0, this->Ranks, write, NoMemoryForGroup);
  }
  if (!this->Steps.Grids().Gather(now))
  {
    return;
  }
  CollectiveOn(0, this->Ranks,
    [&]
    {
      const PointsView points = this->Steps.Grids().Whole();
      CheckPoints(points, this->Assembly->Index());
      this->Assembly->AddPoints(
        WritePoints(points, step, this->Folder->PlaceOfPoints(), ThreadPool::Process()));
      this->Steps.Grids().Release();
    });
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
  CollectiveOn(0, this->Ranks,
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
/// @param group that group, as a message
/// Throws what encoding it threw.
void SeriesGroups::TakeEncoded(int& number, Bytes& group)
{
  if (const auto encoded = this->Encoder->Take())
  {
    group = PackGroup(encoded->second);
    number = encoded->first;
    this->Encoding = 0;
  }
}

/// Brings the groups that were encoded meanwhile to rank 0, and the problems to all.
void SeriesGroups::Exchange(const std::string& at)
{
  Meet(this->Ranks, this->Tick);
  News mine;
  Bytes group;
  std::string problem;
  Attempt(
    problem, [&] { this->TakeEncoded(mine.Group, group); }, NoMemoryForGroup);
  problem = problem.empty() ? this->IndexProblem : problem;
  mine.Aborted = this->Order.Aborted() ? 1 : 0;
  mine.Bytes = group.size();
  std::vector<News> news(static_cast<std::size_t>(this->Ranks.Size()));
  this->Ranks.AllGather(&mine, sizeof(mine), news.data());
  const std::vector<Bytes> groups = GroupsOfRanks(this->Ranks, news, group);
  bool aborted = false;
  for (std::size_t rank = 0; rank < news.size(); ++rank)
  {
    aborted = aborted || news[rank].Aborted != 0;
    if (news[rank].Group >= 0)
    {
      this->AddToIndex(groups[rank], news[rank].Group);
    }
  }
  if (aborted)
  {
    throw Interruption("Writing was interrupted " + at + ".");
  }
  ThrowTogether(this->Ranks, problem);
}

void SeriesGroups::AddToIndex(const Bytes& group, int number)
{
  this->Encoded += this->StepsOf(number);
  if (this->Assembly)
  {
    Attempt(this->IndexProblem, [&] { this->Assembly->Add(number, UnpackGroup(group)); });
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
    catch (const CollectiveError&)
    {
      // Errors of encoding after it was interrupted are of no interest.
    }
    catch (const Interruption&)
    {
      // Nor is that somebody wishes what happens already.
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
  keep = BroadcastStrings(this->Ranks, std::move(keep));
  int steps = 0;
  for (int group = 0; group < static_cast<int>(keep.size()); ++group)
  {
    steps += this->StepsOf(group);
  }
  if (this->Folder && this->Ranks.Rank() > 0)
  {
    this->Folder->RemoveOwn(keep);
  }
  Meet(this->Ranks, [] {});
  if (this->Assembly)
  {
    keep = this->Assembly->FilesInFile();
  }
  if (this->Folder && this->Ranks.Rank() == 0)
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
