# SPDX-License-Identifier: BSD-3-Clause
"""How long it takes ranks and threads to write a series.

    BANYAN_THREADS=T mpirun -np N pvbatch encode_on_ranks.py --plugin Banyan.so --output FILE.banyan
        FILES.vti.series [--repeat R]

Prints `ranks, threads, seconds, mb_s, bits_per_voxel`: the median of R times of SaveData, with an absolute bound of 1/512 of
the range, so that every step is read once; reading is part of it. The files are read once before, so that they are in memory.
"""
import argparse
import os
import statistics
import time

from paraview import servermanager, simple


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("series")
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--output", required=True)
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    simple.LoadPlugin(os.path.abspath(arguments.plugin), ns=globals())
    source = simple.OpenDataFile(arguments.series)
    low = high = None
    for step in source.TimestepValues:
        source.UpdatePipeline(step)
        first, last = source.PointData[0].GetRange(0)
        low, high = min(first, first if low is None else low), max(last, last if high is None else high)
    extent = source.GetDataInformation().GetExtent()
    samples = (extent[1] - extent[0] + 1) * (extent[3] - extent[2] + 1) * (extent[5] - extent[4] + 1)
    samples *= len(source.TimestepValues)
    rank = servermanager.vtkProcessModule.GetProcessModule().GetPartitionId()
    ranks = servermanager.vtkProcessModule.GetProcessModule().GetNumberOfLocalPartitions()
    seconds = []
    for _ in range(arguments.repeat):
        began = time.perf_counter()
        simple.SaveData(arguments.output, proxy=source, ErrorBoundMode="Absolute", ErrorBound=(high - low) / 512.0)
        seconds.append(time.perf_counter() - began)
    if rank == 0:
        size = os.path.getsize(arguments.output)
        size += sum(entry.stat().st_size for entry in os.scandir(arguments.output + ".d"))
        median = statistics.median(seconds)
        print(f"{ranks},{os.environ.get('BANYAN_THREADS', '')},{median:.2f},{4e-6 * samples / median:.0f},"
              f"{8.0 * size / samples:.4f}", flush=True)


main()
