# SPDX-License-Identifier: BSD-3-Clause
"""pvbatch read_steps.py PLUGIN SERIES.banyan : how fast ParaView's reader gives whole steps, MB/s of values.

Each pass reads all steps in order: the first one opens the series, those after it find in the cache what
fits there. Once with arrays that decode when a value is asked for, and once without.
"""

import sys
import time

from paraview import simple


def seconds_of_step(reader, step):
    """Until the first value of the first array is there. @return seconds, bytes"""
    begin = time.time()
    reader.UpdatePipeline(step)
    array = reader.GetClientSideObject().GetOutputDataObject(0).GetPointData().GetArray(0)
    array.GetTuple(0)
    seconds = time.time() - begin
    return seconds, array.GetNumberOfValues() * array.GetDataTypeSize()


def main(plugin, series):
    simple.LoadPlugin(plugin, ns=vars(simple))
    for deferred in (1, 0):
        reader = simple.BanyanSeriesReader(FileName=series, DeferDecoding=deferred)
        reader.UpdatePipelineInformation()
        steps = list(reader.TimestepValues)
        speeds = []
        for _ in range(6):
            measured = [seconds_of_step(reader, step) for step in steps]
            speeds.append(sum(size for _, size in measured) / 1e6 / sum(s for s, _ in measured))
        later = sorted(speeds[1:])
        print(f"DeferDecoding {deferred}: {speeds[0]:.0f} MB/s at first, {later[len(later) // 2]:.0f} later "
              "(median)", flush=True)
        simple.Delete(reader)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: pvbatch read_steps.py PLUGIN SERIES.banyan")
    main(*sys.argv[1:])
