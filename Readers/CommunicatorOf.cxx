// SPDX-License-Identifier: BSD-3-Clause
#include "CommunicatorOf.h"

#include "Parallel/Communicate/MpiCommunicator.h"

#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#include "vtkMultiProcessController.h"

namespace banyan
{

std::unique_ptr<Communicator> CommunicatorOf(
  vtkMultiProcessController* controller, const MpiTimeout& timeout)
{
  auto* const mpi =
    controller ? vtkMPICommunicator::SafeDownCast(controller->GetCommunicator()) : nullptr;
  return mpi && controller->GetNumberOfProcesses() > 1
           ? MakeMpiCommunicator(mpi->GetMPIComm()->GetHandle(), std::size_t{ 1 } << 30, timeout)
           : MakeSelfCommunicator();
}

} // namespace banyan
