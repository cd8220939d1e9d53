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

/// Collective. Throws CollectiveError on all ranks when one of them failed: see AgreeOnError.
/// @param failure this rank's error sentence; empty if all is well
void ThrowTogether(Communicator& communicator, const std::string& failure);

/// Collective. Every rank runs `action`; when it throws on one, all ranks throw CollectiveError.
/// An action that sends messages must send them even when it fails.
void Collective(Communicator& communicator, const std::function<void()>& action);

} // namespace banyan

#endif
