# Shared by the scripts of this folder: source it, do not run it.
# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause

set -euo pipefail

RepositoryRoot="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BuildFolder="${BANYAN_BUILD_DIR:-$RepositoryRoot/build}"

# One line for the user, on stderr so that a script's own output stays usable in a pipe.
say()
{
  printf '%s\n' "$*" >&2
}

# Says in one sentence why a script cannot go on, and ends it.
fail()
{
  say "$(basename "$0"): $*"
  exit 1
}

# Announces a stage: `stage 2 6 "Building"` prints "[2/6] Building".
stage()
{
  say "[$1/$2] $3"
}

# Processors that this process may use, as many as its memory carries when each needs $1 MiB.
jobs_for_memory()
{
  local mebibytes_each="$1" cores available limit jobs
  cores="$(nproc)"
  available="$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo)"
  # A container may be allowed less than the machine has.
  for limit in /sys/fs/cgroup/memory.max /sys/fs/cgroup/memory/memory.limit_in_bytes; do
    if [[ -r "$limit" && "$(cat "$limit")" =~ ^[0-9]+$ ]]; then
      limit="$(awk '{ printf "%.0f", $1 / 1048576 }' "$limit")"
      available=$((limit < available ? limit : available))
      break
    fi
  done
  jobs=$((available / mebibytes_each))
  jobs=$((jobs < cores ? jobs : cores))
  echo $((jobs > 1 ? jobs : 1))
}

# What Open MPI wants to be told in containers and for root.
prepare_mpi()
{
  if [[ "$(id -u)" == 0 ]]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  fi
  # Containers mostly forbid ranks to read each other's memory; without this every start warns.
  export OMPI_MCA_btl_vader_single_copy_mechanism=none
}

# Prints the path of a program that needs Core alone, such as banyan-info. Builds it when it is
# missing: in the build folder when there is one, otherwise in build-core, without ParaView.
core_program()
{
  local name="$1" folder
  for folder in "$BuildFolder" "$RepositoryRoot/build-core"; do
    if [[ -x "$folder/bin/$name" ]]; then
      printf '%s\n' "$folder/bin/$name"
      return
    fi
  done
  folder="$BuildFolder"
  if [[ ! -f "$folder/CMakeCache.txt" ]]; then
    command -v cmake >/dev/null ||
      fail "cmake is missing; Utilities/install-dependencies.sh installs it."
    folder="$RepositoryRoot/build-core"
    say "Configuring $name in $folder"
    cmake -S "$RepositoryRoot" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DBANYAN_WITH_PARAVIEW=OFF -DBANYAN_BUILD_TESTING=OFF >&2 ||
      fail "the configuration did not succeed."
  fi
  say "Building $name, once"
  cmake --build "$folder" --target "$name" --parallel "$(jobs_for_memory 1000)" >&2 ||
    fail "$name could not be built."
  printf '%s\n' "$folder/bin/$name"
}

# Prints a Python 3 that has all the named modules.
python_with()
{
  local python
  for python in python3 /usr/bin/python3; do
    if "$python" -c "import $(printf '%s, sys, ' "$@" | sed 's/, $//')" 2>/dev/null; then
      printf '%s\n' "$python"
      return
    fi
  done
  fail "Python 3 with $* is needed; Utilities/install-dependencies.sh installs it."
}

# Runs lines of bash in the project's folder on a release of Debian: on this machine if it has that release, or
# else in a folder of its own (on-debian.sh). BuildFolder is the build there.
on_debian()
{
  local release="$1" lines="$2" here
  here="$(. /etc/os-release && [[ "$ID" == debian ]] && echo "${VERSION_ID:-testing}")"
  local enter=("$RepositoryRoot/Utilities/on-debian.sh" "$release")
  [[ "$release" != "$here" ]] || enter=(env -C "$RepositoryRoot")
  "${enter[@]}" bash -ec ". Utilities/common.sh; prepare_mpi; $lines"
}
