#ifndef banyan_Parallel_MpiCommunicator_h
#define banyan_Parallel_MpiCommunicator_h

#include "Parallel/Communicator.h"

namespace banyan
{

/// A communicator over a duplicate of an MPI communicator (collective; the duplicate is freed with
/// the object unless MPI has ended before).
/// @param mpiComm address of an MPI_Comm; void, so that no header of Core needs MPI
std::unique_ptr<Communicator> MakeMpiCommunicator(const void* mpiComm);

/// Ranks of the communicator that run on this machine (collective).
int RanksOnThisNode(const void* mpiComm);

} // namespace banyan

#endif
