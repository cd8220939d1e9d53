#!/usr/bin/env bash
# Counts pictures that a client asks for by tickets, and does not wait for: tables 1 to 3 of the study of
# an image cache (Documentation/papers.md) for our own design.
#
#   tickets.sh [--quick] [--output DIR] [--views N] [--ranks LIST] [--simulated LIST] [--help]
#
#   --quick          64^3 samples, 256^2 pixels and 5 views, ranks 1,2 and 8: half a minute instead of five
#   --output DIR     where tickets.csv goes (default benchmark-output); its tables are printed
#   --views N        of an orbit (default 30); a third of them on simulated ranks
#   --ranks LIST     processes, each with one thread (default 1,2,3,4); times are those of a cluster only where
#                    each has a core
#   --simulated LIST ranks that are threads of one process: work and messages, no times (default 8,16,32,64)
#
# Columns are explained in README.md. Installs what is missing, and builds in build-benchmark (BANYAN_BUILD_DIR
# names another folder). BANYAN_SKIP_INSTALL=1 leaves the packages of the system alone, BANYAN_SKIP_BUILD=1 the build.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

output="benchmark-output"
quick=0
views=""
ranks=""
simulated=""
read_options "quick" "output views ranks simulated" "$@"
views="${views:-$((quick ? 5 : 30))}"
ranks="${ranks:-$( ((quick)) && echo 1,2 || echo 1,2,3,4)}"
simulated="${simulated:-$( ((quick)) && echo 8 || echo 8,16,32,64)}"

stage 1 3 "Installing what is missing and building"
install_and_build
program="$BuildFolder/bin/banyan-bench-tickets"
[[ -x "$program" ]] || fail "there is no $program; it has to be built first, with MPI."
prepare_mpi
mkdir -p "$output" || fail "the folder for the results cannot be made."
table="$output/tickets.csv"
common=(--output "$table" --samples $((quick ? 64 : 256)) --picture $((quick ? 256 : 1024)))

stage 2 3 "Measuring"
rm -f "$table"
for count in ${ranks//,/ }; do
  say "      $count ranks"
  # Not bound to a core: each rank has a thread that draws beside that which sends messages.
  mpiexec --oversubscribe --bind-to none -n "$count" "$program" "${common[@]}" --views "$views" < /dev/null ||
    fail "measuring $count ranks failed."
done
say "      simulated ranks"
"$program" "${common[@]}" --views $(((views + 2) / 3)) --simulate "$simulated" || fail "measuring simulated ranks failed."

stage 3 3 "Reporting"
"$python" "$here/Interaction/tickets.py" "$table" || fail "the report could not be written."
say "Done: $table"
