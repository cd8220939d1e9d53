#!/usr/bin/env bash
# Measures time and error of the ray caster and of VTK's volume mappers, and draws charts.
#
#   raycast.sh [--quick] [--scaling] [--output DIR] [--data DIR] [--work DIR] [--repeat N]
#              [--threads LIST] [--scenes LIST] [--renderers LIST] [--settings LIST] [--help]
#
#   --quick           128^3 samples and 256^2 pixels instead of 256^3 and 1024^2, all threads only:
#                     minutes instead of half an hour
#   --scaling         measures time against the size of the volume instead: 64^3 to 1024^3
#                     (--quick: 256^3) and the first frame of an encoded series from a cold start;
#                     BANYAN_CACHE_MB sets the budget of memory
#   --output DIR      where raycast.csv, raycast.png, raycast-largest.png (the worst pixel) and
#                     raycast-pictures.png go, or raycast-scaling.csv and raycast-scaling.png
#                     (default benchmark-output)
#   --data DIR        folder of real data (default ../shared/data beside the project, if it exists)
#   --work DIR        keeps volumes and converged pictures, which a later run uses again
#                     (default: raycast-scenes in the build folder)
#   --repeat N        timed frames, of which the median counts (default 3); fewer of those settings
#                     that take seconds
#   --threads LIST    numbers of threads, separated by commas (default 1 and all processors); fewer
#                     than the largest measure only settings that the design's goals need, and one
#                     sample per voxel
#   --scenes LIST     only these, e.g. S1-256,S2-256-shaded,bonsai (default all)
#   --renderers LIST  only these: banyan, banyan-plain, vtk-gpu, vtk-fixed-point (default all)
#   --settings LIST   only these sample distances and tolerances (default all)
#
# Installs what is missing, and builds in build-benchmark (BANYAN_BUILD_DIR names another folder).
# VTK's mappers draw into a window of the X display, or of a virtual one. Ends with tables, the last of
# which compares with the design's goals.
# BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
scaling=0
repeat=3
threads=""
scenes=""
renderers=""
settings=""
read_options "quick scaling" "output data work repeat threads scenes renderers settings" "$@"
find_data
if [[ -z "$threads" ]]; then
  threads="$([[ $quick == 1 || $(nproc) == 1 ]] && nproc || echo "1,$(nproc)")"
fi
size=256
turbulence=128
sizes=(64 128 256 512 1024)
measuring=(${scenes:+--scenes "$scenes"} ${renderers:+--renderers "$renderers"}
  ${settings:+--settings "$settings"})
if [[ $quick == 1 ]]; then
  size=128
  turbulence=64
  sizes=(64 128 256)
  measuring+=(--picture 256)
fi

# The last step of the turbulence, unless it is there.
generate_turbulence()
{
  local file="turbulence-$turbulence"
  if [[ ! -e "$work/$file.raw" ]]; then
    "$BuildFolder/bin/banyan-generate" --series turbulence --size "$turbulence" --steps 1 \
      --raw "$work/$file.raw" 2> "$work/$file.log" ||
      fail "the turbulence could not be generated: $(tail -1 "$work/$file.log")"
  fi
  printf '{"name": "turbulence", "file": "%s", "samples": [%d, %d, %d], "steps": 1}\n' \
    "$file.raw" "$turbulence" "$turbulence" "$turbulence" > "$work/$file.json"
  real+=("$work/$file.json")
}

# Time and error as options ask for, with a number of threads.
measure_with()
{
  local count="$1"
  shift
  "$RepositoryRoot/Utilities/with-display.sh" "$BuildFolder/bin/banyan-bench-raycast" \
    --output "$output/raycast.csv" --references "$work" --pictures "$work/pictures" \
    --size "$size" --threads "$count" --repeat "$repeat" \
    "${measuring[@]+"${measuring[@]}"}" "$@" "${real[@]+"${real[@]}"}" || fail "measuring failed."
}

