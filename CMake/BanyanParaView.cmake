# SPDX-License-Identifier: BSD-3-Clause
# Finds ParaView (unless this is ParaView's own build), checks that it fits, and builds the plugin.
# The first version of ParaView that fits, and the last one that all tests have passed with.
set(BANYAN_PARAVIEW_FIRST 5.11)
set(BANYAN_PARAVIEW_TESTED 6.1)

if(NOT BANYAN_INSIDE_PARAVIEW)
  include(BanyanPythonModules)
  find_package(ParaView QUIET)
  if(NOT ParaView_FOUND)
    message(FATAL_ERROR "Banyan needs ParaView ${BANYAN_PARAVIEW_FIRST} or newer and its "
      "development files, which were not found: install them (Utilities/install-dependencies.sh on Debian), "
      "set ParaView_DIR, or build Core alone with -DBANYAN_WITH_PARAVIEW=OFF.\n"
      "${ParaView_NOT_FOUND_MESSAGE}")
  endif()
  if(ParaView_VERSION VERSION_LESS BANYAN_PARAVIEW_FIRST)
    message(FATAL_ERROR "Banyan needs ParaView ${BANYAN_PARAVIEW_FIRST} or newer, but "
      "${ParaView_DIR} is version ${ParaView_VERSION}: set ParaView_DIR to a newer one.")
  endif()
  if(ParaView_VERSION VERSION_GREATER "${BANYAN_PARAVIEW_TESTED}.99")
    message(WARNING "Banyan's tests have not passed with ParaView ${ParaView_VERSION} yet, but with "
      "${BANYAN_PARAVIEW_TESTED}: expect faults.")
  endif()
endif()
if(NOT PARAVIEW_USE_MPI)
  message(FATAL_ERROR "Banyan needs a ParaView that was built with MPI; the one in "
    "${ParaView_DIR} was built without.")
endif()
set(BUILD_SHARED_LIBS ON)
find_package(MPI QUIET COMPONENTS C)
if(NOT MPI_C_FOUND)
  message(FATAL_ERROR "Banyan needs the development files of the MPI that ParaView was built "
    "with (Open MPI on Debian: package libopenmpi-dev), which were not found.")
endif()

if(BANYAN_INSIDE_PARAVIEW)
  # ParaView's own paraview_plugin_build() has entered here and expects the plugin.
  add_subdirectory(Plugin)
  return()
endif()

paraview_plugin_scan(
  PLUGIN_FILES "${CMAKE_CURRENT_SOURCE_DIR}/paraview.plugin"
  PROVIDES_PLUGINS banyan_plugins
  ENABLE_BY_DEFAULT ON)
# paraview_plugin_build() enters the folder of paraview.plugin, which lies in the root so that the
# repository can be dropped into ParaView's source tree. Here the root is already being processed:
# lead it to Plugin/ instead.
set_property(GLOBAL PROPERTY
  _paraview_plugin_Banyan_file "${CMAKE_CURRENT_SOURCE_DIR}/Plugin/paraview.plugin")
paraview_plugin_build(
  PLUGINS ${banyan_plugins}
  PLUGINS_FILE_NAME "banyan.plugins.xml"
  HEADERS_DESTINATION "${BANYAN_INSTALL_HEADERS}")
