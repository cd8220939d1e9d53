#!/usr/bin/env bash
# Draws meshes of any cells in ParaView, with Banyan and with ParaView's own mappers: time, memory and error.
#
#   meshes.sh [--quick] [--output DIR] [--data DIR] [--work DIR] [--meshes LIST] [--renderers LIST]
#             [--tolerances LIST] [--pixels N] [--limit SECONDS] [--memory GB] [--help]
#
#   --quick            other sizes than 8 million hexahedra, and of other cells about 64 thousand; at most 60 seconds
#                      per row, 12 of them for pictures after the first: half an hour
#   --output DIR       where meshes.csv, meshes.png (a chart of error and time) and the folder meshes-pictures go
#                      (default benchmark-output)
#   --data DIR         folder of real data (default ../shared/data beside the project, if it exists)
#   --work DIR         keeps meshes, which a later run uses again, and what ParaView said (default: meshes in the
#                      build folder)
#   --meshes LIST      only these, separated by commas: hexahedra-N, tetrahedra-N, mixed-N or curvilinear-N, cut from
#                      N^3 cubes; specfem_mount_st_helens, can, disk_out_ref, block_crush, hexa, from --data. With -S2
#                      behind its name a mesh is drawn with the function S2 instead of S1
#   --renderers LIST   only these: banyan, paraview-projected-tetra, paraview-bunyk, paraview-zsweep, paraview-resample
#   --tolerances LIST  of banyan, in 1/255; 0 is every sample (default 0,0.5,1,2,4,16,64,255)
#   --pixels N         per side of pictures of meshes that are made (default 1024); others have 500 x 400
#   --limit SECONDS    for each row, after which it is ended and a note says so (default 300); a fifth of it for
#                      pictures after the first
#   --memory GB        for each row; one that needs more fails (default: nine tenths of what is free)
#
# Columns are explained in README.md. A process for each row. Numbers that are missing in meshes.csv have a note on
# stderr. Installs what is missing, and builds in build-benchmark (BANYAN_BUILD_DIR names another folder).
# BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
meshes=""
renderers="banyan,paraview-projected-tetra,paraview-bunyk,paraview-zsweep,paraview-resample"
tolerances="0,0.5,1,2,4,16,64,255"
pixels=1024
limit=""
memory=""
read_options "quick" "output data work meshes renderers tolerances pixels limit memory" "$@"
find_data
limit="${limit:-$((quick ? 60 : 300))}"
memory="${memory:-$(awk '/^MemAvailable:/ { print int(0.9 * $2 * 1024 / 1e9) }' /proc/meminfo)}"
for number in "$limit" "$memory" "$pixels"; do
  [[ "$number" =~ ^[1-9][0-9]*$ ]] || fail "--limit, --memory and --pixels take whole numbers."
