# SPDX-License-Identifier: BSD-3-Clause
"""pvpython demo_encode.py SERIES ERROR_BOUND REPORT FILES...

Encodes the files, a time series of image data or of a mesh, as SERIES (a .banyan file) with an error bound
relative to the range of the whole series, and writes what it took to REPORT (JSON).
"""

import os
import sys
import time

from paraview import servermanager
from paraview import simple

import demo_common as demo


def bytes_of(series):
    """The index and all that lies in its folder of segments."""
    folder = series + ".d"
    return os.path.getsize(series) + sum(
        os.path.getsize(os.path.join(folder, name)) for name in os.listdir(folder))


def describe(information):
    """What there is per step, for the report and in words."""
    points = information.GetNumberOfPoints()
    if information.GetDataSetTypeAsString() != "vtkImageData":
        cells = information.GetNumberOfCells()
        return {"points": points, "cells": cells}, f"{cells} cells"
    extent = information.GetExtent()
    dimensions = [extent[2 * axis + 1] - extent[2 * axis] + 1 for axis in range(3)]
    return ({"points": points, "dimensions": dimensions},
            f"{' x '.join(map(str, dimensions))} voxels")


def announce_progress():
    """Prints how far the writer is, every tenth of the way."""
    handler = servermanager.ActiveConnection.Session.GetProgressHandler()
    printed = [0]

    def print_tenths(caller, _event):
        percent = caller.GetLastProgress()
        if "SeriesWriter" in (caller.GetLastProgressText() or "") and percent >= printed[0] + 10:
            printed[0] = percent - percent % 10
            demo.progress(f"{printed[0]} % encoded")

    handler.AddObserver("ProgressEvent", print_tenths)


def main():
    series, bound, report, files = sys.argv[1], float(sys.argv[2]), sys.argv[3], sys.argv[4:]
    demo.load_plugin()
    reader = demo.open_series(files)
    times = demo.time_values(reader)
    grid, words = describe(reader.GetDataInformation())
    demo.progress(f"{len(times)} steps of {words}: {', '.join(demo.array_names(reader))}")
    announce_progress()
    start = time.perf_counter()
    simple.SaveData(series, proxy=reader, WriteTimeSteps=1, ErrorBound=bound)
    seconds = time.perf_counter() - start
    if not os.path.isfile(series):
        raise demo.DemoError("the series was not written; the messages above say why.")
    demo.write_json(report, {
        "files": len(files), "steps": len(times), **grid,
        "bytes_encoded": bytes_of(series), "seconds": seconds})


demo.run(main)
