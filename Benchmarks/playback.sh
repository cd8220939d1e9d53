#!/usr/bin/env bash
# Plays series, and measures frames that know those before beside frames that are drawn from nothing.
#
#   playback.sh [--quick] [--output DIR] [--data DIR] [--work DIR] [--passes N] [--series LIST] [--help]
#
#   --quick        64^3 samples, 16 steps, 256^2 pixels, one rank: two minutes instead of an hour
#   --output DIR   where playback.csv (a line for each frame), playback-frames.png (time of each frame),
#                  playback-series.png (times by series), playback-paraview.png (in ParaView), and
#                  playback-paper.csv and .png (the study's experiment) go (default benchmark-output)
#   --data DIR     folder of real data (default ../shared/data beside the project, if it exists): the
#                  hurricane Isabel, viscous fingers and the aneurysm are played too
#   --work DIR     keeps the series, which a later run uses again (default: playback-series in the build
#                  folder)
#   --passes N     each with empty caches; of a frame the quickest one counts (default 2); one in ParaView
#   --series LIST  only these, separated by commas: jet, convection, turbulence, wave, few-changes,
#                  earthquake (a mesh, in ParaView alone), isabel_velmag, viscous_fingers_run01,
#                  aneurysm_flow_demo_A
#
# Columns are explained in README.md. Needs pvbatch, and a display or Xvfb. Installs what is missing, and
# builds in build-benchmark (BANYAN_BUILD_DIR names another folder). BANYAN_SKIP_INSTALL=1 leaves the
# packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
passes=2
series=""
read_options "quick" "output data work passes series" "$@"
find_data
size=$((quick ? 64 : 128))
steps=$((quick ? 16 : 50))
mesh=earthquake-$((quick ? 5000 : 50000)) # and its cells
pictures=(512 1024)
ranks=(1 2)
tolerances=(0 8 64)
slow_mb_s=50
if [[ $quick == 1 ]]; then
  pictures=(256)
  ranks=(1)
  tolerances=(8)
fi

wanted()
{
  [[ -z "$series" || ",$series," == *",$1,"* ]]
}

# Encodes a raw series as $work/NAME.banyan, unless it is there; adds it to `names`.
encode()
{
  local name="$1" description="$2"
  if [[ ! -e "$work/$name.banyan" ]]; then
    "$program" --encode "$description" --series "$work/$name.banyan" ||
      fail "the series '$name' could not be encoded."
  fi
  names+=("$name")
}

# The study's experiment needs the raw series: what it counts is kept beside the encoded one.
generate()
{
  local kind="$1" name="$1-$size"
  if [[ ! -e "$work/$name.banyan" ]]; then
    say "      $name"
    "$BuildFolder/bin/banyan-generate" --series "$kind" --size "$size" --steps "$steps" \
      --raw "$work/$name.raw" 2> "$work/$name.log" ||
      fail "the series '$kind' could not be generated: $(tail -1 "$work/$name.log")"
    printf '{"name": "%s", "file": "%s", "samples": [%d, %d, %d], "steps": %d}\n' \
      "$kind" "$name.raw" "$size" "$size" "$size" "$steps" > "$work/$name.json"
  fi
  encode "$name" "$work/$name.json"
  if [[ ! -e "$work/$name-paper.csv" && -e "$work/$name.raw" ]]; then
    "$program" --paper "$work/$name.json" --series "$work/$name.banyan" --name "$name" --picture 128 \
      > "$work/$name-paper.csv" || fail "the study's experiment on '$name' failed."
  fi
  rm -f "$work/$name.raw"
}

# Plays a series in ParaView, with Banyan Volume and with its own Volume.
play_in_paraview()
{
  local name="$1" picture="$2" tolerance
  local common=(--series "$work/$name.banyan" --name "$name" --table "$output/playback.csv" \
    --picture "$picture" --frames "$steps")
  for tolerance in 1 8; do
    in_paraview "${common[@]}" --tolerance "$tolerance"
  done
  in_paraview "${common[@]}" --representation volume
}

