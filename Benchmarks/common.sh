# Shared by the scripts of this folder: source it, do not run it.
# shellcheck shell=bash

# SPDX-License-Identifier: BSD-3-Clause
# Not the folder of the whole project, whose settings are others.
BANYAN_BUILD_DIR="${BANYAN_BUILD_DIR:-$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")/build-benchmark}"
export BANYAN_BUILD_DIR
source "$(dirname "${BASH_SOURCE[0]}")/../Utilities/common.sh"

here="$RepositoryRoot/Benchmarks"
# Debian's Python, for which its packages are.
python=/usr/bin/python3
[[ -x "$python" ]] || python=python3
data=""

# What stands at the top of a script.
help_of()
{
  sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "$1"
}

# Sets variables to what the options of a script say: those of the first list are 1 when they are
# given, those of the second take a value. `--help` prints the top of the script.
read_options()
{
  local flags="$1" valued="$2" option
  shift 2
  while [[ $# -gt 0 ]]; do
    option="${1#--}"
    if [[ "$1" == --help ]]; then
      help_of "${BASH_SOURCE[1]}"
      exit 0
    elif [[ "$1" == --?* && " $flags " == *" $option "* ]]; then
      declare -g "$option=1"
    elif [[ "$1" == --?* && " $valued " == *" $option "* ]]; then
      [[ $# -gt 1 && -n "$2" ]] || fail "$1 needs a value."
      declare -g "$option=$2"
      shift
    else
      fail "there is no option '$1'; --help lists them."
    fi
    shift
  done
}

# Sets `data` to the folder of real data beside the project, unless it is given.
find_data()
{
  if [[ -z "$data" && -d "$RepositoryRoot/../shared/data" ]]; then
    data="$(realpath "$RepositoryRoot/../shared/data")"
  fi
  [[ -z "$data" || -d "$data" ]] || fail "there is no folder '$data'."
}

# Takes what installing the packages is to be told. The plugin is built where `with_paraview` is ON.
install_and_build()
{
  [[ "${BANYAN_SKIP_INSTALL:-0}" == 1 ]] ||
    "$RepositoryRoot/Utilities/install-dependencies.sh" "$@"
  [[ "${BANYAN_SKIP_BUILD:-0}" == 1 ]] ||
    "$RepositoryRoot/Utilities/build.sh" -DBANYAN_WITH_PARAVIEW="${with_paraview:-OFF}" -DBANYAN_BUILD_TESTING=OFF \
      -DBANYAN_BUILD_BENCHMARKS=ON
}

# Images of the real data as one raw series in $work, if they are there; adds it to `real`.
collect()
{
  local name="$1" pattern="$2" images=()
  mapfile -t images < <(compgen -G "$data/$name/$pattern" | sort)
  if [[ ${#images[@]} == 0 ]]; then
    say "      there is no $name"
    return
  fi
  "$python" "$here/Codec/read_images.py" "$name" "$work/$name.raw" "${images[@]}" ||
    fail "the images of '$name' could not be read."
  real+=("$work/$name.json")
}

# The standard field as the encoded series $work/standard-N.banyan, unless it is there.
encode_standard()
{
  local n="$1"
  [[ ! -e "$work/standard-$n.banyan" ]] || return 0
  say "      $n^3"
  "$BuildFolder/bin/banyan-generate" --series standard --size "$n" --raw "$work/standard-$n.raw" ||
    fail "the field of $n^3 samples could not be generated."
  "$BuildFolder/bin/banyan-bench-scaling" --encode "$work/standard-$n.raw" --size "$n" \
    --series "$work/standard-$n.banyan" --threads "$(nproc)" || fail "encoding $n^3 samples failed."
  rm "$work/standard-$n.raw"
}

# Runs Playback/paraview_playback.py in pvbatch. $plugin is Banyan.so.
in_paraview()
{
  "$RepositoryRoot/Utilities/with-display.sh" mpiexec --oversubscribe -n 1 pvbatch \
    "$here/Playback/paraview_playback.py" --plugin "$plugin" --info "$BuildFolder/bin/banyan-info" \
    "$@" < /dev/null > "$work/paraview.log" 2>&1 ||
    fail "ParaView failed: $(grep -m 1 'Error' "$work/paraview.log" || tail -1 "$work/paraview.log")"
}

# A mesh named earthquake-CELLS with so many steps as $work/earthquake-CELLS.banyan, unless it is there.
shake()
{
  local name="$1" steps="$2"
  [[ ! -e "$work/$name.banyan" ]] || return 0
  say "      $name"
  "$BuildFolder/bin/banyan-generate" --series earthquake --cells "${name#*-}" --steps "$steps" \
    --output "$work/$name" 2> "$work/$name.log" ||
    fail "the earthquake could not be generated: $(tail -1 "$work/$name.log")"
  in_paraview --encode "$work/$name/earthquake.exo" --array velocity --series "$work/$name.banyan"
  rm -r "${work:?}/$name"
}
