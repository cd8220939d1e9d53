# SPDX-License-Identifier: BSD-3-Clause
# find_package(Banyan) in another project finds the libraries, in this build folder or installed.
include(CMakePackageConfigHelpers)

set(exported BanyanCore)
if(BANYAN_WITH_PARAVIEW)
  list(APPEND exported BanyanReaders BanyanInputs BanyanFilters BanyanRendering)
endif()
export(TARGETS ${exported} NAMESPACE Banyan:: FILE "${CMAKE_BINARY_DIR}/BanyanTargets.cmake")
configure_file("${CMAKE_CURRENT_LIST_DIR}/BanyanConfig.cmake.in"
  "${CMAKE_BINARY_DIR}/BanyanConfig.cmake" @ONLY)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/BanyanConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)

set(package "${CMAKE_INSTALL_LIBDIR}/cmake/Banyan")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/BanyanInstalledConfig.cmake.in"
  "${CMAKE_BINARY_DIR}/installed/BanyanConfig.cmake"
  INSTALL_DESTINATION "${package}"
  PATH_VARS BANYAN_INSTALL_LIBRARIES BANYAN_INSTALL_HEADERS)
install(FILES "${CMAKE_BINARY_DIR}/installed/BanyanConfig.cmake"
  "${CMAKE_BINARY_DIR}/BanyanConfigVersion.cmake"
  DESTINATION "${package}")
install(FILES "${CMAKE_CURRENT_LIST_DIR}/BanyanPythonModules.cmake" DESTINATION "${package}")
install(DIRECTORY "${CMAKE_SOURCE_DIR}/Core/" DESTINATION "${BANYAN_INSTALL_HEADERS}/Core"
  FILES_MATCHING PATTERN "*.h")

# Installs a program, which finds Core's library beside it.
function(banyan_install_program name)
  file(RELATIVE_PATH libraries "/${CMAKE_INSTALL_BINDIR}" "/${BANYAN_INSTALL_LIBRARIES}")
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
  install(TARGETS ${name} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endfunction()
