#!/usr/bin/env bash
# What it takes to draw a mesh of hexahedra, in our way and in those that VTK has.
#
#   hexmesh.sh [--quick] [--cells N] [--mesh KIND] [--renderers LIST] [--limit SECONDS] [--repeat N]
#              [--scaling] [--adaptive] [--output DIR] [--work DIR] [--help]
#
#   --quick          64 cells across, a picture of 512^2, and at most 60 seconds per renderer: a few
#                    minutes in all
#   --cells N        cells across (default 100: a million in all; 216: ten millions, of which VTK's
#                    tetrahedra are fifty)
#   --mesh KIND      uniform (default); graded: an octree, N a power of two; FILE.exo: an earthquake
#                    that banyan-generate made
#   --renderers LIST only these, separated by commas; banyan-bench-hexmesh-renderer --list has VTK's
#   --limit SECONDS  for each renderer, after which it is ended and its row stays empty (default 900)
#   --repeat N       frames after the first one, of which the median counts (default 3; --quick 1)
#   --scaling        set-up time and bytes per node from 20 thousand to 10 million cells instead
#   --adaptive       an earthquake of N cells (default 200000; or that of --mesh) in full and with coarser
#                    levels instead
#   --output DIR     where hexmesh.csv and hexmesh.png go (default benchmark-output)
#   --work DIR       keeps converged pictures (default: hexmesh-references in the build folder)
#
# A process for each renderer, so that its memory is its own. VTK's mappers draw into a window of the X
# display, or of a virtual one. BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone,
# BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

output="benchmark-output"
work=""
quick=0
scaling=0
adaptive=0
cells=""
mesh="uniform"
renderers=""
limit=""
repeat=""
read_options "quick scaling adaptive" "output work cells mesh renderers limit repeat" "$@"
limit="${limit:-$((quick ? 60 : 900))}"
repeat="${repeat:-$((quick ? 1 : 3))}"
picture=$((quick ? 512 : 1024))
[[ "$limit" =~ ^[1-9][0-9]*$ ]] || fail "--limit takes whole seconds."

# A line of CSV for each renderer; an empty one for those that need too long, or fail.
measure()
{
  local name csv="$output/hexmesh.csv" count status
  count=$((cells * cells * cells))
  [[ "$mesh" == uniform ]] || count=""
  "$program" --header > "$csv" || fail "$csv cannot be written."
  for name in ${renderers//,/ }; do
    say "      $name"
    status=0
    "$RepositoryRoot/Utilities/with-display.sh" timeout "$limit" "$program" --renderer "$name" \
      --mesh "$mesh" --cells "$cells" --picture "$picture" --repeat "$repeat" \
      --threads "$(nproc)" --references "$work" >> "$csv" || status=$?
    if ((status == 124)); then
      say "      $name did not finish within $limit seconds"
    elif ((status != 0)); then
      say "      $name failed"
    fi
    ((status == 0)) || printf '%s,%s,,,,,\n' "$count" "$name" >> "$csv"
  done
}

measure_scaling()
{
  local n csv="$output/hexmesh-scaling.csv"
  "$BuildFolder/bin/banyan-bench-hexmesh" --header > "$csv" || fail "$csv cannot be written."
  for n in 27 58 100 126 158 200 216; do
    say "      $n^3"
    "$BuildFolder/bin/banyan-bench-hexmesh" --cells "$n" --picture 64 --repeat 1 \
      --threads "$(nproc)" >> "$csv" || fail "measuring $n^3 cells failed."
  done
  "$python" "$here/HexMesh/report.py" --scaling "$csv" || fail "the report could not be written."
}

# The study's figure 3: the same earthquake in full, and with coarser levels where they are enough.
measure_adaptive()
{
  local csv="$output/hexmesh-adaptive.csv" options
  "$program" --header > "$csv" || fail "$csv cannot be written."
  for options in "banyan-full" "banyan --tolerance 1" "banyan --tolerance 4" \
    "banyan --tolerance 8" "banyan-one-level --max-elements 0.1" \
    "banyan-one-level --max-elements 0.06"; do
    say "      $options"
    # shellcheck disable=SC2086 # words
    "$program" --mesh "$mesh" --cells "$cells" --picture 512 --repeat "$repeat" \
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
cells="${cells:-$((quick ? 64 : 100))}"
renderers="${renderers:-banyan,banyan-full,$("$program" --list | paste -sd,)}"
measure
stage 3 3 "Reporting"
"$python" "$here/HexMesh/report.py" "$output/hexmesh.csv" "$output/hexmesh.png" ||
  fail "the report could not be written."
say "Done: $output/hexmesh.csv and $output/hexmesh.png"
