#!/usr/bin/env bash
# Draws meshes whose cells lie on 1 to 64 ranks: time of the slowest rank, messages, memory.
#
#   pieces.sh [--quick] [--output DIR] [--cubes N] [--shape S] [--deals LIST] [--ranks LIST] [--pixels LIST]
#             [--levels LIST] [--views N] [--help]
#
#   --quick        40 cubes along each axis, 512 pixels: some minutes. Otherwise an hour
#   --output DIR   where pieces.csv and pieces.png (time against ranks) go (default benchmark-output)
#   --cubes N      of a warped cube, along each axis (default 100: a million hexahedra)
#   --shape S      that they are cut into: hexahedra (default), tetrahedra, mixed
#   --deals LIST   how cells are dealt to ranks: one-by-one, jagged, morton, slabs (default morton,jagged)
#   --ranks LIST   default 1,2,4,8,16,32,64; 1 draws the whole mesh
#   --pixels LIST  per side (default 512,1024)
#   --levels LIST  0 are cells, 1 and up lattices (default 0,1)
#   --views N      around the mesh (default 6)
#
# Ranks are simulated: threads that send each other messages in memory. Times are processor time of the slowest rank.
# Columns are explained in README.md. Installs what is missing, and builds in build-benchmark (BANYAN_BUILD_DIR names
# another folder). BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
quick=0
cubes=""
shape="hexahedra"
deals="morton,jagged"
ranks="1,2,4,8,16,32,64"
pixels=""
levels="0,1"
views=6
read_options "quick" "output cubes shape deals ranks pixels levels views" "$@"
cubes="${cubes:-$((quick ? 40 : 100))}"
pixels="${pixels:-$( ((quick)) && echo 512 || echo 512,1024)}"

stage 1 3 "Installing what is missing and building"
install_and_build
program="$BuildFolder/bin/banyan-bench-pieces"
[[ -x "$program" ]] || fail "there is no $program; it has to be built first."
mkdir -p "$output" || fail "the folder for the results cannot be made."

stage 2 3 "Drawing pieces"
"$program" --cubes "$cubes" --shape "$shape" --deals "$deals" --ranks "$ranks" --pixels "$pixels" --levels "$levels" \
  --views "$views" | tee "$output/pieces.csv"

stage 3 3 "Drawing the chart"
"$python" "$here/Meshes/pieces_report.py" "$output/pieces.csv" "$output/pieces.png"
say "      $output/pieces.csv, $output/pieces.png"
