#!/usr/bin/env bash
# Encodes a time series of volumes, measures how exact the result is, and draws it as an animation.
#
#   demo.sh [--input FILES... | --earthquake] [--ranks N] [--output DIR] [--error-bound E] [--size N]
#           [--cells N] [--help]
#
#   --input FILES...   a time series of image data that ParaView opens (.vti, .mhd, .vti.series, ...),
#                      in order of time; without it a flow simulation makes one
#   --earthquake       simulates an earthquake on a mesh of hexahedra instead, and draws each step
#                      twice: as it is, and with its motion brought out
#   --ranks N          MPI processes that draw (default 2)
#   --output DIR       where the results go (default demo-output)
#   --error-bound E    largest error of a value, as a share of the range of the whole series
#                      (default 1/512, of an earthquake 1/4096); 0 keeps every bit
#   --size N           samples per axis of the flow simulation (default 80)
#   --cells N          cells of the earthquake's mesh, about (default 20000)
#
# Leaves in DIR: series.banyan (with its folder series.banyan.d), frame_*.png, animation.mp4 and
# report.json; of an earthquake plain_*.png and enhanced_*.png, and earthquake.png, which has some
# of them side by side. Installs and builds what is missing first; a second run does not build again.
# BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

here="$RepositoryRoot/Utilities"
inputs=()
ranks=2
output="demo-output"
bound=""
size=80
earthquake=0
cells=20000

parse_arguments()
{
  while [[ $# -gt 0 ]]; do
    local option="$1"
    shift
    case "$option" in
      --help)
        sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
        exit 0
        ;;
      --input)
        while [[ $# -gt 0 && "$1" != --* ]]; do
          inputs+=("$1")
          shift
        done
        [[ ${#inputs[@]} -gt 0 ]] || fail "--input needs at least one file."
        ;;
      --earthquake) earthquake=1 ;;
      --ranks | --output | --error-bound | --size | --cells)
        [[ $# -gt 0 ]] || fail "$option needs a value."
        case "$option" in
          --ranks) ranks="$1" ;;
          --output) output="$1" ;;
          --error-bound) bound="$1" ;;
          --size) size="$1" ;;
          --cells) cells="$1" ;;
        esac
        shift
        ;;
      *) fail "there is no option '$option'; --help lists them." ;;
    esac
  done
}