done
for name in ${renderers//,/ }; do
  [[ "$name" =~ ^(banyan|paraview-(projected-tetra|bunyk|zsweep|resample))$ ]] ||
    fail "there is no renderer '$name'; --help lists them."
done

# Sets `meshes` to what is drawn when nobody says.
choose_meshes()
{
  local name
  meshes="hexahedra-40,hexahedra-100,hexahedra-200,tetrahedra-55,mixed-60,curvilinear-100"
  ((quick == 0)) || meshes="hexahedra-40,hexahedra-100,tetrahedra-22,mixed-25,curvilinear-40"
  for name in specfem_mount_st_helens can disk_out_ref block_crush hexa; do
    if [[ -n "$data" && -d "$data/$name" ]]; then
      meshes="$meshes,$name"
    else
      say "      there is no $name${data:+ in $data}; it is left out"
    fi
  done
}

# Runs draw_mesh.py within time and memory; its log is $log.
draw_within()
{
  ulimit -v $((memory * 1000000000 / 1024)) || return
  ulimit -c 0
  exec "$python" "$RepositoryRoot/Testing/PvBatch/run_paraview.py" --seconds "$limit" -- \
    "$here/Meshes/draw_mesh.py" "$@"
}
export -f draw_within
export memory limit python RepositoryRoot here

# What a row that lacks numbers is told by, from the log of a process and its status.
note_of()
{
  local log="$1" status="$2" first sentence=""
  if ((status == 124)); then
    first="$(sed -n 's/^first frame: //p' "$log")"
    sentence="more than $limit s${first:+, the first picture took $first}; "
  elif ((status != 0)) && ! grep -q '^NOTE: ' "$log"; then
    sentence="failed with $memory GB: $(grep -m 1 -E '^[A-Za-z]*Error' "$log" || tail -1 "$log"); "
  fi
  # The notes, and the first thing that VTK complains about.
  sentence+="$(sed -n 's/^NOTE: //p' "$log" | paste -sd ';' | sed 's/;/; /g')"
  sentence+="$(grep -m 1 -E '(ERR|WARN)\| ' "$log" | sed 's/.*\(ERR\|WARN\)| /; /' || true)"
  sed 's/\(; *\)\+/; /g; s/^; //; s/; $//; s/ (0x[0-9a-f]*)//g; s/\x1b\[[0-9]*m//g; s/ *$//' <<<"$sentence"
}

# One picture of a mesh: a row of the table, but for the reference.
told=""
measure()
{
  local mesh="$1" renderer="$2" tolerance="$3" base="${1%-S2}" status=0 note log size drawing rows
  local name="$mesh-$renderer${tolerance:+-$tolerance}"
  size="${pixels}x$pixels"
  [[ "$base" =~ ^(hexahedra|tetrahedra|mixed|curvilinear)- ]] || size=500x400
  log="$work/$name.log"
  drawing=(--plugin "$plugin" --mesh "$work/$base.npz" --name "$mesh" --renderer "$renderer" --pixels "$size"
    --most $((limit / 5)) --picture "$pictures/$name.png")
  [[ "$mesh" == "$base" ]] || drawing+=(--scene S2)
  [[ -z "$tolerance" ]] || drawing+=(--tolerance "$tolerance")
  [[ "$renderer" == reference ]] || drawing+=(--reference "$pictures/$mesh-reference.png" --table "$csv")
  say "      $mesh, $renderer${tolerance:+, tolerance $tolerance}"
  rows="$(wc -l < "$csv")"
  "$RepositoryRoot/Utilities/with-display.sh" bash -c 'draw_within "$@"' _ "${drawing[@]}" \
    < /dev/null > "$log" 2>&1 || status=$?
  note="$(note_of "$log" "$status")"
  [[ -z "$note" ]] || say "        $([[ "$note" == "$told" ]] && echo "the same" || echo "$note")"
  told="$note"
  [[ "$renderer" == reference || "$(wc -l < "$csv")" != "$rows" ]] ||
    printf '%s,%s,%s,%s,,,,,,\n' "$mesh" "${cells[$base]}" "$renderer" "$tolerance" >> "$csv"
}

stage 1 4 "Installing what is missing and building"
with_paraview=ON install_and_build
plugin="$BuildFolder/lib/Banyan/Banyan.so"
[[ -e "$plugin" ]] || fail "there is no $plugin; it has to be built first, with ParaView."
work="${work:-$BuildFolder/meshes}"
pictures="$output/meshes-pictures"
csv="$output/meshes.csv"
rm -rf "$pictures"
mkdir -p "$work" "$pictures" || fail "the folders for the results cannot be made."

stage 2 4 "Making meshes that are not in $work"
[[ -n "$meshes" ]] || choose_meshes
declare -A cells
for mesh in ${meshes//,/ }; do
  base="${mesh%-S2}"
  cells[$base]="$("$python" "$here/Meshes/make_mesh.py" "$base" "$work/$base.npz" --data "$data")" ||
    fail "the mesh '$base' could not be made."
  say "      $mesh: ${cells[$base]} cells"
done

stage 3 4 "Measuring"
echo "mesh,cells,renderer,tolerance,setup_s,first_frame_s,ms_per_frame,memory_mb,psnr_db,max_error" > "$csv" ||
  fail "$csv cannot be written."
for mesh in ${meshes//,/ }; do
  measure "$mesh" reference ""
  for name in ${renderers//,/ }; do
    of="-"
    [[ "$name" != banyan ]] || of="$tolerances"
    for tolerance in ${of//,/ }; do
      measure "$mesh" "$name" "${tolerance#-}"
    done
  done
done

stage 4 4 "Reporting"
"$python" "$here/Meshes/report.py" "$csv" "$output/meshes.png" || fail "the report could not be written."
say "Done: $csv, $output/meshes.png and $pictures"
