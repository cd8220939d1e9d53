# Shared by the scripts of this folder: source it, do not run it.
# shellcheck shell=bash

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

# What Open MPI wants to be told in containers, for root, and on few cores.
prepare_mpi()
{
  if [[ "$(id -u)" == 0 ]]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  fi
  # Containers mostly forbid ranks to read each other's memory; without this every start warns.
  export OMPI_MCA_btl_vader_single_copy_mechanism=none
  export OMPI_MCA_rmaps_base_oversubscribe=1
}
