# SPDX-License-Identifier: BSD-3-Clause
# Stands in for a ParaView of another version.
set(ParaView_VERSION 5.10.1)
set(PARAVIEW_USE_MPI ON)
set(ParaView_FOUND 1)
