# SPDX-License-Identifier: BSD-3-Clause
"""What series of meshes of any cells take, beside .vtu files with zlib.

    pvpython any_cells.py --plugin Banyan.so --out FOLDER [--bound B] FILE.vtu|FIRST.vtu,SECOND.vtu,... [bent:N] ...

`bent:N` is a lattice of N^3 points, bent, in tetrahedra, with a smooth field, and `shuffled:N` the same in any order. Prints
a row for each: cells, points, steps; bits per cell of ids and types; bits per coordinate; bits per value of all arrays, with
the error bound B (default 1/512) of the range; and the same values in the order of the file, as an image of the same size.
Then bytes of all: raw, .vtu (zlib, not encoded as text), the series, and .vtu by series.
"""
import argparse
import json
import os

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

SECTIONS = ["head", "runs", "distances", "ids", "face counts", "face ids", "points"]


def varint(data, at):
    value, shift = 0, 0
    while True:
        value |= (data[at] & 127) << shift
        at += 1
        if data[at - 1] < 128:
            return value, at
        shift += 7


def sections_of(path):
    """Stored bytes of the sections of the file of a mesh."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"BanyanCe":
        return None
    sizes, at = {}, 24
    for name in SECTIONS:
        _, at = varint(data, at)
        stored, at = varint(data, at)
        sizes[name] = stored
        at += stored
    return sizes


def bent(count, shuffle):
    """Points of a bent lattice in five tetrahedra per cube."""
    z, y, x = (a.ravel() for a in numpy.meshgrid(*[numpy.arange(count)] * 3, indexing="ij"))
    places = numpy.stack([x + 0.7 * numpy.sin(0.2 * y), y + 0.5 * numpy.cos(0.15 * z), z + 0.6 * numpy.sin(0.1 * x)], 1)
    random = numpy.random.default_rng(7)
    places = (places + random.uniform(-0.2, 0.2, places.shape)).astype(numpy.float32)
    wave = numpy.sin(0.15 * places[:, 0]) * numpy.cos(0.12 * places[:, 1]) + numpy.sin(0.1 * places[:, 2])
    inner = (x < count - 1) & (y < count - 1) & (z < count - 1)
    first = (x + count * (y + count * z))[inner]
    corner = [(i & 1) + count * ((i >> 1 & 1) + count * (i >> 2)) for i in range(8)]
    parts = ((0, 1, 3, 5), (0, 3, 2, 6), (0, 5, 6, 4), (3, 6, 5, 7), (0, 3, 5, 6))
    ids = numpy.stack([numpy.stack([first + corner[i] for i in part], 1) for part in parts], 1).reshape(-1, 4)
    if shuffle:
        order = random.permutation(len(places))
        back = numpy.argsort(order)
        places, wave, ids = places[order], wave[order], random.permutation(back[ids])
    grid, points, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(places, 1))
    grid.SetPoints(points)
    numbers = numpy_to_vtk(numpy.ascontiguousarray(ids.ravel()), 1, vtkIdTypeArray().GetDataType())
    cells.SetData(4, numbers)
    grid.SetCells(10, cells)
    values = numpy_to_vtk(wave.astype(numpy.float32), 1)
    values.SetName("wave")
    grid.GetPointData().SetScalars(values)
    return grid


def producer(data):
    made = simple.TrivialProducer()
    made.GetClientSideObject().SetOutput(data)
    return made


def steps_of(source, times):
    for time in times:
        source.UpdatePipeline(time) if time is not None else source.UpdatePipeline()
        yield source.GetClientSideObject().GetOutputDataObject(0)


def segments_of(path):
    with open(path, "rb") as file:
        index = json.loads(file.read().split(b"\n", 1)[1])
    return index, sum(segment["bytes"] for segment in index["segments"])


def in_file_order(grid, name, extent, bound, path):
    """Bytes of the values of a point array as an image in their own order; the rest repeats the last one."""
    values = vtk_to_numpy(grid.GetPointData().GetArray(name))
    image = vtkImageData()
    image.SetDimensions(*[extent[2 * a + 1] + 1 for a in range(3)])
    missing = image.GetNumberOfPoints() - len(values)
    padded = numpy.concatenate([values, numpy.repeat(values[-1:], missing, 0)])
    array = numpy_to_vtk(numpy.ascontiguousarray(padded), 1)
    array.SetName(name)
    image.GetPointData().SetScalars(array)
    simple.SaveData(path, proxy=producer(image), ErrorBound=bound)
    return segments_of(path)[1]


def row(name, source, times, options):
    path = os.path.join(options.out, name.replace(":", "_") + ".banyan")
    simple.SaveData(path, proxy=source, WriteTimeSteps=1, ErrorBound=options.bound)
    index, segments = segments_of(path)
    mesh = index["mesh"]
    sizes = sections_of(os.path.join(path + ".d", mesh["file"]))
    if sizes is None:
        print(f"{name}: an octree", flush=True)
        return
    moved = sum(file["bytes"] for file in mesh["moved"])
    raw, zipped, values, ordered, boxed = 0, 0, 0, 0, 0
    for number, grid in enumerate(steps_of(source, times)):
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(os.path.join(options.out, "step.vtu"))
        writer.SetInputData(grid)
        writer.EncodeAppendedDataOff()
        writer.Write()
        zipped += os.path.getsize(os.path.join(options.out, "step.vtu"))
        cells = grid.GetCells()
        raw += 12 * grid.GetNumberOfPoints() + 8 * cells.GetConnectivityArray().GetNumberOfTuples()
        raw += 9 * grid.GetNumberOfCells()
        for array in index["arrays"]:
            data = grid.GetCellData() if "cellArray" in array else grid.GetPointData()
            found = data.GetArray(array.get("cellArray", array["name"]))
            values += found.GetNumberOfValues()
            raw += found.GetNumberOfValues() * found.GetDataTypeSize()
        if number == 0:
            for array in (each for each in index["arrays"] if "cellArray" not in each):
                only = os.path.join(options.out, "only.banyan")
                alone = producer(grid)
                simple.SaveData(only, proxy=alone, PointArrays=[array["name"]], CellArrays=[], ErrorBound=options.bound)
                one, size = segments_of(only)
                boxed += size
                ordered += in_file_order(grid, array["name"], one["extent"], options.bound, only)
    total = os.path.getsize(path) + mesh["bytes"] + moved + segments
    ids = sum(sizes[part] for part in SECTIONS[1:6])
    coordinates = 3 * mesh["points"]
    print(f"| {name} | {mesh['cells']:,} | {mesh['points']:,} | {len(times)} | {8 * ids / mesh['cells']:.2f} | "
          f"{8 * sizes['points'] / coordinates:.2f} | "
          f"{8 * moved / coordinates / max(len(mesh['moved']), 1):.2f} | {8 * segments / values:.2f} | {boxed:,} | "
          f"{ordered:,} | {raw:,} | {zipped:,} | {total:,} | {zipped / total:.1f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--bound", type=float, default=1 / 512)
    parser.add_argument("meshes", nargs="+")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    simple.LoadPlugin(options.plugin)
    print("| mesh | cells | points | steps | ids, bits per cell | bits per coordinate | moved | bits per value | "
          "first step, box | file order | raw | .vtu | series | .vtu by series |", flush=True)
    for mesh in options.meshes:
        kind, _, count = mesh.partition(":")
        if kind in ("bent", "shuffled"):
            row(mesh, producer(bent(int(count), kind == "shuffled")), [None], options)
            continue
        files = mesh.split(",")
        source = simple.OpenDataFile(files if len(files) > 1 else files[0])
        times = list(source.TimestepValues) if len(files) > 1 else [None]
        row(os.path.splitext(os.path.basename(files[0]))[0], source, times, options)


main()
