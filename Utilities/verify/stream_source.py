# SPDX-License-Identifier: BSD-3-Clause
"""pvpython stream_source.py [--array NAME]... FILES...: sends data on a grid through a pipe.

Reads the files, one series in order of time, with ParaView, and writes each step to the standard
output in the form that Programs/StreamSource.h describes: a line of JSON, then the values of its
arrays. Without --array all point arrays of numbers are sent.
"""

import argparse
import json
import os

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON

GHOSTS = "vtkGhostType"
KINDS = ["vtkImageData", "vtkStructuredGrid", "vtkRectilinearGrid", "vtkUnstructuredGrid"]
HIDDEN_POINT, HIDDEN_OR_REFINED_CELL = 2, 32 | 8  # of vtkDataSetAttributes


class SourceError(Exception):
    """Why the source cannot be sent, in a sentence."""


def take_output():
    """The standard output for the stream alone: whatever else prints goes to the messages."""
    output, messages = 1, 2  # pvpython's sys.stdout does not know its number
    stream = os.fdopen(os.dup(output), "wb")
    os.dup2(messages, output)
    return stream


def open_source(files):
    reader = simple.OpenDataFile(files if len(files) > 1 else files[0])
    if reader is None:
        raise SourceError(f"ParaView cannot read {files[0]}.")
    reader.UpdatePipeline()
    return reader


def time_values(reader):
    """The time values of a source, as a series written from it has them."""
    values = getattr(reader, "TimestepValues", None)
    if values is None:
        return [0.0]
    values = list(values) if hasattr(values, "__len__") else [values]
    return [float(value) for value in values] or [0.0]


def only_block(data, file):
    """The block of a composite data set that has cells."""
    iterator = data.NewIterator()
    iterator.UnRegister(None)
    blocks = []
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        block = iterator.GetCurrentDataObject()
        if block.IsA("vtkDataSet") and block.GetNumberOfCells() > 0:
            blocks.append(block)
        iterator.GoToNextItem()
    if len(blocks) != 1:
        raise SourceError(f"{file} holds {len(blocks)} blocks with cells, and a series holds one mesh.")
    return blocks[0]


def image_at(reader, time, file):
    reader.UpdatePipeline(time)
    image = reader.GetClientSideObject().GetOutputDataObject(0)
    if image is not None and image.IsA("vtkCompositeDataSet"):
        image = only_block(image, file)
    if image is None or not any(image.IsA(kind) for kind in KINDS):
        kind = "nothing" if image is None else image.GetClassName()
        raise SourceError(f"{file} holds {kind}, and a series holds image data (vtkImageData), a curvilinear "
                          "or rectilinear grid (vtkStructuredGrid, vtkRectilinearGrid) or a mesh "
                          "(vtkUnstructuredGrid).")
    if image.GetNumberOfPoints() == 0:
        raise SourceError(f"Nothing could be read from {file} at time {time:.17g}.")
    return image


def type_name(values):
    kind = {"f": "float", "i": "int", "u": "uint"}[values.dtype.kind]
    return f"{kind}{8 * values.dtype.itemsize}"


def arrays_of(image, wanted, data=None):
    """Names and values ([tuple][component]) of the point arrays, or of other data."""
    data = data or image.GetPointData()
    arrays = []
    for number in range(data.GetNumberOfArrays()):
        array = data.GetArray(number)
        # None stands for arrays of other things than numbers.
        if array is None or array.GetName() == GHOSTS or array.GetClassName() == "vtkBitArray":
            continue
        if wanted and array.GetName() not in wanted:
            continue
        if image.IsA("vtkUnstructuredGrid") and array in (data.GetGlobalIds(), data.GetPedigreeIds()):
            continue  # names of points and cells, which are no values
        values = vtk_to_numpy(array).reshape(array.GetNumberOfTuples(), -1)
        arrays.append((array.GetName(), numpy.ascontiguousarray(values)))
    return arrays


def flags_of(image):
    """What says which points and cells are hidden, as arrays of the image; none where nothing is."""
    size = image.GetDimensions()
    flags = []
    if image.GetPointGhostArray() is not None:
        points = vtk_to_numpy(image.GetPointGhostArray()) & numpy.uint8(HIDDEN_POINT)
        flags.append((GHOSTS, points.reshape(-1, 1)))
    if image.GetCellGhostArray() is not None:
        cells = vtk_to_numpy(image.GetCellGhostArray()) & numpy.uint8(HIDDEN_OR_REFINED_CELL)
        # Each cell has the place of its lowest corner.
        corners = numpy.zeros(size[::-1], numpy.uint8)
        shape = [max(n - 1, 1) for n in size[::-1]]
        corners[tuple(slice(n) for n in shape)] = cells.reshape(shape)
        flags.append((GHOSTS + " of cells", corners.reshape(-1, 1)))
    return [(name, numpy.ascontiguousarray(values)) for name, values in flags if values.any()]


