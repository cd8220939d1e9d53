#!/usr/bin/env bash
# Uses the packages of Utilities/package.sh as a stranger would, on a release that has nothing of Banyan's.
#
#   Utilities/on-debian.sh RELEASE --bare Testing/Packages/check.sh FOLDER
#
# Installs the packages in FOLDER with apt, and whatever they depend on. Then: the programs run; ParaView lists
# the plugin; pvpython, pvbatch, pvserver and the window load it by name; the README's example and the program
# of the how-to for C++ work. Changes the system that it runs on.
# SPDX-License-Identifier: BSD-3-Clause
source "$(dirname "${BASH_SOURCE[0]}")/../../Utilities/common.sh"

[[ $# == 1 && -d "$1" ]] || fail "the folder with the packages is missing; the top of this script says more."
folder="$(realpath "$1")"
here="$RepositoryRoot/Testing/Packages"
work="$(mktemp -d)"
cd "$work"
export DEBIAN_FRONTEND=noninteractive
prepare_mpi

install_packages()
{
  apt-get -q update
  apt-get -q install -y --no-install-recommends "$@"
}

# run MODE RANKS: by_name.py in this mode of ParaView.
by_name()
{
  "$RepositoryRoot/Utilities/with-display.sh" python3 "$RepositoryRoot/Testing/PvBatch/run_paraview.py" \
    --mode "$1" --ranks "$2" -- "$here/by_name.py" >"$work/log" 2>&1 ||
    { cat "$work/log" >&2; fail "loading the plugin by its name failed in the mode '$1' on $2 ranks."; }
}

stage 1 5 "Installing the packages"
install_packages "$folder"/*.deb >"$work/log" 2>&1 || { tail -n 20 "$work/log" >&2; fail "apt cannot install them."; }

stage 2 5 "Programs"
banyan-generate --output flow
for name in info verify generate; do
  "banyan-$name" --help >/dev/null || fail "banyan-$name does not run."
  [[ -e "/usr/share/man/man1/banyan-$name.1.gz" ]] || fail "banyan-$name has no man page."
done

# A bare release has no display, compiler or Python program.
install_packages xvfb xauth openbox imagemagick g++ cmake make python3 openmpi-bin >"$work/log" 2>&1 ||
  { tail -n 20 "$work/log" >&2; fail "what this check needs itself cannot be installed."; }

stage 3 5 "The plugin by its name"
by_name builtin 1
by_name batch 1
by_name batch 3
by_name server 2
by_name window 1

stage 4 5 "The README's example"
sed -n '/^```python$/,/^```$/{/^```/d;p}' "$RepositoryRoot/README.md" |
  sed 's|^LoadPlugin(.*|LoadDistributedPlugin("Banyan", ns=globals())|' >example.py
grep -q LoadDistributedPlugin example.py || fail "the README's example loads no plugin."
"$RepositoryRoot/Utilities/with-display.sh" mpiexec --oversubscribe -n 2 pvbatch example.py ||
  fail "the README's example failed."
compgen -G "frame.*.png" >/dev/null || fail "the README's example made no picture."
pvpython "$RepositoryRoot/Utilities/verify/stream_source.py" flow/flow.vti.series |
  banyan-verify --stream flow.banyan || fail "the series is not within its bound."

stage 5 5 "The C++ program of the how-to"
cmake -S "$RepositoryRoot/Documentation/howto/draw-a-series" -B program >"$work/log" 2>&1 ||
  { cat "$work/log" >&2; fail "find_package(Banyan) failed."; }
cmake --build program >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "the program does not compile."; }
"$RepositoryRoot/Utilities/with-display.sh" program/DrawSeries heat.banyan heat.png || fail "the program does not run."
[[ -s heat.png ]] || fail "the program made no picture."
say "The packages work."
