// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Watchdog_MpiError_h
#define banyan_Parallel_Watchdog_MpiError_h

#include "Base/Error.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <string>

namespace banyan
{

/// Throws Error with MPI's words unless `code` is success.
/// @param action as in "MPI could not ..."
inline void CheckMpi(int code, const char* action)
{
  if (code != MPI_SUCCESS)
  {
    char text[MPI_MAX_ERROR_STRING] = {};
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw Error(std::string("MPI could not ") + action + ": " + std::string(text, length));
  }
}

} // namespace banyan

#endif
