#!/usr/bin/env bash
# Saves pictures of up to 100 million pixels in pvbatch, and measures their time and memory.
#
#   pictures.sh [--quick] [--output DIR] [--work DIR] [--sizes LIST] [--ranks LIST] [--help]
#
#   --quick        up to 24 million pixels, on one rank, of 128^3 samples: two minutes
#   --output DIR   where pictures.csv and the PNG files go (default benchmark-output)
#   --work DIR     keeps the series, which a later run uses again (default: pictures-series in the build folder)
#   --sizes LIST   of pictures, separated by commas (default 1600x1000,6000x4000,13312x7552)
#   --ranks LIST   numbers of ranks (default 1,2)
#
# Columns of pictures.csv:
#   size, megapixels, ranks
#   shown          surface (of a sphere, by ParaView alone), banyan (our volume), volume (ParaView's Volume)
#   way            whole (a view of that size), parts (a screenshot that is larger than the view)
#   seconds        of SaveScreenshot, with the PNG file
#   processor_s    of all ranks meanwhile
#   first_mib, others_mib   the most memory that the first rank had, and any other one; over that of a view of
#                  400 x 300 in the same process before
#   bytes_a_pixel  of the first rank, by that
#   off            largest difference to the picture that one rank draws as a whole, of 255
#
# Installs what is missing, and builds in build-benchmark (BANYAN_BUILD_DIR names another folder).
# BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
work=""
quick=0
sizes=""
ranks=""
read_options "quick" "output work sizes ranks" "$@"
samples=256
if [[ $quick == 1 ]]; then
  samples=128
  sizes="${sizes:-1600x1000,6000x4000}"
  ranks="${ranks:-1}"
fi
sizes="${sizes:-1600x1000,6000x4000,13312x7552}"
ranks="${ranks:-1,2}"

stage 1 3 "Installing what is missing and building"
with_paraview=ON install_and_build
plugin="$BuildFolder/lib/Banyan/Banyan.so"
[[ -e "$plugin" ]] || fail "there is no $plugin; it has to be built first, with ParaView."
prepare_mpi
work="${work:-$BuildFolder/pictures-series}"
mkdir -p "$work" "$output" || fail "the folders for the results cannot be made."
output="$(realpath "$output")"

stage 2 3 "Making the series that is not in $work"
encode_standard "$samples"

stage 3 3 "Measuring"
table="$output/pictures.csv"
rm -f "$table"
for count in ${ranks//,/ }; do
  for size in ${sizes//,/ }; do
    for shown in surface banyan volume; do
      for way in whole parts; do
        say "      $size, $count ranks, $shown, $way"
        log="$work/$size-$count-$shown-$way.log"
        "$RepositoryRoot/Utilities/with-display.sh" "$python" "$RepositoryRoot/Testing/PvBatch/run_paraview.py" \
          --mode batch --ranks "$count" --seconds 1800 -- "$here/Pictures/draw_picture.py" --plugin "$plugin" \
          --series "$work/standard-$samples.banyan" --size "$size" --shown "$shown" --way "$way" \
          --output "$output" < /dev/null > "$log" 2>&1 ||
          fail "$size, $count ranks, $shown, $way: $(tail -1 "$log"); more is in $log."
      done
    done
  done
done
"$python" "$here/Pictures/report.py" "$table"
