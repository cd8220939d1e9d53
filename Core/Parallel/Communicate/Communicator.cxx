// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace banyan
{
namespace
{

constexpr int MeetingTag = 0;

/// Waits for a message of every rank in the list, asleep most of the time.
void AwaitBytes(
  Communicator& communicator, const std::vector<int>& ranks, const std::function<void()>& tick)
{
  using std::chrono::microseconds;
  std::vector<char> bytes(ranks.size());
  for (std::size_t i = 0; i < ranks.size(); ++i)
  {
    communicator.ReceiveWhole(ranks[i], MeetingTag, &bytes[i], 1);
  }
  // The last rank to come is noticed this late at most. With 5 ms, saving small steps on two ranks
  // takes a fifth longer: the time of ctest -R PvBatch.Write.2.
  constexpr microseconds longest{ 500 };
  microseconds pause{ 20 };
  Communicator::Arrival arrival;
  for (std::size_t open = ranks.size(); open > 0;)
  {
    if (communicator.TakeAnyWhole(arrival))
    {
      --open;
      continue;
    }
    tick();
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, longest);
  }
}

/// Meet, in a part of Communicator::Together.
void MeetTogether(Communicator& communicator, const std::function<void()>& tick)
{
  std::vector<int> others;
  for (int rank = 1; rank < communicator.Size(); ++rank)
  {
    others.push_back(rank);
  }
  const char byte = 0;
  if (communicator.Rank() == 0)
  {
    AwaitBytes(communicator, others, tick);
    for (const int rank : others)
    {
      communicator.SendWhole(rank, MeetingTag, &byte, 1);
    }
  }
  else
  {
    communicator.SendWhole(0, MeetingTag, &byte, 1);
    AwaitBytes(communicator, { 0 }, tick);
  }
  communicator.WaitAll();
}

} // namespace

void Communicator::LeaveTogether(const std::string&) {}

std::vector<std::string> AllGatherStrings(Communicator& communicator, const std::string& mine)
{
  const std::size_t ranks = static_cast<std::size_t>(communicator.Size());
  const std::uint64_t length = mine.size();
  std::vector<std::uint64_t> lengths(ranks);
  communicator.AllGather(&length, sizeof(length), lengths.data());

  std::vector<std::string> all(ranks);
  const std::size_t longest = *std::max_element(lengths.begin(), lengths.end());
  if (longest == 0)
  {
    return all;
  }
  std::string padded = mine;
  padded.resize(longest);
  std::string gathered(longest * ranks, '\0');
  communicator.AllGather(padded.data(), longest, &gathered[0]);
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    all[rank] = gathered.substr(rank * longest, lengths[rank]);
  }
  return all;
}

std::vector<std::string> BroadcastStrings(
  Communicator& communicator, std::vector<std::string> ofRankZero)
{
  std::uint64_t count = ofRankZero.size();
  communicator.Broadcast(0, &count, sizeof(count));
  ofRankZero.resize(count);
  for (std::string& text : ofRankZero)
  {
    std::uint64_t length = text.size();
    communicator.Broadcast(0, &length, sizeof(length));
    text.resize(length);
    communicator.Broadcast(0, &text[0], length);
  }
  return ofRankZero;
}

void Meet(Communicator& communicator, const std::function<void()>& tick)
{
  communicator.Together([&](Communicator& ranks) { MeetTogether(ranks, tick); });
}

std::vector<double> AllGatherValues(Communicator& communicator, double mine)
{
  std::vector<double> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  return all;
}

double AllSum(Communicator& communicator, double mine)
{
  double sum = 0.0;
  for (const double value : AllGatherValues(communicator, mine))
  {
    sum += value;
  }
  return sum;
}

double AllMax(Communicator& communicator, double mine)
{
  const std::vector<double> all = AllGatherValues(communicator, mine);
  return *std::max_element(all.begin(), all.end());
}

std::string AgreeOnError(Communicator& communicator, const std::string& mine)
{
  return AgreedError(AllGatherStrings(communicator, mine));
}

std::string AgreedError(const std::vector<std::string>& all)
{
  if (all.front().rfind("Rank ", 0) == 0 &&
      std::count(all.begin(), all.end(), all.front()) == static_cast<std::ptrdiff_t>(all.size()))
  {
    return all.front(); // they have agreed on it before
  }
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    if (!all[rank].empty())
    {
      // Alone there is only one rank, and naming it would only puzzle.
      return all.size() == 1 ? all[rank] : "Rank " + std::to_string(rank) + ": " + all[rank];
    }
  }
  return {};
}

} // namespace banyan
