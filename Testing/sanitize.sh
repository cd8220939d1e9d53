#!/usr/bin/env bash
# Runs tests of Core under the address and undefined-behaviour sanitizers, and under the thread sanitizer.
#
#   sanitize.sh [asan] [avx2] [tsan] [--help]
#
#   asan   all tests of the codec, of series, of series of meshes and of caches (preset asan)
#   avx2   the same with kernels for AVX2, built with clang as the fuzzers are (preset fuzz)
#   tsan   16 threads that read one file, encoding on several threads, and the caches (preset tsan)
#
# Without arguments all. Builds what it runs, which takes a while. Fails when a test does, or when a
# sanitizer finds anything. BANYAN_SKIP_BUILD=1 leaves the build away.
source "$(dirname "${BASH_SOURCE[0]}")/../Utilities/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

[[ "${1:-}" != --help ]] || {
  sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
  exit 0
}

# Tests of threads: which threads encode what, and who reads while others do.
Threads='ConcurrentReading.*:OpenGroups.*:StaticArrays.*:Series.*:QuantizedBlockCache.*:*Chains*'

build()
{
  [[ "${BANYAN_SKIP_BUILD:-0}" != 1 ]] || return 0
  # None of these tests casts rays, and loops that do take a quarter of an hour to compile.
  cmake -S "$RepositoryRoot" --preset "$1" -DBANYAN_SANITIZE_RENDERING=OFF >&2 &&
    cmake --build "$RepositoryRoot/build-$1" --parallel "$(jobs_for_memory 2000)" \
      --target "${@:2}" >&2 || fail "the tests could not be built under '$1'."
}

# One program of tests; goes on after a failure.
run()
{
  say "$1: $(basename "$2") ${3:-}"
  "$2" --gtest_brief=1 "${@:3}" || status=1
}

export ASAN_OPTIONS="detect_stack_use_after_return=1:${ASAN_OPTIONS:-}"
export UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1:${UBSAN_OPTIONS:-}"
export TSAN_OPTIONS="halt_on_error=1:${TSAN_OPTIONS:-}"
status=0
[[ $# -gt 0 ]] || set -- asan avx2 tsan
for kind in "$@"; do
  case "$kind" in
    asan | avx2)
      programs=(TestCodec TestSeries TestMeshSeries TestCache)
      preset="${kind/avx2/fuzz}"
      build "$preset" "${programs[@]}"
      for program in "${programs[@]}"; do
        run "$kind" "$RepositoryRoot/build-$preset/bin/$program"
      done
      ;;
    tsan)
      build tsan TestSeries TestCache
      run tsan "$RepositoryRoot/build-tsan/bin/TestSeries" --gtest_filter="$Threads"
      run tsan "$RepositoryRoot/build-tsan/bin/TestCache"
      ;;
    *) fail "'$kind' is none of 'asan', 'avx2' and 'tsan'." ;;
  esac
done
exit "$status"
