// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Communicate/NodeBroadcast.h"

#include "Parallel/Communicate/Collective.h"

#include <string>
#include <vector>

namespace banyan
{
namespace
{

constexpr int TagOfBytes = 0;

/// Sends what leaders have made to the other ranks of their machines.
void SendToOthers(
  Communicator& communicator, const std::vector<int>& leaders, const MachineBytes& made)
{
  const int self = communicator.Rank();
  const int leader = leaders[static_cast<std::size_t>(self)];
  for (int rank = 0; rank < communicator.Size(); ++rank)
  {
    if (leader == self && rank != self && leaders[static_cast<std::size_t>(rank)] == self)
    {
      communicator.Send(rank, TagOfBytes, made.Memory.get(), made.Count);
    }
  }
  if (leader != self)
  {
    communicator.Receive(leader, TagOfBytes, made.Memory.get(), made.Count);
  }
  communicator.WaitAll();
}

} // namespace

void OnLeaders(
  Communicator& communicator, const NodeCommunicator& machines, const std::function<void()>& work)
{
  Collective(communicator,
    [&]
    {
      if (machines.Leads())
      {
        work();
      }
    });
}

MachineBytes NodeBroadcast(Communicator& communicator, NodeCommunicator& machines,
  std::size_t bytes, const std::function<void(char*)>& write)
{
  // Lists the ranks that lead now. Each rank does when memory cannot be shared.
  std::vector<int> leaders;
  for (int rank = 0; rank < communicator.Size(); ++rank)
  {
    leaders.push_back(machines.LeaderOf(rank));
  }
  const int self = communicator.Rank();
  const int leader = leaders[static_cast<std::size_t>(self)];
  MachineBytes made;
  made.Count = static_cast<std::size_t>(
    AllMax(communicator, leader == self ? static_cast<double>(bytes) : 0.0));
  made.Memory = machines.Allocate(communicator, made.Count);
  made.Together = machines.RanksHere() > 1;
  if (leader == self)
  {
    write(made.Memory.get());
  }
  if (!machines.Shares())
  {
    communicator.Together([&](Communicator& ranks) { SendToOthers(ranks, leaders, made); });
  }
  communicator.Barrier();
  return made;
}

} // namespace banyan