# All settings with the largest number of threads, then with fewer those that goals need.
measure_renderers()
{
  local count most scene settings
  most="$(tr , '\n' <<<"$threads" | sort -n | tail -1)"
  rm -rf "$work/pictures"
  mkdir -p "$work/pictures"
  say "      $most thread(s)"
  measure_with "$most"
  cp "$output/raycast.csv" "$work/most-threads.csv" || fail "the results cannot be copied."
  for count in ${threads//,/ }; do
    ((count != most)) || continue
    say "      $count thread(s)"
    while read -r scene settings; do
      measure_with "$count" --append --goals-only --scenes "$scene" --settings "$settings" < /dev/null
    done < <("$python" "$here/RayCast/goals.py" --needed "$work/most-threads.csv")
  done
}

# A process for each line, so that the first frame and the memory are its own. One sample per voxel,
# and as the picture needs for errors of 16, 4 and 1/255. BANYAN_CACHE_MB sets the budget.
measure_scaling()
{
  local n count needed available sampling program="$BuildFolder/bin/banyan-bench-scaling"
  local csv="$output/raycast-scaling.csv"
  "$program" --header > "$csv"
  for n in "${sizes[@]}"; do
    # Values, and half as much again for all others.
    needed=$((n * n * n / 1048576 * 6))
    available="$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo)"
    ((needed <= available)) || say "      $n^3 from memory needs $needed MiB and is left out"
    for count in ${threads//,/ }; do
      say "      $n^3, $count thread(s)"
      for sampling in "" "--tolerance 16" "--tolerance 4" "--tolerance 1"; do
        # shellcheck disable=SC2086 # two words, or none
        "$program" --size "$n" --series "$work/standard-$n.banyan" --threads "$count" \
          --repeat "$repeat" $sampling >> "$csv" || fail "measuring $n^3 samples failed."
        ((needed <= available)) || continue
        # shellcheck disable=SC2086
        "$program" --size "$n" --threads "$count" --repeat "$repeat" $sampling >> "$csv" ||
          fail "measuring $n^3 samples failed."
      done
    done
  done
}

stage 1 4 "Installing what is missing and building"
install_and_build
[[ -x "$BuildFolder/bin/banyan-bench-raycast" ]] ||
  fail "there is no $BuildFolder/bin/banyan-bench-raycast; it has to be built first."
work="${work:-$BuildFolder/raycast-scenes}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."

if [[ $scaling == 1 ]]; then
  stage 2 4 "Encoding the standard field, sizes that are not in $work"
  for n in "${sizes[@]}"; do
    encode_standard "$n"
  done
  stage 3 4 "Measuring"
  measure_scaling
  stage 4 4 "Reporting"
  "$python" "$here/RayCast/report_scaling.py" "$output/raycast-scaling.csv" \
    "$output/raycast-scaling.png" || fail "the report could not be written."
  say "Done: $output/raycast-scaling.csv and $output/raycast-scaling.png"
  exit 0
fi

stage 2 4 "Collecting volumes${data:+ from $data}"
real=()
if [[ -n "$data" ]]; then
  collect bonsai '*.mhd'
  collect engine '*.mhd'
  collect isabel_velmag '*.vti'
  collect viscous_fingers_run01 '*.mhd'
fi
generate_turbulence
stage 3 4 "Measuring"
measure_renderers
stage 4 4 "Reporting"
others=()
for table in raycast-scaling hexmesh hexmesh-scaling; do
  [[ ! -e "$output/$table.csv" ]] || others+=("$output/$table.csv")
done
"$python" "$here/RayCast/report.py" "$output/raycast.csv" "$output/raycast.png" \
  "$output/raycast-largest.png" &&
  "$python" "$here/RayCast/goals.py" "$output/raycast.csv" "${others[@]+"${others[@]}"}" &&
  "$python" "$here/RayCast/compare_pictures.py" "$work/pictures" "$output/raycast-pictures.png" ||
  fail "the report could not be written."
say "Done: $output/raycast.csv, $output/raycast.png, -largest.png and -pictures.png"
