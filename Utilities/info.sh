#!/usr/bin/env bash
# Tells what an encoded series holds, how small it is, how exact, and what its tree is made of.
#
#   info.sh FILE [--step N] [--array NAME] [--json] [--time] [--figure PICTURE] [--help]
#
#   FILE               the series, name.banyan
#   --step N           of one time step (the first is 0) instead of all
#   --array NAME       of one array instead of all
#   --json             as JSON instead of text
#   --time             also measures how long decoding takes, for some seconds
#   --figure PICTURE   draws how many subtrees are unchanged, by size, over the time steps (figure 9
#                      of the study), as .png, .svg or .pdf; .csv writes the table behind it, with
#                      everything known per step
#
# Builds what it needs when it is missing. How to read the report: Documentation/howto/how-good.md.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

arguments=()
figure=""
while [[ $# -gt 0 ]]; do
  case "$1" in
    --help)
      sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    --figure)
      [[ $# -gt 1 ]] || fail "--figure needs the name of a file."
      figure="$2"
      shift
      ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
case "$figure" in
  "" | *.png | *.svg | *.pdf | *.csv) ;;
  *) fail "--figure writes .png, .svg, .pdf or .csv, not '$figure'." ;;
esac

program="$(core_program banyan-info)" || exit 1
case "$figure" in
  "") exec "$program" "${arguments[@]+"${arguments[@]}"}" ;;
  *.csv) exec "$program" --csv "$figure" "${arguments[@]+"${arguments[@]}"}" ;;
esac
table="$(mktemp)"
trap 'rm -f "$table"' EXIT
"$program" --csv "$table" "${arguments[@]+"${arguments[@]}"}"
"$(python_with matplotlib)" "$RepositoryRoot/Utilities/info/plot_steps.py" "$table" "$figure" ||
  fail "the figure could not be drawn."
say "The figure is in $figure."
