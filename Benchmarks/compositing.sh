#!/usr/bin/env bash
# Simulates compositing on clusters of 2 to many ranks: ours and, unmodified, that of IceT, on frames
# that the ray caster has drawn; writes a table and charts of time and bytes.
#
#   compositing.sh [--quick] [--output DIR] [--data DIR] [--work DIR] [--scenes LIST]
#                  [--cameras LIST] [--ranks LIST] [--networks LIST] [--help]
#
#   --quick          two of the four cameras, 2 to 64 ranks: minutes instead of hours
#   --output DIR     where compositing.csv, compositing-time.png and compositing-bytes.png go (default
#                    benchmark-output)
#   --data DIR       folder of real data (default ../shared/data beside the project, if it exists)
#   --work DIR       keeps volumes; frames are recorded there and removed (default:
#                    compositing-frames in the build folder)
#   --scenes LIST    of bonsai, isabel_velmag, turbulence, S1, S2, separated by commas (default all
#                    but S1; without real data, S1 stands in for it)
#   --cameras LIST   of perspective-full, perspective-zoom, parallel-full, parallel-zoom
#   --ranks LIST     numbers of ranks, up to 512 (default 2,3,4,8,16,32,64 and, unless --quick, 256
#                    and 512)
#   --networks LIST  gigabits per second (default 10,100)
#
# The network is SimGrid's: a fat tree of 512 nodes, full bisection, 1 us per link, 95 % of the
# bandwidth for data, 1 us per message on both sides. Only the network takes time, so that the
# numbers are the same in every run; pictures are 1024^2. Collective calls of MPI, which IceT makes,
# go as in MPICH: the simulator's own send from everybody to everybody. `slic-published` and
# `direct-send` are left out with more than 64 ranks.
#
# Installs what is missing (the simulator too), and builds in build-benchmark (BANYAN_BUILD_DIR names
# another folder). BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1
# the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
source "$here/Compositing/simulation.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
scenes=""
cameras=""
ranks=""
networks=""
read_options "quick" "output data work scenes cameras ranks networks" "$@"
find_data
if [[ $quick == 1 ]]; then
  cameras="${cameras:-perspective-full,parallel-zoom}"
  ranks="${ranks:-2,3,4,8,16,32,64}"
fi
cameras="${cameras:-perspective-full,perspective-zoom,parallel-full,parallel-zoom}"
ranks="${ranks:-2,3,4,8,16,32,64,256,512}"
networks="${networks:-10,100}"
scenes="${scenes:-bonsai,isabel_velmag,turbulence,S2}"

# A volume that can be drawn: S1, S2, or the JSON file of a series.
prepare_scene()
{
  local scene="$1"
  volume=""
  case "$scene" in
    S1 | S2) volume="$scene" ;;
    turbulence)
      if [[ ! -e "$work/turbulence.raw" ]]; then
        "$BuildFolder/bin/banyan-generate" --series turbulence --size 64 --steps 1 \
          --raw "$work/turbulence.raw" 2> "$work/turbulence.log" ||
          fail "the turbulence could not be generated: $(tail -1 "$work/turbulence.log")"
      fi
      printf '{"name": "turbulence", "file": "turbulence.raw", "samples": [64, 64, 64], "steps": 1}\n' \
        > "$work/turbulence.json"
      volume="$work/turbulence.json"
      ;;
    *)
      real=()
      [[ -z "$data" ]] || collect "$scene" "$([[ $scene == bonsai ]] && echo '*.mhd' || echo '*_02.vti')"
      if [[ ${#real[@]} == 0 ]]; then
        say "      S1 stands in for $scene"
        volume="S1"
      else
        volume="${real[0]}"
      fi
      ;;
  esac
}

# All methods on one frame; with more than 64 ranks, without the two of ours that send most messages:
# the simulator would take hours for them.
simulate()
{
  local frame="$1" network="$2" name scene camera count methods
  name="$(basename "$frame" .frame)"
  count="${name##*_}"
  camera="${name%_*}"
  camera="${camera##*_}"
  scene="${name%_*_*}"
  methods=""
  if [[ "$count" -gt 64 ]]; then
    methods="banyan,banyan-raw,banyan-floats,binary-swap,icet-direct,icet-reduce,icet-tree,icet-bswap"
    methods+=",icet-bswap-folding,icet-radixk,icet-radixkr"
  fi
  # shellcheck disable=SC2086 # none where all methods are wanted
  on_simulated_ranks "$count" "$network" "$frame" "$scene" "$camera" "${network}Gb/s" \
    "$((network * 125000000))" $methods >> "$output/compositing.csv" ||
    fail "the simulation of $name failed: $(tail -1 "$work/simulation.log")"
}

stage 1 4 "Installing what is missing and building"
install_and_build --with-peers
build_simulation banyan-simulate-compositing "$here/Compositing/SimulateCompositing.cxx"
work="${work:-$BuildFolder/compositing-frames}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."
work="$(realpath "$work")"
output="$(realpath "$output")"
# shellcheck disable=SC2086
write_platforms ${networks//,/ }

stage 2 4 "Recording frames and simulating them"
echo "scene,camera,ranks,network,method,ms,bytes,messages,max_bytes_in" > "$output/compositing.csv"
drawn=" "
for scene in ${scenes//,/ }; do
  prepare_scene "$scene"
  [[ "$drawn" != *" $volume "* ]] || continue
  drawn+="$volume "
  for camera in ${cameras//,/ }; do
    say "      $scene, $camera"
    # One frame at a time: those of many ranks take much room.
    for count in ${ranks//,/ }; do
      frame="$("$BuildFolder/bin/banyan-record-frames" --output "$work" --ranks "$count" \
        --cameras "$camera" "$volume")" || fail "the frames could not be drawn."
      for network in ${networks//,/ }; do
        simulate "$frame" "$network"
      done
      rm -f "$frame"
    done
  done
done
stage 3 4 "Drawing charts"
"$python" "$here/Compositing/report.py" "$output/compositing.csv" "$output/compositing-time.png" \
  "$output/compositing-bytes.png" || fail "the report could not be written."
stage 4 4 "Done: $output/compositing.csv, compositing-time.png and compositing-bytes.png"
