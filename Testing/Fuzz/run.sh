#!/usr/bin/env bash
# Builds the fuzzers under the address and undefined-behaviour sanitizers, and runs each.
#
#   run.sh [--seconds N] [--only LIST] [--jobs N] [--output DIR] [--help]
#
#   --seconds N   how long each runs (default 600)
#   --only LIST   these only, separated by commas: Index,Group,Block,Exceptions,Mesh,Cells
#   --jobs N      how many run at a time (default: one per processor)
#   --output DIR  folder for what they find, which a later run goes on from, and their logs
#                 (default fuzz-output)
#
# They start from Testing/Fuzz/Seeds, and from seeds that are made anew from the golden files. Needs
# clang. Builds in build-fuzz (BANYAN_BUILD_DIR names another folder), which takes a while;
# BANYAN_SKIP_BUILD=1 leaves that away. Ends with a line for each: executions, edges covered, and what
# was found. Fails when anything was.
source "$(dirname "${BASH_SOURCE[0]}")/../../Utilities/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

build="${BANYAN_BUILD_DIR:-$RepositoryRoot/build-fuzz}"
seconds=600
only="Index,Group,Block,Exceptions,Mesh,Cells"
jobs="$(nproc)"
output="fuzz-output"
while [[ $# -gt 0 ]]; do
  case "$1" in
    --help)
      sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    --seconds | --only | --jobs | --output)
      [[ $# -gt 1 ]] || fail "$1 needs a value."
      declare "${1#--}=$2"
      shift
      ;;
    *) fail "'$1' is no option; --help lists them." ;;
  esac
  shift
done
[[ "$seconds" =~ ^[1-9][0-9]*$ && "$jobs" =~ ^[1-9][0-9]*$ ]] ||
  fail "--seconds and --jobs are whole numbers from 1 on."
IFS=, read -ra names <<< "$only"
for name in "${names[@]}"; do
  [[ -f "$RepositoryRoot/Testing/Fuzz/Fuzz$name.cxx" ]] || fail "there is no fuzzer 'Fuzz$name'."
done

build_all()
{
  command -v clang++ >/dev/null || fail "clang is missing."
  cmake -S "$RepositoryRoot" --preset fuzz -B "$build" >&2 &&
    cmake --build "$build" --parallel "$(jobs_for_memory 2000)" \
      --target MakeSeeds "${names[@]/#/Fuzz}" >&2 || fail "the fuzzers could not be built."
}

# Runs one; its log names the input of whatever it finds.
fuzz()
{
  local name="$1" folders=("$output/$1") folder options=()
  mkdir -p "$output/$name" "$output/found"
  for folder in "$RepositoryRoot/Testing/Fuzz/Seeds/$name" "$output/seeds/$name"; do
    [[ ! -d "$folder" ]] || folders+=("$folder")
  done
  # Its inputs would stay a few bytes long for hours.
  [[ "$name" != Block ]] || options=(-len_control=0 -max_len=2048)
  "$build/bin/Fuzz$name" -max_total_time="$seconds" -print_final_stats=1 -timeout=60 \
    -rss_limit_mb=3000 -artifact_prefix="$output/found/$name-" \
    "${options[@]+"${options[@]}"}" "${folders[@]}" > "$output/$name.log" 2>&1 ||
    touch "$output/$name.failed"
}

# The last number that a log has behind a word.
last_of()
{
  grep -oE "$2 *[0-9]+" "$1" | tail -1 | grep -oE '[0-9]+$' || echo 0
}

[[ "${BANYAN_SKIP_BUILD:-0}" == 1 ]] || build_all
mkdir -p "$output/seeds"
rm -f "$output"/*.failed
"$build/bin/MakeSeeds" "$output/seeds" "$RepositoryRoot/Testing/Core/Series/Golden" ||
  fail "the seeds could not be made."
for name in "${names[@]}"; do
  while [[ "$(jobs -rp | wc -l)" -ge "$jobs" ]]; do
    wait -n
  done
  say "Fuzz$name: $seconds seconds"
  fuzz "$name" &
done
wait
status=0
for name in "${names[@]}"; do
  result="nothing found"
  if [[ -e "$output/$name.failed" ]]; then
    result="FAILED, see $output/$name.log"
    status=1
  fi
  printf '%-16s %10s executions %7s edges  %s\n' "Fuzz$name" \
    "$(last_of "$output/$name.log" 'number_of_executed_units:')" \
    "$(last_of "$output/$name.log" 'cov:')" "$result"
done
exit "$status"