# Plays a series with some options on so many ranks.
play()
{
  local name="$1" count="$2"
  shift 2
  local launch=()
  ((count == 1)) || launch=(mpiexec --oversubscribe -n "$count")
  "${launch[@]+"${launch[@]}"}" "$program" --series "$work/$name.banyan" --name "$name" \
    --output "$output/playback.csv" --passes "$passes" "$@" < /dev/null ||
    fail "playing '$name' failed."
}

# A command that reads files at slow_mb_s.
slowly()
{
  LD_PRELOAD="$(find "$BuildFolder" -name 'libbanyan-slow-reads.so' | head -1)" \
    BANYAN_SLOW_MB_S=$slow_mb_s "$@"
}

stage 1 5 "Installing what is missing and building"
with_paraview=ON install_and_build
program="$BuildFolder/bin/banyan-bench-playback"
plugin="$BuildFolder/lib/Banyan/Banyan.so"
for file in "$program" "$plugin"; do
  [[ -e "$file" ]] || fail "there is no $file; it has to be built first, with MPI and ParaView."
done
prepare_mpi
work="${work:-$BuildFolder/playback-series}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."

stage 2 5 "Making series that are not in $work"
names=()
for kind in jet convection turbulence wave few-changes; do
  ! wanted "$kind" || generate "$kind"
done
if [[ -n "$data" && $quick == 0 ]]; then
  for kind in isabel_velmag:'*.vti' viscous_fingers_run01:'*.mhd' aneurysm_flow_demo_A:'*.vti'; do
    wanted "${kind%%:*}" || continue
    real=()
    [[ -e "$work/${kind%%:*}.banyan" ]] || collect "${kind%%:*}" "${kind#*:}"
    if [[ -e "$work/${kind%%:*}.banyan" || ${#real[@]} != 0 ]]; then
      encode "${kind%%:*}" "$work/${kind%%:*}.json"
    fi
  done
fi
! wanted earthquake || shake "$mesh" "$steps"

stage 3 5 "Measuring"
rm -f "$output/playback.csv"
# Memory that a virtual machine has never used is slow the first time: 10 ms for a picture of 512^2.
"$python" -c 'b"1" * (4 << 30)' 2> /dev/null || true
for name in "${names[@]}"; do
  say "      $name"
  for picture in "${pictures[@]}"; do
    for tolerance in "${tolerances[@]}"; do
      for count in "${ranks[@]}"; do
        play "$name" "$count" --picture "$picture" --tolerance "$tolerance" --frames "$steps"
      done
    done
  done
  few=(--picture "${pictures[0]}" --frames "$steps")
  play "$name" 1 "${few[@]}" --mode loop
  play "$name" 1 "${few[@]}" --mode rest
  play "$name" 1 "${few[@]}" --mode function
  play "$name" 1 "${few[@]}" --cold --name "$name (cold)"
  slowly play "$name" 1 "${few[@]}" --name "$name ($slow_mb_s MB/s)"
  export BANYAN_THREADS=1
  play "$name" 1 "${few[@]}" --tolerance 0 --name "$name (a thread)"
  slowly play "$name" 1 "${few[@]}" --tolerance 0 --name "$name (a thread at $slow_mb_s MB/s)"
  unset BANYAN_THREADS
done

stage 4 5 "Measuring in ParaView"
for name in "${names[@]}" $(! wanted earthquake || echo "$mesh"); do
  say "      $name"
  for picture in "${pictures[@]}"; do
    play_in_paraview "$name" "$picture"
  done
done

stage 5 5 "Reporting"
rm -f "$output/playback-paper.csv"
for name in "${names[@]}"; do
  if [[ -e "$work/$name-paper.csv" ]]; then
    sed "$([[ ! -e "$output/playback-paper.csv" ]] || echo 1d)" "$work/$name-paper.csv" >> "$output/playback-paper.csv"
  fi
done
"$python" "$here/Playback/report.py" "$output" || fail "the report could not be written."
say "Done: $output/playback.csv, $output/playback-*.png and $output/playback-paper.csv"
