// SPDX-License-Identifier: BSD-3-Clause
#include "RankTalk.h"

#include "vtkMPIController.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <unistd.h>

namespace banyan
{
namespace
{

constexpr int MeetingTag = 0x42414f; // beside the one of SeriesGathering

/// Waits for a byte from a rank, asleep most of the time.
void AwaitByte(vtkMPIController* controller, int from, const std::function<void()>& tick)
{
  using std::chrono::microseconds;
  char byte = 0;
  vtkMPICommunicator::Request request;
  controller->NoBlockReceive(&byte, 1, from, MeetingTag, request);
  microseconds pause{ 20 };
  while (!request.Test())
  {
    tick();
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, microseconds{ 5000 });
  }
}

} // namespace

RankTalk::RankTalk(vtkMultiProcessController* controller)
  : Controller(controller)
{
  if (controller)
  {
    this->Mine = controller->GetLocalProcessId();
    this->Count = controller->GetNumberOfProcesses();
  }
}

void RankTalk::Meet(const std::function<void()>& tick) const
{
  // Other controllers than MPI's wait in the calls that follow, as they like.
  vtkMPIController* mpi = vtkMPIController::SafeDownCast(this->Controller);
  if (this->Count < 2 || !mpi)
  {
    return;
  }
  const char byte = 0;
  if (this->Mine != 0)
  {
    mpi->Send(&byte, 1, 0, MeetingTag);
    AwaitByte(mpi, 0, tick);
    return;
  }
  for (int rank = 1; rank < this->Count; ++rank)
  {
    AwaitByte(mpi, rank, tick);
  }
  for (int rank = 1; rank < this->Count; ++rank)
  {
    mpi->Send(&byte, 1, rank, MeetingTag);
  }
}

std::vector<vtkMultiProcessStream> RankTalk::Exchange(const vtkMultiProcessStream& mine) const
{
  std::vector<vtkMultiProcessStream> all(1, mine);
  if (this->Count > 1)
  {
    this->Controller->AllGather(mine, all);
  }
  return all;
}

void RankTalk::AgreeOn(const std::string& problem) const
{
  vtkMultiProcessStream mine;
  mine << problem;
  std::vector<vtkMultiProcessStream> all = this->Exchange(mine);
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    std::string theirs;
    all[rank] >> theirs;
    if (!theirs.empty())
    {
      throw AgreedError((this->Count > 1 ? "Rank " + std::to_string(rank) + ": " : "") + theirs);
    }
  }
}

void RankTalk::Together(const std::function<void()>& action) const
{
  std::string problem;
  try
  {
    action();
  }
  catch (const std::bad_alloc&)
  {
    problem = "There is not enough memory for a group of steps of the series. Lower 'Keyframe "
              "Interval' (KeyframeInterval).";
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
  this->AgreeOn(problem);
}

void RankTalk::OnRank(int rank, const std::function<void()>& action) const
{
  this->Together(
    [&]
    {
      if (this->Mine == rank)
      {
        action();
      }
    });
}

std::vector<std::string> RankTalk::FromRankZero(const std::vector<std::string>& texts) const
{
  if (this->Count < 2)
  {
    return texts;
  }
  vtkMultiProcessStream stream;
  stream << static_cast<int>(texts.size());
  for (const std::string& text : texts)
  {
    stream << text;
  }
  this->Controller->Broadcast(stream, 0);
  int count = 0;
  stream >> count;
  std::vector<std::string> received(static_cast<std::size_t>(count));
  for (std::string& text : received)
  {
    stream >> text;
  }
  return received;
}

int RankTalk::RanksOnThisNode() const
{
  char name[256] = {};
  (void)gethostname(name, sizeof(name) - 1);
  vtkMultiProcessStream mine;
  mine << std::string(name);
  std::vector<vtkMultiProcessStream> all = this->Exchange(mine);
  return static_cast<int>(std::count_if(all.begin(), all.end(),
    [&](vtkMultiProcessStream& stream)
    {
      std::string theirs;
      stream >> theirs;
      return theirs == name;
    }));
}

} // namespace banyan