# Refuses what cannot work before anything is installed, built or written.
check_arguments()
{
  local file
  [[ "$ranks" =~ ^[1-9][0-9]{0,3}$ ]] || fail "--ranks needs a number from 1 on, not '$ranks'."
  [[ "$size" =~ ^[0-9]+$ ]] || fail "--size needs a number, not '$size'."
  [[ "$cells" =~ ^[0-9]+$ ]] || fail "--cells needs a number, not '$cells'."
  [[ "$earthquake" == 0 || ${#inputs[@]} == 0 ]] ||
    fail "--earthquake makes its own input: leave one of --earthquake and --input out."
  # The late waves of an earthquake are far weaker than the first.
  [[ -n "$bound" ]] || bound="$([[ "$earthquake" == 1 ]] && echo 1/4096 || echo 1/512)"
  [[ -n "$output" ]] || fail "--output needs the name of a folder."
  bound="$(awk -v text="$bound" 'BEGIN {
    number = "^([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)?$"
    parts = split(text, part, "/")
    if (parts < 1 || parts > 2 || part[1] !~ number) exit 1
    value = part[1] + 0
    if (parts == 2) {
      if (part[2] !~ number || part[2] + 0 == 0) exit 1
      value /= part[2]
    }
    if (value >= 1) exit 1
    printf "%.17g\n", value
  }')" || fail "--error-bound needs a number from 0 to below 1, such as 0.001 or 1/512."
  for file in "${inputs[@]+"${inputs[@]}"}"; do
    [[ -r "$file" && -f "$file" ]] || fail "the input file '$file' does not exist or cannot be read."
  done
}

# Runs a stage's command and keeps how long it took.
declare -A seconds
timed()
{
  local name="$1" start
  shift
  start="$(date +%s.%N)"
  "$@"
  seconds[$name]="$(awk -v a="$start" -v b="$(date +%s.%N)" 'BEGIN { printf "%.3f", b - a }')"
}

install_and_build()
{
  [[ "${BANYAN_SKIP_INSTALL:-0}" == 1 ]] || "$here/install-dependencies.sh"
  [[ "${BANYAN_SKIP_BUILD:-0}" == 1 ]] || "$here/build.sh" --product
  export BANYAN_PLUGIN="$BuildFolder/lib/Banyan/Banyan.so"
  [[ -f "$BANYAN_PLUGIN" ]] || fail "the build left no plugin at $BANYAN_PLUGIN."
}

# The simulation's result is kept in the build folder and made again when the generator changed.
make_input()
{
  if [[ ${#inputs[@]} -gt 0 ]]; then
    say "      ${#inputs[@]} files are given"
    return
  fi
  local folder="$BuildFolder/demo-input-$size" generator="$BuildFolder/bin/banyan-generate"
  local options=(--size "$size" --steps 24 --seed 2)
  inputs=("$folder/flow.vti.series")
  if [[ "$earthquake" == 1 ]]; then
    folder="$BuildFolder/demo-earthquake-$cells"
    options=(--series earthquake --cells "$cells" --arrays velocity --format vtu)
    inputs=("$folder/earthquake.vtu.series")
  fi
  if [[ "${inputs[0]}" -nt "$generator" ]]; then
    say "      the series in $folder is used again"
    return
  fi
  rm -rf "$folder"
  "$generator" --output "$folder" "${options[@]}" 2> >(sed 's/^/      /' >&2) ||
    fail "the simulation did not succeed."
}

encode()
{
  pvpython "$here/demo/demo_encode.py" "$work/series.banyan" "$bound" "$work/encode.json" \
    "${inputs[@]}" || fail "the series could not be encoded."
}

measure()
{
  pvpython "$here/demo/demo_measure.py" "$work/series.banyan" "$bound" "$work/measure.json" \
    "${inputs[@]}" || fail "the encoded series could not be compared with its source."
}

draw()
{
  local script=demo_draw.py
  [[ "$earthquake" == 0 ]] || script=demo_earthquake.py
  "$here/with-display.sh" mpiexec --oversubscribe -n "$ranks" pvbatch "$here/demo/$script" \
    "$work/series.banyan" "$work/measure.json" "$work" "$work/draw.json" ||
    fail "the frames could not be drawn."
}

animate()
{
  local first=frame frames rate
  local pictures=(-i "$work/frame_%04d.png")
  if [[ "$earthquake" == 1 ]]; then
    first=plain
    pictures=(-i "$work/plain_%04d.png" -framerate RATE -i "$work/enhanced_%04d.png"
      -filter_complex hstack)
  fi
  frames="$(find "$work" -name "${first}_*.png" | wc -l)"
  # About three seconds, as smooth as the number of frames allows.
  rate=$((frames / 3))
  rate=$((rate < 2 ? 2 : rate > 25 ? 25 : rate))
  # This pixel format and this order of the file are what browsers play while they load it.
  ffmpeg -nostdin -loglevel error -y -framerate "$rate" "${pictures[@]/RATE/$rate}" \
    -c:v libx264 -crf 18 -pix_fmt yuv420p -movflags +faststart "$work/animation.mp4" >&2 ||
    fail "ffmpeg could not make the animation."
  [[ "$earthquake" == 0 ]] || side_by_side "$frames"
}

# Four steps as they are, and below them the same with their motion brought out.
side_by_side()
{
  local kind step files=()
  for kind in plain enhanced; do
    for step in 10 20 35 60; do # of 81
      files+=(-i "$work/$(printf '%s_%04d.png' "$kind" $((step * ($1 - 1) / 80)))")
    done
  done
  ffmpeg -nostdin -loglevel error -y "${files[@]}" -filter_complex \
    '[0][1][2][3]hstack=4[upper];[4][5][6][7]hstack=4[lower];[upper][lower]vstack,scale=1600:-1' \
    "$work/earthquake.png" >&2 || fail "ffmpeg could not put the pictures side by side."
}

# Puts the results where they belong, all of them or none.
deliver()
{
  mkdir -p "$output"
  rm -rf "$output/series.banyan" "$output/series.banyan.d" "$output"/{frame,plain,enhanced}_*.png \
    "$output/animation.mp4" "$output/earthquake.png" "$output/report.json"
  mv "$work/series.banyan.d" "$work/series.banyan" "$work"/*.png "$work/animation.mp4" \
    "$work/report.json" "$output/"
}

parse_arguments "$@"
check_arguments
prepare_mpi
# On the file system of the results, so that they can be moved there at once when all is done.
mkdir -p "$(dirname "$output")" || fail "the folder of '$output' cannot be made."
work="$(mktemp -d "$(dirname "$output")/.banyan-demo.XXXXXX")" ||
  fail "nothing can be written next to '$output'."
trap 'rm -rf "$work"' EXIT

stage 1 6 "Installing what is missing and building"
timed build install_and_build
stage 2 6 "Making a time series"
timed generate make_input
stage 3 6 "Encoding it"
timed encode encode
stage 4 6 "Comparing every value with its source"
timed measure measure
stage 5 6 "Drawing it on $ranks ranks"
timed draw draw
stage 6 6 "Making the animation and the report"
timed animate animate
times=()
for name in build generate encode measure draw animate; do
  times+=("$name=${seconds[$name]}")
done
python3 "$here/demo/demo_report.py" "$work" "$ranks" "${times[@]}" ||
  fail "the report could not be written."
deliver
say "Done: $output/animation.mp4 and $output/report.json"
