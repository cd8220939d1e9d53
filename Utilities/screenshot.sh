#!/usr/bin/env bash
# Takes a picture of the ParaView window that shows a series as 'Banyan Volume': the one of the
# README. Needs the plugin (build.sh), Xvfb, openbox and ImageMagick's import.
#
#   Utilities/screenshot.sh SERIES.banyan PICTURE.png
# SPDX-License-Identifier: BSD-3-Clause
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

[[ $# == 2 ]] || fail "usage: Utilities/screenshot.sh SERIES.banyan PICTURE.png"
[[ -e "$1" ]] || fail "there is no file '$1'."
plugin="$BuildFolder/lib/Banyan"
[[ -e "$plugin/Banyan.so" ]] || fail "the plugin is not built: run Utilities/build.sh first."
for program in Xvfb openbox import paraview; do
  command -v "$program" > /dev/null ||
    fail "'$program' is missing: run Utilities/install-dependencies.sh."
done

# A display of its own, just large enough for the window.
if [[ -z "${BANYAN_SCREENSHOT_DISPLAY:-}" ]]; then
  exec env -u DISPLAY BANYAN_SCREENSHOT_DISPLAY=1 BANYAN_SCREEN=1300x820x24 \
    "$RepositoryRoot/Utilities/with-display.sh" "$0" "$@"
fi

work="$(mktemp -d)"
pids=()
clean_up()
{
  kill "${pids[@]}" 2> /dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT

# Without the settings of the user, and without the modal dialog that welcomes new ones.
export HOME="$work" XDG_CONFIG_HOME="$work" XDG_RUNTIME_DIR="$work" QT_X11_NO_MITSHM=1
export PV_PLUGIN_PATH="$plugin" BANYAN_READY="$work/ready"
BANYAN_SERIES="$(realpath "$1")"
export BANYAN_SERIES PYTHONPATH="$RepositoryRoot/Utilities/demo"

openbox > /dev/null 2>&1 &
pids+=($!)

say "starting ParaView"
timeout 120 paraview --disable-registry --geometry=1300x790+0+0 \
  --script="$RepositoryRoot/Utilities/screenshot/window_script.py" > "$work/log" 2>&1 &
pids+=($!)
for _ in $(seq 200); do
  [[ -e "$BANYAN_READY" ]] && break
  sleep 0.5
done
[[ "$(cat "$BANYAN_READY" 2> /dev/null)" == ready ]] \
  || fail "ParaView did not show the series: $(cat "$BANYAN_READY" "$work/log" 2> /dev/null | tail -5)"
sleep 2 # the panels settle
# Without the black of the display around the window.
import -window root "$work/screen.png"
convert "$work/screen.png" -bordercolor black -border 1 -trim +repage "$2"
say "wrote $2"
