#!/usr/bin/env bash
# Measures frames of a camera that zooms into a part of a volume, with zones that are balanced in
# different ways: figures 11 and 12 of "Dynamic load balancing for parallel volume rendering".
#
#   balance.sh [--quick] [--output DIR] [--data DIR] [--work DIR] [--frames N] [--ranks LIST] [--help]
#
#   --quick        128^3 samples, 256^2 pixels and 40 frames instead of 256^3, 512^2 and 80: a minute
#                  or two
#   --output DIR   where balance.csv, balance-ranks.csv (each rank's times), balance.png,
#                  balance-ranks.png go; twenty jumps of the camera and a camera at rest (200 frames
#                  each, work that is counted in place of time: the same in every run) are in
#                  balance-jumps.csv and balance-rest.csv; where there is mpirun, real
#                  ranks are in balance-real.csv, and with a half of the volume in the memory of each
#                  in balance-pieces.csv (default benchmark-output)
#   --data DIR     folder of real data (default ../shared/data beside the project, if it exists):
#                  bonsai is zoomed into as well, in balance-bonsai.csv
#   --work DIR     keeps volumes (default: balance-scenes in the build folder)
#   --frames N     of the zoom
#   --ranks LIST   default 2,4,8,16
#
# Ranks are simulated where cores are missing: each one's zone is really drawn, one after the other on
# one thread, and the processor time of the slowest is the frame's. Two ranks are also real (mpirun),
# in wall-clock time. Installs what is missing, and builds in build-benchmark (BANYAN_BUILD_DIR names
# another folder). BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1
# the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
frames=""
ranks="2,4,8,16"
read_options "quick" "output data work frames ranks" "$@"
find_data
size=$((quick ? 128 : 256))
picture=$((quick ? 256 : 512))
frames="${frames:-$((quick ? 40 : 80))}"

stage 1 4 "Installing what is missing and building"
install_and_build
program="$BuildFolder/bin/banyan-bench-balance"
[[ -x "$program" ]] || fail "there is no $program; it has to be built first."
work="${work:-$BuildFolder/balance-scenes}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."
common=(--size "$size" --picture "$picture")

stage 2 4 "Measuring simulated ranks"
"$program" "${common[@]}" --frames "$frames" --ranks "$ranks" --output "$output/balance.csv" \
  --rank-times "$output/balance-ranks.csv" || fail "measuring failed."
# One path of the camera that is not the zoom.
measure_path()
{
  say "      $1, $2 frames"
  "$program" "${common[@]}" --counted --path "$1" --frames "$2" --ranks "$ranks" \
    --output "$output/balance-$1.csv" || fail "measuring failed."
}
measure_path jumps 200
measure_path rest 200
real=()
if [[ -n "$data" ]]; then
  collect bonsai '*.mhd'
fi
for series in "${real[@]+"${real[@]}"}"; do
  say "      bonsai"
  "$program" "${common[@]}" --series "$series" --frames "$frames" --ranks 8 \
    --output "$output/balance-bonsai.csv" || fail "measuring bonsai failed."
done

stage 3 4 "Measuring two real ranks"
if command -v mpirun > /dev/null; then
  mpirun -np 2 --oversubscribe "$program" --mpi "${common[@]}" --frames "$frames" \
    --output "$output/balance-real.csv" || fail "measuring real ranks failed."
  say "      each with half of the volume in its memory"
  mpirun -np 2 --oversubscribe "$program" --mpi --pieces "${common[@]}" --frames "$frames" \
    --modes off,measured-cost \
    --output "$output/balance-pieces.csv" || fail "measuring ranks with pieces failed."
else
  say "      there is no mpirun"
fi

stage 4 4 "Reporting"
"$python" "$here/Balance/report.py" "$output" || fail "the report could not be written."
say "Done: $output/balance.csv, balance.png, balance-ranks.png and the other paths"
