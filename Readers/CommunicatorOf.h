// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_CommunicatorOf_h
#define banyan_Readers_CommunicatorOf_h

#include "BanyanReadersModule.h"

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Watchdog/MpiTimeout.h"

class vtkMultiProcessController;

namespace banyan
{

/// Collective: the ranks of a controller, as Core's algorithms speak to them. Its messages never
/// meet those of the controller, nor those of another communicator of it.
/// @param controller may be null: this rank alone. So are ranks of controllers without MPI
/// @param timeout how long ranks are waited for; without one, as long as it takes
/// Throws Error as MakeMpiCommunicator.
BANYANREADERS_EXPORT std::unique_ptr<Communicator> CommunicatorOf(
  vtkMultiProcessController* controller, const MpiTimeout& timeout = { 0.0, {} });

} // namespace banyan

#endif
