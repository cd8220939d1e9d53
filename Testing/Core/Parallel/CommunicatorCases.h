// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_CommunicatorCases_h
#define banyan_Testing_CommunicatorCases_h

#include "Parallel/Communicate/Communicator.h"

#include <string>
#include <vector>

// What every communicator must do, the same on simulated ranks and under MPI. All functions are
// collective and return what is wrong, or an empty string.
namespace banyan::testing
{

/// Byte i of message number `message` from one rank to another: each is different.
inline char ByteOf(int from, int to, int message, std::size_t i)
{
  return static_cast<char>(from * 31 + to * 17 + message * 7 + static_cast<int>(i % 251));
}

inline std::vector<char> MessageOf(int from, int to, int message, std::size_t bytes)
{
  std::vector<char> data(bytes);
  for (std::size_t i = 0; i < bytes; ++i)
  {
    data[i] = ByteOf(from, to, message, i);
  }
  return data;
}

/// All to all (each to itself too), several messages of equal tag, sizes 0, 1 and `bytes`.
inline std::string CheckMessages(Communicator& communicator, std::size_t bytes)
{
  const std::size_t sizes[] = { bytes, 0, 1, bytes };
  const int self = communicator.Rank();
  std::vector<std::vector<char>> sent, received, expected;
  for (int peer = 0; peer < communicator.Size(); ++peer)
  {
    for (int message = 0; message < 4; ++message)
    {
      sent.push_back(MessageOf(self, peer, message, sizes[message]));
      expected.push_back(MessageOf(peer, self, message, sizes[message]));
      received.emplace_back(sizes[message]);
    }
  }
  for (std::size_t i = 0; i < sent.size(); ++i)
  {
    const int peer = static_cast<int>(i / 4);
    // The last message has a tag of its own and may overtake the others.
    const int tag = i % 4 == 3 ? 32767 : 0;
    communicator.Receive(peer, tag, received[i].data(), received[i].size());
    communicator.Send(peer, tag, sent[i].data(), sent[i].size());
  }
  communicator.WaitAll();
  communicator.WaitAll(); // nothing is left to wait for
  return received == expected ? "" : "messages did not arrive as they were sent";
}

/// Messages of a size that the receiver does not know, from all to all, in the order of arrival.
inline std::string CheckWholeMessages(Communicator& communicator, std::size_t bytes)
{
  const int self = communicator.Rank();
  const int size = communicator.Size();
  for (int round = 0; round < 2; ++round)
  {
    std::vector<std::vector<char>> sent, received;
    for (int peer = 0; peer < size; ++peer)
    {
      sent.push_back(MessageOf(self, peer, round, bytes * static_cast<std::size_t>(peer) / 3));
      received.emplace_back(bytes * static_cast<std::size_t>(size));
      communicator.ReceiveWhole(peer, 9, received.back().data(), received.back().size());
    }
    for (int peer = 0; peer < size; ++peer)
    {
      communicator.SendWhole(peer, 9, sent[peer].data(), sent[peer].size());
    }
    std::vector<bool> here(static_cast<std::size_t>(size), false);
    for (int i = 0; i < size; ++i)
    {
      const Communicator::Arrival arrival = communicator.WaitAnyWhole();
      if (arrival.Posted >= here.size() || here[arrival.Posted])
      {
        return "a message arrived twice";
      }
      here[arrival.Posted] = true;
      received[arrival.Posted].resize(arrival.Bytes);
    }
    communicator.WaitAll();
    for (int peer = 0; peer < size; ++peer)
    {
      if (received[peer] !=
          MessageOf(peer, self, round, bytes * static_cast<std::size_t>(self) / 3))
      {
        return "a message of unknown size did not arrive as it was sent";
      }
    }
  }
  return "";
}

/// The same without waiting: nothing is there before it has been sent, and then it comes.
inline std::string CheckTakingMessages(Communicator& communicator, std::size_t bytes)
{
  const int self = communicator.Rank();
  const int size = communicator.Size();
  Communicator::Arrival arrival;
  if (communicator.TakeAnyWhole(arrival))
  {
    return "a message arrived that was not awaited";
  }
  std::vector<std::vector<char>> sent, received;
  for (int peer = 0; peer < size; ++peer)
  {
    sent.push_back(MessageOf(self, peer, 5, bytes + static_cast<std::size_t>(peer)));
    received.emplace_back(bytes * 2 + static_cast<std::size_t>(size));
    communicator.ReceiveWhole(peer, 11, received.back().data(), received.back().size());
  }
  if (communicator.TakeAnyWhole(arrival))
  {
    return "a message arrived before it was sent";
  }
  communicator.Barrier();
  for (int peer = 0; peer < size; ++peer)
  {
    communicator.SendWhole(peer, 11, sent[peer].data(), sent[peer].size());
  }
  for (int taken = 0; taken < size;)
  {
    if (communicator.TakeAnyWhole(arrival))
    {
      received[arrival.Posted].resize(arrival.Bytes);
      ++taken;
    }
  }
  communicator.WaitAll();
  for (int peer = 0; peer < size; ++peer)
  {
    if (received[peer] != MessageOf(peer, self, 5, bytes + static_cast<std::size_t>(self)))
    {
      return "a message that was taken is not what was sent";
    }
  }
  return communicator.TakeAnyWhole(arrival) ? "a message arrived twice" : "";
}

inline std::string CheckCollectives(Communicator& communicator, std::size_t bytes)
{
  const int size = communicator.Size();
  const int self = communicator.Rank();
  for (int root = 0; root < size; ++root)
  {
    const std::vector<char> expected = MessageOf(root, 0, 1, bytes);
    std::vector<char> data = self == root ? expected : std::vector<char>(bytes);
    communicator.Broadcast(root, data.data(), bytes);
    if (data != expected)
    {
      return "a broadcast did not arrive";
    }
  }
  std::vector<char> all(bytes * static_cast<std::size_t>(size)), expected;
  for (int rank = 0; rank < size; ++rank)
  {
    const std::vector<char> part = MessageOf(rank, 0, 2, bytes);
    expected.insert(expected.end(), part.begin(), part.end());
  }
  communicator.AllGather(MessageOf(self, 0, 2, bytes).data(), bytes, all.data());
  communicator.Barrier();
  return all == expected ? "" : "gathered bytes are not those that the ranks gave";
}

/// A collective operation between posting and waiting must not confuse the messages under way.
inline std::string CheckPostedBeforeCollective(Communicator& communicator)
{
  const int next = (communicator.Rank() + 1) % communicator.Size();
  const int previous = (communicator.Rank() + communicator.Size() - 1) % communicator.Size();
  const int mine = communicator.Rank();
  int received = -1;
  communicator.Receive(previous, 3, &received, sizeof(received));
  communicator.Barrier();
  communicator.Send(next, 3, &mine, sizeof(mine));
  const double sum = AllSum(communicator, 1.0);
  communicator.WaitAll();
  return received == previous && sum == communicator.Size() ? "" : "a posted message went astray";
}

inline std::string CheckHelpers(Communicator& communicator)
{
  const int size = communicator.Size();
  const int self = communicator.Rank();
  const std::vector<std::string> strings =
    AllGatherStrings(communicator, self % 2 == 1 ? std::string(self, 'x') : "");
  for (int rank = 0; rank < size; ++rank)
  {
    if (strings[rank] != (rank % 2 == 1 ? std::string(rank, 'x') : ""))
    {
      return "gathered strings are not those that the ranks gave";
    }
  }
  const std::vector<std::string> texts{ "first", "", std::string("\0z", 2) };
  if (BroadcastStrings(communicator, self == 0 ? texts : std::vector<std::string>(7)) != texts)
  {
    return "strings are not those of rank 0";
  }
  Meet(communicator, [] {});
  // Summed in another order this would give other bits.
  double sum = 0.0;
  for (int rank = 0; rank < size; ++rank)
  {
    sum += 1.0 / (rank + 3);
  }
  if (AllSum(communicator, 1.0 / (self + 3)) != sum)
  {
    return "the sum is not that in rank order";
  }
  if (AllMax(communicator, -1.0 - self) != -1.0 ||
      AllGatherValues(communicator, self).back() != size - 1)
  {
    return "the maximum or the gathered values are wrong";
  }
  if (!AgreeOnError(communicator, "").empty())
  {
    return "ranks agreed on an error that nobody had";
  }
  const std::string agreed = AgreeOnError(communicator, self >= size / 2 ? "No memory." : "");
  const std::string expected =
    size == 1 ? "No memory." : "Rank " + std::to_string(size / 2) + ": No memory.";
  const std::string again = AgreeOnError(communicator, agreed);
  return agreed == expected && again == expected
           ? ""
           : "ranks agreed on '" + agreed + "' and then on '" + again + "'";
}

inline std::string CheckCommunicator(Communicator& communicator)
{
  std::string wrong = CheckMessages(communicator, 1000);
  wrong += CheckWholeMessages(communicator, 1000);
  wrong += CheckTakingMessages(communicator, 100);
  wrong += CheckTakingMessages(communicator, 300000);
  wrong += CheckCollectives(communicator, 0);
  wrong += CheckCollectives(communicator, 777);
  wrong += CheckPostedBeforeCollective(communicator);
  wrong += CheckHelpers(communicator);
  return wrong;
}

} // namespace banyan::testing

#endif
