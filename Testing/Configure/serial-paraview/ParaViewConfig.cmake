# SPDX-License-Identifier: BSD-3-Clause
# Stands in for a ParaView that was built without MPI.
set(ParaView_VERSION 5.11.0)
set(PARAVIEW_USE_MPI OFF)
set(ParaView_FOUND 1)
