# SPDX-License-Identifier: BSD-3-Clause
# Tests that are Python scripts in ParaView, with a display of their own and a watchdog.
find_program(BANYAN_PYTHON3 NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(BANYAN_PYTHON3 NAMES python3)

# banyan_add_pvbatch_test(<name>
#   SCRIPT <script.py> [ARGUMENTS <argument>...]
#   [OPTIONS <option of ParaView>]
#   [MODE builtin|batch|server|window|served]   builtin by default; see Testing/PvBatch/run_paraview.py
#   [RANKS <n>] [SECONDS <n>]     1 rank, 120 seconds
#   [SETUP <fixture>...] [REQUIRES <fixture>...])
# The script's name is relative to the current folder. BANYAN_DATA_DIR is in its environment, and a
# script that exits with 77 counts as skipped.
function(banyan_add_pvbatch_test name)
  cmake_parse_arguments(PARSE_ARGV 1 TEST "" "SCRIPT;MODE;RANKS;SECONDS;OPTIONS"
    "ARGUMENTS;SETUP;REQUIRES")
  foreach(default IN ITEMS MODE=builtin RANKS=1 SECONDS=120)
    string(REPLACE "=" ";" default "${default}")
    list(GET default 0 option)
    if(NOT TEST_${option})
      list(GET default 1 TEST_${option})
    endif()
  endforeach()
  math(EXPR outer "${TEST_SECONDS} + 60")
  add_test(NAME ${name}
    COMMAND "${Banyan_SOURCE_DIR}/Utilities/with-display.sh" "${BANYAN_PYTHON3}"
      "${Banyan_SOURCE_DIR}/Testing/PvBatch/run_paraview.py"
      --mode ${TEST_MODE} --ranks ${TEST_RANKS} --seconds ${TEST_SECONDS}
      -- ${TEST_OPTIONS} "${CMAKE_CURRENT_SOURCE_DIR}/${TEST_SCRIPT}" ${TEST_ARGUMENTS})
  set_tests_properties(${name} PROPERTIES
    LABELS pvbatch
    PROCESSORS ${TEST_RANKS}
    TIMEOUT ${outer}
    SKIP_RETURN_CODE 77
    ENVIRONMENT "BANYAN_DATA_DIR=${BANYAN_DATA_DIR};PYTHONDONTWRITEBYTECODE=1"
    FIXTURES_SETUP "${TEST_SETUP}"
    FIXTURES_REQUIRED "${TEST_REQUIRES}")
endfunction()
