// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Communicate_NodeCommunicator_h
#define banyan_Parallel_Communicate_NodeCommunicator_h

#include "Parallel/Communicate/Communicator.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// Which ranks run on one machine, and memory that they have together: what all of them read lies
/// there once, and not once per rank.
///
/// The memory is a file without a name (memfd_create), which needs no room in /dev/shm or /tmp, and
/// is gone with the last process that has it, however that ends. Others open it below /proc. All of
/// it is there before it is written to: what does not fit is an Error, not a signal.
/// @par Limits: Linux. Ranks in containers of their own count as on machines of their own.
class NodeCommunicator
{
public:
  /// The same for processes that can have memory together: the running kernel, the namespace of
  /// processes and the user. Empty where that cannot be found out, and where the variable
  /// BANYAN_SHARED_MEMORY is 0: the rank is on its own then.
  static std::string ThisMachine();

  /// Collective.
  /// @param machine of this rank
  explicit NodeCommunicator(Communicator& communicator, const std::string& machine = ThisMachine());

  /// Whether some machine has several ranks, and they have memory together.
  bool Shares() const { return this->Sharing; }
  /// Whether this rank is the lowest one of its machine.
  bool Leads() const { return this->LeaderOf(this->Self) == this->Self; }
  int LeaderOf(int rank) const { return this->LeaderOfRank[static_cast<std::size_t>(rank)]; }
  /// How many ranks have memory together with this one, itself included.
  int RanksHere() const
  {
    return this->Sharing ? this->RanksOfMachine[static_cast<std::size_t>(this->Self)] : 1;
  }
  /// The lowest rank of each machine, in ascending order.
  const std::vector<int>& Leaders() const { return this->AllLeaders; }

  /// Memory that all ranks of a machine have together, all zero; collective. It lasts until the
  /// last rank lets it go. After a Barrier, others may read what one rank wrote.
  ///
  /// Where memory cannot be had together, each rank is on its own from then on (Shares() is false,
  /// each rank leads), and has the memory for itself.
  /// @param bytes the same on all ranks
  /// Throws CollectiveError when there is not enough memory.
  std::shared_ptr<char> Allocate(Communicator& communicator, std::size_t bytes);

  /// Why ranks of a machine have no memory together although they could; empty if all is well. The
  /// same on all ranks.
  const std::string& WhyNot() const { return this->Reason; }

private:
  void BeAlone();
  std::shared_ptr<char> TogetherOrNull(Communicator& communicator, std::size_t bytes);

  int Self = 0;
  bool Sharing = false;
  std::vector<int> LeaderOfRank;
  std::vector<int> AllLeaders;
  std::vector<int> RanksOfMachine; ///< per rank, whether they share or not
  std::string Reason;
};

} // namespace banyan

#endif
