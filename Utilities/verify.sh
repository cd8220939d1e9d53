#!/usr/bin/env bash
# Proves that each value of an encoded series is within its error bound of the source.
#
#   verify.sh FILE --against SOURCE... [--array NAME] [--opacity V:O,V:O...] [--json] [--help]
#   verify.sh FILE --against SOURCE... --raw-type float32 --dims X Y Z [...]
#
#   FILE               the series, name.banyan
#   --against SOURCE   what it was made from: a file or files, in order of time, of image data, of a
#                      curvilinear or rectilinear grid or of a mesh that ParaView opens (.vti,
#                      .vti.series, .pvd, .mhd, .vts, .vtr, .exo, .vtu, ...), or another .banyan (of
#                      no mesh)
#   --raw-type T       SOURCE are raw files without a header, little-endian, x fastest, of type
#                      float32, float64, uint8, ...; each holds one time step or more
#   --dims X Y Z       samples of raw files per axis
#   --array NAME       compares this array alone; may be given several times
#   --opacity V:O,...  opacities over values, linear in between, that weigh the errors (equation 2
#                      of the study that Banyan started from); a ramp over the range by default
#   --json             the report as JSON instead of text
#
# Exit status 0: every finite value of every step is within the bound, NaN and infinities are the same
# bits, and so are the points of grids, which points and cells are hidden and the values at hidden points; 1: not so, and the worst value is named; 2: the two cannot be compared (steps,
# times, grids, arrays or types differ, or something cannot be read). Neither raw files nor .banyan
# need ParaView. Builds what it needs when it is missing.
# How to read the report: Documentation/howto/how-good.md.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

NotComparable=2
arguments=() # of the program that compares
sources=()
arrays=() # the options that name them
needs_paraview=1

parse_arguments()
{
  while [[ $# -gt 0 ]]; do
    case "$1" in
      --help)
        sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
        exit 0
        ;;
      --against)
        while [[ $# -gt 1 && "$2" != --* ]]; do
          sources+=("$2")
          shift
        done
        ;;
      --array)
        arguments+=("$1" "${@:2:1}")
        arrays+=("$1" "${@:2:1}")
        shift $(($# > 1 ? 1 : 0))
        ;;
      --raw-type | --dims)
        needs_paraview=0
        arguments+=("$1")
        ;;
      *) arguments+=("$1") ;;
    esac
    shift
  done
  if [[ ${#sources[@]} -gt 0 && "${sources[0]}" == *.banyan ]]; then
    needs_paraview=0
  fi
}

# Ends the script with the status for what cannot be compared.
refuse()
{
  say "$(basename "$0"): $*"
  exit "$NotComparable"
}

# Reads the source with ParaView and hands it to the program through a pipe.
compare_with_paraview()
{
  local statuses
  command -v pvpython >/dev/null ||
    refuse "pvpython, which reads the source, is missing; Utilities/install-dependencies.sh" \
      "installs it."
  set +e
  pvpython "$RepositoryRoot/Utilities/verify/stream_source.py" \
    "${arrays[@]+"${arrays[@]}"}" "${sources[@]}" |
    "$program" --stream "${arguments[@]+"${arguments[@]}"}"
  statuses=("${PIPESTATUS[@]}")
  # The program's own verdict counts: the reader ends early when it is no longer listened to.
  exit "${statuses[1]}"
}

parse_arguments "$@"
for file in "${sources[@]+"${sources[@]}"}"; do
  [[ -r "$file" && -f "$file" ]] || refuse "the source '$file' does not exist or cannot be read."
done
program="$(core_program banyan-verify)" || exit "$NotComparable"
if [[ ${#sources[@]} -gt 0 && "$needs_paraview" == 1 ]]; then
  compare_with_paraview
fi
if [[ ${#sources[@]} -gt 0 ]]; then
  arguments+=(--against "${sources[@]}")
fi
exec "$program" "${arguments[@]+"${arguments[@]}"}"
