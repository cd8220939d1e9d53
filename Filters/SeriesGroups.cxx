// SPDX-License-Identifier: BSD-3-Clause
// How SeriesWriting deals groups of steps out to the ranks, and what becomes of them.
#include "SeriesWriting.h"

#include "vtkMultiProcessStream.h"

#include "Series/Encode/GroupMessage.h"

#include <algorithm>

namespace banyan
{

void SeriesWriting::Collect(int step, const StepAgreement& now)
{
  const int group = this->Deal.GroupOf(step);
  const int place = this->Deal.PlaceOf(step);
  const int owner = this->Deal.OwnerOf(group);
  const int next = this->Deal.NeedsBefore(step);
  const bool receives = this->Talk.Rank() == owner;
  const bool receivesForNext = this->Talk.Rank() == next;
  if ((place == 0 && receives) || receivesForNext)
  {
    // Its values are those of the group before until that is encoded.
    this->Encoder->Wait([this] { this->Tick(); });
  }
  this->Exchange("at " + this->Named(step));
  StepValues none;
  if (receives)
  {
    this->Values.resize(std::max<std::size_t>(this->Values.size(), place + 1));
  }
  this->Gathering.Gather(
    this->Mine(), now, this->Written, owner, receives ? this->Values[place] : none);
  if (next >= 0)
  {
    this->Gathering.Gather(
      this->Mine(), now, this->Written, next, receivesForNext ? this->ValuesBefore : none);
  }
  if (this->Deal.EndsGroup(step))
  {
    this->Talk.OnRank(owner, [this, group] { this->Encode(group); });
  }
}

void SeriesWriting::Encode(int group)
{
  const int first = group * this->Order.Options.KeyframeInterval;
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
    times.push_back(this->TimeOf(first + place));
    steps.push_back(borrowed(this->Values[place]));
  }
  this->Encoding = static_cast<int>(steps.size());
  this->Encoder->Start(group, std::move(times), std::move(steps), borrowed(this->ValuesBefore));
}

/// Brings the groups that were encoded meanwhile to rank 0, and the problems to all.
void SeriesWriting::Exchange(const std::string& at)
{
  this->Talk.Meet([this] { this->Tick(); });
  std::string problem = this->IndexProblem;
  int number = -1;
  std::string message;
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
    problem = error.what();
  }
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

void SeriesWriting::AddToIndex(const std::string& message, int number)
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

/// Collective. Deletes the files that the index file does not name, and after an error that file as
/// well.
void SeriesWriting::GiveUp(bool interrupted)
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
  for (int group = 0; group < static_cast<int>(keep.size()); ++group)
  {
    this->Kept += this->StepsOf(group);
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
}

} // namespace banyan
