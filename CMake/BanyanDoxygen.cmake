# SPDX-License-Identifier: BSD-3-Clause
# The target "documentation": pages of the C++ interface, in documentation/html of the build folder.
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  set(DOXYGEN_PROJECT_NAME "Banyan")
  set(DOXYGEN_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/documentation")
  set(DOXYGEN_FILE_PATTERNS "*.h")
  set(DOXYGEN_EXCLUDE_PATTERNS "*-inl.h")
  set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
  set(DOXYGEN_GENERATE_LATEX NO)
  set(DOXYGEN_QUIET YES)
  set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
  set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${CMAKE_SOURCE_DIR}/Documentation/architecture.md")
  doxygen_add_docs(documentation
    Core Readers Filters Rendering Representations Documentation/architecture.md
    WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}" COMMENT "Pages of the C++ interface")
endif()
