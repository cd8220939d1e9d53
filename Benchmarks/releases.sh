#!/usr/bin/env bash
# Compares the speed of Banyan as the compilers of several releases of Debian make it.
#
#   releases.sh [--releases LIST] [--output DIR] [--repeat N] [--help]
#
#   --releases LIST  separated by commas (default 12,13,testing); the first is what others are compared with
#   --output DIR     where releases.csv goes (default benchmark-output)
#   --repeat N       rounds, of which the median counts (default 5)
#
# Builds in build-debian-RELEASE, for this machine's release in build. A round runs every release once, one after the
# other: encoding and decoding turbulence (96^3, 16 steps, 8 bits), and drawing S1 and S2 (256^3, 1024^2 pixels), all
# on one thread.
# Ends with a table of medians, and of how much longer each release takes than the first. The release of this machine
# is used as it is; others need root (Utilities/on-debian.sh).
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

releases=12,13,testing
output="benchmark-output"
repeat=5
read_options "" "releases output repeat" "$@"
IFS=, read -r -a releases <<<"$releases"
unset BANYAN_BUILD_DIR # each release has its own
# Seen by all releases, which share the project's folder alone.
work="$RepositoryRoot/build-benchmark-debian"
mkdir -p "$work" "$output"

stage 1 2 "Building on ${#releases[@]} releases"
for release in "${releases[@]}"; do
  on_debian "$release" 'Utilities/install-dependencies.sh
    cmake --preset release -B $BuildFolder -DBANYAN_BUILD_BENCHMARKS=ON
    cmake --build $BuildFolder --parallel --target banyan-generate banyan-bench-codec BanyanBenchRayCaster' \
    >"$work/$release.log" 2>&1 || fail "Debian $release cannot build it; $work/$release.log says why."
done
on_debian "${releases[0]}" "\$BuildFolder/bin/banyan-generate --series turbulence --size 96 --steps 16 \
  --raw $work/turbulence.raw" 2>/dev/null || fail "the series could not be generated."
echo '{"name": "turbulence", "file": "turbulence.raw", "samples": [96, 96, 96], "steps": 16}' >"$work/turbulence.json"

stage 2 2 "Measuring"
table="$output/releases.csv"
rm -f "$table"
for ((round = 1; round <= repeat; ++round)); do
  for release in "${releases[@]}"; do
    say "      round $round of $repeat: Debian $release"
    rm -f "$work/codec.csv"
    on_debian "$release" "export BANYAN_THREADS=1
      \$BuildFolder/bin/banyan-bench-codec --output $work/codec.csv --work $work/encoded --bits 8 \
        --methods banyan --repeat 1 --bricks 200 $work/turbulence.json
      \$BuildFolder/bin/BanyanBenchRayCaster 256 1024 1 1 >$work/rays.csv" >"$work/log" 2>&1 ||
      fail "the programs failed on Debian $release; $work/log says why."
    "$python" "$here/releases.py" "$table" "$release" "$work"
  done
done
"$python" "$here/releases.py" "$table"
