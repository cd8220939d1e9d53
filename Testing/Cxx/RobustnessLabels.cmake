# SPDX-License-Identifier: BSD-3-Clause
# Read by ctest after the tests are known: gtest_discover_tests() cannot pass a list of labels on.
foreach(test IN LISTS TestVtkIoRobustness_TESTS)
  set_tests_properties("${test}" PROPERTIES LABELS "vtk;robustness")
endforeach()
