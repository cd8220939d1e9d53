# SPDX-License-Identifier: BSD-3-Clause
# Compiler-wide settings: ccache, link order, sanitizers. Nothing here is needed to build.
find_program(BANYAN_CCACHE ccache)
if(BANYAN_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER "${BANYAN_CCACHE}")
  set(CMAKE_CXX_COMPILER_LAUNCHER "${BANYAN_CCACHE}")
endif()
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
if(BANYAN_SANITIZE)
  add_compile_options(-fsanitize=${BANYAN_SANITIZE} -fno-omit-frame-pointer -g)
  add_link_options(-fsanitize=${BANYAN_SANITIZE})
endif()

# ParaView opens and closes each library in a folder to see which are plugins, and loads those: what one of
# ours has told another (a hook, a thread) must stay valid. So once opened, they stay.
string(APPEND CMAKE_SHARED_LINKER_FLAGS " -Wl,-z,nodelete")
string(APPEND CMAKE_MODULE_LINKER_FLAGS " -Wl,-z,nodelete")
