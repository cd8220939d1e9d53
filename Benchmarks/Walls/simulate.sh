#!/usr/bin/env bash
# What walls.sh does with each recorded wall: `banyan-bench-walls --then`.
#
#   simulate.sh WORK OUTPUT VOLUME NETWORKS REAL FOLDER MEGAPIXELS TILES VIEW
#
# Appends to OUTPUT/walls-pixels.csv what bringing pixels to the tiles takes on simulated ranks. Where
# REAL is a part of the volume, above 0, the same is drawn by real ranks, for OUTPUT/walls-real.csv.
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
source "$here/Compositing/simulation.sh"
# SPDX-License-Identifier: BSD-3-Clause

[[ $# == 9 ]] || fail "nine arguments are needed; the top of this file lists them."
work="$1"
output="$2"
volume="$3"
networks="$4"
part="$5"
folder="$6"
megapixels="$7"
tiles="$8"
view="$9"
ranks="$(wc -l < "$folder/by-data/shares")"
methods="by-data,by-data-few-bits,by-picture,icet-reduce,icet-floats-reduce"
build_simulation banyan-simulate-walls "$here/Walls/SimulateWalls.cxx"
for network in ${networks//,/ }; do
  on_simulated_ranks "$ranks" "$network" "$folder" "$volume" "$megapixels" "$tiles" "$view" \
    "$network" "$methods" >> "$output/walls-pixels.csv" ||
    fail "the simulation of $ranks ranks failed: $(tail -1 "$work/simulation.log")"
done
[[ "$part" != 0 ]] || exit 0
prepare_mpi
mpirun -np "$ranks" --oversubscribe "$BuildFolder/bin/banyan-bench-walls" --real "$folder" \
  --volume "$volume" --part "$part" --views "$view" --columns "$megapixels:$tiles:$ranks" \
  > "$work/real.csv" || fail "drawing on $ranks real ranks failed."
sed "s/^/$volume,$megapixels,$ranks,$view,/" "$work/real.csv" >> "$output/walls-real.csv"
