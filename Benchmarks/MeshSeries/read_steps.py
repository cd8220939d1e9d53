# SPDX-License-Identifier: BSD-3-Clause
"""What each rank takes to read the steps of a mesh series: memory, time, bricks.

    mpirun -np N pvbatch --sym read_steps.py --plugin Banyan.so FILE.banyan

Prints `ranks, mesh_mb, step_mb, steps_mb, step_s, processor_s, bricks`. Megabytes are those of the rank that has
most, above what it had before: the most that it ever had (VmHWM) when the mesh was made and the first step read, what that
first step left behind (VmRSS), and what all steps did. Then seconds from step to step (the median, of the slowest
rank), the seconds of processors that all ranks took for that, and the bricks that the rank with most of them decoded for a
step. Nothing is drawn, and nothing read ahead. BANYAN_CACHE_MB says what may be kept.
"""
import argparse
import os
import statistics
import time

from paraview import servermanager, simple
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkParallelCore import vtkCommunicator, vtkMultiProcessController


def megabytes(name):
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith(name + ":")) / 1024.0


def bricks_decoded(reader):
    """By this rank, so far."""
    reader.UpdatePropertyInformation()
    return reader.GetProperty("BricksDecoded").GetElement(0)


def of_all(values, operation):
    """On the first rank: the largest, or the sum, of each value of all ranks."""
    mine, theirs = vtkDoubleArray(), vtkDoubleArray()
    for array in (mine, theirs):
        array.SetNumberOfTuples(len(values))
    for i, value in enumerate(values):
        mine.SetValue(i, value)
    vtkMultiProcessController.GetGlobalController().AllReduce(mine, theirs, operation)
    return [theirs.GetValue(i) for i in range(len(values))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plugin", required=True)
    parser.add_argument("file", help="a series of meshes")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False)
    reader = simple.OpenDataFile(arguments.file)
    reader.ReadAhead = 0
    reader.UpdatePipelineInformation()
    controller = vtkMultiProcessController.GetGlobalController()
    before = megabytes("VmRSS")
    peak, left, seconds, processor, bricks = 0.0, 0.0, [], [], []
    for step, moment in enumerate(reader.TimestepValues):
        controller.Barrier()
        decoded, used, start = bricks_decoded(reader), sum(os.times()[:2]), time.perf_counter()
        reader.UpdatePipeline(moment)
        if step == 0:
            peak, left = megabytes("VmHWM") - before, megabytes("VmRSS") - before
            continue
        seconds.append(time.perf_counter() - start)
        processor.append(sum(os.times()[:2]) - used)
        bricks.append(bricks_decoded(reader) - decoded)
    most = of_all([peak, left, megabytes("VmHWM") - before, statistics.median(seconds), max(bricks)],
                  vtkCommunicator.MAX_OP)
    total = of_all([statistics.median(processor)], vtkCommunicator.SUM_OP)[0]
    ranks = servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions()
    if controller.GetLocalProcessId() == 0:
        print("ranks, mesh_mb, step_mb, steps_mb, step_s, processor_s, bricks")
        print(f"{ranks}, {most[0]:.0f}, {most[1]:.0f}, {most[2]:.0f}, {most[3]:.3f}, {total:.3f}, {most[4]:.0f}",
              flush=True)


main()
