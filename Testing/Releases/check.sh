#!/usr/bin/env bash
# Compares what Banyan writes, reads and draws on several releases of Debian.
#
#   Testing/Releases/check.sh [RELEASE...]      (default 12 13 testing)
#
# The first release makes a flow and an earthquake, and each encodes the same files. The flow's bytes have to be the
# same; from the series of all releases each has to read the same values, bit for bit. Each draws the scenes of
# Testing/PvBatch from one series: no channel of a pixel may differ from the first release's by more than 1 of 255.
# Each takes a picture of ParaView's window.
#
# Builds the plugin on each release first. Leaves all in build-debian-compared, pictures of the windows as
# window-RELEASE.png. The release of this machine is used as it is; others need
# root (Utilities/on-debian.sh).
source "$(dirname "${BASH_SOURCE[0]}")/../../Utilities/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

releases=("$@")
[[ $# -gt 0 ]] || releases=(12 13 testing)
first="${releases[0]}"
work="$RepositoryRoot/build-debian-compared"
rm -rf "$work"
mkdir -p "$work"

# script RELEASE NAME ARGUMENTS: a script of the tests in ParaView there.
script()
{
  local release="$1" name="$2"
  shift 2
  on_debian "$release" "export PYTHONPATH=\$PWD/Testing/PvBatch
    Utilities/with-display.sh python3 Testing/PvBatch/run_paraview.py --seconds 600 -- $name $*" \
    >"$work/$release.log" 2>&1 || fail "$name failed on Debian $release: $work/$release.log says why."
}

stage 1 4 "Building"
for release in "${releases[@]}"; do
  on_debian "$release" "Utilities/install-dependencies.sh; Utilities/build.sh --product" >"$work/build-$release.log" 2>&1 ||
    fail "Debian $release cannot build it: $work/build-$release.log says why."
done

stage 2 4 "Encoding on each release"
on_debian "$first" "\$BuildFolder/bin/banyan-generate --size 48 --steps 6 --output $work/source
  \$BuildFolder/bin/banyan-generate --series earthquake --cells 4000 --arrays velocity --format vtu --output $work/source" \
  >"$work/source.log" 2>&1 || fail "the series could not be generated: $work/source.log says why."
declare -A sources=([flow]=flow.vti.series [earthquake]=earthquake.vtu.series)
for series in "${!sources[@]}"; do
  for release in "${releases[@]}"; do
    script "$release" Testing/Releases/encode.py --plugin "\$BuildFolder/lib/Banyan/Banyan.so" \
      --source "$work/source/${sources[$series]}" --out "$work/$series-$release/$series.banyan"
  done
done
# A mesh is compressed by the release's own zstd.
python3 "$RepositoryRoot/Testing/PvBatch/compare_files.py" --fewest 1 "${releases[@]/#/$work/flow-}" ||
  fail "the releases do not write the same bytes."
for series in "${!sources[@]}"; do
  written=("${releases[@]/#/$work/$series-}")
  for release in "${releases[@]}"; do
    script "$release" Testing/Releases/compare_series.py --plugin "\$BuildFolder/lib/Banyan/Banyan.so" \
      "${written[@]/%//$series.banyan}"
  done
done
say "      each release reads the same values from the series of all, bit for bit"

stage 3 4 "Drawing on each release"
script "$first" Testing/PvBatch/make_series.py --plugin "\$BuildFolder/lib/Banyan/Banyan.so" --out "$work/series"
for release in "${releases[@]}"; do
  script "$release" Testing/PvBatch/draw_scenes.py --plugin "\$BuildFolder/lib/Banyan/Banyan.so" --data "$work/series" \
    --figures --parts --out "$work/pictures-$release"
done
for release in "${releases[@]:1}"; do
  say "Debian $release against Debian $first:"
  on_debian "$first" "pvpython Testing/PvBatch/compare_pictures.py $work/pictures-$first $work/pictures-$release" ||
    fail "the pictures of Debian $release differ."
done

stage 4 4 "Pictures of the window"
for release in "${releases[@]}"; do
  on_debian "$release" "Utilities/screenshot.sh $work/flow-$first/flow.banyan $work/window-$release.png"
done
say "Series and pictures are the same on ${#releases[@]} releases."
