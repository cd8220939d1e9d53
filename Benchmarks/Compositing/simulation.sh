# Simulated ranks: source it behind common.sh, do not run it. $work is a folder for its files.
# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause

# Builds a program with the simulator's compiler, the MPI adapter and the unmodified IceT, unless it
# is newer than all sources; sets `simulation` to it and `icet` to IceT's library.
#   build_simulation NAME SOURCE...
build_simulation()
{
  command -v smpicxx > /dev/null || fail "smpicxx is missing: install libsimgrid-dev."
  local paraview core="$BuildFolder/lib/Banyan" source
  paraview="$(compgen -G "/usr/include/paraview-*" | tail -n 1)"
  icet="vtkIceTCore-pv${paraview##*-}"
  [[ -e "$paraview/vtkicet/src/include/IceT.h" ]] ||
    fail "IceT's headers are missing: install paraview-dev."
  simulation="$BuildFolder/bin/$1"
  shift
  for source in "$@" "$here"/Compositing/{,Peers/}*.{cxx,h} "$here"/Walls/*.h \
    "$RepositoryRoot"/Core/Parallel/*/*.{cxx,h}; do
    if [[ ! -e "$simulation" || "$source" -nt "$simulation" ]]; then
      smpicxx -std=c++17 -O2 -DNDEBUG -fPIC -I"$RepositoryRoot/Core" \
        -I"$paraview/vtkicet/src/include" -I"$paraview" \
        -I"$here/Compositing" "$@" "$here"/Compositing/FrameFile.cxx \
        "$here"/Compositing/Peers/*.cxx \
        "$RepositoryRoot"/Core/Parallel/{Communicate/MpiCommunicator,Watchdog/MpiWatchdog}.cxx \
        -L"$core" -Wl,-rpath,"$core" -lBanyanCore -l"$icet" -o "$simulation" ||
        fail "the simulation could not be built."
      return
    fi
  done
}

# Fat trees of 2 levels, 16 switches of 32 nodes each.
#   write_platforms GIGABITS...
write_platforms()
{
  local bandwidth
  printf 'n%d\n' {0..511} > "$work/hosts"
  for bandwidth in "$@"; do
    cat > "$work/platform-$bandwidth.xml" << END
<?xml version='1.0'?>
<!DOCTYPE platform SYSTEM "https://simgrid.org/simgrid.dtd">
<platform version="4.1">
  <cluster id="fat" prefix="n" suffix="" radical="0-511" speed="10Gf" bw="${bandwidth}Gbps"
           lat="1us" topology="FAT_TREE" topo_parameters="2;16,32;1,16;1,1"
           sharing_policy="SPLITDUPLEX"/>
</platform>
END
  done
}

# Runs the program on simulated ranks; what it says goes to $work/simulation.log.
#   on_simulated_ranks COUNT GIGABITS ARGUMENTS...
on_simulated_ranks()
{
  local count="$1" network="$2" private status=0
  shift 2
  private="$(mktemp -d "$work/run.XXXXXX")"
  TMPDIR="$private" timeout 1800 smpirun -np "$count" -platform "$work/platform-$network.xml" \
    -hostfile "$work/hosts" --cfg=smpi/privatize-libs:"lib$icet.so.1" \
    --cfg=smpi/bw-factor:0:0.95 --cfg=smpi/lat-factor:0:1.0 --cfg=network/crosstraffic:0 \
    --cfg=smpi/os:0:1e-6:0 --cfg=smpi/ois:0:1e-6:0 --cfg=smpi/or:0:1e-6:0 \
    --cfg=smpi/coll-selector:mpich --cfg=smpi/simulate-computation:no \
    --log=root.thres:warning "$simulation" "$@" 2> "$work/simulation.log" || status=$?
  rm -rf "$private"
  return $status
}
