# SPDX-License-Identifier: BSD-3-Clause
"""What all ranks together hold of a mesh that they draw (Pss_Anon and Pss_Shmem of /proc/PID/smaps_rollup,
which count memory that processes share once), and how long it takes them.

    mpirun -np N pvbatch mesh_memory.py --plugin Banyan.so FILE.exo ARRAY

Prints `ranks, read_mb, drawn_mb, mesh_mb, shared_mb, first_s, values_s, again_s, processor_s`: of all ranks after the
reader has read and after a frame, the difference, and how much of the latter is memory that they share; then the seconds
of the first frame, of one with another component of the array (the median of five), and of one where nothing has changed,
and the seconds of processors that all ranks took for the first frame. With BANYAN_SHARED_MEMORY=0 each rank holds its own.
"""
import argparse
import os
import re
import statistics
import time

from paraview import servermanager, simple


def ranks():
    """The processes that the launcher of this one has started; this one alone without a launcher."""
    own = servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions()
    if own == 1:
        return [os.getpid()]
    found = []
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat", encoding="ascii") as stat:
                parent = int(stat.read().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue
        if parent == os.getppid():
            found.append(int(entry))
    if len(found) != own:
        raise SystemExit(f"{len(found)} processes of {own} ranks were found on this machine")
    return found


def megabytes(file, pattern):
    with open(file, encoding="ascii") as text:
        return sum(int(kilobytes) for kilobytes in re.findall(pattern, text.read())) / 1024.0


def measure():
    """Megabytes of all ranks, and those of them that are files in memory."""
    processes = ranks()
    everything = sum(megabytes(f"/proc/{p}/smaps_rollup", r"(?m)^Pss_(?:Anon|Shmem): +(\d+) kB") for p in processes)
    shared = sum(megabytes(f"/proc/{p}/smaps", r"/memfd:banyan[^\n]*\n(?:[A-Z][^\n]*\n)*?Pss: +(\d+) kB")
                 for p in processes)
    return everything, shared


def processor_seconds():
    """Of all ranks so far, in their own code and in the kernel's."""
    ticks = 0
    for process in ranks():
        with open(f"/proc/{process}/stat", encoding="ascii") as stat:
            ticks += sum(int(field) for field in stat.read().rsplit(")", 1)[1].split()[11:13])
    return ticks / os.sysconf("SC_CLK_TCK")


def seconds_of(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plugin", required=True)
    parser.add_argument("file", help="a series of Exodus")
    parser.add_argument("array")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False)
    source = simple.OpenDataFile(arguments.file)
    source.NodeBlockFields = [arguments.array]
    source.ApplyDisplacements = 0
    blocks = simple.MergeBlocks(Input=source)
    blocks.UpdatePipeline()
    before, _ = measure()
    view = simple.CreateView("RenderView")
    view.ViewSize = [400, 400]
    worked, start = processor_seconds(), time.perf_counter()
    display = simple.Show(blocks, view)
    simple.ColorBy(display, ("POINTS", arguments.array))
    display.SetRepresentationType("Banyan Volume")
    display.ReuseFrames = 0
    simple.ResetCamera(view)
    simple.Render(view)
    first, worked = time.perf_counter() - start, processor_seconds() - worked
    after, shared = measure()
    values = []
    for component in "XYZXY":
        simple.ColorBy(display, ("POINTS", arguments.array, component))
        values.append(seconds_of(lambda: simple.Render(view)))
    again = seconds_of(lambda: simple.Render(view))
    print("ranks, read_mb, drawn_mb, mesh_mb, shared_mb, first_s, values_s, again_s, processor_s")
    print(f"{len(ranks())}, {before:.0f}, {after:.0f}, {after - before:.0f}, {shared:.0f}, {first:.2f}, "
          f"{statistics.median(values):.2f}, {again:.2f}, {worked:.2f}", flush=True)


main()
