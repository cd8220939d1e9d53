#!/usr/bin/env bash
# Measures size, error and speed of the codec and of its peers, and draws a chart.
#
#   codec.sh [--quick] [--output DIR] [--data DIR] [--work DIR] [--repeat N] [--methods LIST] [--help]
#
#   --quick         64^3 samples and 16 steps instead of 128^3 and 50: minutes instead of an hour
#   --output DIR    where codec.csv and codec.png go (default benchmark-output)
#   --data DIR      folder of real data (default ../shared/data beside the project, if it exists);
#                   measured at 8 bits of accuracy
#   --work DIR      keeps the generated series, which a later run uses again: delete it when the
#                   generators have changed (default: codec-series in the build folder)
#   --repeat N      timed passes, of which the median counts (default 3)
#   --methods LIST  only these, separated by commas (default all)
#
# Installs what is missing, the peers included, builds in build-benchmark (BANYAN_BUILD_DIR names
# another folder), and generates four series: turbulence, convection, jet, wavep. Ends with a table.
# Fails when one of our methods exceeds its error bound; asserts nothing about times.
# BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
repeat=""
methods=""
read_options "quick" "output data work repeat methods" "$@"
find_data
size=$((quick ? 64 : 128))
steps=$((quick ? 16 : 50))
measuring=(${repeat:+--repeat "$repeat"} ${methods:+--methods "$methods"})

# One series into $work, unless it is there; with its description, whose name comes first.
generate()
{
  local name="$1" file="$1-$size-$steps"
  if [[ ! -e "$work/$file.raw" ]]; then
    say "      $name"
    "$BuildFolder/bin/banyan-generate" --series "$name" --size "$size" --steps "$steps" \
      --raw "$work/$file.part" 2> "$work/$file.log" ||
      fail "the series '$name' could not be generated: $(tail -1 "$work/$file.log")"
    mv "$work/$file.part" "$work/$file.raw"
  fi
  printf '{"name": "%s", "file": "%s", "samples": [%d, %d, %d], "steps": %d}\n' \
    "$name" "$file.raw" "$size" "$size" "$size" "$steps" > "$work/$file.json"
  generated+=("$work/$file.json")
}

measure()
{
  "$BuildFolder/bin/banyan-bench-codec" --output "$output/codec.csv" --work "$work/encoded" \
    "${measuring[@]+"${measuring[@]}"}" "$@" || status=1
}

stage 1 5 "Installing what is missing and building"
install_and_build --with-peers
[[ -x "$BuildFolder/bin/banyan-bench-codec" ]] ||
  fail "there is no $BuildFolder/bin/banyan-bench-codec; it has to be built first."
work="${work:-$BuildFolder/codec-series}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."

stage 2 5 "Generating series of $size^3 samples and $steps steps, those that are not in $work"
generated=()
for name in turbulence convection jet wavep; do
  generate "$name"
done

stage 3 5 "Reading real data${data:+ from $data}"
real=()
if [[ -n "$data" ]]; then
  collect isabel_velmag '*.vti'
  collect viscous_fingers_run01 '*.mhd'
  collect colpex_weather '*.vti'
  collect aneurysm_flow_demo_A '*.vti'
fi

stage 4 5 "Measuring"
status=0
measure "${generated[@]}"
[[ ${#real[@]} == 0 ]] || measure --append --bits 8 "${real[@]}"

stage 5 5 "Reporting"
"$python" "$here/Codec/report.py" "$output/codec.csv" "$output/codec.png" ||
  fail "the report could not be written."
say "Done: $output/codec.csv and $output/codec.png"
[[ "$status" == 0 ]] || fail "a method of ours failed or exceeded its error bound (see above)."
