// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Communicate_ExchangeBytes_h
#define banyan_Parallel_Communicate_ExchangeBytes_h

#include "Base/Bytes.h"

#include <string>
#include <vector>

namespace banyan
{

class Communicator;

/// Collective: sends a message to each rank, and brings what each has for this one.
/// @param to by rank, this one too; nothing is sent where a message is empty. May be too short
/// where this rank has failed
/// @param failure of this rank so far: its sentence, empty if all is well. All ranks agree on it
/// before anything is sent
/// @return by rank
/// Throws CollectiveError.
std::vector<Bytes> ExchangeBytes(
  Communicator& communicator, std::vector<Bytes> to, std::string failure);

/// Collective: brings each rank's message to all.
/// @return by rank
/// Throws CollectiveError.
std::vector<Bytes> AllGatherBytes(Communicator& communicator, Bytes mine, std::string failure);

} // namespace banyan

#endif
