#!/usr/bin/env bash
# Measures display walls that many ranks draw, by data and by picture: time against megapixels and
# ranks, with IceT beside it. Table 4 of the study of Vol-a-Tile 2.
#
#   walls.sh [--quick] [--part P] [--output DIR] [--work DIR] [--volumes LIST] [--views LIST]
#            [--columns LIST] [--networks LIST] [--help]
#
#   --part P         of the samples of volumes, and of the pixels of walls, per axis (default 1: two
#                    hours and 8 GiB of memory)
#   --quick          --part 0.25, and two views: ten minutes
#   --output DIR     where walls.csv, walls-ranks.png, walls-views.png and what they come from go:
#                    walls-casting.csv, walls-pixels.csv, and walls-real.csv of real ranks (default
#                    benchmark-output)
#   --work DIR       for frames, which are removed (default: wall-frames in the build folder)
#   --volumes LIST   of deep (512^2 x 2048), flat (4096 x 2048 x 128), separated by commas
#   --views LIST     of whole, turned-30, turned-80, zoomed
#   --columns LIST   megapixels:tiles:ranks (default 4:1:1, 8:2:2, 24:6:6, 50:14:14, 100:28:28, and 24
#                    megapixels on 1, 4, 16 and 64 ranks, of which six have tiles at most)
#   --networks LIST  gigabits per second (default 10); the table is of the first
#
# Volumes are made up. All is drawn on one core, one rank's part after the other's, whole pictures
# and not samples of them: cast_ms is the processor time of the slowest rank, with one thread. Ranks
# are balanced before by frames with fewer pixels: by data with half of them per axis, by picture
# with a quarter of the rows. Pixels go through SimGrid as in compositing.sh, after the last ray.
# Bricks that a pan needs are decoded and not sent. A colour volume is left out: 16384^2 x 128 of
# three bytes are 103 GB.
#
# Installs what is missing (the simulator too), and builds in build-benchmark (BANYAN_BUILD_DIR names
# another folder). BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1
# the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
source "$here/Compositing/simulation.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
part=""
volumes="deep,flat"
views=""
columns=""
networks="10"
read_options "quick" "part output work volumes views columns networks" "$@"
if [[ $quick == 1 ]]; then
  part="${part:-0.25}"
  views="${views:-whole,turned-80}"
fi
part="${part:-1}"
views="${views:-whole,turned-30,turned-80,zoomed}"
columns="${columns:-4:1:1,8:2:2,24:6:6,50:14:14,100:28:28,24:1:1,24:4:4,24:6:16,24:6:64}"
columns="$(awk -v part="$part" 'BEGIN { RS = "[,\n]"; FS = OFS = ":"; ORS = "," }
  NF == 3 { $1 *= part * part; print }' <<< "$columns")"
columns="${columns%,}"

stage 1 4 "Installing what is missing and building"
install_and_build --with-peers
build_simulation banyan-simulate-walls "$here/Walls/SimulateWalls.cxx"
program="$BuildFolder/bin/banyan-bench-walls"
[[ -x "$program" ]] || fail "there is no $program; it has to be built first."
work="${work:-$BuildFolder/wall-frames}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."
work="$(realpath "$work")"
output="$(realpath "$output")"
# shellcheck disable=SC2086
write_platforms ${networks//,/ }

# Walls of one volume: draw_walls VOLUME PART VIEWS COLUMNS REAL, with the arguments of the program,
# and what simulate.sh takes.
draw_walls()
{
  "$program" --work "$work" --volume "$1" --part "$2" --views "$3" --columns "$4" --then \
    "'$here/Walls/simulate.sh' '$work' '$output' $1 $networks $5" || fail "drawing '$1' failed."
}

stage 2 4 "Drawing walls and simulating their pixels"
echo "volume,megapixels,tiles,ranks,view,division,cast_ms,mean_ms,brick_ms,bytes_bricks" \
  > "$output/walls-casting.csv"
echo "volume,megapixels,ranks,view,method,network,ms,bytes,max_bytes_in,max_difference" \
  > "$output/walls-pixels.csv"
echo "volume,megapixels,ranks,view,division,bytes,max_difference" > "$output/walls-real.csv"
for volume in ${volumes//,/ }; do
  say "      $volume"
  draw_walls "$volume" "$part" "$views" "$columns" 0 >> "$output/walls-casting.csv"
done

stage 3 4 "Drawing small ones on real ranks, too"
if command -v mpirun > /dev/null; then
  for volume in ${volumes//,/ }; do
    draw_walls "$volume" 0.125 whole,turned-30 0.3:2:2,0.3:3:3,0.3:2:4,0.3:4:4 0.125 > /dev/null
  done
else
  say "      there is no mpirun"
fi

stage 4 4 "Reporting"
"$python" "$here/Walls/report.py" "$output" || fail "the report could not be written."
say "Done: $output/walls.csv, walls-ranks.png and walls-views.png"
