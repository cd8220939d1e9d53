#!/usr/bin/env bash
# Moves the mouse in ParaView's window, and measures how long a user waits for its pictures.
#
#   interaction.sh [--quick] [--output DIR] [--data DIR] [--work DIR] [--scenes LIST] [--modes LIST] [--help]
#
#   --quick        128^3 samples, a view of 512^2, paths orbit and opacity, modes builtin, builtin-off, and line on
#                  the first scene: three minutes
#   --output DIR   where interaction.csv (a line for each path of the mouse), interaction-quality.csv (for each
#                  picture after a single move), interaction.png (a chart of it) and interaction.mp4 (a film of
#                  the window without a server) go (default benchmark-output)
#   --data DIR     folder of real data (default ../shared/data beside the project, if it exists), for isabel
#   --work DIR     keeps the series, which a later run uses again, and what ParaView said (default:
#                  interaction-series in the build folder)
#   --scenes LIST  only these, separated by commas: S1, S2 (256^3), large (S2 with 1024^3), earthquake (a mesh),
#                  isabel
#   --modes LIST   only these, separated by commas: builtin, server, line, and each with -off or -volume; server and line
#                  with -remote or -remote-off, too, which are in no list by default
#
# Columns, modes and scenes are explained in README.md. Needs paraview, ffmpeg, and a display or Xvfb. Installs what
# is missing, and builds in build-benchmark (BANYAN_BUILD_DIR names another folder). BANYAN_SKIP_INSTALL=1 leaves the
# packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
scenes=""
modes=""
read_options "quick" "output data work scenes modes" "$@"
find_data
if [[ $quick == 1 ]]; then
  size=128
  mesh=earthquake-5000
  pixels=512
  scenes="${scenes:-S1,S2}"
  modes="${modes:-builtin,builtin-off,line}"
else
  size=256
  mesh=earthquake-50000
  pixels=1024
  scenes="${scenes:-S1,S2,large,earthquake${data:+,isabel}}"
  modes="${modes:-builtin,builtin-off,builtin-volume,server,server-off,server-volume,line,line-off,line-volume}"
fi
large=1024
steps=16
shaking=8 # a step in which the ground moves

# Refuses a list with a name that is not among the others.
require_known()
{
  local what="$1" names="$2" name
  shift 2
  for name in ${names//,/ }; do
    [[ " $* " == *" $name "* ]] || fail "there is no $what '$name'; --help lists them."
  done
}

# The series of a scene in $work, made unless it is there.
make_series()
{
  case "$1" in
    S1 | S2) encode_standard "$size" ;;
    large) encode_standard "$large" ;;
    earthquake) shake "$mesh" "$steps" ;;
    isabel)
      [[ ! -e "$work/isabel_velmag.banyan" ]] || return 0
      real=()
      [[ -z "$data" ]] || collect isabel_velmag '*.vti'
      [[ ${#real[@]} != 0 ]] || fail "the scene 'isabel' needs the folder isabel_velmag in --data."
      "$BuildFolder/bin/banyan-bench-playback" --encode "${real[0]}" --series "$work/isabel_velmag.banyan" ||
        fail "the hurricane could not be encoded."
      rm -f "$work/isabel_velmag.raw"
      ;;
  esac
}

# What drive_window.py is to be told of a scene.
describe()
{
  case "$1" in
    S1 | S2) echo --scene "$1" --name "$1-$size" --series "$work/standard-$size.banyan" ;;
    large) echo --scene S2 --name "S2-$large" --series "$work/standard-$large.banyan" ;;
    earthquake) echo --scene ramp --name "$mesh" --series "$work/$mesh.banyan" --step "$shaking" ;;
    isabel) echo --scene ramp --name isabel --series "$work/isabel_velmag.banyan" ;;
  esac
}

# One scene in one mode.
measure()
{
  local scene="$1" mode="$2" starting=() driving=() log="$work/$1-$2.log"
  if [[ $scene == large && $mode == *-volume ]]; then
    say "      $scene, $mode: left out: ParaView's Volume makes copies of all $large^3 values, 4 GiB each"
    return
  fi
  say "      $scene, $mode"
  case "$mode" in
    server*) starting=(--server local) ;;
    line*) starting=(--server line) ;;
    *) [[ $scene != "$filmed" ]] || driving=(--film "$film/$mode") ;;
  esac
  [[ $quick == 0 ]] || driving+=(--paths "orbit,opacity")
  # shellcheck disable=SC2046 # several words
  "$RepositoryRoot/Utilities/with-display.sh" "$python" "$here/Interaction/start_window.py" --pixels "$pixels" \
    --seconds 1800 "${starting[@]+"${starting[@]}"}" -- --plugin "$plugin" --info "$BuildFolder/bin/banyan-info" \
    --mode "$mode" --output "$output" $(describe "$scene") "${driving[@]+"${driving[@]}"}" \
    < /dev/null > "$log" 2>&1 ||
    fail "$scene, $mode: $(grep -m 1 -E '^([A-Za-z]*Error|[a-z_]*\.py): ' "$log" || tail -1 "$log"); more is in $log."
}

filmed="${scenes%%,*}"
[[ ",$scenes," != *,S2,* ]] || filmed=S2
require_known scene "$scenes" S1 S2 large earthquake isabel
require_known mode "$modes" {builtin,server,line}{,-off,-volume} {server,line}-remote{,-off}
stage 1 4 "Installing what is missing and building"
with_paraview=ON install_and_build
plugin="$BuildFolder/lib/Banyan/Banyan.so"
[[ -e "$plugin" ]] || fail "there is no $plugin; it has to be built first, with ParaView."
for program in paraview pvserver ffmpeg; do
  command -v "$program" > /dev/null || fail "'$program' is missing: run Utilities/install-dependencies.sh."
done
prepare_mpi
work="${work:-$BuildFolder/interaction-series}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."
output="$(realpath "$output")"
film="$work/film"
# Large enough for the window with all that stands around the view.
export BANYAN_SCREEN=1600x1400x24

stage 2 4 "Making series that are not in $work"
for scene in ${scenes//,/ }; do
  make_series "$scene"
done

stage 3 4 "Measuring"
rm -rf "$film" "$output"/interaction{,-quality}.csv "$output"/interaction.{png,mp4}
first=1
for scene in ${scenes//,/ }; do
  for mode in ${modes//,/ }; do
    [[ $quick == 1 && $first == 0 && $mode == line* ]] || measure "$scene" "$mode"
  done
  first=0
done

stage 4 4 "Reporting"
"$python" "$here/Interaction/report.py" "$output" "$film" || fail "the report could not be written."
results=("$output"/interaction*)
say "Done: ${results[*]}"
