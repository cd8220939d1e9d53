#!/usr/bin/env bash
# Measures still renders of the standard scenes inside ParaView, on one and on two ranks with one
# worker thread each: ParaView's own work and compositing are part of them.
#
#   balance_paraview.sh [--output DIR] [--frames N] [--pixels N] [--help]
#
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

output="benchmark-output"
frames=16
pixels=1024
read_options "" "output frames pixels" "$@"

stage 1 2 "Installing what is missing and building"
[[ "${BANYAN_SKIP_INSTALL:-0}" == 1 ]] || "$RepositoryRoot/Utilities/install-dependencies.sh"
[[ "${BANYAN_SKIP_BUILD:-0}" == 1 ]] ||
  "$RepositoryRoot/Utilities/build.sh" -DBANYAN_WITH_PARAVIEW=ON
plugin="$BuildFolder/lib/Banyan/Banyan.so"
[[ -f "$plugin" ]] || fail "there is no $plugin; it has to be built first."
mkdir -p "$output" || fail "the folder for the results cannot be made."

stage 2 2 "Drawing in ParaView"
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
