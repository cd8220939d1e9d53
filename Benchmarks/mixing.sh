#!/usr/bin/env bash
# Draws two volumes that share space in ParaView, with Banyan and with VTK's vtkMultiVolume: time and error.
#
#   mixing.sh [--quick] [--output DIR] [--work DIR] [--scenes LIST] [--renderers LIST] [--help]
#
#   --quick            128^3 samples and 512^2 pixels in place of 256^3 and 1024^2: a few minutes
#   --output DIR       where mixing.csv, mixing.png (a chart of error and time), mixing-pictures.png (all pictures side
#                      by side) and the folder mixing-pictures go (default benchmark-output)
#   --work DIR         keeps the data, which a later run uses again, and what ParaView said (default: mixing in the
#                      build folder)
#   --scenes LIST      only these, separated by commas: one-grid, crossed, image-and-mesh
#   --renderers LIST   only these: banyan, banyan-every-sample, banyan-apart, banyan-apart-every-sample, or
#                      vtk-multi-volume-D with samples D voxels apart (default: all, with D of 1 and 0.5)
#
# Columns are explained in README.md. A process for each row. Installs what is missing, and builds in build-benchmark
# (BANYAN_BUILD_DIR names another folder). BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone,
# BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
scenes="one-grid,crossed,image-and-mesh"
renderers="banyan,banyan-every-sample,banyan-apart,banyan-apart-every-sample,vtk-multi-volume-1,vtk-multi-volume-0.5"
read_options "quick" "output work scenes renderers" "$@"
samples=$((quick ? 128 : 256))
pixels=$((quick ? 512 : 1024))
mesh="mixed-$((quick ? 25 : 60))"
most=30 # seconds for pictures after the first
for name in ${scenes//,/ }; do
  [[ "$name" =~ ^(one-grid|crossed|image-and-mesh)$ ]] || fail "there is no scene '$name'; --help lists them."
done
for name in ${renderers//,/ }; do
  [[ "$name" =~ ^(banyan(-apart)?(-every-sample)?|vtk-multi-volume-[0-9.]+)$ ]] ||
    fail "there is no renderer '$name'; --help lists them."
done

# One picture: a row of the table, but for the reference.
measure()
{
  local scene="$1" renderer="$2" drawing
  local name="$scene-$renderer"
  say "      $name"
  if [[ "$scene" == image-and-mesh && "$renderer" == vtk-* ]]; then
    echo "$scene,$renderer,,,," >> "$csv"
    return
  fi
  drawing=(--plugin "$plugin" --scene "$scene" --renderer "$renderer" --samples "$samples" --pixels "$pixels"
    --fields "$work/standard-$samples.npy" --mesh "$work/$mesh.npz" --most "$most" --picture "$pictures/$name.png")
  [[ "$renderer" == reference ]] || drawing+=(--reference "$pictures/$scene-reference.png" --table "$csv")
  "$RepositoryRoot/Utilities/with-display.sh" "$python" "$RepositoryRoot/Testing/PvBatch/run_paraview.py" \
    --seconds 600 -- "$here/Mixing/draw_volumes.py" "${drawing[@]}" < /dev/null > "$work/$name.log" 2>&1 ||
    fail "ParaView failed: $(tail -1 "$work/$name.log")"
}

stage 1 4 "Installing what is missing and building"
with_paraview=ON install_and_build
plugin="$BuildFolder/lib/Banyan/Banyan.so"
[[ -e "$plugin" ]] || fail "there is no $plugin; it has to be built first, with ParaView."
work="${work:-$BuildFolder/mixing}"
pictures="$output/mixing-pictures"
csv="$output/mixing.csv"
rm -rf "$pictures"
mkdir -p "$work" "$pictures" || fail "the folders for the results cannot be made."

stage 2 4 "Making a mesh that is not in $work"
"$python" "$here/Meshes/make_mesh.py" "$mesh" "$work/$mesh.npz" > "$work/cells" || fail "the mesh could not be made."
say "      $mesh: $(cat "$work/cells") cells"

stage 3 4 "Measuring"
echo "scene,renderer,first_frame_s,ms_per_frame,psnr_db,max_error" > "$csv" || fail "$csv cannot be written."
for scene in ${scenes//,/ }; do
  for name in reference ${renderers//,/ }; do
    measure "$scene" "$name"
  done
done

stage 4 4 "Reporting"
"$python" "$here/Mixing/report.py" "$csv" "$output/mixing.png" "$pictures" "$output/mixing-pictures.png" ||
  fail "the report could not be written."
say "Done: $csv, $output/mixing.png, $output/mixing-pictures.png and $pictures"