def points_of(grid):
    """Name, values and role of the points of a grid that is no image; none of an image."""
    if grid.IsA("vtkStructuredGrid"):
        return [("", vtk_to_numpy(grid.GetPoints().GetData()), "points")]
    if grid.IsA("vtkRectilinearGrid"):
        along = [grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates()]
        return [("", vtk_to_numpy(values).reshape(-1, 1), f"along {axis}") for values, axis in zip(along, "xyz")]
    return []


def placement_of(image):
    """Where the samples of an image lie; other grids have points."""
    if not image.IsA("vtkImageData"):
        identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        return {"origin": [0.0] * 3, "spacing": [1.0] * 3, "direction": identity}
    matrix = image.GetDirectionMatrix()
    return {"origin": list(image.GetOrigin()), "spacing": list(image.GetSpacing()),
            "direction": [matrix.GetElement(row, column) for row in range(3) for column in range(3)]}


def faces_of(grid):
    """Of each polyhedron how many faces; per face how many points, and these."""
    faces = []
    stream = vtkIdList()
    for cell in range(grid.GetNumberOfCells()):
        if grid.GetCellType(cell) == VTK_POLYHEDRON:
            stream.Reset()
            grid.GetFaceStream(cell, stream)
            faces += [stream.GetId(i) for i in range(stream.GetNumberOfIds())] or [0]
    return numpy.array(faces, numpy.int64)


def parts_of(grid):
    """Values and roles of points and cells."""
    cells = grid.GetCells()
    types = numpy.array([grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())], numpy.uint8)
    offsets, corners = (vtk_to_numpy(array).astype(numpy.int64)
                        for array in (cells.GetOffsetsArray(), cells.GetConnectivityArray()))
    parts = [(vtk_to_numpy(grid.GetPoints().GetData()), "coordinates"), (offsets, "offsets"), (types, "types"),
             (corners[:offsets[-1]], "corners")]
    if VTK_POLYHEDRON in types:
        parts.append((faces_of(grid), "faces"))
    return [("", values.reshape(len(values), -1), role) for values, role in parts]


def send_mesh(stream, grid, time, arrays, wanted):
    """Points and corners of cells come before the values."""
    parts = parts_of(grid) + [(name, values, "") for name, values in arrays]
    parts += [(name, values, "cells") for name, values in arrays_of(grid, wanted, grid.GetCellData())]
    header = {"time": time, "mesh": {"points": grid.GetNumberOfPoints(), "cells": grid.GetNumberOfCells()},
              "arrays": [{"name": name, "type": type_name(values), "components": values.shape[1],
                          "tuples": values.shape[0], "role": role} for name, values, role in parts]}
    stream.write(json.dumps(header).encode() + b"\n")
    for _name, values, _role in parts:
        stream.write(memoryview(numpy.ascontiguousarray(values)).cast("B"))
    stream.flush()


def send_step(stream, image, time, arrays, wanted):
    if image.IsA("vtkUnstructuredGrid"):
        send_mesh(stream, image, time, arrays, wanted)
        return
    arrays = flags_of(image) + arrays  # by which the others are judged
    parts = points_of(image) + [(name, values, "") for name, values in arrays]
    header = {"time": time, "extent": list(image.GetExtent()), **placement_of(image),
              "arrays": [{"name": name, "type": type_name(values), "components": values.shape[1],
                          "role": role} for name, values, role in parts]}
    stream.write(json.dumps(header).encode() + b"\n")
    for _name, values, _role in parts:
        stream.write(memoryview(numpy.ascontiguousarray(values)).cast("B"))
    stream.flush()


def send(stream, wanted, files):
    reader = open_source(files)
    for time in time_values(reader):
        image = image_at(reader, time, files[0])
        send_step(stream, image, time, arrays_of(image, wanted), wanted)
    stream.write(b'{"end": true}\n')


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--array", action="append", default=[])
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    stream = take_output()
    try:
        try:
            send(stream, set(arguments.array), arguments.files)
        except (SourceError, RuntimeError) as error:  # ParaView raises the latter
            stream.write(json.dumps({"error": str(error).strip()}).encode() + b"\n")
        stream.close()
    except BrokenPipeError:
        # Nobody listens any more: whoever compared has said why.
        os._exit(1)


main()
