#!/usr/bin/env bash
# Configures and builds everything with the preset "release", in build/.
#   build.sh [--product] [CMAKE OPTIONS...]      e.g. build.sh -DBANYAN_WITH_PARAVIEW=OFF
# --product leaves the tests out: it builds the plugin and the programs.
# BANYAN_BUILD_DIR names another build folder, BANYAN_JOBS the number of parallel compilers.
# SPDX-License-Identifier: BSD-3-Clause
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

if [[ "${1:-}" == --help ]]; then
  sed -n '2,5s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
targets=(all)
if [[ "${1:-}" == --product ]]; then
  targets=(product)
  shift
fi
command -v cmake >/dev/null || fail "cmake is missing; Utilities/install-dependencies.sh installs it."

# The heaviest ParaView sources take about 1.2 GB each while they are compiled.
jobs="${BANYAN_JOBS:-$(jobs_for_memory 1500)}"
cd "$RepositoryRoot"
say "Configuring in $BuildFolder"
cmake --preset release -B "$BuildFolder" "$@" >&2 || fail "the configuration did not succeed."
say "Building with $jobs jobs"
cmake --build "$BuildFolder" --target "${targets[@]}" --parallel "$jobs" >&2 || fail "the build did not succeed."
