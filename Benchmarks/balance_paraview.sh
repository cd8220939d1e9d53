#!/usr/bin/env bash
# Measures still renders of the standard scenes inside ParaView, on one and on two ranks with one
# worker thread each: ParaView's own work and compositing are part of them.
#
#   balance_paraview.sh [--parts] [--output DIR] [--frames N] [--pixels N] [--help]
#
#   --parts        instead: what the parts of frames of S2 take that are not smoothed, in
#                  balance-paraview-parts.csv (Balance/FrameParts.cxx)
#   --output DIR   where balance-paraview.csv goes (default benchmark-output)
#   --frames N     of each run; the first four are not counted (default 16)
#   --pixels N     edge of the picture (default 1024)
#
# Each scene is drawn with and without ParaView's smoothing of edges (FXAA): it is done on one core of the first
# rank where OpenGL is software, and takes the same time on any number of ranks.
#
# Needs pvbatch, mpirun and two cores with nothing else to do. Installs what is missing, and builds in
# build-benchmark (BANYAN_BUILD_DIR names another folder). BANYAN_SKIP_INSTALL=1 leaves the packages
# of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
frames=16
pixels=1024
parts=0
read_options "parts" "output frames pixels" "$@"

stage 1 2 "Installing what is missing and building"
[[ "${BANYAN_SKIP_INSTALL:-0}" == 1 ]] || "$RepositoryRoot/Utilities/install-dependencies.sh"
[[ "${BANYAN_SKIP_BUILD:-0}" == 1 ]] ||
  "$RepositoryRoot/Utilities/build.sh" -DBANYAN_WITH_PARAVIEW=ON
plugin="$BuildFolder/lib/Banyan/Banyan.so"
[[ -f "$plugin" ]] || fail "there is no $plugin; it has to be built first."
mkdir -p "$output" || fail "the folder for the results cannot be made."

stage 2 2 "Drawing in ParaView"
prepare_mpi
if [[ $parts == 1 ]]; then
  table="$output/balance-paraview-parts.csv"
  meter="$(find "$BuildFolder" -name banyan-frame-parts.so -print -quit)"
  [[ -n "$meter" ]] || fail "there is no banyan-frame-parts.so; it has to be built first."
  scratch="$(mktemp -d)"
  trap 'rm -rf "$scratch"' EXIT
  for ranks in 1 2; do
    BANYAN_FRAME_PARTS="$scratch/$ranks" "$RepositoryRoot/Utilities/with-display.sh" mpirun \
      -np "$ranks" --bind-to core -x LD_PRELOAD="$meter" pvbatch "$here/Balance/paraview_frames.py" \
      --plugin "$plugin" --frames "$frames" --pixels "$pixels" --scene S2 --no-fxaa > /dev/null ||
      fail "drawing on $ranks ranks failed."
  done
  echo "ranks,rank,part,ms,processor_ms" > "$table"
  for run in 1.0 2.0 2.1; do
    sed "1d;s/^/${run%.*},${run#*.},/" "$scratch/$run" | tee -a "$table"
  done
  say "Done: $table"
  exit 0
fi
table="$output/balance-paraview.csv"
echo "ranks,smoothed,scene,ms,banyan_ms,render_ms,composite_ms,imbalance" > "$table"
for scene in "S1" "S2" "S1 --shaded" "S2 --shaded"; do
  for smoothed in yes no; do
    for ranks in 1 2; do
      # shellcheck disable=SC2086 # a scene is one word or two
      row="$("$RepositoryRoot/Utilities/with-display.sh" mpirun -np "$ranks" --bind-to core pvbatch \
        "$here/Balance/paraview_frames.py" --plugin "$plugin" --frames "$frames" --pixels "$pixels" \
        --scene $scene $([[ $smoothed == yes ]] || echo --no-fxaa) |
        grep '^S[12]')" || fail "drawing $scene on $ranks ranks failed."
      echo "$ranks,$smoothed,$row" | tee -a "$table"
    done
  done
done
say "Done: $table"
