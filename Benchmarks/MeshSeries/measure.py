# SPDX-License-Identifier: BSD-3-Clause
"""Encodes a mesh series, and writes its values as raw series for banyan-bench-codec.

    pvpython measure.py --plugin Banyan.so --file EARTHQUAKE.exo --array velocity --steps N --out FOLDER
"""
import argparse
import json
import os

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy


def block_of(data):
    """The first block that has cells."""
    iterator = data.NewIterator()
    iterator.UnRegister(None)
    iterator.InitTraversal()
    while iterator.GetCurrentDataObject().GetNumberOfCells() == 0:
        iterator.GoToNextItem()
    return iterator.GetCurrentDataObject()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--file", required=True)
    parser.add_argument("--array", required=True)
    parser.add_argument("--steps", type=int, required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    simple.LoadPlugin(options.plugin)
    source = simple.OpenDataFile(options.file)
    times = list(source.TimestepValues)
    chosen = times[len(times) // 2:][:options.steps]  # when waves are everywhere
    part = simple.ExtractTimeSteps(Input=source)
    part.TimeStepIndices = [times.index(time) for time in chosen]
    simple.SaveData(os.path.join(options.out, "mesh.banyan"), proxy=part, PointArrays=[options.array],
                    CellArrays=[])
    files = []
    for time in chosen:
        source.UpdatePipeline(time)
        grid = block_of(source.GetClientSideObject().GetOutputDataObject(0))
        values = vtk_to_numpy(grid.GetPointData().GetArray(options.array)).astype(numpy.float32)
        for component in range(values.shape[1]):
            name = f"{options.array}-{component}"
            if time == chosen[0]:
                files.append(open(os.path.join(options.out, name + ".raw"), "wb"))
                with open(os.path.join(options.out, name + ".json"), "w", encoding="ascii") as file:
                    json.dump({"name": name, "file": name + ".raw", "steps": len(chosen),
                               "samples": [values.shape[0], 1, 1]}, file)
            files[component].write(values[:, component].tobytes())
    for file in files:
        file.close()


main()
