# SPDX-License-Identifier: BSD-3-Clause
# Tests on several MPI ranks that can neither hang nor depend on how the machine is set up.

# What Open MPI wants to be told for root and in containers.
set(BANYAN_MPI_TEST_ENVIRONMENT
  OMPI_ALLOW_RUN_AS_ROOT=1
  OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  OMPI_MCA_btl_vader_single_copy_mechanism=none
  OMPI_MCA_mpi_yield_when_idle=1)

# banyan_add_mpi_test(<name> <ranks> <seconds> <command> [<argument>...])
# The watchdog ends the launcher politely, so that it ends its ranks; ctest itself would leave
# them behind.
function(banyan_add_mpi_test name ranks seconds)
  math(EXPR outer "${seconds} + 30")
  add_test(NAME ${name}
    COMMAND timeout --kill-after=10 ${seconds} "${MPIEXEC_EXECUTABLE}" --oversubscribe
      ${MPIEXEC_NUMPROC_FLAG} ${ranks} ${ARGN})
  set_tests_properties(${name} PROPERTIES
    ENVIRONMENT "${BANYAN_MPI_TEST_ENVIRONMENT}"
    PROCESSORS ${ranks}
    TIMEOUT ${outer})
endfunction()
