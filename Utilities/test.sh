#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test.
#   test.sh [CTEST OPTIONS...]       e.g. test.sh -L core, test.sh -R Codec
# BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone.
# SPDX-License-Identifier: BSD-3-Clause
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

if [[ "${1:-}" == --help ]]; then
  sed -n '2,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 0
fi
here="$RepositoryRoot/Utilities"

stage 1 3 "Installing the packages that are missing"
[[ "${BANYAN_SKIP_INSTALL:-0}" == 1 ]] || "$here/install-dependencies.sh"
stage 2 3 "Building"
"$here/build.sh"
stage 3 3 "Testing"
prepare_mpi
cd "$BuildFolder"
# Tests that start several processes, or that measure, say so themselves (PROCESSORS, RUN_SERIAL).
exec "$here/with-display.sh" ctest --output-on-failure --no-tests=error \
  --parallel "$(nproc)" "$@"
