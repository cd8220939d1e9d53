// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Communicate_Collective_h
#define banyan_Parallel_Communicate_Collective_h

#include "Base/Error.h"

#include <functional>
#include <string>

namespace banyan
{

class Communicator;

/// All ranks throw it together, with the same sentence, after the same messages. They may go on to
/// talk to each other.
class CollectiveError : public Error
{
public:
  using Error::Error;
};

/// What a user reads when memory has run out and nothing more is known.
inline constexpr const char* NoMemory = "There is not enough memory.";

/// Collective. Every rank runs `action`; when it throws on one, all ranks throw CollectiveError.
/// An action that sends messages must send them even when it fails.
/// @param noMemory the sentence for std::bad_alloc
void Collective(Communicator& communicator, const std::function<void()>& action,
  const std::string& noMemory = NoMemory);

/// The same, where one rank alone has something to do.
void CollectiveOn(int rank, Communicator& communicator, const std::function<void()>& action,
  const std::string& noMemory = NoMemory);

/// The first half of Collective, for work with messages between failing and agreeing: runs
/// `action`, unless something has failed before.
/// @param failure becomes the sentence of what `action` throws
void Attempt(std::string& failure, const std::function<void()>& action,
  const std::string& noMemory = NoMemory);

/// The second half. Throws CollectiveError when one rank failed: see AgreeOnError.
/// @param failure this rank's error sentence; empty if all is well
void ThrowTogether(Communicator& communicator, const std::string& failure);

} // namespace banyan

#endif
