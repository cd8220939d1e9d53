// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Communicate_NodeBroadcast_h
#define banyan_Parallel_Communicate_NodeBroadcast_h

#include "Parallel/Communicate/NodeCommunicator.h"

#include <cstddef>
#include <functional>
#include <memory>

namespace banyan
{

/// Collective: work of those who lead a machine, for which the others wait. Throws CollectiveError.
void OnLeaders(
  Communicator& communicator, const NodeCommunicator& machines, const std::function<void()>& work);

/// Bytes that all ranks of a machine read.
struct MachineBytes
{
  std::shared_ptr<char> Memory;
  std::size_t Count = 0;
  bool Together = false; ///< whether other ranks of this machine have the same memory
};

/// Collective: what the leader of each machine writes, for all ranks of it. Nobody writes to it
/// afterwards. It lies in memory that they have together; where that cannot be had (any more), it
/// is sent to those who are no leaders.
/// @param bytes that leaders write, the same on all of them; without effect on other ranks
/// @param write throws nothing: the others wait already
/// Throws CollectiveError when there is not enough memory.
MachineBytes NodeBroadcast(Communicator& communicator, NodeCommunicator& machines,
  std::size_t bytes, const std::function<void(char*)>& write);

} // namespace banyan

#endif
