# SPDX-License-Identifier: BSD-3-Clause
# Since Debian 13, Python modules are named NAME.cpython-313-x86_64-linux-gnu.so. The CMake files in the
# packages of ParaView (5.13.2, 6.1.1) and VTK (9.6.2) still say NAME.so, so that find_package() ends with an
# error. CMake writes a loop into such files that looks for each file; here it gets the real names instead.
# To be dropped when find_package(ParaView) succeeds without it.
include_guard(GLOBAL)
function(banyan_name_python_modules variable access targets file)
  if(NOT access STREQUAL "READ_ACCESS" OR NOT file MATCHES "Python[A-Za-z]*-targets\\.cmake$")
    return()
  endif()
  foreach(target IN LISTS targets)
    set(named "${_cmake_import_check_files_for_${target}}")
    set(found "")
    foreach(name IN LISTS named)
      string(REGEX REPLACE "\\.so$" "" stem "${name}")
      file(GLOB suffixed "${stem}.cpython-*.so")
      if(NOT EXISTS "${name}" AND suffixed)
        list(GET suffixed 0 name)
      endif()
      list(APPEND found "${name}")
    endforeach()
    set("_cmake_import_check_files_for_${target}" "${found}" PARENT_SCOPE)
  endforeach()
endfunction()
variable_watch(_cmake_import_check_targets banyan_name_python_modules)
