"""What all ranks together hold of a mesh that they draw (Pss_Anon and Pss_Shmem of /proc/PID/smaps_rollup,
which count memory that processes share once).

    mpirun -np N pvbatch mesh_memory.py --plugin Banyan.so FILE.exo ARRAY

Prints `ranks, read_mb, drawn_mb, mesh_mb, shared_mb`: of all ranks after the reader has read and after a frame,
the difference, and how much of the latter is memory that they share. With BANYAN_SHARED_MEMORY=0 each rank holds its own.
"""
import argparse
import os
import re

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
    display = simple.Show(blocks, view)
    simple.ColorBy(display, ("POINTS", arguments.array))
    display.SetRepresentationType("Banyan Volume")
    simple.ResetCamera(view)
    simple.Render(view)
    after, shared = measure()
    print("ranks, read_mb, drawn_mb, mesh_mb, shared_mb")
    print(f"{len(ranks())}, {before:.0f}, {after:.0f}, {after - before:.0f}, {shared:.0f}", flush=True)


main()
