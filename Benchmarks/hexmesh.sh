#!/usr/bin/env bash
# What it takes to draw a mesh of hexahedra, in our way and in those that VTK has.
#
#   hexmesh.sh [--quick] [--long] [--cells N] [--mesh KIND] [--renderers LIST] [--limit SECONDS]
#              [--memory GB] [--repeat N] [--scaling] [--adaptive] [--output DIR] [--work DIR] [--help]
#
#   --quick          64 cells across, a picture of 512^2, and at most 60 seconds per renderer: a few
#                    minutes in all
#   --long           a million cells, then ten millions (216 across), of which VTK's tetrahedra are
#                    fifty: hours
#   --cells N        cells across (default 100: a million in all)
#   --mesh KIND      uniform (default); graded: an octree, N a power of two; earthquake: the ground's
#                    speed, of about N cells in all; FILE.exo: the same of one that banyan-generate made
#   --renderers LIST only these, separated by commas; banyan-bench-hexmesh-renderer --list has VTK's
#   --limit SECONDS  for each renderer, after which it is ended and its row says so (default 900)
#   --memory GB      for each renderer; one that needs more fails, and its row says so (default 20)
#   --repeat N       frames after the first one, of which the median counts (default 3; --quick 1); no
#                    more begin when they have taken a minute
#   --scaling        set-up time and bytes per node from 20 thousand to 10 million cells instead, of
#                    one size and of earthquakes
#   --adaptive       an earthquake of N cells (default 200000; or that of --mesh) in full and with coarser
#                    levels instead
#   --output DIR     where hexmesh.csv and hexmesh.png go (default benchmark-output)
#   --work DIR       keeps meshes and converged pictures (default: hexmesh-references in the build folder)
#
# A process for each renderer, so that its memory is its own. VTK's mappers draw into a window of the X
# display, or of a virtual one. BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone,
# BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
long=0
scaling=0
adaptive=0
cells=""
mesh="uniform"
renderers=""
limit=""
memory=20
repeat=""
read_options "quick long scaling adaptive" "output work cells mesh renderers limit memory repeat" "$@"
limit="${limit:-$((quick ? 60 : 900))}"
repeat="${repeat:-$((quick ? 1 : 3))}"
picture=$((quick ? 512 : 1024))
for number in "$limit" "$memory"; do
  [[ "$number" =~ ^[1-9][0-9]*$ ]] || fail "--limit and --memory take whole numbers."
done

# One renderer, within the time and the memory that it may take.
draw_with()
{
  ulimit -v $((memory * 1000000000 / 1024)) || return
  ulimit -c 0
  exec timeout "$limit" "$program" --renderer "$1" --mesh "$mesh" --cells "$2" \
    --picture "$picture" --repeat "$repeat" --threads "$(nproc)" --references "$work"
}
export -f draw_with

# A line of CSV for each renderer; of those that need too long, or fail, one that says so.
measure()
{
  local across="$1" name csv="$output/hexmesh.csv" count status note
  say "      the mesh and its converged picture"
  count="$("$program" --renderer reference --mesh "$mesh" --cells "$across" --picture "$picture" \
    --threads "$(nproc)" --references "$work")" || fail "the mesh could not be made."
  export memory limit program mesh picture repeat work
  for name in ${renderers//,/ }; do
    say "      $name"
    status=0
    "$RepositoryRoot/Utilities/with-display.sh" bash -c "draw_with $name $across" >> "$csv" ||
      status=$?
    ((status != 0)) || continue
    note="failed with $memory GB"
    ((status != 124)) || note="not within $limit s"
    say "      $name: $note"
    printf '%s,%s,,,,,,%s\n' "$count" "$name" "$note" >> "$csv"
  done
}

measure_scaling()
{
  local mesh csv="$output/hexmesh-scaling.csv"
  "$BuildFolder/bin/banyan-bench-hexmesh" --header > "$csv" || fail "$csv cannot be written."
  for mesh in "27" "58" "100" "126" "158" "200" "216" "20000 --earthquake" "200000 --earthquake" \
    "1000000 --earthquake" "2000000 --earthquake" "4000000 --earthquake" "10000000 --earthquake"; do
    say "      --cells $mesh"
    # shellcheck disable=SC2086 # words
    "$BuildFolder/bin/banyan-bench-hexmesh" --picture 64 --repeat 1 --threads "$(nproc)" \
      --cells $mesh >> "$csv" || fail "measuring the mesh failed."
  done
  "$python" "$here/HexMesh/report.py" --scaling "$csv" || fail "the report could not be written."
}

# The study's figure 3: the same earthquake in full, and with coarser levels where they are enough.
measure_adaptive()
{
  local csv="$output/hexmesh-adaptive.csv" options
  "$program" --header > "$csv" || fail "$csv cannot be written."
  for options in "banyan-full" "banyan --tolerance 1" "banyan --tolerance 4" \
    "banyan --tolerance 8" "banyan --tolerance 32" "banyan-one-level --max-elements 0.06" \
    "banyan-one-level --max-elements 0.015"; do
    say "      $options"
    # shellcheck disable=SC2086 # words
    "$program" --mesh "$mesh" --cells "$cells" --picture 1024 --repeat "$repeat" \
      --threads "$(nproc)" --references "$work" --save "$output/hexmesh-${options// /}.ppm" \
      --renderer $options >> "$csv" || fail "drawing the earthquake failed."
  done
  "$python" "$here/HexMesh/report.py" --adaptive "$csv" || fail "the report could not be written."
}

stage 1 3 "Installing what is missing and building"
install_and_build
program="$BuildFolder/bin/banyan-bench-hexmesh-renderer"
[[ -x "$program" ]] || fail "there is no $program; it has to be built first."
work="${work:-$BuildFolder/hexmesh-references}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."
stage 2 3 "Measuring"
if [[ $scaling == 1 ]]; then
  measure_scaling
  exit 0
fi
if [[ $adaptive == 1 ]]; then
  cells="${cells:-200000}"
  [[ "$mesh" == *.exo ]] || mesh=earthquake
  measure_adaptive
  exit 0
fi
if [[ "$mesh" == earthquake ]]; then
  cells="${cells:-$((quick ? 200000 : 1000000))}"
  ((long == 0)) || cells="$cells 10000000"
else
  cells="${cells:-$((quick ? 64 : 100))}"
  ((long == 0)) || cells="$cells 216"
fi
renderers="${renderers:-banyan,banyan-full,$("$program" --list | paste -sd,)}"
"$program" --header > "$output/hexmesh.csv" || fail "$output/hexmesh.csv cannot be written."
for across in $cells; do
  measure "$across"
done
stage 3 3 "Reporting"
"$python" "$here/HexMesh/report.py" "$output/hexmesh.csv" "$output/hexmesh.png" ||
  fail "the report could not be written."
say "Done: $output/hexmesh.csv and $output/hexmesh.png"
