# SPDX-License-Identifier: BSD-3-Clause
"""ParaView opens the series "earthquake" in each of its formats: all steps, all cells, equal values.

    test_earthquake.py --generate BANYAN_GENERATE --out DIR
"""
import argparse
import os
import subprocess

import numpy
from paraview import servermanager
from paraview.simple import Delete, ExodusIIReader, MergeBlocks, OpenDataFile
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy

STEPS = 3
TIMES = [0.0, 10.0, 20.0]


def generate(program, folder, options):
    subprocess.run([program, "--series", "earthquake", "--cells", "5000", "--steps", str(STEPS),
                    "--duration", str(TIMES[-1]), "--output", folder] + options, check=True)


def expect(condition, sentence):
    if not condition:
        raise SystemExit(sentence)


def read(name, source):
    """Points, cells and arrays at each time."""
    expect(list(source.TimestepValues) == TIMES, f"{name}: times {list(source.TimestepValues)}")
    merged = MergeBlocks(Input=source)
    steps = []
    for time in TIMES:
        merged.UpdatePipeline(time)
        grid = servermanager.Fetch(merged)
        expect(grid.IsA("vtkUnstructuredGrid"), f"{name}: {grid.GetClassName()}")
        arrays = {key: vtk_to_numpy(grid.GetPointData().GetArray(key)).copy()
                  for key in ("velocity", "ground_displacement")}
        steps.append({
            "points": vtk_to_numpy(grid.GetPoints().GetData()).copy(),
            "types": set(dataset_adapter.WrapDataObject(grid).CellTypes),
            "corners": vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8).copy(),
            **arrays})
    Delete(merged)
    Delete(source)
    return steps


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--generate", required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    found = {}
    for name, arguments in (("exodus", []), ("vtu", ["--format", "vtu"]), ("voxels", ["--voxels"])):
        folder = os.path.join(options.out, name)
        generate(options.generate, folder, arguments)
        file = "earthquake.exo" if name == "exodus" else "earthquake.vtu.series"
        found[name] = read(name, OpenDataFile(os.path.join(folder, file)))
    # The other reader of ParaView for the same file.
    old = ExodusIIReader(FileName=[os.path.join(options.out, "exodus", "earthquake.exo")])
    old.PointVariables = old.PointVariables.Available
    found["exodus again"] = read("exodus again", old)

    for name, steps in found.items():
        types = {11} if name == "voxels" else {12}
        order = [0, 1, 3, 2, 4, 5, 7, 6] if name == "voxels" else list(range(8))
        for step, (one, other) in enumerate(zip(steps, found["vtu"])):
            where = f"{name}, step {step}"
            expect(one["types"] == types, f"{where}: types {one['types']}")
            expect(len(one["corners"]) > 3500, f"{where}: {len(one['corners'])} cells")
            # Corner by corner: the older reader counts points as it meets them in the cells.
            for key in ("points", "velocity", "ground_displacement"):
                expect(numpy.array_equal(one[key][one["corners"][:, order]],
                                         other[key][other["corners"]]), f"{where}: other {key}")
            corners = one["points"][one["corners"][:, order]]
            size = corners[:, 6] - corners[:, 0]
            expect(numpy.all(size > 0) and numpy.all(size == size[:, :1]), f"{where}: no cubes")
        expect(numpy.all(steps[0]["velocity"] == 0.0), f"{name}: it begins in motion")
        expect(numpy.abs(steps[2]["velocity"]).max() > 1e-3, f"{name}: it never moves")
    print("All formats agree on", len(found["vtu"][0]["corners"]), "cells.")


if __name__ == "__main__":
    main()
