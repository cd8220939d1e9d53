#!/usr/bin/env bash
# What the values of a mesh series take on disk, beside codecs that know nothing of the mesh.
#
#   mesh_series.sh [--cells N] [--steps N] [--input FILE.exo] [--output DIR] [--help]
#
#   --cells N      of the earthquake that is generated (default 20000)
#   --steps N      how many are encoded, from the middle of the series on (default 16)
#   --input FILE   an earthquake that banyan-generate has written, instead
#   --output DIR   where the series and mesh_series.csv go (default benchmark-output/mesh-series)
#
# Prints what Utilities/info.sh says of the series of `velocity` (bound: 1/512 of the range), then the
# bits per value of others, within the same bound, on the same values in the order of the mesh's points
# (banyan-bench-codec, "8 bits"): codes of 8 bits with zstd, levels 3 and 19, and with their bits shuffled;
# and zfp, which has one dimension here, with the bound as its tolerance and with the largest tolerance whose
# errors stay within it.
# Needs the plugin and the benchmarks built (BANYAN_BUILD_DIR, -DBANYAN_BUILD_BENCHMARKS=ON) where zfp and Blosc
# are installed (Utilities/install-dependencies.sh --with-peers).
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output/mesh-series"
cells=20000
steps=16
input=""
read_options "" "cells steps input output" "$@"
plugin="$BuildFolder/lib/Banyan/Banyan.so"
[[ -e "$plugin" && -x "$BuildFolder/bin/banyan-bench-codec" ]] ||
  fail "there is no $plugin, or no banyan-bench-codec beside it; both have to be built first."
mkdir -p "$output"

if [[ -z "$input" ]]; then
  stage 1 3 "Simulating an earthquake in $cells cells"
  "$BuildFolder/bin/banyan-generate" --series earthquake --cells "$cells" --output "$output/earthquake" \
    2> "$output/earthquake.log" || fail "the earthquake failed: $(tail -1 "$output/earthquake.log")"
  input="$output/earthquake/earthquake.exo"
fi
stage 2 3 "Encoding"
pvpython --force-offscreen-rendering "$here/MeshSeries/measure.py" --plugin "$plugin" \
  --file "$input" --array velocity --steps "$steps" --out "$output" >&2 || fail "encoding failed."
"$BuildFolder/bin/banyan-info" "$output/mesh.banyan" | sed -n '1,/encoded: payloads/p'

stage 3 3 "Measuring the others"
methods="zstd-8bit,zstd-8bit-19,bitshuffle-8bit,zfp,zfp-tuned"
"$BuildFolder/bin/banyan-bench-codec" --output "$output/mesh_series.csv" --work "$output" --bits 8 \
  --repeat 1 --bricks 0 --methods "$methods" "$output"/velocity-*.json ||
  fail "the measurements failed; they need zfp and Blosc (Utilities/install-dependencies.sh --with-peers) and -DBANYAN_BUILD_BENCHMARKS=ON."
"$python" - "$output/mesh_series.csv" << 'PYTHON'
import csv
import sys

with open(sys.argv[1], encoding="utf-8", newline="") as file:
    rows = list(csv.DictReader(file))
for method in dict.fromkeys(row["method"] for row in rows):
    bits = [float(row["bits_per_voxel"]) for row in rows if row["method"] == method]
    print(f"{method}: {sum(bits) / len(bits):.3f} bits per value")
PYTHON
